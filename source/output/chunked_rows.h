#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace Squeal
{
  /**
   * Rows of a table that lie on the processes one part after the other, as chunks for HDF5's filters `shuffle` and `deflate`. A chunk is
   * compressed by the process that has its first row, and comes to process 0 when that asks for it. All processes must call.
   */
  class ChunkedRows
  {
  public:
    struct Chunk
    {
      bool                       is_deflated; ///< else only shuffled: it would have grown
      std::vector<unsigned char> bytes;
    };

    /**
     * Compresses the chunks of this process.
     *
     * @param values         rows of this process
     * @param row_size       [byte]
     * @param number_size    of a value [byte]
     * @param largest_chunk  most rows of a chunk
     */
    ChunkedRows(const char   *values,
                std::uint64_t n_rows_here,
                std::size_t   row_size,
                std::size_t   number_size,
                std::uint64_t largest_chunk,
                MPI_Comm      communicator);

    /// Of all processes.
    std::uint64_t n_rows() const
    {
      return ends.back();
    }

    std::uint64_t rows_per_chunk() const
    {
      return chunk_rows;
    }

    /// Hands the chunks of this process to process 0.
    void send() const;

    /// On process 0: all chunks in their order, with the number of their first row.
    void receive(const std::function<void(std::uint64_t first_row, const Chunk &chunk)> &action) const;

    /// Of 1 to 9; with higher ones shapes of modes get smaller by half a per cent at most, and take up to two and a half times as long.
    static constexpr int compression_level = 1;

  private:
    std::uint64_t first_row(int process) const
    {
      return process == 0 ? 0 : ends[process - 1];
    }

    /// The row at or after @p row where a chunk begins, or the end.
    std::uint64_t next_chunk(std::uint64_t row) const;

    /// The process that has a row.
    int process_of(std::uint64_t row) const;

    /// The rows of the chunks of this process: others send what they have of the last one.
    std::vector<char> rows_of_chunks(const char *values, std::size_t row_size) const;

    const MPI_Comm             communicator;
    int                        rank;
    std::vector<std::uint64_t> ends; ///< of the rows of each process
    std::uint64_t              chunk_rows;
    std::vector<Chunk>         chunks; ///< of this process
  };
} // namespace Squeal
