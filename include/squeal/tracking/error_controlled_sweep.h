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

  /// Where results are kept as they come, and where an interrupted sweep finds them again.
  class ChartStore
  {
  public:
    virtual ~ChartStore() = default;

    /// The result at an operating point, known by its line and friction coefficient, if there is one; the same on every process.
    virtual std::optional<ChartPoint> find(const OperatingPoint &point) const = 0;

    /// Keeps a final result; called on every process.
    virtual void keep(const OperatingPoint &point, const ChartPoint &result) = 0;

    /// Blocks of vectors by which the basis has grown, in their order.
    virtual std::vector<MultiVector> basis() const = 0;

    /// Keeps the next block of the basis; called on every process.
    virtual void keep(const MultiVector &block) = 0;
  };

  /// What a sweep has found within its tolerance.
  struct ErrorControlledSweep
  {
    std::vector<std::optional<ChartPoint>> points;      ///< one for each operating point; nothing where the tolerance is missed
    double                                 worst_error; ///< largest estimated |δλ| / |λ| of the points [-]
    int                                    n_growths;
    std::string                            why_stopped; ///< empty if all points meet the tolerance
  };

  /// The results of @p model at several operating points, in turns of some for each thread of each process, which are then given to @p each in order.
  std::vector<ChartPoint> evaluate(const ChartModel                                   &model,
                                   const std::vector<OperatingPoint>                  &points,
                                   MPI_Comm                                            communicator,
                                   const std::function<void(int, const ChartPoint &)> &each = {});

  /// Predicts zeros for stability_chart() by ChartModel::predicted_zero(), the same on every process; @p at gives the operating point of a μ.
  PredictZero zero_predictor(const ChartModel &model, const std::function<OperatingPoint(double)> &at, MPI_Comm communicator);

  /**
   * Grows the basis of @p model until the estimated errors of all modes in the
   * band meet the tolerance at every one of the operating @p points: first at
   * those numbered in @p training, one after the other. Their modes tell which
   * smaller basis would do (ChartModel::compressed_basis()). With that all points are
   * evaluated, and it grows where the largest error is left. A result that
   * meets the tolerance is final; later vectors serve the other points only.
   * The basis so far and the results in the @p store, which may be null,
   * determine how a sweep goes on: an interrupted one continues as if it had
   * not been.
   */
  ErrorControlledSweep error_controlled_sweep(ChartModel                        &model,
                                              const std::vector<OperatingPoint> &points,
                                              const std::vector<int>            &training,
                                              const ErrorControlledSweepOptions &options,
                                              ChartStore                        *store,
                                              MPI_Comm                           communicator,
                                              Progress                          &progress);
} // namespace Squeal
