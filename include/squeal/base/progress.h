#pragma once

#include <chrono>
#include <condition_variable>
#include <iosfwd>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace Squeal
{
  /// One finished step of a run, as the run record lists it.
  struct StepRecord
  {
    std::string name;
    double      seconds;     ///< wall time [s]
    double      cpu_seconds; ///< processor time of this process [s]
    double      peak_memory; ///< peak resident memory of this process so far [byte]
    std::string summary;     ///< what the step found, one phrase
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
    Progress();

    /// A channel that prints to @p stream; @p live: it is a terminal.
    Progress(std::ostream &stream, bool live);

    ~Progress();

    Progress(const Progress &)            = delete;
    Progress &operator=(const Progress &) = delete;

    /// Begins a step; an unfinished one is finished first.
    void begin(const std::string &name);

    /// Sets the state of the current step that the live counter shows.
    void update(const std::string &state);

    /// Ends the current step with the line that stays.
    void finish(const std::string &summary = "");

    /// Prints a line that belongs to no step.
    void note(const std::string &text);

    /// All finished steps.
    const std::vector<StepRecord> &steps() const;

    /// Seconds since construction.
    double elapsed() const;

  private:
    using Clock = std::chrono::steady_clock;

    /// Shows the counter until the channel is closed.
    void count();

    std::ostream           *stream = nullptr;
    bool                    live   = false;
    Clock::time_point       start, step_start;
    double                  cpu_step_start = 0.;
    std::string             current, state;
    std::vector<StepRecord> records;

    std::mutex              mutex; ///< guards the stream and the current step
    std::condition_variable closing;
    bool                    closed = false;
    std::thread             counter;
  };
} // namespace Squeal
