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
  /// Stopping criteria for the basis of a chart.
  struct ErrorControlledSweepOptions
  {
    double tolerance     = 1e-6; ///< for the estimated |δλ| / |λ| of every mode of the band at every operating point [-]
    int    maximum_basis = 1500; ///< maximum number of vectors, at least the number of real modes
  };

  /// Result of a sweep within its tolerance.
  struct ErrorControlledSweep
  {
    std::size_t n_left;      ///< number of points that miss the tolerance
    double      worst_error; ///< largest estimated |δλ| / |λ| of the other points [-]
    int         n_growths;
    std::string why_stopped; ///< empty if all points meet the tolerance
  };

  /// Receives the result at an operating point, by its index.
  using KeepPoint = std::function<void(int, ChartPoint &&)>;

  /// Evaluates @p model at several operating points, in rounds of a few per thread and process, and passes the results to @p each in order.
  void evaluate(const ChartModel &model, const std::vector<OperatingPoint> &points, MPI_Comm communicator, const KeepPoint &each);

  /// Evaluates @p model at all points.
  std::vector<ChartPoint> evaluate(const ChartModel &model, const std::vector<OperatingPoint> &points, MPI_Comm communicator);

  /// Predicts zeros for stability_chart() by ChartModel::predicted_zero(), the same on every process; @p at: operating point for a given μ.
  PredictZero zero_predictor(const ChartModel &model, const std::function<OperatingPoint(double)> &at, MPI_Comm communicator);

  /**
   * Extends the basis of @p model until the estimated errors of all modes in the band meet the tolerance at all operating @p points. It is
   * first extended at the points numbered in @p training, one after the other, and compressed (ChartModel::compressed_basis()); without
   * training it is not compressed. Then all points are evaluated, and the basis is extended at the point with the largest remaining error.
   * A result that meets the tolerance is final and passed to @p keep; later vectors serve only the remaining points.
   */
  ErrorControlledSweep error_controlled_sweep(ChartModel                        &model,
                                              const std::vector<OperatingPoint> &points,
                                              const std::vector<int>            &training,
                                              const ErrorControlledSweepOptions &options,
                                              const KeepPoint                   &keep,
                                              MPI_Comm                           communicator,
                                              Progress                          &progress);
} // namespace Squeal
