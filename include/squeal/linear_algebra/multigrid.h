#pragma once

#include <squeal/linear_algebra/linear_operator.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <memory>
#include <string>
#include <vector>

namespace Squeal
{
  /// What smoothed aggregation is told of a matrix beside its entries.
  struct NearNullSpace
  {
    MultiVector      vectors; ///< motions that cost little energy, n × k, such as those of rigid bodies
    std::vector<int> points;  ///< of each row of this process: number of the point to which it belongs, with up to three rows
  };

  /**
   * One cycle of algebraic multigrid by smoothed aggregation (P. Vaněk, J. Mandel, M. Brezina, 1996) for a symmetric positive
   * definite matrix: a symmetric positive definite approximation of A⁻¹, in single precision. Memory grows like the entries of A.
   * The hierarchy is MueLu's; each level is smoothed by a sweep of the Gauss-Seidel method forwards and one backwards, within a
   * process.
   */
  class Multigrid : public LinearOperator
  {
  public:
    /// Throws SolverError naming @p what if there is no hierarchy.
    Multigrid(const SparseMatrix &A, const NearNullSpace &space, const std::string &what);
    ~Multigrid() override;

    void apply(const MultiVector &X, MultiVector &Y) const override;

    const RowMap &map() const override;

    /// Entries of all matrices of the hierarchy, on all processes.
    double n_entries() const;

    int n_levels() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation;
  };
} // namespace Squeal
