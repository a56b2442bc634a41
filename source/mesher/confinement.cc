// SPDX-License-Identifier: GPL-3.0-or-later

#include "meshing.h"

#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

#include <fcntl.h>
#include <linux/sched.h>
#include <seccomp.h>
#include <sys/resource.h>
#include <sys/time.h>

namespace Squeal
{
  namespace
  {
    // System calls that do not exist on a processor have negative numbers, which libseccomp ignores
    constexpr int forbidden[] = {SCMP_SYS(execve),     SCMP_SYS(execveat),  SCMP_SYS(fork),     SCMP_SYS(vfork),    SCMP_SYS(socket),
                                 SCMP_SYS(socketpair), SCMP_SYS(truncate),  SCMP_SYS(creat),    SCMP_SYS(mkdir),    SCMP_SYS(mkdirat),
                                 SCMP_SYS(mknod),      SCMP_SYS(mknodat),   SCMP_SYS(rename),   SCMP_SYS(renameat), SCMP_SYS(link),
                                 SCMP_SYS(linkat),     SCMP_SYS(renameat2), SCMP_SYS(symlink),  SCMP_SYS(chmod),    SCMP_SYS(fchmodat),
                                 SCMP_SYS(chown),      SCMP_SYS(lchown),    SCMP_SYS(fchownat), SCMP_SYS(symlinkat)};

    // Calls that fail with EACCES instead of ending the process, because Gmsh tries to remove files that it did not create
    constexpr int removing_files[] = {SCMP_SYS(unlink), SCMP_SYS(unlinkat), SCMP_SYS(rmdir)};

    // Newer calls with arguments that a filter cannot check; they fail with ENOSYS so that libraries use the older calls
    constexpr int unavailable[] = {SCMP_SYS(clone3), SCMP_SYS(openat2), SCMP_SYS(io_uring_setup)};

    void check(const int result)
    {
      if (result != 0)
        throw std::runtime_error(std::string("seccomp: ") + std::strerror(-result));
    }
  } // namespace

  void confine()
  {
    // Limit the size of the log file of Gmsh
    constexpr rlim_t largest_log = 1 << 24; // [byte]
    const rlimit     file_size{largest_log, largest_log};
    setrlimit(RLIMIT_FSIZE, &file_size);
    std::signal(SIGXFSZ, SIG_IGN);

    const std::unique_ptr<void, void (*)(scmp_filter_ctx)> filter(seccomp_init(SCMP_ACT_ALLOW), seccomp_release);
    if (!filter)
      throw std::runtime_error("seccomp is not available on this system");
    for (const int call : forbidden)
      check(seccomp_rule_add(filter.get(), SCMP_ACT_KILL_PROCESS, call, 0));
    for (const std::uint64_t bit : {O_WRONLY, O_RDWR, O_CREAT, O_TRUNC})
      {
        check(seccomp_rule_add(filter.get(), SCMP_ACT_KILL_PROCESS, SCMP_SYS(open), 1, SCMP_A1(SCMP_CMP_MASKED_EQ, bit, bit)));
        check(seccomp_rule_add(filter.get(), SCMP_ACT_KILL_PROCESS, SCMP_SYS(openat), 1, SCMP_A2(SCMP_CMP_MASKED_EQ, bit, bit)));
      }
    // Permit new threads, but not new processes
    check(seccomp_rule_add(filter.get(), SCMP_ACT_KILL_PROCESS, SCMP_SYS(clone), 1, SCMP_A0(SCMP_CMP_MASKED_EQ, CLONE_THREAD, 0)));
    for (const int call : removing_files)
      check(seccomp_rule_add(filter.get(), SCMP_ACT_ERRNO(EACCES), call, 0));
    for (const int call : unavailable)
      check(seccomp_rule_add(filter.get(), SCMP_ACT_ERRNO(ENOSYS), call, 0));
    check(seccomp_load(filter.get()));
  }

  void limit_resources([[maybe_unused]] const double bytes, const double seconds)
  {
    const auto limit = [](const auto resource, const double value) {
      const rlim_t whole = static_cast<rlim_t>(std::ceil(value));
      const rlimit both{whole, whole};
      setrlimit(resource, &both);
    };
#if !defined(__SANITIZE_ADDRESS__) // the sanitizer reserves more address space than any limit allows
    limit(RLIMIT_AS, bytes);
#endif
    limit(RLIMIT_CORE, 0.);
    const itimerval once{{}, {static_cast<time_t>(seconds), static_cast<suseconds_t>(1e6 * std::fmod(seconds, 1.))}};
    setitimer(ITIMER_REAL, &once, nullptr);
  }
} // namespace Squeal
