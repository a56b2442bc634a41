// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/bases/reduced_basis.h>
#include <squeal/estimates/mode_groups.h>
#include <squeal/estimates/reduction_errors.h>
#include <squeal/output/table.h>
#include <squeal/studies/steps/reduction_sets.h>

namespace Squeal
{
  /// A basis of a study and its measured accuracy and cost.
  struct MeasuredBasis
  {
    const BasisRecipe     *recipe;
    std::string            name;       ///< name of the basis and of its variant
    std::string            truncation; ///< truncation of the component modes
    ReducedBasis           basis;      ///< vectors may be freed after the measurement
    int                    n_r           = 0;
    double                 build_seconds = 0., solve_seconds = 0.;
    std::vector<ModeError> errors = {};
  };

  /// Largest error of λ of the modes of a basis relative to the reference.
  double largest_error(const MeasuredBasis &candidate);

  /// `Output/Write system = reduced`: writes the reduced model of a basis, as a step of the run.
  ///
  /// @param number of the basis, counted from one
  void write_reduced_system(const ReducedModel &model, const ReductionPlan &plan, const MeasuredBasis &candidate, int number, Run &run);

  /// Full-order modes as reference for the bases.
  struct ReferenceSolution
  {
    ComplexModes                          modes;
    std::vector<ModeLabel>                labels;      ///< labels of the modes
    std::vector<double>                   disc_shares; ///< the disc's share of the energy of each mode [-]; empty: there is no disc
    std::vector<std::string>              groups;
    std::vector<std::vector<std::string>> joined; ///< groups that the error table also lists together
    std::vector<bool>                     unstable;
    double                                seconds; ///< CPU time of the solution, including its factorisation
  };

  /// Numbers of component modes for a truncation.
  struct TruncatedModes
  {
    ModeTruncation             truncation;
    std::map<BasisSource, int> n;
  };

  /// Table of the largest errors in each group of modes, and times.
  Table reduction_error_table(const std::vector<MeasuredBasis> &candidates, const ReferenceSolution &reference);

  /// Table of columns, sizes, ranks, speed-ups and times of the bases; @p n: dofs of the uncoupled structure, @p full_seconds: time at full
  /// order.
  Table reduction_basis_table(const std::vector<MeasuredBasis> &candidates, int n, double full_seconds);

  /// Table of all modes of all bases and the reference.
  Table reduction_mode_table(const std::vector<MeasuredBasis> &candidates, const ReferenceSolution &reference);

  /// Table of the reliability of the error estimates, which are computed without the reference.
  Table reduction_estimate_table(const std::vector<MeasuredBasis> &candidates, const ReferenceSolution &reference);

  /// Table of the numbers of component modes of each truncation.
  Table reduction_truncation_table(const std::vector<TruncatedModes> &truncations);
} // namespace Squeal
