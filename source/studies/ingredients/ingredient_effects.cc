// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/groups.h>
#include <squeal/base/conventions.h>
#include <squeal/estimates/mode_pairing.h>
#include <squeal/studies/ingredients/ingredients.h>

namespace Squeal
{
  namespace
  {
    /// |λ_1 − λ_2| / |λ_1| up to which modes with the same label may be counterparts regardless of their shapes [-].
    constexpr double same_name_within = 0.1;

    /// Pairs modes without counterpart by shape that have the same label and close λ, for example modes of a doublet or of equal pins,
    /// whose shapes a change may mix.
    void pair_by_name(std::vector<PairedMode> &pairs, const FrictionModes &first, const FrictionModes &second)
    {
      std::vector<int>  left_1, left_2;
      std::vector<bool> is_paired(second.labels.size(), false);
      for (std::size_t i = 0; i < pairs.size(); ++i)
        if (pairs[i].partner >= 0)
          is_paired[pairs[i].partner] = true;
        else
          left_1.push_back(static_cast<int>(i));
      for (std::size_t j = 0; j < is_paired.size(); ++j)
        if (!is_paired[j])
          left_2.push_back(static_cast<int>(j));
      if (left_1.empty() || left_2.empty())
        return;

      // Add columns without gain if there are fewer columns than rows
      const std::size_t n_columns = std::max(left_1.size(), left_2.size());
      const auto        gain      = [&](const int row, const int column) {
        if (column >= static_cast<int>(left_2.size()))
          return 0.;
        const int    i = left_1[row], j = left_2[column];
        const double distance = std::abs(second.modes.lambda[j] - first.modes.lambda[i]) / std::abs(first.modes.lambda[i]);
        const bool   same     = first.labels[i].family != ModeFamily::unnamed && first.labels[i].shape() == second.labels[j].shape();
        return same && distance < same_name_within ? 1. - distance : 0.;
      };
      const std::vector<int> columns = best_assignment(left_1.size(), n_columns, gain);
      for (std::size_t row = 0; row < left_1.size(); ++row)
        if (gain(static_cast<int>(row), columns[row]) > 0.)
          pairs[left_1[row]] = {left_2[columns[row]], 0., true};
    }

    bool grows_strongly(const std::optional<std::complex<double>> &lambda, const bool unstable)
    {
      return unstable && lambda && modal_quantities(*lambda).divergence_rate >= weak_divergence;
    }

    template <typename Quantity>
    LargestChange largest(const std::vector<ModeChange> &modes, const Quantity &quantity)
    {
      LargestChange result;
      for (const ModeChange &mode : modes)
        if (const std::optional<double> value = quantity(mode); value && (!result.mode || std::abs(*value) > result.amount))
          result = {std::abs(*value), &mode};
      return result;
    }

    /// Largest acceptable effect, relative to the required accuracy [-].
    constexpr double allowed = 1.;

    /// The next change of the same ingredient after @p number that is acceptable and has a smaller effect.
    std::optional<int> next_of_ingredient(const std::vector<CheaperChange> &changes, const int number)
    {
      const double bound = std::min(allowed, changes[number].severity);
      for (std::size_t i = number + 1; i < changes.size(); ++i)
        if (changes[i].ingredient == changes[number].ingredient && changes[i].severity < bound)
          return static_cast<int>(i);
      return std::nullopt;
    }
  } // namespace

  double ModeChange::frequency(const double band_end) const
  {
    const double from = reference ? reference->imag() : band_end, to = variant ? variant->imag() : band_end;
    return 100. * (to / from - 1.);
  }

  std::optional<double> ModeChange::divergence() const
  {
    if (!reference || !variant)
      return std::nullopt;
    return 100. * (modal_quantities(*variant).divergence_rate - modal_quantities(*reference).divergence_rate);
  }

  bool ModeChange::changes_verdict() const
  {
    return (grows_strongly(reference, unstable_reference) && !unstable_variant) ||
           (grows_strongly(variant, unstable_variant) && !unstable_reference);
  }

  LargestChange Effect::frequency() const
  {
    return largest(modes, [&](const ModeChange &mode) -> std::optional<double> {
      return mode.reference && mode.reference->imag() <= band_end ? std::make_optional(mode.frequency(band_end)) : std::nullopt;
    });
  }

  LargestChange Effect::divergence() const
  {
    return largest(modes, [](const ModeChange &mode) { return mode.divergence(); });
  }

  std::size_t Effect::n_unstable(const bool in_variant) const
  {
    return std::count_if(modes.begin(), modes.end(),
                         [&](const ModeChange &mode) { return in_variant ? mode.unstable_variant : mode.unstable_reference; });
  }

  std::size_t Effect::n_lost() const
  {
    return std::count_if(modes.begin(), modes.end(), [](const ModeChange &mode) { return !mode.variant; });
  }

  bool Effect::changes_verdict() const
  {
    return n_growing_real_reference != n_growing_real_variant ||
           std::any_of(modes.begin(), modes.end(), [](const ModeChange &mode) { return mode.changes_verdict(); });
  }

  double Effect::severity(const IngredientsParameters &accuracy) const
  {
    if (changes_verdict())
      return std::numeric_limits<double>::infinity();
    return std::max(frequency().amount / accuracy.frequency_tolerance, divergence().amount / accuracy.divergence_tolerance);
  }

  Effect effect_of(const SolvedModel &reference, const SolvedModel &variant)
  {
    const FrictionModes    &first = reference.friction, &second = variant.friction;
    std::vector<PairedMode> pairs = pair_modes(*reference.shapes, *variant.shapes).coarse;
    pair_by_name(pairs, first, second);

    Effect result;
    result.band_end                 = circular_frequency(variant.parameters.discretization.maximum_frequency);
    result.n_growing_real_reference = first.n_growing_real();
    result.n_growing_real_variant   = second.n_growing_real();
    std::vector<bool> is_paired(second.labels.size(), false);
    for (std::size_t i = 0; i < pairs.size(); ++i)
      {
        ModeChange mode{first.labels[i], first.modes.lambda[i], std::nullopt, first.unstable[i]};
        mode.in_cluster = pairs[i].in_cluster;
        if (const int partner = pairs[i].partner; partner >= 0)
          {
            mode.variant          = second.modes.lambda[partner];
            mode.unstable_variant = second.unstable[partner];
            mode.overlap          = pairs[i].overlap;
            is_paired[partner]    = true;
          }
        result.modes.push_back(mode);
      }
    for (std::size_t j = 0; j < is_paired.size(); ++j)
      if (!is_paired[j])
        result.modes.push_back({second.labels[j], std::nullopt, second.modes.lambda[j], false, second.unstable[j]});
    return result;
  }

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
