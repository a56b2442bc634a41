#include <squeal/base/resident_memory.h>

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

using namespace Squeal;

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
  // Only now does freed memory go back to the system: Open MPI lets malloc keep it
  ASSERT_TRUE(reset_peak_memory());
  EXPECT_LT(resident_memory(), before + 0.1 * bytes);
  EXPECT_LT(peak_resident_memory(), before + 0.1 * bytes);
}
