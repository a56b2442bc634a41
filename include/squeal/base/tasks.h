// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <functional>

namespace Squeal
{
  /// Threads on which this process may work: @p wanted, or where that is 0 OMP_NUM_THREADS if it is set to a positive number, and else one
  /// for each core that the process may use, as far as it need not share them with @p n_processes - 1 others on this machine.
  unsigned int usable_threads(unsigned int wanted, unsigned int n_processes = 1);

  /// Sets the number of threads of run_tasks(), which is 1 before.
  void set_task_threads(unsigned int n);

  unsigned int n_task_threads();

  /// Calls task(0) to task(n - 1), in any order and several at a time. They may not communicate, nor write what another one reads. What the
  /// first of those that fail throws is thrown here, when no other is at work any more.
  void run_tasks(int n, const std::function<void(int)> &task);

  /// Calls f(first, n) as tasks for parts of 0, ..., total - 1 of @p size each, the last of them of what is left; for one part without
  /// anything if the total is 0. Parts are the same however many threads there are.
  void run_parts(int total, int size, const std::function<void(int first, int n)> &f);
} // namespace Squeal
