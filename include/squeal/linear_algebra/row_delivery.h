#pragma once

#include <squeal/linear_algebra/dense.h>
#include <squeal/linear_algebra/row_map.h>

#include <map>
#include <vector>

namespace Squeal
{
  /**
   * Brings rows of vectors from where they are to where they are wanted: from any process to those that own them, and back. Who sends what
   * to whom is found once; all processes must call.
   */
  class RowDelivery
  {
  public:
    /// @param numbers of the rows here, in the order in which they lie; several processes may have the same
    RowDelivery(const std::vector<int> &numbers, const RowMap &owners);

    /// Whether no process has a row here.
    bool empty() const
    {
      return nothing;
    }

    /// Own rows become those that are here.
    void deliver(const Eigen::Ref<const DenseMatrix> &here, Eigen::Ref<DenseMatrix> own) const
    {
      exchange(places_here, here, places_owned, own, false);
    }

    /// The same, but what is here is added to the own rows, process after process.
    void add(const Eigen::Ref<const DenseMatrix> &here, Eigen::Ref<DenseMatrix> own) const
    {
      exchange(places_here, here, places_owned, own, true);
    }

    /// Rows here become those of their owners.
    void fetch(const Eigen::Ref<const DenseMatrix> &own, Eigen::Ref<DenseMatrix> here) const
    {
      exchange(places_owned, own, places_here, here, false);
    }

  private:
    /// Of the rows that are exchanged with each process.
    using Places = std::map<unsigned int, std::vector<int>>;

    void exchange(const Places                        &from,
                  const Eigen::Ref<const DenseMatrix> &X,
                  const Places                        &to,
                  Eigen::Ref<DenseMatrix>              Y,
                  bool                                 adding) const;

    MPI_Comm communicator;
    Places   places_here, places_owned;
    bool     nothing;
  };
} // namespace Squeal
