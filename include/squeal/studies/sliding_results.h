#pragma once

#include <squeal/output/fields.h>
#include <squeal/studies/scene.h>

namespace Squeal
{
  /// `sliding_pins.csv` and `sliding_certificate.csv`, and a note on open pins and uniqueness.
  void write_sliding_tables(const Scene &scene, const SlidingState &state, const OperationParameters &operation, Run &run);

  /// `sliding_state.vtu` and `sliding_state_contact.vtu`.
  void write_sliding_fields(const Scene &scene, const SlidingState &state, const OperationParameters &operation, const FieldWriter &writer);
} // namespace Squeal
