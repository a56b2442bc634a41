#include <squeal/linear_algebra/dense_serialization.h>
#include <squeal/linear_algebra/row_delivery.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Squeal
{
  namespace MPI = dealii::Utilities::MPI;

  namespace
  {
    /// Columns that travel together: more take larger buffers, fewer more messages.
    constexpr Eigen::Index columns_at_a_time = 16;
  } // namespace

  RowDelivery::RowDelivery(const std::vector<int> &numbers, const RowMap &owners)
    : communicator(owners.communicator())
    , nothing(MPI::max(static_cast<int>(numbers.size()), communicator) == 0)
  {
    Places wanted;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      {
        const int process = owners.owner(numbers[i]);
        places_here[process].push_back(static_cast<int>(i));
        wanted[process].push_back(numbers[i]);
      }
    places_owned = MPI::some_to_some(communicator, wanted);
    for (auto &[process, places] : places_owned)
      for (int &place : places)
        place -= owners.first();
  }

  void RowDelivery::exchange(const Places                        &from,
                             const Eigen::Ref<const DenseMatrix> &X,
                             const Places                        &to,
                             Eigen::Ref<DenseMatrix>              Y,
                             const bool                           adding) const
  {
    for (Eigen::Index first = 0; first < X.cols(); first += columns_at_a_time)
      {
        const auto                          columns = Eigen::seqN(first, std::min(columns_at_a_time, X.cols() - first));
        std::map<unsigned int, DenseMatrix> rows;
        for (const auto &[process, places] : from)
          rows[process] = X(places, columns);
        for (const auto &[process, received] : MPI::some_to_some(communicator, rows))
          if (adding)
            Y(to.at(process), columns) += received;
          else
            Y(to.at(process), columns) = received;
      }
  }
} // namespace Squeal
