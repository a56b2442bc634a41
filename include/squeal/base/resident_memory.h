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

  /**
   * Lets blocks of 32 MB and more go back to the system as soon as they are freed. SuperLU_dist, which comes with the packages of
   * deal.II, tells the allocator to keep everything: a process would hold the sum of what its steps ever used. To be called once, first.
   */
  void return_freed_blocks();

  /// Gives freed memory in smaller blocks back to the system, too.
  void return_freed_memory();

  /// Gives freed memory back and begins a new peak; whether the system allows it.
  bool reset_peak_memory();
} // namespace Squeal
