#pragma once

#include <squeal/linear_algebra/multivector.h>

namespace Squeal
{
  /// A linear map on distributed vectors, y = A x, for many vectors at once.
  class LinearOperator
  {
  public:
    virtual ~LinearOperator() = default;

    /// Y = A X; X and Y have the same map and number of columns and do not alias.
    virtual void apply(const MultiVector &X, MultiVector &Y) const = 0;

    /// Distribution of the rows of Y, and of those of X where A is square.
    virtual const RowMap &map() const = 0;
  };
} // namespace Squeal
