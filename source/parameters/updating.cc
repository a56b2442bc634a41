#include <squeal/parameters/updating.h>

namespace Squeal
{
  void UpdatingParameters::declare(Declarations &declarations)
  {
    declarations.enter("Updating");
    declarations.add(
      "Measured modes", measured_modes,
      "CSV file of measured modes, to which the parameters of Designs/Variables are fitted within their ranges. Columns `state` (component: "
      "free disc, or pins with sliding contact; coupled: without friction; complex: at Operation/Friction coefficient), `label`, "
      "`frequency [Hz]`; optional `member`, `deviation [Hz]`, `damping ratio [%]`, `damping deviation [%]`. Looked for in the folder of the "
      "parameter file.");
    declarations.add("Tolerance", tolerance, "none", "The fit ends when a step is smaller than this part of the ranges.", {1e-12, 0.1});
    declarations.add("Iterations", n_iterations, "none", "Largest number of iterations.", {1., 1e4});
  }
} // namespace Squeal
