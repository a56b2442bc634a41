// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/bases/basis_recipes.h>

#include <memory>
#include <string>

namespace Squeal
{
  /// Nominal numbers of columns of T_r0 and T_r, before dependent columns are dropped; tables 2, 4 and 5 of the paper.
  struct BasisSize
  {
    int n_r0, n_r;
  };
  BasisSize nominal_size(const BasisRecipe &recipe, const BasisCounts &counts);

  /// Rank tolerances.
  struct BasisOptions
  {
    /// Directions whose M-norm is below this fraction of the largest are dropped [-].
    double tolerance = 1e-10;

    /// Singular values of P_n T_r0 (columns scaled to unit M-norm) below this fraction of the largest count as zero [-].
    double connection_tolerance = 1e-12;

    double pod_tolerance = 1e-6; ///< principal axes of the snapshots below this fraction of the largest are dropped [-]
    int    pod_size      = 0;    ///< largest number of principal axes; 0: limited by the tolerance only
  };

  /// Rank of the connection of the components: T_cr spans the kernel of P_n T_r0.
  struct ConnectionRank
  {
    int    rank             = 0;  ///< rank of P_n T_r0; 0 for a basis that needs no connection
    double smallest_kept    = 0.; ///< smallest nonzero singular value, relative to the largest [-]
    double largest_dropped  = 0.; ///< largest singular value that counts as zero, relative to the largest [-]; 0: none
    double constraint_error = 0.; ///< max |P_n T_r0 T_cr| / max |T_r0 T_cr| before the final correction [-]
  };

  /// A basis of the coupled system, with the rank and the accuracy of its construction.
  struct ReducedBasis
  {
    std::shared_ptr<MultiVector> vectors;        ///< T_r in coupled coordinates, n × r, M_c-orthonormal
    int                          n_r0;           ///< columns of T_r0
    int                          n_nominal;      ///< nominal number of columns of T_r, see nominal_size()
    int                          n_dropped;      ///< columns of T_r0 T_cr that are dependent, or dropped by POD
    double                       tolerance;      ///< rank tolerance [-]
    double                       condition;      ///< condition number of the Gram matrix of T_r0 T_cr, columns scaled (POD: unscaled) [-]
    double                       orthonormality; ///< max |T_rᵀ M_c T_r − I|, below 1e-10
    ConnectionRank               connection;

    /// Number of vectors r.
    int size() const
    {
      return vectors->n_columns();
    }
  };

  /**
   * Builds a basis: joins the columns of T_r0; for component modes, finds T_cr with P_n T_r0 T_cr = 0 by a singular value decomposition of
   * P_n T_r0, columns scaled to unit M-norm, and converts to coupled coordinates; then orthonormalises the columns in M_c. Rigid-body
   * motions that are missing in the disc_free modes of a free disc are added.
   *
   * Throws SolverError if an ingredient is missing or empty, if a basis of component modes is larger than the system, or if
   * orthonormalisation fails.
   */
  ReducedBasis reduced_basis(const BasisRecipe &recipe, const BasisIngredients &ingredients, const BasisOptions &options = {});
} // namespace Squeal
