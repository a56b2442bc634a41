// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/progress.h>
#include <squeal/base/memory.h>

#include <sys/resource.h>

#include <iomanip>
#include <ostream>
#include <sstream>

namespace Squeal
{
  namespace
  {
    constexpr const char *erase_line = "\r\033[K";

    std::string line_start(const std::string &name, const double seconds)
    {
      std::ostringstream line;
      line << "  " << std::left << std::setw(26) << name << std::right << std::fixed << std::setprecision(2) << std::setw(8) << seconds
           << " s";
      return line.str();
    }
  } // namespace

  Stopwatch::Stopwatch()
    : start(std::chrono::steady_clock::now())
    , cpu_start(std::clock())
  {}

  Cost Stopwatch::cost() const
  {
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
            double(std::clock() - cpu_start) / CLOCKS_PER_SEC, 1024. * usage.ru_maxrss};
  }

  Progress::Progress(std::ostream &stream, const bool live)
    : stream(&stream)
    , live(live)
  {
    if (live)
      counter = std::thread([this]() { count(); });
  }

  Progress::~Progress()
  {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      closed = true;
      if (live && !current.empty())
        *stream << erase_line << std::flush;
    }
    closing.notify_all();
    if (counter.joinable())
      counter.join();
  }

  void Progress::count()
  {
    std::unique_lock<std::mutex> lock(mutex);
    while (!closing.wait_for(lock, std::chrono::milliseconds(200), [this]() { return closed; }))
      if (!current.empty())
        *stream << erase_line << line_start(current, step.cost().seconds) << (state.empty() ? "" : "   ") << state << std::flush;
  }

  void Progress::begin(const std::string &name)
  {
    if (!current.empty())
      finish();
    const std::lock_guard<std::mutex> lock(mutex);
    current = name;
    step    = Stopwatch();
    state.clear();
  }

  void Progress::update(const std::string &new_state)
  {
    const std::lock_guard<std::mutex> lock(mutex);
    state = new_state;
  }

  Cost Progress::finish(const std::string &summary)
  {
    const std::lock_guard<std::mutex> lock(mutex);
    if (current.empty())
      return {};
    const Cost cost = step.cost();
    records.push_back({cost, current, summary});
    if (stream != nullptr)
      *stream << (live ? erase_line : "") << line_start(current, cost.seconds) << (summary.empty() ? "" : "   ") << summary << std::endl;
    current.clear();
    return_freed_memory();
    return cost;
  }

  void Progress::note(const std::string &text)
  {
    const std::lock_guard<std::mutex> lock(mutex);
    if (stream != nullptr)
      *stream << (live ? erase_line : "") << text << std::endl;
  }
} // namespace Squeal
