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
    declarations.add("Number of designs", n_samples, "Samples of a Latin hypercube or a Sobol sequence. Units: none.", {1., 1e5});
    declarations.add("Seed", seed, "Of the random numbers of samples: equal seeds give equal designs. Units: none.", {0., 2147483647.});
    declarations.add("Processes", n_processes,
                     "Designs that are solved side by side on this machine, or by every MPI process; 0: one for each core. Units: none.",
                     {0., 1024.});
  }
} // namespace Squeal
