#include <squeal/base/memory_limit.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

using namespace Squeal;
namespace fs = std::filesystem;

namespace
{
  /// A machine made of files.
  class MemoryLimits : public ::testing::Test
  {
  protected:
    MemoryLimits()
      : root(fs::temp_directory_path() / ("squeal_memory_test_" + std::to_string(getpid())))
    {
      write("proc/meminfo", "MemTotal:       8000 kB\nMemFree:        100 kB\nMemAvailable:   4000 kB\n");
    }
    ~MemoryLimits() override
    {
      fs::remove_all(root);
    }
    void write(const fs::path &name, const std::string &text) const
    {
      fs::create_directories((root / name).parent_path());
      std::ofstream(root / name) << text;
    }
    const fs::path root;
  };
} // namespace

TEST_F(MemoryLimits, WithoutGroups)
{
  EXPECT_EQ(available_memory(root), 4000. * 1024.);
  EXPECT_TRUE(std::isinf(available_memory(root / "nowhere")));
}

TEST_F(MemoryLimits, OfGroupsOfTheSecondVersion)
{
  write("proc/self/cgroup", "0::/batch/job\n");
  write("sys/fs/cgroup/batch/job/memory.max", "max\n");
  write("sys/fs/cgroup/batch/job/memory.current", "500000\n");
  EXPECT_EQ(available_memory(root), 4000. * 1024.);
  // The groups about it limit it, too; what is only cached can be had.
  write("sys/fs/cgroup/batch/memory.max", "1000000\n");
  write("sys/fs/cgroup/batch/memory.current", "900000\n");
  EXPECT_EQ(available_memory(root), 100000.);
  write("sys/fs/cgroup/batch/memory.stat", "anon 500000\ninactive_file 300000\nactive_file 50000\n");
  EXPECT_EQ(available_memory(root), 450000.);
  write("sys/fs/cgroup/batch/job/memory.max", "400000\n");
  EXPECT_EQ(available_memory(root), 0.);
}

TEST_F(MemoryLimits, OfGroupsOfTheFirstVersion)
{
  write("proc/self/cgroup", "5:cpu,cpuacct:/elsewhere\n4:hugetlb,memory:/outside/of/the/container\n0::/\n");
  write("sys/fs/cgroup/memory/memory.limit_in_bytes", "2000000\n");
  write("sys/fs/cgroup/memory/memory.usage_in_bytes", "1500000\n");
  write("sys/fs/cgroup/memory/memory.stat", "inactive_file 7\ntotal_inactive_file 200000\ntotal_active_file 0\n");
  EXPECT_EQ(available_memory(root), 700000.);
  // The number that stands for none
  write("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
  EXPECT_EQ(available_memory(root), 4000. * 1024.);
}

TEST(MemoryLimit, OfThisMachine)
{
  EXPECT_GT(available_memory(), 0.);
}
