#include <squeal/base/text.h>
#include <squeal/studies/paper_statements.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace Squeal
{
  namespace
  {
    // ------------------------------------------------------------------- verdicts

    enum class Outcome
    {
      holds,
      holds_less,
      does_not_hold
    };
  } // namespace

  template <>
  inline constexpr EnumName<Outcome> enum_table<Outcome>[] = {{Outcome::holds, "holds"},
                                                              {Outcome::holds_less, "holds less"},
                                                              {Outcome::does_not_hold, "does not hold"}};

  namespace
  {
    /// A verdict with the rule that it follows.
    struct Ruling
    {
      Outcome     outcome;
      std::string rule;
    };

    /// For a quantity that shall be small.
    Ruling at_most(const double value, const double bound, const double weaker_bound)
    {
      return {value <= bound        ? Outcome::holds :
              value <= weaker_bound ? Outcome::holds_less :
                                      Outcome::does_not_hold,
              text("holds up to ", bound, ", less up to ", weaker_bound)};
    }

    /// For one that shall be large.
    Ruling at_least(const double value, const double bound, const double weaker_bound)
    {
      return {value >= bound        ? Outcome::holds :
              value >= weaker_bound ? Outcome::holds_less :
                                      Outcome::does_not_hold,
              text("holds from ", bound, " on, less from ", weaker_bound, " on")};
    }

    /// For one of the same sign as the paper's, and of its size.
    Ruling alike(const double value, const double paper)
    {
      const double ratio = value / paper;
      return {ratio >= 0.5 && ratio <= 2. ? Outcome::holds :
              ratio > 0.                  ? Outcome::holds_less :
                                            Outcome::does_not_hold,
              "holds from half to twice the paper's, less with its sign"};
    }

    /// For a number of modes.
    Ruling as_many(const double value, const double paper)
    {
      return {value == paper ? Outcome::holds :
              value > paper  ? Outcome::holds_less :
                               Outcome::does_not_hold,
              "holds if equal, less if there are more"};
    }

    struct Statement
    {
      std::string           section, words;
      std::optional<double> paper;
      double                here;
      std::string           unit;
      Ruling                ruling;
      std::string           modes; ///< of which it speaks
    };
    using Statements = std::vector<Statement>;

    // ---------------------------------------------------------------------- modes

    constexpr auto flexural = ModeFamily::flexural, torsional = ModeFamily::torsional;

    bool is_in_plane(const ModeLabel &label)
    {
      return label.family == ModeFamily::radial || label.family == ModeFamily::circumferential;
    }

    /// Divergence rate [%].
    double rate(const ComparedMode &mode)
    {
      return 100. * mode.quantities.divergence_rate;
    }

    std::string describe(const ComparedMode &mode)
    {
      return text(to_string(mode.label), " ", decimal_text(mode.quantities.frequency), " Hz");
    }

    std::string list(const std::vector<std::string> &names)
    {
      std::string result;
      for (const std::string &name : names)
        result += (result.empty() ? "" : "; ") + name;
      return result;
    }

    /// Modes of each shape in the order of their frequencies.
    template <typename Mode>
    std::map<ModeShape, std::vector<const Mode *>> by_shape(const std::vector<Mode> &modes)
    {
      std::map<ModeShape, std::vector<const Mode *>> result;
      for (const Mode &mode : modes)
        if (mode.label.family != ModeFamily::unnamed)
          result[mode.label.shape()].push_back(&mode);
      return result;
    }

    /// A quantity with the mode that it is the largest of.
    struct Largest
    {
      double      value = 0.;
      std::string mode  = {};

      void compare(const double other, const std::string &of)
      {
        if (other > value || mode.empty())
          *this = {other, of};
      }
    };

    /// The largest relative change of a frequency [%] between modes of a shape, in the order of their frequencies.
    template <typename From, typename To, typename Predicate>
    Largest largest_shift(const std::vector<From> &from, const std::vector<To> &to, const Predicate &is_meant)
    {
      const auto shapes = by_shape(from);
      Largest    result;
      for (const auto &[shape, changed] : by_shape(to))
        if (const auto it = shapes.find(shape); it != shapes.end() && it->second.size() == changed.size() && is_meant(changed[0]->label))
          for (std::size_t j = 0; j < changed.size(); ++j)
            result.compare(100. * std::abs(changed[j]->quantities.frequency / it->second[j]->quantities.frequency - 1.),
                           describe(*it->second[j]));
      return result;
    }

    /// The two of a doublet, `-` and `+`; null where the run has no such pair.
    struct Doublet
    {
      const StatedMode *minus = nullptr, *plus = nullptr;

      Doublet(const std::vector<StatedMode> &modes, const ModeShape &shape)
      {
        for (const StatedMode &mode : modes)
          if (mode.label.shape() == shape && mode.label.sign == DoubletSign::plus)
            plus = &mode;
          else if (mode.label.shape() == shape && mode.label.sign == DoubletSign::minus)
            minus = &mode;
      }

      bool is_complete() const
      {
        return minus != nullptr && plus != nullptr;
      }
    };

    /// Divergence rates [%] of the pin modes of a family, ascending.
    std::vector<double> rates_of(const std::vector<StatedMode> &modes, const ModeFamily family)
    {
      std::vector<double> result;
      for (const StatedMode &mode : modes)
        if (mode.label.family == family && mode.label.rank == 1)
          result.push_back(rate(mode));
      std::sort(result.begin(), result.end());
      return result;
    }

    // ----------------------------------------------------------------- statements

    /// From a frequency of Table 1 to another one [%].
    constexpr double change(const double from, const double to)
    {
      return 100. * (to / from - 1.);
    }

    constexpr double split_of_A02 = change(489, 697), split_of_R01 = change(643, 647), spread_of_F1 = change(3551, 3562),
                     coupling_of_R01 = -change(649, 643), friction_of_F1 = -change(3551, 3516), damped_friction_of_F1 = -change(3551, 3521),
                     friction_of_C00 = change(644, 645);

    void add_component_modes(const SectionFour &results, Statements &statements)
    {
      for (const auto &[family, name, paper] : {std::make_tuple(flexural, "bending modes F1 per pin below 5 kHz", 2.),
                                                std::make_tuple(torsional, "torsional modes T1 per pin below 5 kHz", 1.)})
        {
          const double n = std::count_if(results.component.begin(), results.component.end(), [family = family](const ComparedMode &mode) {
            return mode.label.family == family && mode.quantities.frequency <= 5000.;
          });
          statements.push_back({"4.1", name, paper, n / results.n_pins, "-", as_many(n / results.n_pins, paper), ""});
        }
    }

    void add_coupled_modes(const SectionFour &results, Statements &statements)
    {
      // Split of doublets and spread of pin modes [%]
      Largest axial, in_plane, bending;
      for (const auto &[shape, modes] : by_shape(results.coupled))
        {
          const ModeLabel &label  = modes[0]->label;
          const double     spread = 100. * (modes.back()->quantities.frequency / modes.front()->quantities.frequency - 1.);
          if (modes.size() == 2 && label.family == ModeFamily::axial && label.nodal_diameters > 1)
            axial.compare(spread, shape_text(label));
          else if (modes.size() == 2 && is_in_plane(label))
            in_plane.compare(spread, shape_text(label));
          else if (label.family == flexural && label.rank == 1)
            bending.compare(spread, shape_text(label));
        }
      if (!axial.mode.empty())
        statements.push_back({"4.2", "coupling splits double disc modes, axial ones most", split_of_A02, axial.value, "%",
                              alike(axial.value, split_of_A02), axial.mode});
      if (!bending.mode.empty())
        statements.push_back({"4.2", "coupling spreads the bending modes of the pins", spread_of_F1, bending.value, "%",
                              alike(bending.value, spread_of_F1), bending.mode});
      if (!in_plane.mode.empty())
        statements.push_back({"4.2", "coupling hardly splits in-plane disc modes", split_of_R01, in_plane.value, "%",
                              at_most(in_plane.value, split_of_R01, 1.), in_plane.mode});
      const Largest shift = largest_shift(results.component, results.coupled,
                                          [](const ModeLabel &label) { return is_in_plane(label) || label.family == torsional; });
      if (!shift.mode.empty())
        statements.push_back({"4.2", "coupling hardly shifts in-plane disc modes and torsion of pins", coupling_of_R01, shift.value, "%",
                              at_most(shift.value, coupling_of_R01, 2.), shift.mode});
    }

    void add_frequencies(const SectionFour &results, Statements &statements)
    {
      const auto all = [](const ModeLabel &) { return true; };
      for (const auto &[modes, name, paper] : {std::make_tuple(&results.undamped, "without C_b", friction_of_F1),
                                               std::make_tuple(&results.damped, "with C_b", damped_friction_of_F1)})
        if (const Largest shift = largest_shift(results.coupled, *modes, all); !shift.mode.empty())
          statements.push_back({"4.3", text("complex modes have nearly the frequencies of the real coupled ones, ", name), paper,
                                shift.value, "%", at_most(shift.value, 1., 2.), shift.mode});
      if (const Largest shift = largest_shift(results.coupled, results.undamped,
                                              [](const ModeLabel &label) { return is_in_plane(label) || label.family == torsional; });
          !shift.mode.empty())
        statements.push_back({"Table 1", "friction hardly shifts in-plane disc modes and torsion of pins", friction_of_C00, shift.value,
                              "%", at_most(shift.value, friction_of_C00, 0.5), shift.mode});
    }

    void add_unstable_modes(const SectionFour &results, Statements &statements)
    {
      std::vector<std::string> disc, pins, weak;
      Largest                  asymmetry;
      for (const StatedMode &mode : results.undamped)
        if (mode.unstable)
          {
            auto &kind = !grows(mode) ? weak : mode.label.is_of_pins() ? pins : disc;
            kind.push_back(describe(mode));
            // The partner decays as fast, at the same frequency
            double rest = 1.;
            for (const StatedMode &other : results.undamped)
              if (!other.unstable)
                rest = std::min(rest, std::hypot(other.quantities.divergence_rate / mode.quantities.divergence_rate + 1.,
                                                 other.quantities.frequency / mode.quantities.frequency - 1.));
            asymmetry.compare(rest, describe(mode));
          }
      const double n_disc = static_cast<double>(disc.size()), n_pins = static_cast<double>(pins.size());
      statements.push_back({"4.3", "unstable disc modes without C_b", 2., n_disc, "-", as_many(n_disc, 2.), list(disc)});
      statements.push_back({"4.3", "unstable pin modes without C_b", 2., n_pins, "-", as_many(n_pins, 2.), list(pins)});
      if (!weak.empty())
        statements.push_back({"4.3", "further unstable modes without C_b, below 0.01 %", 0., static_cast<double>(weak.size()), "-",
                              as_many(static_cast<double>(weak.size()), 0.), list(weak)});
      if (!asymmetry.mode.empty())
        statements.push_back({"4.3", "unstable modes have a stable partner with the opposite divergence rate: largest relative rest", 0.,
                              asymmetry.value, "-", at_most(asymmetry.value, 1e-3, 0.1), asymmetry.mode});
    }

    void add_waves(const SectionFour &results, Statements &statements)
    {
      for (const StatedMode &mode : results.undamped)
        if (grows(mode) && mode.waves)
          {
            const Doublet     pair(results.undamped, mode.label.shape());
            const WaveShares &own      = *mode.waves;
            const bool        is_along = own.positive > own.negative;
            const double      share    = std::max(own.positive, own.negative);
            const std::string way      = is_along ? "with the rotation" : "against the rotation";
            statements.push_back({"4.3", text(to_string(mode.label), " looks like a rotating wave: share that travels ", way), std::nullopt,
                                  share, "-", at_least(share, 0.75, 0.6), describe(mode)});
            if (pair.is_complete() && pair.minus->waves)
              {
                const double opposite = is_along ? pair.minus->waves->negative : pair.minus->waves->positive;
                statements.push_back({"4.3", text("its partner ", to_string(pair.minus->label), " rotates the opposite way: share"),
                                      std::nullopt, opposite, "-", at_least(opposite, 0.75, 0.6), describe(*pair.minus)});
              }
          }
    }

    /// What C_b does to the pairs that lead without it.
    void add_leading_pairs(const SectionFour &results, Statements &statements)
    {
      const auto lower = [](const double value) {
        return Ruling{value < 0. ? Outcome::holds : Outcome::does_not_hold, "holds below zero"};
      };
      for (const auto &[diameters, paper_sum, paper_change] : {std::make_tuple(4, -0.02, 0.01), std::make_tuple(5, -0.07, -0.03)})
        {
          const ModeShape shape = {ModeFamily::axial, 0, diameters, 0};
          const Doublet   before(results.undamped, shape), after(results.damped, shape);
          if (!before.is_complete() || !after.is_complete())
            continue;
          const std::string name = shape_text(after.plus->label);
          const double      sum = rate(*after.plus) + rate(*after.minus), change = rate(*after.plus) - rate(*before.plus);
          statements.push_back({"4.3", text("C_b breaks the symmetry of the chart: sum of the divergence rates of ", name), paper_sum, sum,
                                "%", lower(sum), list({describe(*after.minus), describe(*after.plus)})});
          statements.push_back({"4.3", text("C_b reduces the divergence rate of the growing ", name), paper_change, change, "%",
                                lower(change), describe(*after.plus)});
        }
      const auto before = rates_of(results.undamped, flexural), after = rates_of(results.damped, flexural);
      if (!before.empty() && !after.empty())
        statements.push_back({"4.3", "C_b reduces the divergence rate of the leading F1", -0.01, after.back() - before.back(), "%",
                              lower(after.back() - before.back()), ""});
    }

    void add_pins(const SectionFour &results, Statements &statements)
    {
      const auto bending_before = rates_of(results.undamped, flexural), bending = rates_of(results.damped, flexural),
                 torsion = rates_of(results.damped, torsional);
      if (bending.size() > 3 && bending_before.size() == bending.size())
        {
          const double before = bending_before[bending.size() - 2], after = bending[bending.size() - 2];
          const Ruling ruling = {after < 100. * weak_divergence ? Outcome::holds :
                                 after < before                 ? Outcome::holds_less :
                                                                  Outcome::does_not_hold,
                                 "holds below 0.01 %, less if it falls"};
          statements.push_back({"4.3", "C_b stabilises the second unstable pin mode: its divergence rate, or that of what takes its place",
                                0., after, "%", ruling, text("without C_b ", decimal_text(before, 3), " %")});
        }
      for (const PaperRange &range : paper_ranges_damped)
        {
          const auto &rates = range.label.family == flexural ? bending : torsion;
          if (rates.empty())
            continue;
          const double      least = rates[(rates.size() - 1) / range.every];
          const std::string which = text("many pin modes turn to highly negative divergence rates: ", to_string(range.label));
          statements.push_back({"4.3", which + ", most damped", range.lowest, rates[0], "%", alike(rates[0], range.lowest), ""});
          statements.push_back({"4.3", which + (range.every > 1 ? ", least damped of the lower half" : ", least damped"), range.highest,
                                least, "%", alike(least, range.highest), ""});
        }
    }

    /// Of the growing modes all but @p n_kept, those of which the least lies in the other span.
    std::vector<const StatedMode *> not_kept(const std::vector<StatedMode> &modes,
                                             const std::vector<double>     &shares,
                                             const std::size_t              n_kept)
    {
      std::vector<std::pair<double, const StatedMode *>> growing;
      for (std::size_t j = 0; j < modes.size(); ++j)
        if (grows(modes[j]))
          growing.emplace_back(shares[j], &modes[j]);
      std::stable_sort(growing.begin(), growing.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
      std::vector<const StatedMode *> result;
      for (std::size_t j = 0; j + n_kept < growing.size(); ++j)
        result.push_back(growing[j].second);
      return result;
    }

    void add_changes_of_stability(const SectionFour &results, Statements &statements)
    {
      const GrowthKept        &kept = results.kept;
      std::vector<std::string> removed, added;
      double                   strongest = 0.;
      for (const StatedMode *mode : not_kept(results.undamped, kept.share_before, kept.n_kept))
        removed.push_back(describe(*mode));
      for (const StatedMode *mode : not_kept(results.damped, kept.share_after, kept.n_kept))
        {
          added.push_back(describe(*mode));
          strongest = std::max(strongest, rate(*mode));
        }
      const double n_removed = static_cast<double>(removed.size()), n_added = static_cast<double>(added.size());
      statements.push_back(
        {"4.3", "C_b stabilises: unstable modes that it removes", 1., n_removed, "-", as_many(n_removed, 1.), list(removed)});
      const Ruling ruling = {added.empty()   ? Outcome::holds :
                             strongest < 0.1 ? Outcome::holds_less :
                                               Outcome::does_not_hold,
                             "holds if none, less if all are below 0.1 %"};
      statements.push_back({"4.3", "C_b stabilises: unstable modes that it adds", 0., n_added, "-", ruling, list(added)});
      if (!added.empty())
        statements.push_back({"4.3", "largest divergence rate of those that it adds", std::nullopt, strongest, "%", ruling, ""});
    }
  } // namespace

  Table statements(const SectionFour &results, const bool with_rules)
  {
    Statements all;
    add_component_modes(results, all);
    add_coupled_modes(results, all);
    add_frequencies(results, all);
    add_unstable_modes(results, all);
    add_waves(results, all);
    add_leading_pairs(results, all);
    add_pins(results, all);
    add_changes_of_stability(results, all);
    Columns<Statement> columns = {
      {"section", "", &Statement::section}, {"statement", "", &Statement::words},
      {"paper", "", &Statement::paper, 2},  {"here", "", &Statement::here, 3},
      {"unit", "", &Statement::unit},       {"verdict", "", [](const Statement &s) { return to_string(s.ruling.outcome); }}};
    if (with_rules)
      {
        columns.push_back({"rule", "", [](const Statement &s) { return s.ruling.rule; }});
        columns.push_back({"modes", "", &Statement::modes});
      }
    return Table(columns, all);
  }
} // namespace Squeal
