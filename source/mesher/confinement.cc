#include "confinement.h"

#include <squeal/geometry/mesher_protocol.h>

#include <algorithm>
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

    constexpr int starting_programs[] = {SYS_execve, SYS_execveat
#  if defined(__x86_64__)
                                         ,
                                         SYS_fork, SYS_vfork
#  endif
    };

    constexpr int using_network[] = {SYS_socket, SYS_socketpair};

    // File name first
    constexpr int changing_files[] = {SYS_truncate
#  if defined(__x86_64__)
                                      ,
                                      SYS_creat,
                                      SYS_mkdir,
                                      SYS_mknod,
                                      SYS_rename,
                                      SYS_link,
                                      SYS_symlink,
                                      SYS_chmod,
                                      SYS_chown,
                                      SYS_lchown
#  endif
    };

    // Directory first, then file name
    constexpr int changing_files_at[] = {SYS_mkdirat,
                                         SYS_mknodat,
                                         SYS_renameat2,
                                         SYS_linkat,
                                         SYS_symlinkat,
                                         SYS_fchmodat,
                                         SYS_fchownat
#  if defined(SYS_renameat)
                                         ,
                                         SYS_renameat
#  endif
    };

    // No script asks for these; Gmsh itself tries to remove files that it did not make.
    constexpr int removing_files[] = {SYS_unlinkat
#  if defined(__x86_64__)
                                      ,
                                      SYS_unlink, SYS_rmdir
#  endif
    };

    // Ways around the above whose arguments a filter cannot read; callers take the older call instead.
    constexpr int unavailable[] = {435 /* clone3 */, 437 /* openat2 */, 425 /* io_uring_setup */};

    template <typename Calls>
    bool contains(const Calls &calls, const int call)
    {
      return std::find(std::begin(calls), std::end(calls), call) != std::end(calls);
    }

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

      template <typename Calls>
      void forbid(const Calls &calls, const unsigned int action)
      {
        for (const int call : calls)
          if_equal(call, action);
      }

      /// Forbids a call whose 32-bit argument has one of @p bits, or lacks all of them.
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

      void if_equal(const unsigned int value, const unsigned int action)
      {
        program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, 1));
        program.push_back(BPF_STMT(BPF_RET | BPF_K, action));
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
      const int         call  = info->si_syscall;
      const ucontext_t &where = *static_cast<const ucontext_t *>(context);
      if (contains(using_network, call))
        reply_and_end(MesherReply::uses_network, nullptr);
      if (contains(starting_programs, call) || call == SYS_clone)
        reply_and_end(MesherReply::starts_program, nullptr);
#  if defined(__x86_64__)
      if (call == SYS_open)
        reply_and_end(MesherReply::writes_file, text_argument(where, 0));
#  endif
      reply_and_end(MesherReply::writes_file, text_argument(where, contains(changing_files, call) ? 0 : 1));
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
    filter.forbid(starting_programs, SECCOMP_RET_TRAP);
    filter.forbid(using_network, SECCOMP_RET_TRAP);
    filter.forbid(changing_files, SECCOMP_RET_TRAP);
    filter.forbid(changing_files_at, SECCOMP_RET_TRAP);
    filter.forbid(removing_files, SECCOMP_RET_ERRNO | EACCES);
    filter.forbid(unavailable, SECCOMP_RET_ERRNO | ENOSYS);
    filter.forbid_bits(SYS_openat, 2, writing, true);
    filter.forbid_bits(SYS_clone, 0, CLONE_THREAD, false); // threads are no programs
    filter.install();
  }
#else
  void confine()
  {
    throw std::runtime_error("seccomp: not on this processor");
  }
#endif

  void limit_resources(const double bytes, const double seconds)
  {
    const auto limit = [](const auto resource, const double value) {
      const rlim_t whole = static_cast<rlim_t>(std::ceil(value));
      const rlimit both{whole, whole};
      setrlimit(resource, &both);
    };
    limit(RLIMIT_AS, bytes);
    limit(RLIMIT_CPU, 2. * seconds + 10.); // beyond what the parent, which says what happened, allows
    limit(RLIMIT_CORE, 0.);
  }
} // namespace Squeal
