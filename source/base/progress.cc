#include <squeal/base/progress.h>

#include <sys/resource.h>

#include <iomanip>
#include <ostream>
#include <sstream>

namespace Squeal
{
  namespace
  {
    /// Peak resident memory of this process [byte].
    double peak_memory()
    {
      rusage usage;
      getrusage(RUSAGE_SELF, &usage);
      return 1024. * usage.ru_maxrss;
    }

    constexpr const char *erase_line = "\r\033[K";
  } // namespace

  Progress::Progress()
    : start(Clock::now())
    , step_start(start)
    , last_update(start)
  {}

  Progress::Progress(std::ostream &stream, const bool live)
    : Progress()
  {
    this->stream = &stream;
    this->live   = live;
  }

  void Progress::begin(const std::string &name)
  {
    if (!current.empty())
      finish();
    current    = name;
    step_start = Clock::now();
    update("");
  }

  void Progress::update(const std::string &state)
  {
    if (stream == nullptr || !live || current.empty())
      return;
    const auto now = Clock::now();
    if (!state.empty() && now - last_update < std::chrono::milliseconds(100))
      return;
    last_update = now;
    *stream << erase_line << "  " << current << " ... " << state << std::flush;
  }

  void Progress::finish(const std::string &summary)
  {
    if (current.empty())
      return;
    const double seconds = std::chrono::duration<double>(Clock::now() - step_start).count();
    records.push_back({current, seconds, peak_memory(), summary});
    if (stream != nullptr)
      {
        std::ostringstream line;
        line << "  " << std::left << std::setw(26) << current << std::right << std::fixed
             << std::setprecision(2) << std::setw(8) << seconds << " s";
        if (!summary.empty())
          line << "   " << summary;
        *stream << (live ? erase_line : "") << line.str() << std::endl;
      }
    current.clear();
  }

  void Progress::note(const std::string &text)
  {
    if (stream != nullptr)
      *stream << (live ? erase_line : "") << text << std::endl;
  }

  const std::vector<StepRecord> &Progress::steps() const
  {
    return records;
  }

  double Progress::elapsed() const
  {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }
} // namespace Squeal
