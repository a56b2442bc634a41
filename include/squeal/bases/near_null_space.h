#pragma once

#include <squeal/linear_algebra/multigrid.h>
#include <squeal/model/model.h>

namespace Squeal
{
  /**
   * Rigid-body motions of all bodies together, of which every part of a body moves in six, on the dofs that the columns of
   * @p kernel select (T_c, or the kernel of a component), and the nodes of these dofs.
   */
  NearNullSpace near_null_space(const Model &model, const SparseMatrix &kernel);
} // namespace Squeal
