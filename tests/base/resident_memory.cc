#include <squeal/base/resident_memory.h>

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <utility>
#include <vector>

using namespace Squeal;

namespace
{
  /// What more is resident while a block of memory is in use, and after it.
  std::pair<double, double> resident_with_and_after(const std::size_t bytes)
  {
    const double before = resident_memory();
    double       with   = 0.;
    {
      const auto block = std::make_unique<char[]>(bytes);
      std::memset(block.get(), 1, bytes);
      EXPECT_EQ(block[bytes / 2], 1);
      with = resident_memory() - before;
    }
    return {with, resident_memory() - before};
  }
} // namespace

TEST(ResidentMemory, PeakIsThatSinceTheReset)
{
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer keeps freed memory, to find who still uses it";
#endif
  constexpr std::size_t bytes  = 200'000'000;
  const double          before = resident_memory();
  if (before == 0. || !reset_peak_memory())
    GTEST_SKIP() << "the system does not tell";
  EXPECT_LT(peak_resident_memory(), before + 0.1 * bytes);
  {
    const auto block = std::make_unique<char[]>(bytes);
    std::memset(block.get(), 1, bytes);
    EXPECT_EQ(block[bytes / 2], 1);
    EXPECT_GT(resident_memory(), before + 0.9 * bytes);
  }
  EXPECT_GT(peak_resident_memory(), before + 0.9 * bytes);
  // Only now does freed memory go back to the system: a library lets malloc keep it
  ASSERT_TRUE(reset_peak_memory());
  EXPECT_LT(resident_memory(), before + 0.1 * bytes);
  EXPECT_LT(peak_resident_memory(), before + 0.1 * bytes);
}

TEST(ResidentMemory, FreedBlocksGoBack)
{
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer keeps freed memory, to find who still uses it";
#endif
  if (resident_memory() == 0.)
    GTEST_SKIP() << "the system does not tell";
  constexpr std::size_t bytes = 200'000'000;
  return_freed_blocks();
  const auto [with, after] = resident_with_and_after(bytes);
  EXPECT_GT(with, 0.9 * bytes);
  EXPECT_LT(after, 0.1 * bytes);

  // Smaller ones when asked for, though something behind them is in use
  const double                         before = resident_memory();
  std::vector<std::unique_ptr<char[]>> blocks;
  constexpr std::size_t                small = 1'000'000;
  for (std::size_t i = 0; i < bytes / small; ++i)
    {
      blocks.push_back(std::make_unique<char[]>(small));
      std::memset(blocks.back().get(), 1, small);
    }
  const auto last = std::move(blocks.back());
  blocks.clear();
  EXPECT_EQ(last[small / 2], 1);
  EXPECT_GT(resident_memory() - before, 0.5 * bytes);
  return_freed_memory();
  EXPECT_LT(resident_memory() - before, 0.1 * bytes);
}
