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
    double tolerance     = 1e-6; ///< limit for the estimated |δλ| / |λ| of every mode of the band at every operating point [-]
    int    maximum_basis = 1500; ///< size beyond which the basis is not extended; it contains all real modes in any case
  };

  struct ErrorControlledSweep
  {
    std::size_t n_left;      ///< number of points that do not meet the tolerance
    double      worst_error; ///< largest estimated |δλ| / |λ| at the points that meet the tolerance [-]
    int         n_growths;
    std::string why_stopped; ///< reason for stopping; empty if all points meet the tolerance
  };

  /// Function that receives the index of an operating point and its result.
  using KeepPoint = std::function<void(int, ChartPoint &&)>;

  /// Evaluates @p model at several operating points, in rounds of several points per thread, and passes the results to @p each in order.
  void evaluate(const ChartModel &model, const std::vector<OperatingPoint> &points, MPI_Comm communicator, const KeepPoint &each);

  std::vector<ChartPoint> evaluate(const ChartModel &model, const std::vector<OperatingPoint> &points, MPI_Comm communicator);

  /// Function that predicts zeros for stability_chart() by ChartModel::predicted_zero(), identical on every process; @p at returns the
  /// operating point for a given μ.
  PredictZero zero_predictor(const ChartModel &model, const std::function<OperatingPoint(double)> &at, MPI_Comm communicator);

  /**
   * Extends the basis of @p model to reduce the estimated errors of all modes in the band to the tolerance at all operating @p points. The
   * basis is first extended at the points with the indices @p training, one after the other, and then compressed
   * (ChartModel::compressed_basis()); without training points it is not compressed. After that, all points are evaluated, and the basis is
   * extended at the point with the largest remaining error until all points meet the tolerance or the basis cannot be improved further. A
   * result that meets the tolerance is final and is passed to @p keep; vectors added later are used only for the remaining points.
   */
  ErrorControlledSweep error_controlled_sweep(ChartModel                        &model,
                                              const std::vector<OperatingPoint> &points,
                                              const std::vector<int>            &training,
                                              const ErrorControlledSweepOptions &options,
                                              const KeepPoint                   &keep,
                                              MPI_Comm                           communicator,
                                              Progress                          &progress);
} // namespace Squeal
