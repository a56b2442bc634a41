#include <squeal/base/tasks.h>
#include <squeal/base/worker_process.h>

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

using namespace Squeal;

namespace
{
  /// Sets OMP_NUM_THREADS, or removes it, as long as it exists.
  class ThreadsOfEnvironment
  {
  public:
    explicit ThreadsOfEnvironment(const char *value)
    {
      if (const char *before = std::getenv(name); before != nullptr)
        old = before;
      set(value);
    }

    ~ThreadsOfEnvironment()
    {
      set(old.empty() ? nullptr : old.c_str());
    }

  private:
    static void set(const char *value)
    {
      if (value != nullptr)
        ::setenv(name, value, 1);
      else
        ::unsetenv(name);
    }

    static constexpr const char *name = "OMP_NUM_THREADS";
    std::string                  old;
  };
} // namespace

TEST(Tasks, AreAllDone)
{
  for (const unsigned int n_threads : {1, 2, 5})
    {
      set_task_threads(n_threads);
      EXPECT_EQ(n_task_threads(), n_threads);
      std::vector<int> n_calls(100, 0);
      run_tasks(100, [&](const int i) { ++n_calls[i]; });
      EXPECT_EQ(n_calls, std::vector<int>(100, 1));
      run_tasks(0, [](const int) { FAIL(); });
    }
  set_task_threads(1);
}

TEST(Tasks, AreDoneAtATime)
{
  set_task_threads(2);
  // Each waits for the other
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
      try
        {
          run_tasks(20, [&](const int i) {
            ++n_done;
            if (i == 7 || i == 13)
              throw std::runtime_error(std::to_string(i));
          });
          FAIL();
        }
      catch (const std::runtime_error &error)
        {
          EXPECT_STREQ(error.what(), "7");
        }
      EXPECT_EQ(n_done, 20);
    }
  set_task_threads(1);
}

TEST(Tasks, ThreadsThatMayBeUsed)
{
  {
    const ThreadsOfEnvironment three("3");
    EXPECT_EQ(usable_threads(0), 3u);
    EXPECT_EQ(usable_threads(5), 5u);
  }
  {
    const ThreadsOfEnvironment nested("2,4");
    EXPECT_EQ(usable_threads(0), 2u);
  }
  for (const char *nothing : {"", "all", "-1", "0"})
    {
      const ThreadsOfEnvironment useless(nothing);
      EXPECT_EQ(usable_threads(0), n_usable_cores()) << nothing;
    }
  const ThreadsOfEnvironment none(nullptr);
  EXPECT_EQ(usable_threads(0), n_usable_cores());
  EXPECT_EQ(usable_threads(0, 1000000), 1u);
}
