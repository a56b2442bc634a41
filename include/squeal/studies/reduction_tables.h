#pragma once

#include <squeal/bases/reduced_basis.h>
#include <squeal/estimates/reduction_errors.h>
#include <squeal/output/table.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// A basis of a study with what was measured of it.
  struct Candidate
  {
    const BasisRecipe     *recipe;
    std::string            name;       ///< with the variant where there are several
    std::string            truncation; ///< of the component modes
    ReducedBasis           basis;      ///< its vectors go when it has been measured
    int                    n_r           = 0;
    double                 build_seconds = 0., solve_seconds = 0.;
    std::vector<ModeError> errors = {};
  };

  /// Largest errors in each group of modes, and times.
  Table reduction_error_table(const std::vector<Candidate> &candidates, const std::vector<std::string> &groups);

  /**
   * Columns, sizes, decisions on rank, gains and times.
   *
   * @param n            dofs of the coupled system
   * @param full_seconds of the solution at full order
   */
  Table reduction_basis_table(const std::vector<Candidate> &candidates, int n, double full_seconds);

  /// Every mode of every basis beside the reference.
  Table reduction_mode_table(const std::vector<Candidate>   &candidates,
                             const std::vector<ModeLabel>   &labels,
                             const std::vector<std::string> &groups);

  /// How far the estimates are to be trusted: they know nothing of the reference, by which modes are @p unstable.
  Table reduction_estimate_table(const std::vector<Candidate> &candidates, const std::vector<bool> &unstable);
} // namespace Squeal
