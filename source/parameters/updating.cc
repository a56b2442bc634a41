// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/parameters/updating.h>

namespace Squeal
{
  void UpdatingParameters::declare(Declarations &declarations)
  {
    declarations.enter("Updating");
    declarations.add(
      "Measured modes", measured_modes,
      "CSV file of measured modes, to which the parameters in Designs/Variables are fitted within their ranges. Columns: `state` "
      "(component: free disc, or pins with sliding contact, not with a system file; coupled: without friction; complex: at "
      "Operation/Friction coefficient or at the values of the system file), `label` and `frequency [Hz]`; optional: `member` (lowest, "
      "highest or k for one of several modes with the label; empty: their mean), `deviation [Hz]` (for all modes or for none), and "
      "`damping ratio [%]` with `damping deviation [%]` (for complex modes). The file is searched for in the folder of the parameter "
      "file, then in the current directory. Empty: the file that the system file names; without a system file, a name is required.");
    declarations.add(
      "Sensors", sensors,
      "CSV file of sensors and measured shapes; modes are then paired by shapes instead of labels. Columns: `x [m]`, `y [m]`, `z [m]`, "
      "`direction x`, `direction y`, `direction z`, and a column for each shape, whose name is the label of the mode in the file of "
      "measured modes (for an imaginary part, the label followed by ` imaginary`). The file is searched for like the file of measured "
      "modes.");
    declarations.add("Least MAC", least_overlap, "-",
                     "Minimum modal assurance criterion (MAC) between a measured shape and its computed counterpart. If the MAC with every "
                     "computed mode is smaller, the shape has no counterpart, and the run fails.",
                     {0., 1.});
    declarations.add("Tolerance", tolerance, "none", "The fit ends when its steps are smaller than this fraction of the ranges.",
                     {1e-12, 1e-3});
    declarations.add("Iterations", n_iterations, "none",
                     "Maximum number of iterations. The run fails if the fit has not converged by then.", {1., 1e4});
  }
} // namespace Squeal
