#pragma once

#include <squeal/base/conventions.h>
#include <squeal/bases/mode_label.h>
#include <squeal/output/table.h>
#include <squeal/studies/friction_modes.h>

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

  /// Modes of the disc with free and of the pins with sliding contact; then the real coupled modes.
  std::vector<ComparedMode> component_modes_to_compare(const FrictionlessModes &frictionless);
  std::vector<ComparedMode> coupled_modes_to_compare(const FrictionlessModes &frictionless);

  /// Modes with friction.
  std::vector<ComparedMode> complex_modes_to_compare(const FrictionModes &friction);

  /**
   * Modes of a run in the order of their frequencies: of the components alone, coupled without friction, and with friction,
   * without and with radial dissipation. Empty: not computed.
   */
  struct TableOneResults
  {
    std::vector<ComparedMode> component, coupled, undamped, damped;
  };

  /// How far frequencies agree with the paper's.
  struct Agreement
  {
    double       difference = 0.; ///< root mean square of the relative differences [-]
    unsigned int n          = 0;  ///< of so many
  };

  /// `3.229 % rms (34)`.
  std::string to_string(const Agreement &agreement);

  /// The paper's Table 1 beside a run.
  struct TableOne
  {
    Table     table;
    Agreement component, coupled, undamped, damped;
  };

  /**
   * The paper's Table 1 (D. Brizard, O. Chiello, J.-J. Sinou, X. Lorang, J. Sound Vib. 330 (2011) 703), all of its columns,
   * beside the modes of a run; cells of modes that the run has not computed are empty. A row bears the paper's label and the
   * paper's numbers; columns `mode ...` say which mode of the run stands beside them:
   *
   * - of most rows the one with the same label;
   * - of pairs of which one grows the one that grows beside the one that grows. Here that is always the one with the plus
   *   (mark_doublets()); the paper prints A0-4 - as growing with C_b, +0.65 %, and A0-4 + as decaying, -0.67 %;
   * - of modes that the paper finds hard to name the one with the nearest frequency;
   * - of the modes of pins, which have no names of their own, those of the same place in the order of the divergence rates: a
   *   range of the paper is two rows, with the smallest and largest frequency and divergence rate.
   *
   * The component frequency of F1, printed 3353 Hz, is read 3553 Hz.
   */
  TableOne table_one(const TableOneResults &results);

  /// A divergence rate of Table 1, with the label at which the paper prints it.
  struct PaperDivergence
  {
    ModeLabel label;
    double    rate; ///< [%]
  };

  /**
   * What Table 1 prints with radial dissipation for the disc mode that here is called @p label, growing modes beside growing
   * ones; nothing where no divergence rate is printed.
   */
  std::optional<PaperDivergence> paper_divergence_damped(const ModeLabel &label);

  /// Range of divergence rates that Table 1 prints for a family of pin modes with radial dissipation.
  struct PaperRange
  {
    ModeLabel label;
    double    lowest, highest; ///< [%]
    int       every;           ///< one mode of so many is damped: of F1 those that bend radially
  };
  extern const std::array<PaperRange, 2> paper_ranges_damped;
} // namespace Squeal
