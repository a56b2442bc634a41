// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/bases/reduced_basis.h>
#include <squeal/estimates/mode_groups.h>
#include <squeal/estimates/reduction_errors.h>
#include <squeal/output/table.h>
#include <squeal/studies/steps/reduction_sets.h>

namespace Squeal
{
  /// A basis of a study with what was measured of it.
  struct MeasuredBasis
  {
    const BasisRecipe     *recipe;
    std::string            name;       ///< with the variant where there are several
    std::string            truncation; ///< of the component modes
    ReducedBasis           basis;      ///< its vectors go when it has been measured
    int                    n_r           = 0;
    double                 build_seconds = 0., solve_seconds = 0.;
    std::vector<ModeError> errors = {};
  };

  /// The modes of full order that bases are measured against.
  struct ReferenceSolution
  {
    ComplexModes                          modes;
    std::vector<ModeLabel>                labels;      ///< of the modes
    std::vector<double>                   disc_shares; ///< of their energy [-]; empty: there is no disc
    std::vector<std::string>              groups;
    std::vector<std::vector<std::string>> joined; ///< groups whose maxima the paper takes together
    std::vector<bool>                     unstable;
    double                                seconds; ///< of the processor for the solution, its factorisation included
  };

  /// Numbers of component modes that a truncation has led to.
  struct TruncatedModes
  {
    ModeTruncation             truncation;
    std::map<BasisSource, int> n;
  };

  /// Largest errors in each group of modes, and times.
  Table reduction_error_table(const std::vector<MeasuredBasis> &candidates, const ReferenceSolution &reference);

  /// Columns, sizes, decisions on rank, gains and times beside @p n dofs of the uncoupled structure and @p full_seconds at full order.
  Table reduction_basis_table(const std::vector<MeasuredBasis> &candidates, int n, double full_seconds);

  /// Every mode of every basis beside the reference.
  Table reduction_mode_table(const std::vector<MeasuredBasis> &candidates, const ReferenceSolution &reference);

  /// How far the estimates are to be trusted: they know nothing of the reference.
  Table reduction_estimate_table(const std::vector<MeasuredBasis> &candidates, const ReferenceSolution &reference);

  /// Numbers of component modes below each truncation.
  Table reduction_truncation_table(const std::vector<TruncatedModes> &truncations);
} // namespace Squeal
