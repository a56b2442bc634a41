#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace Squeal
{
  /// Ignores the signals that were ignored when the program began, whatever libraries have done since.
  void ignore_again();

  /**
   * Ends the process when SIGINT, SIGTERM, SIGHUP or SIGPIPE arrives: cleans up,
   * says so in one line, and exits with 128 + the number of the signal. A thread
   * of its own does it, whatever library computes meanwhile. A signal that is
   * ignored at the start stays ignored, as `nohup` and shells expect.
   *
   * There may be one at a time. Libraries must not take the signals over later.
   */
  class Interruption
  {
  public:
    Interruption();

    /// Gives the signals back their former meaning.
    ~Interruption();

    Interruption(const Interruption &)            = delete;
    Interruption &operator=(const Interruption &) = delete;

    /// Lets other processes of the run speak.
    void be_silent()
    {
      silent = true;
    }

    /// While it is held, a signal waits: for steps that are done wholly or not at all.
    [[nodiscard]] std::unique_lock<std::mutex> hold()
    {
      return std::unique_lock<std::mutex>(mutex);
    }

    /**
     * Sets what is done before the process ends; nothing if empty. To be called
     * while hold() is held. @p action returns what it means for the user, one phrase.
     */
    void before_end(std::function<std::string()> new_action)
    {
      action = std::move(new_action);
    }

  private:
    /// Waits for a signal, or for the end of this object.
    void wait();

    std::mutex                   mutex; ///< guards the action; locked for good once the process ends
    std::function<std::string()> action;
    std::atomic<bool>            silent{false};
    std::thread                  waiting;
  };
} // namespace Squeal
