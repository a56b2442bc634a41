// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/file_writing.h>

#include <cerrno>
#include <fstream>

namespace Squeal
{
  int write_file(const std::filesystem::path &file, const std::string_view text)
  {
    errno = 0;
    std::ofstream stream(file, std::ios::binary);
    stream << text;
    stream.close();
    return stream ? 0 : errno != 0 ? errno : EIO;
  }

  void replace_file(const std::filesystem::path &file, const std::string_view text)
  {
    const std::filesystem::path temporary = file.string() + ".incomplete";
    if (const int problem = write_file(temporary, text); problem != 0)
      throw std::filesystem::filesystem_error("write", temporary, std::error_code(problem, std::generic_category()));
    std::filesystem::rename(temporary, file);
  }
} // namespace Squeal
