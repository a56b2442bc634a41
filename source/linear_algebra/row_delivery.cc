#include <squeal/linear_algebra/row_delivery.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <numeric>

namespace Squeal
{
  namespace
  {
    /// Columns that travel together: more take larger buffers, fewer more messages.
    constexpr int columns_at_a_time = 8;

    std::vector<int> offsets_of(const std::vector<int> &counts)
    {
      std::vector<int> offsets(counts.size(), 0);
      std::partial_sum(counts.begin(), counts.end() - 1, offsets.begin() + 1);
      return offsets;
    }

    std::vector<int> times(const int factor, std::vector<int> values)
    {
      for (int &value : values)
        value *= factor;
      return values;
    }
  } // namespace

  RowDelivery::RowDelivery(std::vector<int> numbers_here, const int first_row, const int n_rows, const MPI_Comm communicator)
    : numbers(std::move(numbers_here))
    , communicator(communicator)
  {
    int n_processes;
    MPI_Comm_size(communicator, &n_processes);
    const int        end = first_row + n_rows;
    std::vector<int> ends(n_processes); // of the rows of each process, ascending
    MPI_Allgather(&end, 1, MPI_INT, ends.data(), 1, MPI_INT, communicator);
    const auto owner = [&](const int number) { return std::upper_bound(ends.begin(), ends.end(), number) - ends.begin(); };

    // Rows in the order of their owners
    sent.counts.resize(n_processes);
    for (const int number : numbers)
      ++sent.counts[owner(number)];
    sent.offsets          = offsets_of(sent.counts);
    std::vector<int> next = sent.offsets, numbers_sent(numbers.size());
    sent.places.resize(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i)
      {
        const int place     = next[owner(numbers[i])]++;
        sent.places[place]  = static_cast<int>(i);
        numbers_sent[place] = numbers[i];
      }

    received.counts.resize(n_processes);
    MPI_Alltoall(sent.counts.data(), 1, MPI_INT, received.counts.data(), 1, MPI_INT, communicator);
    received.offsets = offsets_of(received.counts);
    AssertThrow(received.offsets.back() + received.counts.back() == n_rows,
                dealii::ExcMessage("rows of a solution are missing, or are there twice"));
    received.places.resize(n_rows);
    MPI_Alltoallv(numbers_sent.data(), sent.counts.data(), sent.offsets.data(), MPI_INT, received.places.data(), received.counts.data(),
                  received.offsets.data(), MPI_INT, communicator);
    for (int &place : received.places)
      place -= first_row;
  }

  void RowDelivery::deliver(const double *X, const std::size_t X_stride, double *Y, const std::size_t Y_stride, const int n_columns) const
  {
    std::vector<double> outgoing, incoming;
    // In a buffer, the rows for a process are together, one column of them after the other.
    const auto for_entries = [](const Messages &messages, const int n, const auto &action) {
      std::size_t position = 0;
      for (std::size_t process = 0; process < messages.counts.size(); ++process)
        for (int j = 0; j < n; ++j)
          for (int i = 0; i < messages.counts[process]; ++i)
            action(position++, messages.places[messages.offsets[process] + i], j);
    };
    for (int first = 0; first < n_columns; first += columns_at_a_time)
      {
        const int n = std::min(columns_at_a_time, n_columns - first);
        outgoing.resize(sent.places.size() * n);
        incoming.resize(received.places.size() * n);
        for_entries(sent, n, [&](const std::size_t k, const int i, const int j) { outgoing[k] = X[i + (first + j) * X_stride]; });
        MPI_Alltoallv(outgoing.data(), times(n, sent.counts).data(), times(n, sent.offsets).data(), MPI_DOUBLE, incoming.data(),
                      times(n, received.counts).data(), times(n, received.offsets).data(), MPI_DOUBLE, communicator);
        for_entries(received, n, [&](const std::size_t k, const int i, const int j) { Y[i + (first + j) * Y_stride] = incoming[k]; });
      }
  }
} // namespace Squeal
