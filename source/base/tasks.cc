// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/tasks.h>
#include <squeal/base/worker_process.h>

#include <deal.II/base/multithread_info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <thread>
#include <vector>

namespace Squeal
{
  namespace
  {
    unsigned int n_threads = 1;
  }

  unsigned int usable_threads(const unsigned int wanted, const unsigned int n_processes)
  {
    if (wanted > 0)
      return wanted;
    // Read the first number, because OMP_NUM_THREADS may be a list for nested loops
    if (const char *text = std::getenv("OMP_NUM_THREADS"); text != nullptr)
      if (const long number = std::strtol(text, nullptr, 10); number > 0)
        return static_cast<unsigned int>(std::min(number, 1024l));
    // Use fewer cores than the share of this process if it is bound to fewer cores
    const unsigned int share = std::thread::hardware_concurrency() / std::max(1u, n_processes);
    return std::max(1u, std::min(n_usable_cores(), share));
  }

  void set_task_threads(const unsigned int n)
  {
    n_threads = std::max(1u, n);
    // The limit of deal.II also applies to TBB, which runs the tasks
    dealii::MultithreadInfo::set_thread_limit(n_threads);
  }

  unsigned int n_task_threads()
  {
    return n_threads;
  }

  void run_tasks(const int n, const std::function<void(int)> &task)
  {
    std::vector<std::exception_ptr> failures(std::max(n, 0));
    const auto                      attempt = [&](const int i) {
      try
        {
          task(i);
        }
      catch (...)
        {
          failures[i] = std::current_exception();
        }
    };
    if (n_threads == 1 || n <= 1)
      for (int i = 0; i < n; ++i)
        attempt(i);
    else
      tbb::parallel_for(0, n, attempt, tbb::simple_partitioner());
    for (const std::exception_ptr &failure : failures)
      if (failure)
        std::rethrow_exception(failure);
  }

  void run_parts(const int total, const int size, const std::function<void(int, int)> &f)
  {
    run_tasks(std::max(1, (total + size - 1) / size), [&](const int part) { f(part * size, std::min(size, total - part * size)); });
  }
} // namespace Squeal
