// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <unistd.h>

namespace Squeal::Testing
{
  /// A temporary file in its own directory.
  class File
  {
  public:
    explicit File(const std::string &name, const std::string &content = "")
    {
      std::string pattern = (std::filesystem::temp_directory_path() / "squeal-test-XXXXXX").string();
      directory           = ::mkdtemp(pattern.data());
      path                = directory / name;
      std::ofstream(path) << content;
    }
    ~File()
    {
      std::filesystem::remove_all(directory);
    }

    std::string string() const
    {
      return path.string();
    }

    std::filesystem::path directory, path;
  };

  /// Message of the Exception thrown by the action, or "accepted".
  template <typename Exception, typename Action>
  std::string message(const Action &action)
  {
    try
      {
        action();
      }
    catch (const Exception &exception)
      {
        return exception.what();
      }
    return "accepted";
  }

  inline void expect_mentions(const std::string &text, const std::vector<std::string> &parts)
  {
    for (const std::string &part : parts)
      EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is missing in:\n" << text;
  }
} // namespace Squeal::Testing
