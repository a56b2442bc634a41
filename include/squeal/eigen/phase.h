#pragma once

#include <squeal/linear_algebra/multivector.h>

namespace Squeal
{
  /**
   * Turns each complex vector so that its entry of largest modulus is real and
   * positive; of several that are equal but for rounding, that of the lowest row.
   */
  void fix_phase(MultiVector &real_part, MultiVector &imaginary_part);
} // namespace Squeal
