#include <squeal/base/file_writing.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <string>

namespace Squeal
{
  int write_file(const std::filesystem::path                   &file,
                 const int                                      flags,
                 const std::initializer_list<std::string_view> &texts,
                 const bool                                     on_disk)
  {
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | flags, 0666);
    int       problem    = descriptor < 0 ? errno : 0;
    for (std::string_view text : texts)
      while (problem == 0 && !text.empty())
        {
          const ssize_t n = ::write(descriptor, text.data(), text.size());
          if (n >= 0)
            text.remove_prefix(n);
          else if (errno != EINTR)
            problem = errno;
        }
    // Some file systems do not know fsync() and say that the argument is invalid.
    if (problem == 0 && on_disk && ::fsync(descriptor) != 0 && errno != EINVAL)
      problem = errno;
    if (descriptor >= 0 && ::close(descriptor) != 0 && problem == 0)
      problem = errno;
    return problem;
  }

  void replace_file(const std::filesystem::path &file, const std::string_view text)
  {
    const std::filesystem::path temporary = file.string() + ".incomplete";
    if (const int problem = write_file(temporary, O_TRUNC, {text}, true); problem != 0)
      throw std::filesystem::filesystem_error("write", temporary, std::error_code(problem, std::generic_category()));
    std::filesystem::rename(temporary, file);
  }
} // namespace Squeal
