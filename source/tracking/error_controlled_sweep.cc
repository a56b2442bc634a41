// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/tasks.h>
#include <squeal/base/text.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/tracking/error_controlled_sweep.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <numeric>

namespace Squeal
{
  namespace
  {
    /// Fraction of the tolerance that is required at training points, so that points between them are likely to meet the tolerance [-].
    constexpr double training_factor = 0.5;

    /// Number of successive extensions that do not halve the error of a point, after which this error counts as a rounding error. An
    /// extension by the residuals of the inaccurate modes normally divides their errors by ten or more.
    constexpr int max_growths_in_vain = 4;

    /// Updates the number of successive extensions that did not halve the error, after an extension that changed the error from @p before
    /// to @p after.
    int in_vain(const int n_so_far, const double before, const double after)
    {
      return after < 0.5 * before ? 0 : n_so_far + 1;
    }

    /// Extends the basis for the inaccurate modes of a point; returns the reason if this is impossible, else an empty string.
    std::string grow(ChartModel           &model,
                     const OperatingPoint &point,
                     const ChartPoint     &chart,
                     const double          tolerance,
                     const int             maximum_basis)
    {
      auto vectors = model.new_vectors({{point, &chart, model.inaccurate_modes(chart, tolerance)}});
      if (!vectors)
        return "the residuals contain no new directions beyond rounding errors";
      if (model.size() + vectors->n_columns() > maximum_basis)
        return text("the basis would exceed ", maximum_basis, " vectors");
      model.extend(*std::move(vectors));
      return "";
    }

    /// Extends the basis at the training points, one after the other, and compresses it; returns the number of extensions.
    int train(ChartModel                        &model,
              const std::vector<OperatingPoint> &points,
              const std::vector<int>            &training,
              const ErrorControlledSweepOptions &options,
              const MPI_Comm                     communicator,
              const std::function<void(double)> &report)
    {
      const double            tolerance = training_factor * options.tolerance;
      std::vector<ChartPoint> charts;
      bool                    may_grow  = true;
      int                     n_growths = 0, n_in_vain = 0;
      for (const int t : training)
        for (double before = 0.;; ++n_growths) // before: error of this point before the last extension
          {
            ChartPoint   chart = evaluate(model, {points[t]}, communicator).front();
            const double error = model.largest_error(chart);
            report(error);
            if (before > 0.)
              n_in_vain = in_vain(n_in_vain, before, error);
            may_grow = may_grow && n_in_vain < max_growths_in_vain;
            // If the basis cannot be extended further, continue with the next training point
            if (error <= tolerance || !may_grow)
              {
                charts.push_back(std::move(chart));
                break;
              }
            before   = error;
            may_grow = grow(model, points[t], chart, tolerance, options.maximum_basis).empty();
          }
      model.restart(model.compressed_basis(charts, options.tolerance, options.maximum_basis));
      return n_growths;
    }
  } // namespace

  void evaluate(const ChartModel &model, const std::vector<OperatingPoint> &points, const MPI_Comm communicator, const KeepPoint &each)
  {
    const int n = dealii::Utilities::MPI::n_mpi_processes(communicator), me = dealii::Utilities::MPI::this_mpi_process(communicator);
    const int n_points = static_cast<int>(points.size());
    // Several points per thread, for load balancing
    constexpr int points_of_thread = 16;
    const int     n_at_once        = n * points_of_thread * static_cast<int>(dealii::Utilities::MPI::min(n_task_threads(), communicator));
    model.prepare();
    for (int first = 0; first < n_points; first += n_at_once)
      {
        const int               n_here = std::min(n_at_once, n_points - first);
        std::vector<ChartPoint> mine(n_here > me ? (n_here - me + n - 1) / n : 0);
        run_tasks(static_cast<int>(mine.size()), [&](const int i) { mine[i] = model.evaluate(points[first + i * n + me]); });
        for (int i = 0; i < n_here; ++i)
          {
            const int owner = i % n;
            each(first + i, n == 1 ? std::move(mine[i]) :
                                     dealii::Utilities::MPI::broadcast(communicator, owner == me ? mine[i / n] : ChartPoint(), owner));
          }
      }
  }

  std::vector<ChartPoint> evaluate(const ChartModel &model, const std::vector<OperatingPoint> &points, const MPI_Comm communicator)
  {
    std::vector<ChartPoint> result;
    evaluate(model, points, communicator, [&](int, ChartPoint &&point) { result.push_back(std::move(point)); });
    return result;
  }

  PredictZero zero_predictor(const ChartModel &model, const std::function<OperatingPoint(double)> &at, const MPI_Comm communicator)
  {
    return [&model, at, communicator](const ZeroSearch &search) {
      const auto point = [&](const ModesAtPoint &modes) { return at(modes.point->friction_coefficient); };
      const auto zero  = model.predicted_zero(search, point(search.first), point(search.second));
      // Use the value of process 0: rounding errors must not cause different friction coefficients on different processes
      const auto same = dealii::Utilities::MPI::broadcast(communicator, zero ? std::vector{*zero} : std::vector<double>(), 0);
      return same.empty() ? std::nullopt : std::optional(same.front());
    };
  }

  ErrorControlledSweep error_controlled_sweep(ChartModel                        &model,
                                              const std::vector<OperatingPoint> &points,
                                              const std::vector<int>            &training,
                                              const ErrorControlledSweepOptions &options,
                                              const KeepPoint                   &keep,
                                              const MPI_Comm                     communicator,
                                              Progress                          &progress)
  {
    if (points.empty())
      throw SolverError("there is no operating point to evaluate", "sweep", "give at least one point");
    ErrorControlledSweep result{points.size(), 0., 0, ""};
    const auto           report = [&](const double error) {
      progress.update(text(points.size() - result.n_left, " of ", points.size(), " operating points, ", counted(model.size(), "vector"),
                                     ", estimated error ", error));
    };

    if (!training.empty())
      result.n_growths = train(model, points, training, options, communicator, report);
    std::vector<int> left(points.size());
    std::iota(left.begin(), left.end(), 0);
    int    grown        = -1; // index of the point of the last extension
    int    n_in_vain    = 0;
    double error_before = 0.;
    for (;; ++result.n_growths)
      {
        std::vector<OperatingPoint> points_left;
        for (const int i : left)
          points_left.push_back(points[i]);
        // Find the first point with the largest error
        std::vector<int> missed;
        int              worst = -1;
        ChartPoint       worst_point;
        double           worst_error = 0.;
        evaluate(model, points_left, communicator, [&](const int k, ChartPoint &&point) {
          const double error = model.largest_error(point);
          if (left[k] == grown)
            n_in_vain = in_vain(n_in_vain, error_before, error);
          if (error <= options.tolerance)
            {
              result.worst_error = std::max(result.worst_error, error);
              --result.n_left;
              keep(left[k], std::move(point));
            }
          else
            {
              missed.push_back(left[k]);
              if (worst < 0 || !(error <= worst_error))
                {
                  worst       = left[k];
                  worst_point = std::move(point);
                  worst_error = error;
                }
            }
          report(error);
        });
        if (worst < 0)
          break;
        left         = missed;
        grown        = worst;
        error_before = worst_error;
        result.why_stopped =
          n_in_vain >= max_growths_in_vain ?
            text("repeated extensions of the basis do not halve the estimated error ", worst_error, ", which is probably due to rounding") :
            grow(model, points[worst], worst_point, options.tolerance, options.maximum_basis);
        if (!result.why_stopped.empty())
          break;
      }
    return result;
  }
} // namespace Squeal
