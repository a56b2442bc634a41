// SPDX-License-Identifier: GPL-3.0-or-later

// Preloaded fork server: it relocates more than 200 libraries once, which takes longer than a small run. For every request it forks before
// `main`; the child runs the program, and the parent replies with its exit status.

#include <dlfcn.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace
{
  struct Request
  {
    std::vector<char> text;       // working folder and arguments, each terminated by zero
    int               streams[2]; // standard output and error
  };

  /// Receives a request; false if the client has closed the socket.
  bool receive(const int socket, Request &request)
  {
    request.text.resize(1 << 20);
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(request.streams))];
    iovec                 part    = {request.text.data(), request.text.size()};
    msghdr                message = {};
    message.msg_iov               = &part;
    message.msg_iovlen            = 1;
    message.msg_control           = control;
    message.msg_controllen        = sizeof(control);
    const ssize_t  n_bytes        = ::recvmsg(socket, &message, MSG_CMSG_CLOEXEC);
    const cmsghdr *descriptors    = CMSG_FIRSTHDR(&message);
    if (n_bytes <= 0 || !descriptors)
      return false;
    std::memcpy(request.streams, CMSG_DATA(descriptors), sizeof(request.streams));
    request.text.resize(n_bytes);
    return true;
  }

  /// Sets streams, folder and environment of the child; returns its arguments and environment in the kernel's layout.
  std::vector<char *> become(Request &request)
  {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::unsetenv("LD_PRELOAD");
    ::unsetenv("SQUEAL_STARTER_SOCKET");
    for (const int stream : {0, 1})
      ::dup2(request.streams[stream], stream + 1);
    char *const         end = request.text.data() + request.text.size();
    std::vector<char *> words;
    for (char *word = request.text.data(); word < end; word += std::strlen(word) + 1)
      words.push_back(word);
    if (::chdir(words.front()) != 0)
      ::_exit(127);
    words.erase(words.begin());
    words.push_back(nullptr);
    for (char **variable = environ; *variable; ++variable)
      words.push_back(*variable);
    words.push_back(nullptr);
    return words;
  }
} // namespace

using Main      = int (*)(int, char **, char **);
using StartMain = int (*)(Main, int, char **, void (*)(), void (*)(), void (*)(), void *);

extern "C" int __libc_start_main(Main main, int argc, char **argv, void (*init)(), void (*fini)(), void (*rtld_fini)(), void *stack_end)
{
  const auto start = reinterpret_cast<StartMain>(::dlsym(RTLD_NEXT, "__libc_start_main"));
  if (const char *const number = std::getenv("SQUEAL_STARTER_SOCKET"))
    {
      const int socket = std::atoi(number);
      for (static Request request;;)
        {
          if (!receive(socket, request))
            ::_exit(0);
          const pid_t child = ::fork();
          if (child == 0)
            {
              ::close(socket);
              static std::vector<char *> words = become(request);
              argc                             = std::find(words.begin(), words.end(), nullptr) - words.begin();
              environ                          = words.data() + argc + 1;
              return start(main, argc, words.data(), init, fini, rtld_fini, stack_end);
            }
          int status = 127 << 8;
          ::waitpid(child, &status, 0);
          for (const int stream : request.streams)
            ::close(stream);
          if (::send(socket, &status, sizeof(status), MSG_NOSIGNAL) < 0)
            ::_exit(0);
        }
    }
  return start(main, argc, argv, init, fini, rtld_fini, stack_end);
}
