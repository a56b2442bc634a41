#pragma once

#include <squeal/linear_algebra/multivector.h>

#include <memory>

namespace Squeal
{
  /**
   * M ü + C u̇ + K u = f of the uncoupled bodies (left-hand side of eq. (4) of
   * the paper) on the free dofs; rows distributed over the processes.
   */
  struct SecondOrderSystem
  {
    std::shared_ptr<const SparseMatrix> mass;      ///< M [kg]
    std::shared_ptr<const SparseMatrix> damping;   ///< C [N s/m]; null: none
    std::shared_ptr<const SparseMatrix> stiffness; ///< K [N/m]
  };
} // namespace Squeal
