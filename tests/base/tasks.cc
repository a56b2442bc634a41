// SPDX-License-Identifier: GPL-3.0-or-later

#include "input.h"

#include <squeal/base/mpi_environment.h>
#include <squeal/base/tasks.h>
#include <squeal/base/worker_process.h>

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  /// Sets or removes an environment variable until the end of the scope.
  class Variable
  {
  public:
    explicit Variable(const char *name, const char *value = nullptr)
      : name(name)
    {
      if (const char *before = std::getenv(name))
        old = before;
      set(value);
    }
    ~Variable()
    {
      set(old ? old->c_str() : nullptr);
    }
    void set(const char *value) const
    {
      value != nullptr ? ::setenv(name, value, 1) : ::unsetenv(name);
    }

  private:
    const char *const          name;
    std::optional<std::string> old;
  };
} // namespace

TEST(Tasks, AreDoneAtATime)
{
  set_task_threads(2);
  // Each task waits until the other has begun
  std::atomic<int> n_begun = 0;
  run_tasks(2, [&](const int) {
    ++n_begun;
    for (int i = 0; i < 10000 && n_begun < 2; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(n_begun, 2);
  });
  set_task_threads(1);
}

TEST(Tasks, TheFirstFailureIsTold)
{
  for (const unsigned int n_threads : {1, 3})
    {
      set_task_threads(n_threads);
      std::atomic<int> n_done = 0;
      const auto       action = [&](const int i) {
        ++n_done;
        if (i == 7 || i == 13)
          throw std::runtime_error(std::to_string(i));
      };
      EXPECT_EQ(message<std::runtime_error>([&] { run_tasks(20, action); }), "7");
      EXPECT_EQ(n_done, 20);
    }
  set_task_threads(1);
}

TEST(Tasks, ThreadsThatMayBeUsed)
{
  const Variable threads("OMP_NUM_THREADS", "3");
  EXPECT_EQ(usable_threads(0), 3u);
  EXPECT_EQ(usable_threads(5), 5u);
  threads.set("2,4"); // nested
  EXPECT_EQ(usable_threads(0), 2u);
  for (const char *nothing : {"", "all", "-1", "0", static_cast<const char *>(nullptr)})
    {
      threads.set(nothing);
      EXPECT_EQ(usable_threads(0), n_usable_cores());
    }
  EXPECT_EQ(usable_threads(0, 1000000), 1u);
}

TEST(MpiEnvironment, DependsOnMpirunAndCores)
{
  const Variable n_processes("OMPI_COMM_WORLD_LOCAL_SIZE"), yields("OMPI_MCA_mpi_yield_when_idle"),
    is_isolated("OMPI_MCA_ess_singleton_isolated"), has_folder("OMPI_MCA_orte_create_session_dirs");
  const auto value = [](const char *name) { return std::string(std::getenv(name) == nullptr ? "none" : std::getenv(name)); };
  n_processes.set("1");
  prepare_mpi_environment();
  EXPECT_EQ(value("OMPI_MCA_mpi_yield_when_idle"), "none");
  n_processes.set("1000000");
  prepare_mpi_environment();
  EXPECT_EQ(value("OMPI_MCA_mpi_yield_when_idle"), "1");
  // Settings of the user are not changed
  yields.set("0");
  prepare_mpi_environment();
  EXPECT_EQ(value("OMPI_MCA_mpi_yield_when_idle"), "0");
  EXPECT_EQ(value("OMPI_MCA_ess_singleton_isolated"), "none");
  EXPECT_EQ(value("OMPI_MCA_orte_create_session_dirs"), "none");

  // Without mpirun, Open MPI runs isolated
  n_processes.set(nullptr);
  yields.set(nullptr);
  prepare_mpi_environment();
  EXPECT_EQ(value("OMPI_MCA_ess_singleton_isolated"), "1");
  EXPECT_EQ(value("OMPI_MCA_orte_create_session_dirs"), "0");
  EXPECT_EQ(value("OMPI_MCA_mpi_yield_when_idle"), "none");
}
