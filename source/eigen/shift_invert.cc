#include "shift_invert.h"

namespace Squeal
{
  ShiftInvert::ShiftInvert(const Factorization &factors, const SparseMatrix &M, const MultiVector *deflated)
    : factors(factors)
    , M(M)
    , deflated(deflated)
  {}



  void ShiftInvert::apply(const MultiVector &X, MultiVector &Y) const
  {
    apply_to_image(M * X, Y);
  }



  void ShiftInvert::apply_to_image(const MultiVector &B, MultiVector &Y) const
  {
    factors.apply(B, Y);
    project(Y);
  }



  void ShiftInvert::project(MultiVector &X) const
  {
    if (deflated != nullptr)
      multiply_add(-1., *deflated, gram(*deflated, M * X), 1., X);
  }



  const SparseMatrix &ShiftInvert::mass() const
  {
    return M;
  }
} // namespace Squeal
