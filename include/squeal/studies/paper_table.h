#pragma once

#include <squeal/base/conventions.h>
#include <squeal/bases/mode_label.h>
#include <squeal/output/table.h>
#include <squeal/parameters/parameters.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// A mode of a run, as it is set beside the paper's.
  struct ComparedMode
  {
    ModeLabel       label;
    ModalQuantities quantities;
  };

  /// Modes of a run in the order of their frequencies: of the components alone, coupled without friction, and with friction.
  struct TableOneResults
  {
    std::vector<ComparedMode> component, coupled, complex;
  };

  /**
   * Whether the parameters describe the scene of the paper's Table 1: shape of disc and pins, materials, mounts and contact
   * as by default. The mesh and the operation may differ.
   */
  bool is_paper_scene(const Parameters &parameters);

  /// Whether friction, load and speed are those of the complex modes in Table 1, and nothing but the contact damps them.
  bool is_paper_operation(const Parameters &parameters);

  /// How far frequencies agree with the paper's.
  struct Agreement
  {
    double       difference = 0.; ///< root mean square of the relative differences [-]
    unsigned int n          = 0;  ///< of so many
  };

  /// The paper's Table 1 beside a run.
  struct TableOne
  {
    Table     table;
    Agreement component, coupled;
  };

  /// Divergence rate in Table 1 of a mode with radial dissipation [%]; nothing where none is printed for the label.
  std::optional<double> paper_divergence_damped(const ModeLabel &label);

  /// Range of divergence rates that Table 1 prints for a family of pin modes with radial dissipation.
  struct PaperRange
  {
    ModeLabel label;
    double    lowest, highest; ///< [%]
    int       every;           ///< one mode of so many is damped: of F1 those that bend radially
  };
  extern const std::array<PaperRange, 2> paper_ranges_damped;

  /**
   * The paper's Table 1 (D. Brizard, O. Chiello, J.-J. Sinou, X. Lorang, J.
   * Sound Vib. 330 (2011) 703) beside the modes of a run. The complex columns
   * are those without or with radial dissipation as the run has it; without complex
   * modes in @p results they stay empty. Its
   * component frequency of F1, printed 3353 Hz, is read 3553 Hz.
   */
  TableOne table_one(const TableOneResults &results, RadialDissipation dissipation);
} // namespace Squeal
