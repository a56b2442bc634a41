#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace Squeal::Testing
{
  /// All that a file holds; nothing where there is no file.
  inline std::string content(const std::filesystem::path &file)
  {
    std::ifstream     stream(file);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
  }
} // namespace Squeal::Testing
