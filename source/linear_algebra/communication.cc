// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/linear_algebra/communication.h>

#include <deal.II/base/mpi.h>

namespace Squeal
{
  namespace MPI = dealii::Utilities::MPI;

  int n_processes(const MPI_Comm communicator)
  {
    return static_cast<int>(MPI::n_mpi_processes(communicator));
  }

  int this_process(const MPI_Comm communicator)
  {
    return static_cast<int>(MPI::this_mpi_process(communicator));
  }

  bool is_alone(const MPI_Comm communicator)
  {
    static const bool only_one = n_processes(MPI_COMM_WORLD) == 1;
    return only_one || n_processes(communicator) == 1;
  }

  template <typename Number>
  void sum_over_processes(const MPI_Comm communicator, Number *values, const std::size_t n)
  {
    if (!is_alone(communicator))
      MPI::sum(dealii::ArrayView<const Number>(values, n), communicator, dealii::ArrayView<Number>(values, n));
  }

  template <typename Number>
  void smallest_of_processes(const MPI_Comm communicator, Number *values, const std::size_t n)
  {
    if (!is_alone(communicator))
      MPI::min(dealii::ArrayView<const Number>(values, n), communicator, dealii::ArrayView<Number>(values, n));
  }

  template void sum_over_processes(MPI_Comm, double *, std::size_t);
  template void sum_over_processes(MPI_Comm, int *, std::size_t);
  template void smallest_of_processes(MPI_Comm, double *, std::size_t);
  template void smallest_of_processes(MPI_Comm, int *, std::size_t);

  double largest_of_processes(const MPI_Comm communicator, const double value)
  {
    return is_alone(communicator) ? value : MPI::max(value, communicator);
  }

  void copy_from_root(const MPI_Comm communicator, void *bytes, const std::size_t n)
  {
    if (!is_alone(communicator))
      MPI::broadcast(static_cast<char *>(bytes), n, 0, communicator);
  }
} // namespace Squeal
