#pragma once

#include <cstdint>
#include <string_view>

namespace Squeal
{
  /// FNV-1a with 64 bits.
  inline std::uint64_t checksum(const std::string_view bytes)
  {
    std::uint64_t result = 0xcbf29ce484222325ull;
    for (const char byte : bytes)
      result = (result ^ static_cast<unsigned char>(byte)) * 0x100000001b3ull;
    return result;
  }
} // namespace Squeal
