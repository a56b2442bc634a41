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
      "How the designs are chosen. one at a time: the scene as it is, then every level of each variable. Latin hypercube and "
      "Sobol sequence: samples of the ranges. file: rows of a CSV file.");
    declarations.add("Variables", variables,
                     "Parameters that vary, with their values, as `Section/Name = values; ...`. Values are a list `a, b, c` (`a | b` where "
                     "values contain commas), or a range `a to b`, with `in n` for n levels, and with `by ratio` for levels of equal "
                     "ratio. `Section/Name[k]` is the k-th number of a value; names joined by `+` take the same value.");
    declarations.add("File", file,
                     "CSV file of designs: names of the first line as in Variables, a design in each of the others. Looked for beside the "
                     "parameter file.");
    declarations.add("Number of designs", n_samples, "none", "Samples of a Latin hypercube or a Sobol sequence.", {1., 1e5});
    declarations.add("Seed", seed, "none", "Of the random numbers of samples: equal seeds give equal designs.", {0., 2147483647.});
    declarations.add("Processes", n_processes, "none",
                     "Designs that are solved side by side on this machine, or by every MPI process; 0: one for each core.", {0., 1024.});
  }

  void SearchParameters::declare(Declarations &declarations)
  {
    declarations.enter("Search");
    declarations.add(
      "Goal", goal,
      "What is made as good as possible within the ranges of Designs/Variables. onset: the smallest friction coefficient from "
      "which on a divergence rate exceeds 0.01 %, as large as possible. divergence rate: the largest one between the first "
      "and the last friction coefficient of the section Sweep, as small as possible. probability: that of squeal with the uncertain "
      "parameters of Robustness/Distributions, as small as possible. quantile: that of the largest divergence rate of a sample, as "
      "small as possible.");
    declarations.add("Quantile", quantile, "none",
                     "Part of the samples whose largest divergence rates are no larger than the goal quantile.", {0.01, 0.999});
    declarations.add("Method", method, "Method of NLopt, none of which needs derivatives.");
    declarations.add("Samples", n_samples, "none", "Points of Sobol's sequence that are tried first; the method starts from the best.",
                     {1., 1e5});
    declarations.add("Evaluations", n_evaluations, "none", "Designs that are solved at most, samples included.", {1., 1e5});
    declarations.add("First step", first_step, "none", "First step of the method, a part of each range.", {1e-6, 0.5});
    declarations.add("Smallest step", smallest_step, "none", "The method ends when its steps are smaller, parts of each range.",
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
