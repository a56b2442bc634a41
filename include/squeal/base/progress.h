// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <chrono>
#include <condition_variable>
#include <ctime>
#include <iosfwd>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace Squeal
{
  /// What work takes on this process.
  struct Cost
  {
    double seconds     = 0.; ///< wall time [s]
    double cpu_seconds = 0.; ///< processor time [s]
    double peak_memory = 0.; ///< peak resident memory so far [byte]
  };

  /// Measures what is done after its construction.
  class Stopwatch
  {
  public:
    Stopwatch();

    Cost cost() const;

  private:
    std::chrono::steady_clock::time_point start;
    std::clock_t                          cpu_start;
  };

  /// One finished step of a run, as the run record lists it.
  struct StepRecord : Cost
  {
    std::string name;
    std::string summary; ///< what the step found, one phrase
  };

  /**
   * The one channel through which computing code speaks while it works: one
   * line per step with its elapsed time, and on a terminal a live counter,
   * which a thread of its own keeps running while libraries compute.
   * Silent on every process but the one that was given a stream.
   */
  class Progress
  {
  public:
    /// A channel that records steps but prints nothing.
    Progress() = default;

    /// A channel that prints to @p stream; @p live: it is a terminal.
    Progress(std::ostream &stream, bool live);

    ~Progress();

    Progress(const Progress &)            = delete;
    Progress &operator=(const Progress &) = delete;

    /// Begins a step; an unfinished one is finished first.
    void begin(const std::string &name);

    /// Sets the state of the current step that the live counter shows.
    void update(const std::string &state);

    /// Ends the current step with the line that stays; returns what it took.
    Cost finish(const std::string &summary = "");

    /// Prints a line that belongs to no step.
    void note(const std::string &text);

    /// All finished steps.
    const std::vector<StepRecord> &steps() const
    {
      return records;
    }

    /// Seconds since construction.
    double elapsed() const
    {
      return run.cost().seconds;
    }

  private:
    /// Shows the counter until the channel is closed.
    void count();

    std::ostream           *stream = nullptr;
    bool                    live   = false;
    Stopwatch               run, step;
    std::string             current, state;
    std::vector<StepRecord> records;

    std::mutex              mutex; ///< guards the stream and the current step
    std::condition_variable closing;
    bool                    closed = false;
    std::thread             counter;
  };
} // namespace Squeal
