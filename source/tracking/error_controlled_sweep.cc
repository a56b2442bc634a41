#include <squeal/base/exceptions.h>
#include <squeal/tracking/error_controlled_sweep.h>
#include <squeal/tracking/mode_links.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <sstream>

namespace Squeal
{
  namespace
  {
    /// The basis is grown at the training points beyond the tolerance, so that points between them meet it, too.
    constexpr double training_factor = 0.5;

    /// Squares of principal axes below this times the tolerance are left out of the basis, see compressed_basis().
    constexpr double compression_factor = 10.;

    /// The point of the largest error.
    struct Worst
    {
      int        number = -1;
      ChartPoint point;
      double     error = 0.;
    };

    Worst worst_of(const ChartModel &model, const std::vector<int> &numbers, const std::vector<ChartPoint> &points)
    {
      Worst worst;
      for (std::size_t i = 0; i < numbers.size(); ++i)
        if (const double error = model.largest_error(points[i]); worst.number < 0 || !(error <= worst.error))
          worst = {numbers[i], points[i], error};
      return worst;
    }

    /// Vectors of an earlier basis in the coordinates of the present one.
    ChartPoint padded(ChartPoint chart, const int size)
    {
      chart.right = with_rows(chart.right, size);
      chart.left  = with_rows(chart.left, size);
      return chart;
    }

    std::vector<OperatingPoint> chosen(const std::vector<OperatingPoint> &points, const std::vector<int> &numbers)
    {
      std::vector<OperatingPoint> result;
      for (const int i : numbers)
        result.push_back(points[i]);
      return result;
    }

    /// Grows the basis at the worst point; returns why it cannot, or nothing.
    std::string grow(ChartModel                        &model,
                     const std::vector<OperatingPoint> &points,
                     const Worst                       &worst,
                     const double                       tolerance,
                     const int                          maximum_basis,
                     ChartStore                        *store)
    {
      const auto vectors = model.new_vectors({{points[worst.number], &worst.point, model.inaccurate_modes(worst.point, tolerance)}});
      if (!vectors)
        return "rounding errors leave no new direction";
      if (model.size() + vectors->NumVectors() > maximum_basis)
        {
          std::ostringstream text;
          text << "the basis would exceed " << maximum_basis << " vectors";
          return text.str();
        }
      model.extend(*vectors);
      if (store != nullptr)
        store->keep(*vectors);
      return "";
    }
  } // namespace

  std::vector<ChartPoint> evaluate(const ChartModel                                   &model,
                                   const std::vector<OperatingPoint>                  &points,
                                   const MPI_Comm                                      communicator,
                                   const std::function<void(int, const ChartPoint &)> &each)
  {
    const int n = dealii::Utilities::MPI::n_mpi_processes(communicator), me = dealii::Utilities::MPI::this_mpi_process(communicator);
    std::vector<ChartPoint> result;
    for (std::size_t first = 0; first < points.size(); first += n)
      {
        const int  n_here = std::min<int>(n, static_cast<int>(points.size() - first));
        ChartPoint mine;
        if (me < n_here)
          mine = model.evaluate(points[first + me]);
        for (int owner = 0; owner < n_here; ++owner)
          {
            result.push_back(n == 1 ? mine : dealii::Utilities::MPI::broadcast(communicator, mine, owner));
            if (each)
              each(static_cast<int>(first) + owner, result.back());
          }
      }
    return result;
  }

  ErrorControlledSweep error_controlled_sweep(ChartModel                        &model,
                                              const std::vector<OperatingPoint> &points,
                                              const std::vector<int>            &training,
                                              const ErrorControlledSweepOptions &options,
                                              ChartStore                        *store,
                                              const MPI_Comm                     communicator,
                                              Progress                          &progress)
  {
    if (points.empty())
      throw SolverError("there is no operating point to evaluate", "sweep", "give one at least");
    ErrorControlledSweep result{std::vector<std::optional<ChartPoint>>(points.size()), 0., 0, ""};
    const auto           report = [&](const std::size_t n_finished, const double error) {
      std::ostringstream text;
      text << n_finished << " of " << points.size() << " operating points, " << model.size() << " vectors, estimated error " << error;
      progress.update(text.str());
    };
    const auto               is_finished = [](const std::optional<ChartPoint> &point) { return point.has_value(); };
    const auto               n_finished  = [&] { return std::count_if(result.points.begin(), result.points.end(), is_finished); };
    std::vector<MultiVector> basis;
    if (store != nullptr)
      {
        basis = store->basis();
        for (std::size_t i = 0; i < points.size(); ++i)
          result.points[i] = store->find(points[i]);
      }

    // ------------------------------------------------- a basis for a few points
    if (basis.empty())
      {
        std::vector<ChartPoint> charts;
        for (std::size_t t = 0; t < training.size();)
          {
            const auto  here  = evaluate(model, {points[training[t]]}, communicator);
            const Worst worst = worst_of(model, {training[t]}, here);
            report(0, worst.error);
            // Where the basis may not grow further, the points may still do
            if (worst.error <= training_factor * options.tolerance || !result.why_stopped.empty())
              {
                charts.push_back(here.front());
                ++t;
              }
            else
              {
                result.why_stopped = grow(model, points, worst, training_factor * options.tolerance, options.maximum_basis, nullptr);
                ++result.n_growths;
              }
          }
        for (ChartPoint &chart : charts)
          chart = padded(chart, model.size());
        // Real modes first, then axes in their order: a basis that may not be larger ends earlier
        const MultiVector compressed = model.compressed_basis(charts, compression_factor * options.tolerance);
        const MultiVector smaller =
          view(compressed, 0, std::min(compressed.NumVectors(), std::max(options.maximum_basis, model.n_real_modes())));
        if (store != nullptr)
          store->keep(smaller);
        model.restart(smaller);
      }
    else
      {
        model.restart(basis.front());
        for (std::size_t b = 1; b < basis.size(); ++b)
          model.extend(basis[b]);
      }
    result.why_stopped.clear();

    // ------------------------------------------------------------ all points
    while (true)
      {
        std::vector<int> left;
        for (std::size_t i = 0; i < points.size(); ++i)
          if (!result.points[i])
            left.push_back(static_cast<int>(i));
        if (left.empty())
          break;
        Worst worst;
        evaluate(model, chosen(points, left), communicator, [&](const int k, const ChartPoint &point) {
          const int    i     = left[k];
          const double error = model.largest_error(point);
          if (error <= options.tolerance)
            {
              result.points[i] = point;
              if (store != nullptr)
                store->keep(points[i], point);
            }
          else if (worst.number < 0 || !(error <= worst.error))
            worst = {i, point, error};
          report(n_finished(), error);
        });
        if (worst.number < 0)
          break;
        result.why_stopped = grow(model, points, worst, options.tolerance, options.maximum_basis, store);
        if (!result.why_stopped.empty())
          break;
        ++result.n_growths;
      }

    for (const auto &point : result.points)
      if (point)
        result.worst_error = std::max(result.worst_error, model.largest_error(*point));
    return result;
  }
} // namespace Squeal
