#include "meshing.h"

#include <squeal/geometry/gmsh_mesh.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

#include <fcntl.h>
#include <linux/sched.h>
#include <seccomp.h>
#include <sys/resource.h>
#include <ucontext.h>
#include <unistd.h>

namespace Squeal
{
  namespace
  {
    /// Argument 0 or 1 of the system call in which a signal came; null where it is not known.
    const char *text_argument([[maybe_unused]] const ucontext_t &context, [[maybe_unused]] const int number)
    {
#if defined(__x86_64__)
      return reinterpret_cast<const char *>(context.uc_mcontext.gregs[number == 0 ? REG_RDI : REG_RSI]);
#elif defined(__aarch64__)
      return reinterpret_cast<const char *>(context.uc_mcontext.regs[number]);
#else
      return nullptr;
#endif
    }

    /// A system call that ends the process, the reply to it, and which of its arguments names a file; -1 if none does.
    struct Forbidden
    {
      int         call;
      MesherReply reply;
      int         file_argument;
    };

    constexpr MesherReply starts = MesherReply::starts_program, writes = MesherReply::writes_file, connects = MesherReply::uses_network;

    // Numbers of calls that a processor does not have are negative, and ignored
    constexpr Forbidden forbidden[] = {
      {SCMP_SYS(execve), starts, -1},  {SCMP_SYS(execveat), starts, -1}, {SCMP_SYS(fork), starts, -1},
      {SCMP_SYS(vfork), starts, -1},   {SCMP_SYS(socket), connects, -1}, {SCMP_SYS(truncate), writes, 0},
      {SCMP_SYS(creat), writes, 0},    {SCMP_SYS(mkdir), writes, 0},     {SCMP_SYS(mknod), writes, 0},
      {SCMP_SYS(rename), writes, 0},   {SCMP_SYS(link), writes, 0},      {SCMP_SYS(symlink), writes, 0},
      {SCMP_SYS(chmod), writes, 0},    {SCMP_SYS(chown), writes, 0},     {SCMP_SYS(lchown), writes, 0},
      {SCMP_SYS(mkdirat), writes, 1},  {SCMP_SYS(mknodat), writes, 1},   {SCMP_SYS(renameat), writes, 1},
      {SCMP_SYS(linkat), writes, 1},   {SCMP_SYS(renameat2), writes, 1}, {SCMP_SYS(symlinkat), writes, 1},
      {SCMP_SYS(fchmodat), writes, 1}, {SCMP_SYS(fchownat), writes, 1},  {SCMP_SYS(socketpair), connects, -1}};

    // Of these only some uses are forbidden, see confine()
    constexpr Forbidden forbidden_uses[] = {{SCMP_SYS(open), writes, 0}, {SCMP_SYS(openat), writes, 1}, {SCMP_SYS(clone), starts, -1}};

    // No script asks for these; Gmsh itself tries to remove files that it did not make.
    constexpr int removing_files[] = {SCMP_SYS(unlink), SCMP_SYS(unlinkat), SCMP_SYS(rmdir)};

    // Ways around the above whose arguments a filter cannot read; callers take the older call instead.
    constexpr int unavailable[] = {SCMP_SYS(clone3), SCMP_SYS(openat2), SCMP_SYS(io_uring_setup)};

    /// Says what was tried, and ends the process. Called in a signal: system calls only.
    void reply_and_end(const MesherReply reply, const char *text)
    {
      const char letter = static_cast<char>(reply);
      bool       sent   = write(mesher_reply_descriptor, &letter, 1) == 1;
      if (text != nullptr)
        sent = sent && write(mesher_reply_descriptor, text, std::strlen(text)) >= 0;
      _exit(sent ? 0 : 1);
    }

    void on_forbidden_call(int, siginfo_t *info, void *context)
    {
      const auto answer = [&](const Forbidden &rule) {
        if (rule.call == info->si_syscall)
          reply_and_end(rule.reply,
                        rule.file_argument < 0 ? nullptr : text_argument(*static_cast<const ucontext_t *>(context), rule.file_argument));
      };
      for (const Forbidden &rule : forbidden)
        answer(rule);
      for (const Forbidden &rule : forbidden_uses)
        answer(rule);
    }

    void check(const int result)
    {
      if (result != 0)
        throw std::runtime_error(std::string("seccomp: ") + std::strerror(-result));
    }
  } // namespace

  void confine()
  {
    // What Gmsh prints goes to a file
    constexpr rlim_t largest_log = 1 << 24; // [byte]
    const rlimit     file_size{largest_log, largest_log};
    setrlimit(RLIMIT_FSIZE, &file_size);
    std::signal(SIGXFSZ, SIG_IGN);

    struct sigaction action = {};
    action.sa_sigaction     = on_forbidden_call;
    action.sa_flags         = SA_SIGINFO;
    sigaction(SIGSYS, &action, nullptr);

    const std::unique_ptr<void, void (*)(scmp_filter_ctx)> filter(seccomp_init(SCMP_ACT_ALLOW), seccomp_release);
    if (!filter)
      throw std::runtime_error("seccomp: not on this system");
    for (const Forbidden &rule : forbidden)
      check(seccomp_rule_add(filter.get(), SCMP_ACT_TRAP, rule.call, 0));
    for (const std::uint64_t bit : {O_WRONLY, O_RDWR, O_CREAT, O_TRUNC})
      {
        check(seccomp_rule_add(filter.get(), SCMP_ACT_TRAP, SCMP_SYS(open), 1, SCMP_A1(SCMP_CMP_MASKED_EQ, bit, bit)));
        check(seccomp_rule_add(filter.get(), SCMP_ACT_TRAP, SCMP_SYS(openat), 1, SCMP_A2(SCMP_CMP_MASKED_EQ, bit, bit)));
      }
    // Threads are no programs
    check(seccomp_rule_add(filter.get(), SCMP_ACT_TRAP, SCMP_SYS(clone), 1, SCMP_A0(SCMP_CMP_MASKED_EQ, CLONE_THREAD, 0)));
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
#if !defined(__SANITIZE_ADDRESS__) // which reserves more addresses than any machine has memory
    limit(RLIMIT_AS, bytes);
#endif
    limit(RLIMIT_CPU, 2. * seconds + 10.); // beyond what the parent, which says what happened, allows
    limit(RLIMIT_CORE, 0.);
  }
} // namespace Squeal
