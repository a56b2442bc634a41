#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/search.h>

namespace Squeal
{
  void SearchParameters::declare(Declarations &declarations)
  {
    declarations.enter("Search");
    declarations.add(
      "Goal", goal,
      "What is made as good as possible within the ranges of Designs/Variables. onset: the smallest friction coefficient from "
      "which on a divergence rate exceeds 0.01 %, as large as possible. divergence rate: the largest one between the first "
      "and the last friction coefficient of the section Sweep, as small as possible.");
    declarations.add("Method", method, "Method of NLopt, none of which needs derivatives.");
    declarations.add("Samples", n_samples, "Points of Sobol's sequence that are tried first; the method starts from the best. Units: none.",
                     {1., 1e5});
    declarations.add("Evaluations", n_evaluations, "Designs that are solved at most, samples included. Units: none.", {1., 1e5});
    declarations.add("First step", first_step, "First step of the method, a part of each range. Units: none.", {1e-6, 0.5});
    declarations.add("Smallest step", smallest_step, "The method ends when its steps are smaller, parts of each range. Units: none.",
                     {1e-9, 0.5});
  }

  void SearchParameters::check() const
  {
    if (n_samples > n_evaluations)
      throw ParameterError(text(n_samples, " samples are more than the ", n_evaluations, " evaluations that are allowed"),
                           "parameter Search/Samples", "lower it, or raise Search/Evaluations");
    if (smallest_step > first_step)
      throw ParameterError("the smallest step " + exact_text(smallest_step) + " is larger than the first, " + exact_text(first_step),
                           "parameter Search/Smallest step", "give a smaller one");
  }
} // namespace Squeal
