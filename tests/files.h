// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <deal.II/base/mpi.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace Squeal::Testing
{
  /// Content of a file, or an empty string if it does not exist.
  inline std::string content(const std::filesystem::path &file)
  {
    std::ifstream     stream(file);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
  }

  /// Writes a file and creates its folders.
  inline void put(const std::filesystem::path &file, const std::string &text)
  {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }

  /// A temporary folder shared by all processes.
  class TemporaryFolder
  {
  public:
    TemporaryFolder()
      : path(std::filesystem::temp_directory_path() /
             ("squeal_test_" + std::to_string(dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, static_cast<int>(getpid()), 0))))
    {
      alone([&] { std::filesystem::create_directories(path); });
    }
    ~TemporaryFolder()
    {
      alone([&] { std::filesystem::remove_all(path); });
    }

    /// Runs @p action on one process while the other processes wait.
    template <typename Function>
    void alone(const Function &action) const
    {
      MPI_Barrier(MPI_COMM_WORLD);
      if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
        action();
      MPI_Barrier(MPI_COMM_WORLD);
    }

    /// Relative paths of all files in the folder and its subfolders; links are listed, not followed.
    std::vector<std::string> files() const
    {
      std::vector<std::string> names;
      for (const auto &entry : std::filesystem::recursive_directory_iterator(path))
        if (!std::filesystem::is_directory(entry.symlink_status()))
          names.push_back(entry.path().lexically_relative(path).string());
      std::sort(names.begin(), names.end());
      return names;
    }

    const std::filesystem::path path;
  };
} // namespace Squeal::Testing
