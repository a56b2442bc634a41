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
  /// Time and memory used by this process.
  struct Cost
  {
    double seconds     = 0.; ///< wall time [s]
    double cpu_seconds = 0.; ///< processor time [s]
    double peak_memory = 0.; ///< peak resident memory so far [byte]
  };

  /// Measures the cost since its construction.
  class Stopwatch
  {
  public:
    Stopwatch();

    Cost cost() const;

  private:
    std::chrono::steady_clock::time_point start;
    std::clock_t                          cpu_start;
  };

  /// A finished step of a run, as listed in the run record.
  struct StepRecord : Cost
  {
    std::string name;
    std::string summary; ///< result of the step in a few words
  };

  /**
   * Progress messages: one line per step with its elapsed time, and on a terminal a live counter, which a separate thread updates during
   * long computations. Only the process with a stream prints.
   */
  class Progress
  {
  public:
    /// Records steps and prints nothing.
    Progress() = default;

    /// Prints to @p stream; @p live: with a live counter, for a terminal.
    Progress(std::ostream &stream, bool live);

    ~Progress();

    Progress(const Progress &)            = delete;
    Progress &operator=(const Progress &) = delete;

    /// Ends the current step and begins a new step.
    void begin(const std::string &name);

    /// Sets the text that the live counter shows for the current step.
    void update(const std::string &state);

    /// Ends the current step, prints its final line and returns its cost.
    Cost finish(const std::string &summary = "");

    /// Prints a line that belongs to no step.
    void note(const std::string &text);

    const std::vector<StepRecord> &steps() const
    {
      return records;
    }

    double elapsed() const
    {
      return run.cost().seconds;
    }

  private:
    /// Updates the live counter until the object is destroyed.
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
