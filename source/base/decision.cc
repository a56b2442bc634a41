#include <squeal/base/decision.h>

#include <algorithm>
#include <mutex>

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

    /// Of what decisions keep: several threads decide.
    std::mutex records_in_use;
  } // namespace

  void merge(std::vector<DecisionRecord> &whole, const std::vector<DecisionRecord> &part)
  {
    for (const DecisionRecord &record : part)
      {
        const auto known = std::find_if(whole.begin(), whole.end(), [&](const auto &other) { return other.quantity == record.quantity; });
        if (known == whole.end())
          {
            whole.push_back(record);
            continue;
          }
        if (record.below > known->below)
          {
            known->below    = record.below;
            known->below_in = record.below_in;
          }
        if (record.above < known->above)
          {
            known->above    = record.above;
            known->above_in = record.above_in;
          }
        known->n_below += record.n_below;
        known->n_above += record.n_above;
      }
    std::sort(whole.begin(), whole.end(), [](const auto &x, const auto &y) { return x.quantity < y.quantity; });
  }

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
    const bool                        exceeds = value > record.threshold;
    const std::lock_guard<std::mutex> lock(records_in_use);
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

  std::vector<DecisionRecord> Decision::take()
  {
    std::vector<DecisionRecord> result = records();
    forget();
    return result;
  }
} // namespace Squeal
