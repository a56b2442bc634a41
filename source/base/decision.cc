#include <squeal/base/decision.h>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    /// All decisions of the program; a function's own, so that it exists before the first of them is made.
    std::vector<DecisionRecord *> &registry()
    {
      static std::vector<DecisionRecord *> all;
      return all;
    }
  } // namespace

  Decision::Decision(const char *quantity, const double threshold)
    : record{quantity, threshold}
  {
    registry().push_back(&record);
  }

  Decision::~Decision()
  {
    auto &all = registry();
    all.erase(std::remove(all.begin(), all.end(), &record), all.end());
  }

  bool Decision::exceeded_by(const double value) const
  {
    const bool exceeds = value > record.threshold;
    if (exceeds)
      {
        record.above = std::min(record.above, value);
        ++record.n_above;
      }
    else
      {
        record.below = std::max(record.below, value);
        ++record.n_below;
      }
    return exceeds;
  }

  std::vector<DecisionRecord> Decision::records()
  {
    std::vector<DecisionRecord> result;
    for (const DecisionRecord *record : registry())
      if (record->n_below + record->n_above > 0)
        result.push_back(*record);
    std::sort(result.begin(), result.end(), [](const auto &x, const auto &y) { return x.quantity < y.quantity; });
    return result;
  }

  void Decision::forget()
  {
    for (DecisionRecord *record : registry())
      *record = {record->quantity, record->threshold};
  }
} // namespace Squeal
