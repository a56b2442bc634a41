// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/worker_process.h>

#include <gtest/gtest.h>

#include <csignal>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include <unistd.h>

using namespace Squeal;

namespace
{
  namespace fs = std::filesystem;

  fs::path log_file()
  {
    return fs::temp_directory_path() / ("squeal_worker_" + std::to_string(getpid()) + ".log");
  }

  /// Arguments that run one of the disabled tests below in a child process.
  std::vector<std::string> only(const std::string &test)
  {
    return {"--gtest_also_run_disabled_tests", "--gtest_filter=" + test};
  }

  std::string end_of(WorkerProcess &process)
  {
    for (;;)
      {
        if (const auto end = process.end())
          return *end;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
  }
} // namespace

TEST(DISABLED_Worker, Crashes)
{
  std::raise(SIGKILL);
}

TEST(DISABLED_Worker, Sleeps)
{
  std::this_thread::sleep_for(std::chrono::hours(1));
}

TEST(WorkerProcess, SaysHowItEnded)
{
  WorkerProcess success({"--gtest_list_tests"}, log_file(), 1);
  EXPECT_EQ(end_of(success), "");
  std::ifstream     stream(log_file());
  const std::string printed{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_NE(printed.find("WorkerProcess."), std::string::npos);

  WorkerProcess crash(only("DISABLED_Worker.Crashes"), log_file(), 1);
  EXPECT_EQ(end_of(crash), "killed by SIGKILL");
  EXPECT_EQ(crash.end(), "killed by SIGKILL");
  fs::remove(log_file());
}

TEST(WorkerProcess, EndsWithItsOwner)
{
  const auto start = std::chrono::steady_clock::now();
  {
    WorkerProcess process(only("DISABLED_Worker.Sleeps"), log_file(), 1);
    EXPECT_FALSE(process.end());
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::minutes(5));
  fs::remove(log_file());
}

TEST(WorkerProcess, NeedsItsLog)
{
  const std::vector<std::string> none;
  EXPECT_THROW(WorkerProcess(none, "/nonexistent/folder/log", 1), FileError);
}

TEST(UsableCores, ThereIsOneAtLeast)
{
  EXPECT_GE(n_usable_cores(), 1u);
}
