// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/designs.h>

namespace Squeal
{
  void DesignParameters::declare(Declarations &declarations)
  {
    declarations.enter("Designs");
    declarations.add(
      "Plan", choice,
      "Method of choosing the designs. `full grid`: all combinations of the levels. `one at a time`: the given model, then every level of "
      "each variable while the other variables are unchanged. `Latin hypercube` and `Sobol sequence`: samples of the ranges and lists. "
      "`file`: rows of a CSV file.");
    declarations.add(
      "Variables", variables,
      "Varied parameters and their values, as `Section/Name = values; ...`. Values are a list `a, b, c` (`a | b` if values contain "
      "commas), or a range `a to b`, with `in n` for n levels and `by ratio` for geometric instead of linear spacing. `Section/Name[k]` "
      "is the k-th number of a parameter that is a list; names joined by `+` take the same value.");
    declarations.add(
      "File", file,
      "CSV file of designs: names as in Variables in the first line, then one design per line. It is searched for in the folder of the "
      "parameter file, then in the current directory.");
    declarations.add("Number of designs", n_samples, "none", "Number of samples of a Latin hypercube or a Sobol sequence.", {1., 1e5});
    declarations.add("Seed", seed, "none", "Seed of the random number generator; the same seed generates the same designs.",
                     {0., 2147483647.});
    declarations.add(
      "Processes", n_processes, "none",
      "Number of designs that each MPI process solves concurrently; 0: as many as the cores and the available memory permit.", {0., 1024.});
  }

  void SearchParameters::declare(Declarations &declarations)
  {
    declarations.enter("Search");
    declarations.add(
      "Goal", goal,
      "Objective of the search within the ranges of Designs/Variables. `onset`: maximise the smallest friction coefficient at which a "
      "divergence rate exceeds 0.01 %. `divergence rate`: minimise the largest divergence rate between the first and the last friction "
      "coefficient of the section Sweep. `probability`: minimise the probability of squeal with the uncertain parameters of "
      "Robustness/Distributions. `quantile`: minimise a quantile of the largest divergence rate of the samples.");
    declarations.add("Quantile", quantile, "none", "Probability level of the quantile if Goal = quantile.", {0.01, 0.999});
    declarations.add("Method", method, "Derivative-free method of NLopt, started from each of the best two points of Samples.");
    declarations.add(
      "Samples", n_samples, "none",
      "Number of points of a Sobol sequence that are evaluated first; the method starts from each of the best two of these points.",
      {1., 1e5});
    declarations.add("Evaluations", n_evaluations, "none", "Maximum number of solved designs, including the samples.", {1., 1e5});
    declarations.add("First step", first_step, "none", "First step of the method, as a fraction of each range.", {1e-6, 0.5});
    declarations.add("Smallest step", smallest_step, "none", "The method ends when its steps are smaller than this fraction of each range.",
                     {1e-9, 0.5});
  }

  void SearchParameters::check() const
  {
    if (n_samples > n_evaluations)
      throw ParameterError(text("the number of samples, ", n_samples, ", exceeds the number of evaluations, ", n_evaluations),
                           "parameter Search/Samples", "lower Search/Samples, or raise Search/Evaluations");
    if (smallest_step > first_step)
      throw ParameterError("the smallest step, " + exact_text(smallest_step) + ", is larger than the first step, " + exact_text(first_step),
                           "parameter Search/Smallest step", "lower Search/Smallest step, or raise Search/First step");
  }
} // namespace Squeal
