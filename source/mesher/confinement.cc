#include "confinement.h"

#include <squeal/geometry/mesher_protocol.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/sched.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

namespace Squeal
{
#if defined(__x86_64__) || defined(__aarch64__)
  namespace
  {
#  if defined(__x86_64__)
    constexpr unsigned int architecture = AUDIT_ARCH_X86_64;

    /// Argument 0 or 1 of the system call in which a signal came.
    const char *text_argument(const ucontext_t &context, const int number)
    {
      return reinterpret_cast<const char *>(context.uc_mcontext.gregs[number == 0 ? REG_RDI : REG_RSI]);
    }
#  else
    constexpr unsigned int architecture = AUDIT_ARCH_AARCH64;

    const char *text_argument(const ucontext_t &context, const int number)
    {
      return reinterpret_cast<const char *>(context.uc_mcontext.regs[number]);
    }
#  endif

    // ------------------------------------------------------- what is forbidden

    /// A system call that ends the process, the reply to it, and which of its arguments names a file; -1 if none does.
    struct Forbidden
    {
      int         call;
      MesherReply reply;
      int         file_argument;
    };

    constexpr MesherReply starts = MesherReply::starts_program, writes = MesherReply::writes_file, connects = MesherReply::uses_network;

    // Of open, openat and clone some uses are allowed, see confine()
    constexpr Forbidden forbidden[] = {
      {SYS_execve, starts, -1},       {SYS_execveat, starts, -1}, {SYS_clone, starts, -1}, {SYS_socket, connects, -1},
      {SYS_socketpair, connects, -1}, {SYS_truncate, writes, 0},  {SYS_openat, writes, 1}, {SYS_mkdirat, writes, 1},
      {SYS_mknodat, writes, 1},       {SYS_renameat2, writes, 1}, {SYS_linkat, writes, 1}, {SYS_symlinkat, writes, 1},
      {SYS_fchmodat, writes, 1},      {SYS_fchownat, writes, 1},
#  if defined(SYS_renameat)
      {SYS_renameat, writes, 1},
#  endif
#  if defined(__x86_64__)
      {SYS_fork, starts, -1},         {SYS_vfork, starts, -1},    {SYS_open, writes, 0},   {SYS_creat, writes, 0},
      {SYS_mkdir, writes, 0},         {SYS_mknod, writes, 0},     {SYS_rename, writes, 0}, {SYS_link, writes, 0},
      {SYS_symlink, writes, 0},       {SYS_chmod, writes, 0},     {SYS_chown, writes, 0},  {SYS_lchown, writes, 0},
#  endif
    };

    // No script asks for these; Gmsh itself tries to remove files that it did not make.
    constexpr int removing_files[] = {
      SYS_unlinkat,
#  if defined(__x86_64__)
      SYS_unlink,
      SYS_rmdir,
#  endif
    };

    // Ways around the above whose arguments a filter cannot read; callers take the older call instead.
    constexpr int unavailable[] = {435 /* clone3 */, 437 /* openat2 */, 425 /* io_uring_setup */};

    // ------------------------------------------------------------------ filter

    /// Program of the kernel's filter, which looks at every system call.
    class Filter
    {
    public:
      Filter()
      {
        load(offsetof(seccomp_data, arch));
        unless_equal(architecture, SECCOMP_RET_KILL_PROCESS);
        load(offsetof(seccomp_data, nr));
      }

      /// Answers a call by an action of the kernel, unless a rule before this one has decided about it.
      void answer(const int call, const unsigned int action)
      {
        program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (unsigned int)(call), 0, 1));
        program.push_back(BPF_STMT(BPF_RET | BPF_K, action));
      }

      /// Decides about a call: forbids it if its 32-bit argument has one of @p bits, or lacks all of them.
      void forbid_bits(const int call, const int argument, const unsigned int bits, const bool where_set)
      {
        program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (unsigned int)(call), 0, 4));
        load(offsetof(seccomp_data, args) + 8 * argument); // both processors store the low half first
        program.push_back(
          BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, bits, (unsigned char)(where_set ? 0 : 1), (unsigned char)(where_set ? 1 : 0)));
        program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP));
        program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
      }

      /// Forbids all calls from a number on.
      void forbid_from(const unsigned int first)
      {
        program.push_back(BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, first, 0, 1));
        program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS));
      }

      void install()
      {
        program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
        const sock_fprog all{(unsigned short)(program.size()), program.data()};
        if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &all) != 0)
          throw std::runtime_error(std::string("seccomp: ") + std::strerror(errno));
      }

    private:
      void load(const unsigned int offset)
      {
        program.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offset));
      }

      void unless_equal(const unsigned int value, const unsigned int action)
      {
        program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 1, 0));
        program.push_back(BPF_STMT(BPF_RET | BPF_K, action));
      }

      std::vector<sock_filter> program;
    };

    // ------------------------------------------------------------------- reply

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
      for (const Forbidden &rule : forbidden)
        if (rule.call == info->si_syscall)
          reply_and_end(rule.reply,
                        rule.file_argument < 0 ? nullptr : text_argument(*static_cast<const ucontext_t *>(context), rule.file_argument));
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

    constexpr unsigned int writing = O_ACCMODE | O_CREAT | O_TRUNC;
    Filter                 filter;
#  if defined(__x86_64__)
    filter.forbid_from(0x40000000); // the x32 numbers of the same calls
    filter.forbid_bits(SYS_open, 1, writing, true);
#  endif
    filter.forbid_bits(SYS_openat, 2, writing, true);
    filter.forbid_bits(SYS_clone, 0, CLONE_THREAD, false); // threads are no programs
    for (const Forbidden &rule : forbidden)
      filter.answer(rule.call, SECCOMP_RET_TRAP);
    for (const int call : removing_files)
      filter.answer(call, SECCOMP_RET_ERRNO | EACCES);
    for (const int call : unavailable)
      filter.answer(call, SECCOMP_RET_ERRNO | ENOSYS);
    filter.install();
  }
#else
  void confine()
  {
    throw std::runtime_error("seccomp: not on this processor");
  }
#endif

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
