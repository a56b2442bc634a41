#include <squeal/base/exceptions.h>
#include <squeal/base/interruption.h>

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <utility>

namespace Squeal
{
  namespace
  {
    constexpr std::array<int, 4> signals = {{SIGINT, SIGTERM, SIGHUP, SIGPIPE}};

    // A handler reaches nothing but what is static, and little more than write() is safe in it.
    int              wake_up[2]; // ends of a pipe: the handler writes, the thread reads
    struct sigaction former[signals.size()];

    // Libraries may take signals for themselves before main() begins, and nobody could tell any longer which the parent
    // wants to be ignored, as nohup does. Functions of this section run before those of the libraries.
    std::array<bool, signals.size()> is_ignored;

    void remember_ignored()
    {
      for (std::size_t s = 0; s < signals.size(); ++s)
        {
          struct sigaction given;
          ::sigaction(signals[s], nullptr, &given);
          is_ignored[s] = given.sa_handler == SIG_IGN;
        }
    }
    __attribute__((section(".preinit_array"), used)) void (*const first_of_all)() = remember_ignored;

    void tell_thread(const int number)
    {
      const int           kept = errno;
      const unsigned char byte = static_cast<unsigned char>(number);
      // The pipe is only full when it has been told often enough.
      [[maybe_unused]] const ssize_t n = ::write(wake_up[1], &byte, 1);
      errno                            = kept;
    }

    /// To the terminal, past the streams: the thread that writes to them may stand still.
    void say(const std::string &text)
    {
      [[maybe_unused]] const ssize_t n = ::write(STDERR_FILENO, text.data(), text.size());
    }
  } // namespace

  void ignore_again()
  {
    for (std::size_t s = 0; s < signals.size(); ++s)
      if (is_ignored[s])
        ::signal(signals[s], SIG_IGN);
  }

  Interruption::Interruption()
  {
    if (::pipe2(wake_up, O_CLOEXEC) != 0)
      throw Error(std::string("no pipe can be opened: ") + std::strerror(errno), "start of the program",
                  "close other programs, or raise the limit of open files");
    ::fcntl(wake_up[1], F_SETFL, O_NONBLOCK);
    waiting = std::thread([this] { wait(); });
    for (std::size_t s = 0; s < signals.size(); ++s)
      {
        struct sigaction own = {};
        own.sa_handler       = tell_thread;
        own.sa_flags         = SA_RESTART;
        ::sigfillset(&own.sa_mask);
        ::sigaction(signals[s], nullptr, &former[s]);
        if (!is_ignored[s])
          ::sigaction(signals[s], &own, nullptr);
      }
    ignore_again();
  }

  Interruption::~Interruption()
  {
    for (std::size_t s = 0; s < signals.size(); ++s)
      ::sigaction(signals[s], &former[s], nullptr);
    tell_thread(0);
    waiting.join();
    ::close(wake_up[0]);
    ::close(wake_up[1]);
  }

  void Interruption::wait()
  {
    unsigned char number = 0;
    ssize_t       n;
    while ((n = ::read(wake_up[0], &number, 1)) < 0 && errno == EINTR)
      ;
    if (n != 1 || number == 0)
      return;
    mutex.lock();
    const std::string consequence = action ? ": " + action() : std::string();
    if (!silent)
      say(std::string("\nsqueal was ended by SIG") + ::sigabbrev_np(number) + consequence + "\n");
    else
      // mpirun ends all processes when the first one has ended: that should be the one that cleans up and speaks.
      std::this_thread::sleep_for(std::chrono::seconds(1));
    ::_exit(128 + number);
  }
} // namespace Squeal
