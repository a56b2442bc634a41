#pragma once

#include <squeal/linear_algebra/multivector.h>

#include <deal.II/base/aligned_vector.h>

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace Squeal
{
  /**
   * A factor L of Pᵀ A P = L Lᵀ as CHOLMOD stores it, which has to outlive its use. Supernode s is the columns first_column[s], ... of L; its rows
   * are row[row_start[s]], ..., ascending, of which the first are these columns; their values begin at value[value_start[s]]. Row i of PᵀX is
   * row permutation[i] of X.
   */
  struct SupernodalFactor
  {
    int           n_rows = 0, n_supernodes = 0;
    const int    *first_column = nullptr, *row_start = nullptr, *value_start = nullptr, *row = nullptr, *permutation = nullptr;
    const double *value = nullptr;

    int n_columns(const int s) const
    {
      return first_column[s + 1] - first_column[s];
    }

    int n_rows_of(const int s) const
    {
      return row_start[s + 1] - row_start[s];
    }
  };

  /**
   * Y = A⁻¹ X for a few or many columns. L is read once for up to sixteen columns, whose rows lie beside each other. CHOLMOD's own solve
   * leaves these products to BLAS, which copies L for each of them, and takes longer.
   *
   * Several threads take groups of columns or, of one group only, subtrees of the elimination tree. Each subtree adds what it changes
   * in rows beyond itself to rows of its own; their sums have always the same order. So the result does not depend on the number of
   * threads, and that of a column hardly on the others.
   */
  class SupernodalSolve
  {
  public:
    explicit SupernodalSolve(const SupernodalFactor &L);

    /// X and Y of one process may be the same.
    void apply(const MultiVector &X, MultiVector &Y) const;

  private:
    /// Numbers of a group of columns: all its rows, those of supernodes at the top as each part changes them, and those of one supernode.
    struct Workspace
    {
      dealii::AlignedVector<double>              rows;
      std::vector<dealii::AlignedVector<double>> changes, fronts;
    };

    /// Calls a function with 0 to n - 1, like run_tasks() or one after the other.
    using Tasks = std::function<void(int n, const std::function<void(int)> &task)>;

    template <int width>
    void solve_group(const MultiVector &X, MultiVector &Y, int first, const Tasks &in_tasks) const;

    std::unique_ptr<Workspace> borrow(int width) const;
    void                       give_back(std::unique_ptr<Workspace> workspace) const;

    SupernodalFactor              L;
    int                           largest_n_rows = 0;
    std::vector<std::vector<int>> parts;        ///< supernodes of the subtrees of each task, ascending
    std::vector<int>              top;          ///< supernodes above all of them, ascending
    std::vector<int>              place_in_top; ///< of their rows; -1 for those of subtrees
    std::vector<int>              top_rows;

    mutable std::mutex                              mutex;
    mutable std::vector<std::unique_ptr<Workspace>> workspaces;
  };
} // namespace Squeal
