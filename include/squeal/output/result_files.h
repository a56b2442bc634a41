#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace Squeal
{
  /// Names of files, seen from a folder, and their sizes [byte].
  using FileSizes = std::map<std::string, std::uintmax_t>;

  /// All files below a folder; links and what else is no file are left out.
  FileSizes files_below(const std::filesystem::path &folder);

  /// First of the files that is not in the folder with its size; empty if all are.
  std::string first_incomplete(const std::filesystem::path &folder, const FileSizes &files);

  /**
   * Whether a name is one that runs gave to their files before the record listed
   * these: tables and fields, in the folders where they wrote them.
   */
  bool is_name_of_result(const std::filesystem::path &name);

  /**
   * Brings what a user put into one result folder over to the next one: as a
   * hard link where the file system has them, else as a copy. The folder that
   * it comes from stays as it is. A name that the new results need themselves
   * becomes NAME.kept, NAME.kept-2, ...
   *
   * @param is_of_run whether a file belongs to the former run and stays behind
   *
   * Returns old and new name of what had to change its name. Throws std::filesystem::filesystem_error.
   */
  std::vector<std::pair<std::string, std::string>> bring_over(const std::filesystem::path                    &from,
                                                              const std::filesystem::path                    &to,
                                                              const std::function<bool(const std::string &)> &is_of_run);

  /// Exchanges the names of two folders in one step; returns false where the file system cannot. Throws std::filesystem::filesystem_error.
  bool exchange(const std::filesystem::path &one, const std::filesystem::path &other);

  /// Moves a folder to @p aside and another one to its place; if that fails, moves it back. Throws std::filesystem::filesystem_error.
  void move_to_place(const std::filesystem::path &complete, const std::filesystem::path &place, const std::filesystem::path &aside);
} // namespace Squeal
