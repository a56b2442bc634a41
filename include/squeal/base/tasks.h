// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <functional>

namespace Squeal
{
  /// Number of threads of this process: @p wanted if positive, else OMP_NUM_THREADS if positive, else the number of usable cores, but at
  /// most the cores of this machine divided by @p n_processes.
  unsigned int usable_threads(unsigned int wanted, unsigned int n_processes = 1);

  /// Sets the number of threads of run_tasks(); initially 1.
  void set_task_threads(unsigned int n);

  unsigned int n_task_threads();

  /// Calls task(0) to task(n - 1), in any order and, with several threads, concurrently. Tasks must not communicate and must not write data
  /// that another task reads. Rethrows the exception of the failing task with the smallest index when all tasks have ended.
  void run_tasks(int n, const std::function<void(int)> &task);

  /// Calls f(first, n) as tasks for blocks of @p size elements of 0, ..., total - 1; the last block has the remainder. Calls f(0, 0) once
  /// if the total is 0. The blocks do not depend on the number of threads.
  void run_parts(int total, int size, const std::function<void(int first, int n)> &f);
} // namespace Squeal
