#include <squeal/base/decision.h>

#include <algorithm>
#include <functional>

namespace Squeal
{
  namespace
  {
    /// All decisions of the program; a function's own, so that it exists before the first of them is made.
    std::vector<Decision *> &registry()
    {
      static std::vector<Decision *> all;
      return all;
    }

    /// Of this thread, other than that of most others.
    std::size_t number_of_thread()
    {
      static std::atomic<std::size_t> n_threads = 0;
      thread_local const std::size_t  number    = n_threads++;
      return number;
    }

    /// @p kept becomes @p value if that is nearer().
    template <typename Nearer>
    void keep_nearest(std::atomic<double> &kept, const double value, const Nearer &nearer)
    {
      double known = kept.load(std::memory_order_relaxed);
      while (nearer(value, known) && !kept.compare_exchange_weak(known, value, std::memory_order_relaxed))
        ;
    }
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
    : quantity(quantity)
    , limit(threshold)
  {
    registry().push_back(this);
  }

  Decision::~Decision()
  {
    auto &all = registry();
    all.erase(std::remove(all.begin(), all.end(), this), all.end());
  }

  bool Decision::exceeded_by(const double value) const
  {
    const bool exceeds = value > limit;
    Asked     &mine    = asked[number_of_thread() % asked.size()];
    if (exceeds)
      keep_nearest(mine.above, value, std::less<>());
    else
      keep_nearest(mine.below, value, std::greater<>());
    (exceeds ? mine.n_above : mine.n_below).fetch_add(1, std::memory_order_relaxed);
    return exceeds;
  }

  DecisionRecord Decision::record() const
  {
    DecisionRecord result{quantity, limit};
    for (const Asked &some : asked)
      {
        result.below = std::max(result.below, some.below.load());
        result.above = std::min(result.above, some.above.load());
        result.n_below += some.n_below;
        result.n_above += some.n_above;
      }
    return result;
  }

  void Decision::clear()
  {
    const DecisionRecord none;
    for (Asked &some : asked)
      {
        some.below   = none.below;
        some.above   = none.above;
        some.n_below = some.n_above = 0;
      }
  }

  std::vector<DecisionRecord> Decision::records()
  {
    std::vector<DecisionRecord> result;
    for (const Decision *decision : registry())
      if (DecisionRecord record = decision->record(); record.n_below + record.n_above > 0)
        result.push_back(std::move(record));
    std::sort(result.begin(), result.end(), [](const auto &x, const auto &y) { return x.quantity < y.quantity; });
    return result;
  }

  void Decision::forget()
  {
    for (Decision *decision : registry())
      decision->clear();
  }

  std::vector<DecisionRecord> Decision::take()
  {
    std::vector<DecisionRecord> result = records();
    forget();
    return result;
  }
} // namespace Squeal
