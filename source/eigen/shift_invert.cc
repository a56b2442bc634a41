#include "shift_invert.h"

namespace Squeal
{
  ShiftInvert::ShiftInvert(const LinearOperator &inverse, const SparseMatrix &M, const MultiVector *deflated)
    : inverse(inverse)
    , M(M)
    , deflated(deflated)
  {}

  void ShiftInvert::apply(const MultiVector &X, MultiVector &Y) const
  {
    apply_to_image(M * X, Y);
  }

  void ShiftInvert::apply_to_image(const MultiVector &B, MultiVector &Y) const
  {
    inverse.apply(B, Y);
    project(Y);
  }

  void ShiftInvert::project(MultiVector &X) const
  {
    if (deflated != nullptr)
      multiply_add(-1., *deflated, gram(*deflated, M * X), 1., X);
  }

  const RowMap &ShiftInvert::map() const
  {
    return M.map();
  }

  const SparseMatrix &ShiftInvert::mass() const
  {
    return M;
  }

  int ShiftInvert::n_free() const
  {
    return M.n_rows() - (deflated != nullptr ? deflated->n_columns() : 0);
  }
} // namespace Squeal
