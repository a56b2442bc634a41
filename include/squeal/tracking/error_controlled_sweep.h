// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/progress.h>
#include <squeal/tracking/chart_model.h>

#include <mpi.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// How far a basis is grown for a chart.
  struct ErrorControlledSweepOptions
  {
    double tolerance     = 1e-6; ///< on the estimated |δλ| / |λ| of every mode of the band at every operating point [-]
    int    maximum_basis = 1500; ///< vectors, at least the real modes
  };

  /// What a sweep has found within its tolerance.
  struct ErrorControlledSweep
  {
    std::size_t n_left;      ///< points that miss the tolerance
    double      worst_error; ///< largest estimated |δλ| / |λ| of the others [-]
    int         n_growths;
    std::string why_stopped; ///< empty if all points meet the tolerance
  };

  /// Takes what was found at an operating point, by its number.
  using KeepPoint = std::function<void(int, ChartPoint &&)>;

  /// The results of @p model at several operating points, in turns of some for each thread of each process, which are then given to @p each
  /// in order.
  void evaluate(const ChartModel &model, const std::vector<OperatingPoint> &points, MPI_Comm communicator, const KeepPoint &each);

  /// The same, all of them.
  std::vector<ChartPoint> evaluate(const ChartModel &model, const std::vector<OperatingPoint> &points, MPI_Comm communicator);

  /// Predicts zeros for stability_chart() by ChartModel::predicted_zero(), the same on every process; @p at gives the operating point of a μ.
  PredictZero zero_predictor(const ChartModel &model, const std::function<OperatingPoint(double)> &at, MPI_Comm communicator);

  /**
   * Grows the basis of @p model until the estimated errors of all modes in the
   * band meet the tolerance at every one of the operating @p points: first at
   * those numbered in @p training, one after the other. Their modes tell which
   * smaller basis would do (ChartModel::compressed_basis()); without training the
   * basis stays as it is. With that all points are
   * evaluated, and it grows where the largest error is left. A result that
   * meets the tolerance is final and goes to @p keep; later vectors serve the other points only.
   */
  ErrorControlledSweep error_controlled_sweep(ChartModel                        &model,
                                              const std::vector<OperatingPoint> &points,
                                              const std::vector<int>            &training,
                                              const ErrorControlledSweepOptions &options,
                                              const KeepPoint                   &keep,
                                              MPI_Comm                           communicator,
                                              Progress                          &progress);
} // namespace Squeal
