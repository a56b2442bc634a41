#pragma once

#include <squeal/geometry/plan.h>

#include <cmath>
#include <vector>

namespace Squeal
{
  /**
   * Moves a point to where a function of it is less than @p least, by steps in eight directions that become half as
   * long again and again. Returns the least value found.
   */
  template <typename Function>
  double move_to_least(Plan::Point &point, const double longest_step, const double shortest_step, double least, const Function &function)
  {
    Plan::Point best = point;
    for (double step = longest_step; step > shortest_step; step /= 2.)
      {
        const Plan::Point from = best;
        for (int direction = 0; direction < 8; ++direction)
          {
            const double angle = direction * std::acos(-1.) / 4.;
            point              = from + step * Plan::Point(std::cos(angle), std::sin(angle));
            if (const double value = function(); value < least)
              {
                least = value;
                best  = point;
              }
          }
      }
    point = best;
    return least;
  }

  /// Nodes that keep their distances and turn together about a centre: a pin's.
  struct TurningPart
  {
    std::vector<unsigned int> nodes;
    Plan::Point               centre;
  };

  /**
   * Turns faces over that are inverted or nearly flat, where smooth() finds no
   * way because several nodes must move at once. Nodes around such faces and
   * whole parts move so that the energy of all corners becomes least,
   *
   *   Σ (a² + b²) / χ(a × b),  χ(D) = (D + √(ε² + D²)) / 2
   *
   * for the edges a, b of a corner; ε decreases, so that inverted corners, of
   * finite energy at first, are pressed to the other side, which they cannot
   * leave again (V. Garanzha, I. Kaporin, L. Kudryavtseva, F. Protais, N. Ray,
   * D. Sokolov, ACM Trans. Graph. 40 (2021) 154).
   *
   * Points stay as they are, to the last bit, where no face is bad, and where
   * bad faces cannot be avoided.
   *
   * @param fixed nodes that move only with a part
   */
  void untangle(const std::vector<Plan::Face>  &faces,
                const std::vector<bool>        &fixed,
                const std::vector<TurningPart> &parts,
                std::vector<Plan::Point>       &points);
} // namespace Squeal
