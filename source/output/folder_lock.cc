#include <squeal/base/exceptions.h>
#include <squeal/base/file_writing.h>
#include <squeal/output/folder_lock.h>
#include <squeal/output/run_record.h>

#include <deal.II/base/utilities.h>

#include <boost/algorithm/string/predicate.hpp>
#include <boost/algorithm/string/trim.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace Squeal
{
  namespace
  {
    /// How the file of every lock begins.
    constexpr const char *mark = "squeal: ";

    std::string content(const int descriptor)
    {
      std::array<char, 8192> text;
      const ssize_t          n = ::pread(descriptor, text.data(), text.size(), 0);
      return n > 0 ? std::string(text.data(), n) : std::string();
    }

    /// Whether an open file still is the one that has this name.
    bool has_name(const int descriptor, const std::filesystem::path &file)
    {
      struct stat opened, named;
      return ::fstat(descriptor, &opened) == 0 && ::lstat(file.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
             opened.st_ino == named.st_ino;
    }
  } // namespace

  FolderLock::FolderLock(const std::filesystem::path &file, const std::string &folder, const std::string &command)
    : file(file)
  {
    const auto fail = [&](const std::string &what, const std::string &change) {
      if (descriptor >= 0)
        ::close(descriptor);
      return FileError(what, "--output " + folder + ", file " + file.string(), change);
    };
    // Once more if the former run removed the file after it had been opened here
    while (descriptor < 0)
      {
        descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
        if (descriptor < 0)
          throw fail(std::string("the result folder cannot be locked: ") + std::strerror(errno),
                     "choose a folder beside which you may write");
        if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
          {
            const std::string holder = boost::trim_copy(content(descriptor));
            ::close(descriptor);
            throw FileError("another run writes to `" + folder + "`: " +
                              (boost::starts_with(holder, mark) ? holder.substr(std::strlen(mark)) : "a process that has just begun"),
                            "--output " + folder, "wait until it has ended, or choose another name");
          }
        if (!has_name(descriptor, file))
          {
            ::close(descriptor);
            descriptor = -1;
          }
      }
    const std::string former = content(descriptor);
    if (!former.empty() && !boost::starts_with(former, mark))
      throw fail("the file has the name of the lock but is none", "move it, or choose another name");
    left_behind                = !former.empty();
    const std::string this_run = mark + ("process " + std::to_string(::getpid())) + " on " + dealii::Utilities::System::get_hostname() +
                                 " since " + utc_time() + ", `" + command + "`\n";
    // Over what is there: a run that is killed, or fails, in between must leave a lock that tells of the run before it
    int problem = write_file(file, 0, {this_run}, false);
    if (problem == 0 && ::ftruncate(descriptor, this_run.size()) != 0)
      problem = errno;
    if (problem != 0)
      {
        if (!left_behind)
          ::unlink(file.c_str());
        throw fail(std::string("the result folder cannot be locked: ") + std::strerror(problem), "check permissions and free space");
      }
  }

  FolderLock::~FolderLock()
  {
    ::unlink(file.c_str());
    ::close(descriptor);
  }

  bool FolderLock::was_left_behind() const
  {
    return left_behind;
  }
} // namespace Squeal
