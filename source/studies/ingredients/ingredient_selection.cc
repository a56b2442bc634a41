#include <squeal/studies/ingredients/ingredient_selection.h>

#include <algorithm>
#include <optional>

namespace Squeal
{
  namespace
  {
    /// Changes with a larger effect than this do not keep the accuracy.
    constexpr double allowed = 1.;

    /// The first change after @p number of the same ingredient that keeps the accuracy with a smaller effect.
    std::optional<int> next_of_ingredient(const std::vector<CheaperChange> &changes, const int number)
    {
      const double bound = std::min(allowed, changes[number].severity);
      for (std::size_t i = number + 1; i < changes.size(); ++i)
        if (changes[i].ingredient == changes[number].ingredient && changes[i].severity < bound)
          return static_cast<int>(i);
      return std::nullopt;
    }
  } // namespace

  ChangesTogether cheapest_changes(const std::vector<CheaperChange>                            &changes,
                                   const std::function<double(const std::vector<int> &chosen)> &severity_of)
  {
    ChangesTogether   result;
    std::vector<int> &chosen = result.changes;
    for (std::size_t i = 0; i < changes.size(); ++i)
      if (changes[i].severity <= allowed &&
          std::none_of(chosen.begin(), chosen.end(), [&](const int other) { return changes[other].ingredient == changes[i].ingredient; }))
        chosen.push_back(static_cast<int>(i));

    while (!chosen.empty())
      {
        if (chosen.size() == 1)
          {
            result.severity = changes[chosen.front()].severity;
            return result;
          }
        ++result.n_solved;
        result.severity = severity_of(chosen);
        if (result.severity <= allowed)
          return result;
        const auto worst = std::max_element(chosen.begin(), chosen.end(),
                                            [&](const int a, const int b) { return changes[a].severity < changes[b].severity; });
        result.put_back.push_back(*worst);
        if (const std::optional<int> next = next_of_ingredient(changes, *worst))
          *worst = *next;
        else
          chosen.erase(worst);
        std::sort(chosen.begin(), chosen.end());
      }
    result.severity = 0.;
    return result;
  }
} // namespace Squeal
