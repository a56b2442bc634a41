#pragma once

#include <squeal/estimates/discretisation_error.h>
#include <squeal/modes/power_balance.h>
#include <squeal/output/fields.h>
#include <squeal/output/table.h>
#include <squeal/parameters/accuracy_goal.h>
#include <squeal/studies/steps/friction_modes.h>
#include <squeal/studies/steps/scene.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// Where the energy of every growing mode comes from, by numbers of the modes.
  using PowerBalances = std::map<int, PowerBalance>;

  /// The balances of all growing modes; how far the largest is from adding up to ξ goes to the run record.
  PowerBalances power_balances(const Linearisation &linearisation, const FrictionModes &friction, Run &run);

  /// `energy.csv`: of each growing mode what disc and pins, friction and damping add to its divergence rate. Nothing without a growing mode.
  void write_power_table(const Linearisation &linearisation, const FrictionModes &friction, const PowerBalances &balances, Run &run);

  /// What friction and damping at each of all contact nodes add to ξ, over its area [1/m²]; zero at open ones.
  std::vector<double> energy_input(const Linearisation &linearisation, const PowerBalance &balance);

  /// Component modes below ω² = @p largest_eigenvalue: component, contact, label, frequency, residual.
  Table component_table(const FrictionlessModes &modes, double largest_eigenvalue);

  /// Real coupled modes: label, share, frequency, residual.
  Table real_table(const FrictionlessModes &modes);

  /**
   * Complex modes: label, share, frequency, growth and divergence rate, damping ratio, residuals, whether they are
   * unstable, how they travel, and estimates where there are any.
   *
   * @param waves of waves_with_rotation()
   * @param more  columns by the numbers of the modes
   */
  Table complex_table(const FrictionModes &friction, const std::vector<std::optional<WaveShares>> &waves, const Columns<int> &more = {});

  /// Columns that estimated errors of the mesh add to complex_table(): those, whether they are within @p limits, and the verdict.
  Columns<int> mesh_error_columns(const std::vector<DiscretisationError> &errors, const AccuracyLimits &limits);

  /**
   * The modes that grow, the largest divergence rate first: label, frequency, growth and divergence rate, share. At most
   * @p n_largest rows.
   */
  Table unstable_table(const FrictionModes &friction, std::size_t n_largest);

  /// What a mode file says of a complex mode: "A0-4 +, 2353 Hz, divergence rate 0.6798 %, unstable".
  std::string mode_title(const ModeLabel &label, const std::complex<double> &lambda);

  /// How the parameters want modes to be animated.
  AnimationOptions animation_options(const OutputParameters &output);

  /**
   * The fields that the parameters choose, in their format, as steps of the run: complex modes with animations of unstable ones, real
   * coupled modes, component modes; where the energy of growing ones enters; and of each kind a list through which ParaView steps. Files bear the numbers of the rows of
   * `complex_modes.csv`, `real_modes.csv` and `component_modes.csv`.
   */
  void write_mode_shapes(const FrictionlessModes &frictionless, const FrictionModes &friction, const PowerBalances &balances, Run &run);

  /// `sliding_pins.csv` and `sliding_certificate.csv`, and a note on open pins and uniqueness.
  void write_sliding_tables(const Scene &scene, const SlidingState &state, const OperationParameters &operation, Run &run);

  /// `sliding_state.vtu` and `sliding_state_contact.vtu`, of a linearisation about steady sliding.
  void write_sliding_fields(const Linearisation &linearisation, Run &run);
} // namespace Squeal
