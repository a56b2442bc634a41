// SPDX-License-Identifier: GPL-3.0-or-later

#include "files.h"

#include <squeal/base/memory.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>

using namespace Squeal;
using namespace Squeal::Testing;
namespace fs = std::filesystem;

TEST(Memory, AvailableOfTheMachineAndItsGroups)
{
  const TemporaryFolder folder;
  const fs::path        root  = folder.path;
  const auto            write = [&](const fs::path &name, const std::string &text) { put(root / name, text); };
  write("proc/meminfo", "MemTotal:       8000 kB\nMemFree:        100 kB\nMemAvailable:   4000 kB\n");
  EXPECT_EQ(available_memory(root), 4000. * 1024.);
  EXPECT_TRUE(std::isinf(available_memory(root / "nowhere")));

  write("proc/self/cgroup", "5:cpu,cpuacct:/elsewhere\n0::/batch/job\n");
  write("sys/fs/cgroup/batch/job/memory.max", "max\n");
  write("sys/fs/cgroup/batch/job/memory.current", "500000\n");
  EXPECT_EQ(available_memory(root), 4000. * 1024.);
  // Limits of parent groups also apply, and the file cache counts as available
  write("sys/fs/cgroup/batch/memory.max", "1000000\n");
  write("sys/fs/cgroup/batch/memory.current", "900000\n");
  EXPECT_EQ(available_memory(root), 100000.);
  write("sys/fs/cgroup/batch/memory.stat", "anon 500000\ninactive_file 300000\nactive_file 50000\n");
  EXPECT_EQ(available_memory(root), 450000.);
  write("sys/fs/cgroup/batch/job/memory.max", "400000\n");
  EXPECT_EQ(available_memory(root), 0.);
  EXPECT_GT(available_memory(), 0.);
}

namespace
{
  constexpr std::size_t bytes = 400'000'000;

  std::unique_ptr<char[]> used_block(const std::size_t size)
  {
    auto block = std::make_unique<char[]>(size);
    std::memset(block.get(), 1, size);
    EXPECT_EQ(block[size / 2], 1);
    return block;
  }

  /// True if memory can be measured; false with the address sanitizer, which keeps freed memory to detect its use.
  bool is_told()
  {
#ifdef __SANITIZE_ADDRESS__
    return false;
#endif
    return resident_memory() > 0. && reset_peak_memory();
  }
} // namespace

TEST(Memory, PeakIsThatSinceTheReset)
{
  if (!is_told())
    GTEST_SKIP();
  const double before = resident_memory();
  EXPECT_LT(peak_resident_memory(), before + 0.1 * bytes);
  {
    const auto block = used_block(bytes);
    EXPECT_GT(resident_memory(), before + 0.9 * bytes);
  }
  EXPECT_GT(peak_resident_memory(), before + 0.9 * bytes);
  // The reset returns freed memory to the system, which malloc would otherwise keep
  ASSERT_TRUE(reset_peak_memory());
  EXPECT_LT(resident_memory(), before + 0.1 * bytes);
  EXPECT_LT(peak_resident_memory(), before + 0.1 * bytes);
}

TEST(Memory, FreedBlocksGoBack)
{
  if (!is_told())
    GTEST_SKIP();
  return_freed_blocks();
  const double before = resident_memory();
  used_block(bytes).reset();
  EXPECT_LT(resident_memory() - before, 0.1 * bytes);

  // Small blocks are returned on request, although a later block is in use
  constexpr std::size_t                small = 1'000'000;
  std::vector<std::unique_ptr<char[]>> blocks;
  for (std::size_t i = 0; i < bytes / small; ++i)
    blocks.push_back(used_block(small));
  const auto last = std::move(blocks.back());
  blocks.clear();
  EXPECT_GT(resident_memory() - before, 0.5 * bytes);
  return_freed_memory();
  EXPECT_LT(resident_memory() - before, 0.1 * bytes);
}
