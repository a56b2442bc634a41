#pragma once

#include <cstdint>
#include <string_view>

namespace Squeal
{
  /// FNV-1a with 64 bits; @p before continues that of what comes before.
  inline std::uint64_t checksum(const std::string_view bytes, std::uint64_t before = 0xcbf29ce484222325ull)
  {
    for (const char byte : bytes)
      before = (before ^ static_cast<unsigned char>(byte)) * 0x100000001b3ull;
    return before;
  }
} // namespace Squeal
