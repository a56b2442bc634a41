#include "tracked_modes.h"

#include <squeal/base/exceptions.h>
#include <squeal/base/tasks.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace Squeal
{
  namespace
  {
    /// Part of a step below which another one is half of it, up to rounding errors.
    constexpr double half_width = 0.5 + 1e-6;

    void insert(TrackedModes &modes, const EvaluateChart &evaluate, const std::vector<double> &values, const bool refines)
    {
      if (values.empty())
        return;
      std::vector<ChartPoint> found = evaluate(values);
      if (found.size() != values.size())
        throw SolverError(std::to_string(found.size()) + " sets of modes instead of " + std::to_string(values.size()),
                          "modes over the friction coefficient", "this is a mistake in the program: please report it");
      std::vector<std::vector<MultipleModes>> multiple(found.size());
      run_tasks(static_cast<int>(found.size()), [&](const int i) { multiple[i] = multiple_modes(found[i]); });
      for (std::size_t i = 0; i < values.size(); ++i)
        {
          found[i].friction_coefficient = values[i];
          const int k                   = std::lower_bound(modes.points.begin(), modes.points.end(), values[i],
                                                           [](const ChartPoint &p, const double value) { return p.friction_coefficient < value; }) -
                        modes.points.begin();
          modes.points.insert(modes.points.begin() + k, std::move(found[i]));
          modes.multiple.insert(modes.multiple.begin() + k, std::move(multiple[i]));
          modes.is_refinement.insert(modes.is_refinement.begin() + k, refines);
          if (k > 0 && k + 1 < modes.n_points())
            {
              const int    stalls    = modes.intervals[k - 1].stalls + 1;
              const double half      = half_width * (modes.width(k - 1) + modes.width(k));
              modes.intervals[k - 1] = {std::nullopt, modes.width(k - 1) <= half ? 0 : stalls};
              modes.intervals.insert(modes.intervals.begin() + k, {std::nullopt, modes.width(k) <= half ? 0 : stalls});
            }
          else if (modes.n_points() > 1)
            modes.intervals.emplace_back();
        }
      if (refines)
        modes.n_refinements += static_cast<int>(values.size());
      std::vector<int> unlinked;
      for (std::size_t k = 0; k < modes.intervals.size(); ++k)
        if (!modes.intervals[k].links)
          unlinked.push_back(static_cast<int>(k));
      run_tasks(static_cast<int>(unlinked.size()), [&](const int i) {
        const int k              = unlinked[i];
        modes.intervals[k].links = link_modes(modes.points[k], modes.points[k + 1], modes.options.largest_circular_frequency);
      });
    }
  } // namespace

  double TrackedModes::tolerance(const int k) const
  {
    return std::max(options.threshold_tolerance,
                    8. * std::numeric_limits<double>::epsilon() * std::max(std::abs(mu(k)), std::abs(mu(k + 1))));
  }

  StabilityChart stability_chart(const std::vector<double> &grid,
                                 const EvaluateChart       &evaluate,
                                 const ChartOptions        &options,
                                 const PredictZero         &predict)
  {
    for (std::size_t i = 1; i < grid.size(); ++i)
      if (!(grid[i] > grid[i - 1]))
        throw Error("friction coefficient " + std::to_string(grid[i]) + " follows " + std::to_string(grid[i - 1]),
                    "modes over the friction coefficient", "give friction coefficients in ascending order, each once");
    for (const auto &[quantity, name] : {std::make_pair(options.largest_circular_frequency, "end of the band"),
                                         {options.threshold_tolerance, "tolerance of thresholds"},
                                         {options.smallest_step, "smallest step"}})
      if (!(quantity > 0.))
        throw Error("the " + std::string(name) + " is " + std::to_string(quantity), "modes over the friction coefficient",
                    "give a positive value");

    TrackedModes tracked{options, {}, {}, {}, {}, {}, {}};
    insert(tracked, evaluate, grid, false);
    for (;;)
      {
        follow_branches(tracked);
        const std::vector<EventSearch> searches = find_events(tracked);
        const std::vector<double>      wanted   = refinement_requests(tracked, searches, predict);
        if (wanted.empty())
          return finished_chart(std::move(tracked), searches);
        insert(tracked, evaluate, wanted, true);
      }
  }
} // namespace Squeal
