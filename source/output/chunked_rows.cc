#include "chunked_rows.h"

#include <squeal/base/tasks.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <zlib.h>

namespace Squeal
{
  namespace
  {
    /// What HDF5's filters make of a chunk: the first bytes of all numbers, then the second ones, ...; then deflated.
    ChunkedRows::Chunk compressed(const std::vector<unsigned char> &chunk, const std::size_t number_size)
    {
      const std::size_t          n = chunk.size() / number_size;
      std::vector<unsigned char> shuffled(chunk.size());
      for (std::size_t byte = 0; byte < number_size; ++byte)
        for (std::size_t i = 0; i < n; ++i)
          shuffled[byte * n + i] = chunk[i * number_size + byte];
      std::vector<unsigned char> deflated(shuffled.size());
      uLongf                     size = deflated.size();
      if (compress2(deflated.data(), &size, shuffled.data(), shuffled.size(), ChunkedRows::compression_level) != Z_OK)
        return {false, std::move(shuffled)};
      deflated.resize(size);
      deflated.shrink_to_fit();
      return {true, std::move(deflated)};
    }
  } // namespace

  ChunkedRows::ChunkedRows(const char         *values,
                           const std::uint64_t n_rows_here,
                           const std::size_t   row_size,
                           const std::size_t   number_size,
                           const std::uint64_t largest_chunk,
                           const MPI_Comm      communicator)
    : communicator(communicator)
  {
    int n_processes;
    MPI_Comm_rank(communicator, &rank);
    MPI_Comm_size(communicator, &n_processes);
    ends.resize(n_processes);
    MPI_Allgather(&n_rows_here, 1, MPI_UINT64_T, ends.data(), 1, MPI_UINT64_T, communicator);
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    chunk_rows = std::clamp<std::uint64_t>(n_rows(), 1, largest_chunk);

    const std::vector<char> rows       = rows_of_chunks(values, row_size);
    const std::size_t       chunk_size = chunk_rows * row_size;
    chunks.resize((rows.size() + chunk_size - 1) / chunk_size);
    run_tasks(static_cast<int>(chunks.size()), [&](const int number) {
      const std::size_t          begin = number * chunk_size;
      std::vector<unsigned char> chunk(chunk_size, 0); // the last one of all has rows beyond the end
      std::copy_n(rows.begin() + begin, std::min(chunk.size(), rows.size() - begin), chunk.begin());
      chunks[number] = compressed(chunk, number_size);
    });
  }

  std::uint64_t ChunkedRows::next_chunk(const std::uint64_t row) const
  {
    return std::min((row + chunk_rows - 1) / chunk_rows * chunk_rows, n_rows());
  }

  int ChunkedRows::process_of(const std::uint64_t row) const
  {
    return static_cast<int>(std::upper_bound(ends.begin(), ends.end(), row) - ends.begin());
  }

  std::vector<char> ChunkedRows::rows_of_chunks(const char *values, const std::size_t row_size) const
  {
    const int n_processes = static_cast<int>(ends.size());
    // Rows before the first chunk that begins on a process belong to one that has begun on a process before
    const auto       end_of_head = [&](const int process) { return std::min(next_chunk(first_row(process)), ends[process]); };
    std::vector<int> sent(n_processes, 0), received(n_processes, 0), sent_offsets(n_processes, 0), received_offsets(n_processes, 0);
    int              n_received = 0;
    for (int process = 0; process < n_processes; ++process)
      if (const auto n = static_cast<int>((end_of_head(process) - first_row(process)) * row_size); n > 0)
        {
          const int owner = process_of(first_row(process) / chunk_rows * chunk_rows);
          if (process == rank)
            sent[owner] = n;
          if (owner == rank)
            {
              received[process]         = n;
              received_offsets[process] = n_received;
              n_received += n;
            }
        }
    const std::size_t n_head = (end_of_head(rank) - first_row(rank)) * row_size, n_here = (ends[rank] - first_row(rank)) * row_size;
    std::vector<char> rows(n_here - n_head + n_received);
    std::copy(values + n_head, values + n_here, rows.begin());
    MPI_Alltoallv(values, sent.data(), sent_offsets.data(), MPI_BYTE, rows.data() + (n_here - n_head), received.data(),
                  received_offsets.data(), MPI_BYTE, communicator);
    return rows;
  }

  void ChunkedRows::send() const
  {
    for (const Chunk &chunk : chunks)
      {
        const std::array<int, 2> head = {{static_cast<int>(chunk.bytes.size()), chunk.is_deflated}};
        MPI_Send(head.data(), 2, MPI_INT, 0, 0, communicator);
        MPI_Send(chunk.bytes.data(), head[0], MPI_BYTE, 0, 0, communicator);
      }
  }

  void ChunkedRows::receive(const std::function<void(std::uint64_t first_row, const Chunk &chunk)> &action) const
  {
    auto own = chunks.begin();
    for (std::uint64_t row = 0; row < n_rows(); row += chunk_rows)
      if (const int process = process_of(row); process == rank)
        action(row, *own++);
      else
        {
          std::array<int, 2> head;
          MPI_Recv(head.data(), 2, MPI_INT, process, 0, communicator, MPI_STATUS_IGNORE);
          Chunk chunk{head[1] != 0, std::vector<unsigned char>(head[0])};
          MPI_Recv(chunk.bytes.data(), head[0], MPI_BYTE, process, 0, communicator, MPI_STATUS_IGNORE);
          action(row, chunk);
        }
  }
} // namespace Squeal
