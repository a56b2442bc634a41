#pragma once

namespace Squeal
{
  /// Memory of this process that is resident now [byte]; 0 where the system does not tell.
  double resident_memory();

  /**
   * Peak of the resident memory of this process since its beginning or since reset_peak_memory() [byte]; 0 where the system
   * does not tell.
   */
  double peak_resident_memory();

  /// Gives freed memory back and begins a new peak; whether the system allows it.
  bool reset_peak_memory();
} // namespace Squeal
