#pragma once

#include <squeal/studies/steps/scene.h>

namespace Squeal
{
  /// `sliding_pins.csv` and `sliding_certificate.csv`, and a note on open pins and uniqueness.
  void write_sliding_tables(const Scene &scene, const SlidingState &state, const OperationParameters &operation, Run &run);

  /// `sliding_state.vtu` and `sliding_state_contact.vtu`, of a linearisation about steady sliding.
  void write_sliding_fields(const Linearisation &linearisation, Run &run);
} // namespace Squeal
