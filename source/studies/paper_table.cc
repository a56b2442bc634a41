#include <squeal/base/conventions.h>
#include <squeal/base/text.h>
#include <squeal/studies/paper_table.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    using Value         = std::optional<double>;
    constexpr auto none = std::nullopt;

    constexpr auto minus = DoubletSign::minus, plus = DoubletSign::plus;

    ModeLabel disc(const ModeFamily family, const int circles, const int diameters, const DoubletSign sign = DoubletSign::none)
    {
      return {family, circles, diameters, 0, sign};
    }

    constexpr auto  A = ModeFamily::axial, R = ModeFamily::radial, C = ModeFamily::circumferential;
    const ModeLabel F1 = {ModeFamily::flexural, 0, 0, 1}, T1 = {ModeFamily::torsional, 0, 0, 1};

    // ------------------------------------------------------------- what is printed

    /// Which mode of a run stands beside one of the paper.
    enum class Match
    {
      label,     ///< of the same label
      frequency, ///< of the nearest frequency: the paper finds it hard to name
      growing,   ///< of the same shape, the one that grows
      decaying,  ///< of the same shape, the other one
      lowest,    ///< least frequency, and least divergence rate, of a group of pin modes
      highest    ///< largest frequency, and largest divergence rate, of a group of pin modes
    };

    /**
     * Modes of a family of pin modes in the order of their divergence rates: from place @p begin to before @p end. A place is
     * counted from so many halves of all modes.
     */
    struct Group
    {
      struct Place
      {
        int halves = 0, count = 0;

        int of(const int n_modes) const
        {
          return halves * n_modes / 2 + count;
        }
      };
      Place begin, end;
    };

    constexpr Group everyone = {{0, 0}, {2, 0}};
    // Without radial dissipation: pairs that decay and grow, and modes in between
    constexpr Group first_decaying = {{0, 0}, {0, 1}}, first_growing = {{2, -1}, {2, 0}};
    constexpr Group second_decaying = {{0, 1}, {0, 2}}, second_growing = {{2, -2}, {2, -1}};
    constexpr Group between_pairs = {{0, 2}, {2, -2}};
    // With it half of the F1 modes are damped much, those that bend radially; of the others two less, and one grows
    constexpr Group radial_half = {{0, 0}, {1, 0}}, most_damped_of_others = {{1, 0}, {1, 1}}, next_damped = {{1, 1}, {1, 2}};
    constexpr Group neutral = {{1, 2}, {2, -1}};

    /// A frequency [Hz] with its divergence rate [%], where it is given and not negligible, and how a run finds the mode.
    struct Printed
    {
      Value frequency = none, divergence = none;
      Match match = Match::label;
      Group group = everyone;
    };

    /// A row of the paper. Where the match of the coupled mode is not the label, it is that of the complex modes.
    struct Row
    {
      ModeLabel   label;
      const char *suffix; ///< of the label, to tell rows of pin modes apart
      Value       component;
      Printed     coupled, undamped, damped;
    };

    /// Of a mode of the disc that no friction makes grow.
    Row stable_row(const ModeLabel &label, const Value component, const Value coupled, const Value undamped, const Value damped)
    {
      return {label, "", component, {coupled}, {undamped}, {damped}};
    }

    /// Of one that the paper finds hard to name.
    Row unnamed_row(const ModeLabel &label, const Value component, const double coupled, const double undamped, const double damped)
    {
      return {
        label, "", component, {coupled, none, Match::frequency}, {undamped, none, Match::frequency}, {damped, none, Match::frequency}};
    }

    /// One of a pair that friction makes grow and decay.
    Printed of_pair(const double frequency, const double divergence)
    {
      return {frequency, divergence, divergence > 0. ? Match::growing : Match::decaying};
    }

    /// A pin mode, or the lower end of a group of them.
    Printed lower(const Group &group, const double frequency, const Value divergence = none)
    {
      return {frequency, divergence, Match::lowest, group};
    }

    Printed upper(const Group &group, const double frequency, const Value divergence = none)
    {
      return {frequency, divergence, Match::highest, group};
    }

    const std::vector<Row> rows = {
      stable_row(disc(A, 0, 1, minus), 251, 295, 295, 296),
      unnamed_row(disc(A, 0, 1, plus), 251, 312, 312, 313),
      stable_row(disc(A, 0, 0), 352, none, none, none),
      stable_row(disc(A, 0, 2, minus), 569, 489, 489, 489),
      stable_row(disc(A, 0, 2, plus), 569, 697, 700, 700),
      stable_row(disc(C, 0, 0), 644, 644, 645, 644),
      stable_row(disc(R, 0, 1, minus), 649, 643, 644, 644),
      {disc(R, 0, 1, plus), "", 649, {647}, {648}, {648, -0.093}},
      unnamed_row({}, none, 1057, 1061, 1061),
      stable_row(disc(A, 0, 3, minus), 1267, 1374, 1379, 1379),
      stable_row(disc(A, 0, 3, plus), 1267, 1567, 1576, 1576),
      stable_row(disc(A, 1, 0), 1404, 1449, 1450, 1450),
      stable_row(disc(R, 0, 2, minus), 1822, 1823, 1823, 1823),
      stable_row(disc(R, 0, 2, plus), 1822, 1825, 1826, 1826),
      stable_row(disc(A, 1, 1, minus), 2082, 2087, 2087, 2087),
      stable_row(disc(A, 1, 1, plus), 2082, 2150, 2153, 2153),
      {disc(A, 0, 4, minus), "", 2220, {2284}, of_pair(2297, -0.64), of_pair(2297, 0.65)},
      {disc(A, 0, 4, plus), "", 2220, {2305}, of_pair(2297, 0.64), of_pair(2297, -0.67)},
      {disc(A, 0, 5, minus), "", 3345, {3380}, of_pair(3376, -0.98), of_pair(3376, -1.02)},
      {disc(A, 0, 5, plus), "", 3345, {3392}, of_pair(3376, 0.98), of_pair(3377, 0.95)},
      stable_row(disc(A, 1, 2, minus), 3365, 3350, 3352, 3352),
      {disc(A, 1, 2, plus), "", 3365, {3371}, {3386}, {3387, -0.078}},
      {F1, " lowest", 3553, lower(everyone, 3551), lower(between_pairs, 3516), {}},
      {F1, " highest", 3553, upper(everyone, 3562), upper(between_pairs, 3564), {}},
      {F1, " pair 1 -", none, {}, lower(first_decaying, 3542, -0.89), lower(most_damped_of_others, 3535, -0.51)},
      {F1, " pair 1 +", none, {}, lower(first_growing, 3542, 0.89), lower(first_growing, 3537, 0.88)},
      {F1, " pair 2 -", none, {}, lower(second_decaying, 3550, -0.10), {}},
      {F1, " pair 2 +", none, {}, lower(second_growing, 3550, 0.10), {}},
      {F1, " next damped", none, {}, {}, lower(next_damped, 3521, -0.12)},
      {F1, " neutral lowest", none, {}, {}, lower(neutral, 3525)},
      {F1, " neutral highest", none, {}, {}, upper(neutral, 3528)},
      {F1, " damped lowest", none, {}, {}, lower(radial_half, 3552, -1.76)},
      {F1, " damped highest", none, {}, {}, upper(radial_half, 3563, -1.07)},
      stable_row(disc(R, 0, 0), 3704, 3704, 3704, 3704),
      {T1, " lowest", 3934, lower(everyone, 3934), lower(everyone, 3934), lower(everyone, 3933, -2.34)},
      {T1, " highest", 3934, upper(everyone, 3934), upper(everyone, 3934), upper(everyone, 3933, -1.41)},
      stable_row(disc(R, 0, 3, minus), 3990, 3989, 3989, 3989),
      stable_row(disc(R, 0, 3, plus), 3990, 3991, 3989, 3990),
      stable_row(disc(C, 0, 1, minus), 4500, 4499, 4499, 4499),
      stable_row(disc(C, 0, 1, plus), 4500, 4500, 4500, 4500),
      stable_row(disc(A, 0, 6, minus), 4659, 4641, 4641, 4641),
      stable_row(disc(A, 0, 6, plus), 4659, 4653, 4652, 4652),
      stable_row(disc(A, 1, 3, minus), 4794, 4800, 4799, 4800),
      stable_row(disc(A, 1, 3, plus), 4794, 4815, 4814, 4815)};

    // ----------------------------------------------------------- the modes of a run

    /// Relative difference of frequencies beyond which two modes without a name are not taken for the same.
    constexpr double largest_distance = 0.1;

    /// What a run has beside a mode of the paper.
    struct Found
    {
      ModeLabel label;
      double    frequency;  ///< [Hz]
      double    divergence; ///< [%]
    };
    using MaybeFound = std::optional<Found>;

    Found found(const ComparedMode &mode)
    {
      return {mode.label, mode.quantities.frequency, 100. * mode.quantities.divergence_rate};
    }

    MaybeFound with_label(const std::vector<ComparedMode> &modes, const ModeLabel &label)
    {
      const auto mode = std::find_if(modes.begin(), modes.end(), [&](const ComparedMode &candidate) { return candidate.label == label; });
      return mode != modes.end() ? MaybeFound(found(*mode)) : none;
    }

    MaybeFound with_frequency(const std::vector<ComparedMode> &modes, const double frequency)
    {
      const auto distance = [&](const ComparedMode &mode) { return std::abs(mode.quantities.frequency / frequency - 1.); };
      const auto nearest =
        std::min_element(modes.begin(), modes.end(), [&](const auto &a, const auto &b) { return distance(a) < distance(b); });
      return nearest != modes.end() && distance(*nearest) < largest_distance ? MaybeFound(found(*nearest)) : none;
    }

    /// The lower or upper end of a group of the modes of a shape.
    MaybeFound end_of_group(const std::vector<ComparedMode> &modes, const ModeLabel &label, const Group &group, const bool is_upper)
    {
      std::vector<Found> family;
      for (const ComparedMode &mode : modes)
        if (mode.label.shape() == label.shape())
          family.push_back(found(mode));
      std::stable_sort(family.begin(), family.end(), [](const Found &a, const Found &b) { return a.divergence < b.divergence; });

      const int n = static_cast<int>(family.size()), begin = group.begin.of(n), end = group.end.of(n);
      if (begin < 0 || begin >= end || end > n)
        return none;
      Found result = family[begin];
      for (int i = begin; i < end; ++i)
        {
          const auto better = [&](const double a, const double b) { return is_upper ? std::max(a, b) : std::min(a, b); };
          result.frequency  = better(result.frequency, family[i].frequency);
          result.divergence = better(result.divergence, family[i].divergence);
        }
      result.label.sign = DoubletSign::none;
      return result;
    }

    /// The mode that a row asks for; nothing if the paper prints none or the run has none.
    MaybeFound find(const Printed &printed, ModeLabel label, const std::vector<ComparedMode> &modes)
    {
      if (!printed.frequency)
        return none;
      switch (printed.match)
        {
          case Match::label:
            return with_label(modes, label);
          case Match::frequency:
            return with_frequency(modes, *printed.frequency);
          case Match::growing:
          case Match::decaying:
            label.sign = printed.match == Match::growing ? plus : minus;
            return with_label(modes, label);
          case Match::lowest:
          case Match::highest:
            return end_of_group(modes, label, printed.group, printed.match == Match::highest);
        }
      return none;
    }

    // --------------------------------------------------------------------- the table

    /// A mode of the paper and the one of the run.
    struct Pair
    {
      Printed    paper;
      MaybeFound here;

      Value frequency() const
      {
        return here ? Value(here->frequency) : none;
      }

      Value divergence() const
      {
        return here ? Value(here->divergence) : none;
      }

      /// Relative difference of the frequencies [%].
      Value difference() const
      {
        return here ? Value(100. * (here->frequency / *paper.frequency - 1.)) : none;
      }

      std::string name() const
      {
        return here ? to_string(here->label) : "";
      }
    };

    /// A row of the paper beside the modes of the run.
    struct Comparison
    {
      std::string name;
      Pair        component, coupled, undamped, damped;
    };

    Agreement agreement_of(const std::vector<Comparison> &comparisons, Pair Comparison::*modes)
    {
      Agreement agreement;
      for (const Comparison &row : comparisons)
        if (const Value difference = (row.*modes).difference())
          {
            agreement.difference += *difference * *difference / 1e4;
            ++agreement.n;
          }
      agreement.difference = std::sqrt(agreement.difference / std::max(agreement.n, 1u));
      return agreement;
    }

    /// Frequencies of the paper and of the run with their difference.
    void add_frequencies(Columns<Comparison> &columns, const std::string &name, Pair Comparison::*modes)
    {
      columns.push_back({name + " paper", "Hz", [modes](const Comparison &c) { return (c.*modes).paper.frequency; }, 0});
      columns.push_back({name, "Hz", [modes](const Comparison &c) { return (c.*modes).frequency(); }, 1});
      columns.push_back({name + " difference", "%", [modes](const Comparison &c) { return (c.*modes).difference(); }, 2});
    }

    /// The same of complex modes, with the label of the mode of the run and with divergence rates.
    void add_complex_modes(Columns<Comparison> &columns, const std::string &name, Pair Comparison::*modes)
    {
      columns.push_back({"mode " + name, "", [modes](const Comparison &c) { return (c.*modes).name(); }});
      add_frequencies(columns, name, modes);
      columns.push_back({"divergence " + name + " paper", "%", [modes](const Comparison &c) { return (c.*modes).paper.divergence; }, 3});
      columns.push_back({"divergence " + name, "%", [modes](const Comparison &c) { return (c.*modes).divergence(); }, 3});
    }
  } // namespace

  std::vector<ComparedMode> component_modes_to_compare(const FrictionlessModes &frictionless)
  {
    std::vector<ComparedMode> modes;
    for (const ComponentModes *set : {&frictionless.disc, &frictionless.pins_sliding})
      {
        std::vector<ModeLabel> labels = set->labels;
        mark_doublets(labels);
        for (std::size_t j = 0; j < labels.size(); ++j)
          modes.push_back({labels[j], modal_quantities({0., std::sqrt(set->eigenvalues[j])})});
      }
    return modes;
  }

  std::vector<ComparedMode> coupled_modes_to_compare(const FrictionlessModes &frictionless)
  {
    std::vector<ComparedMode> modes;
    for (std::size_t j = 0; j < frictionless.labels.size(); ++j)
      modes.push_back({frictionless.labels[j], modal_quantities({0., std::sqrt(frictionless.real.eigenvalues[j])})});
    return modes;
  }

  std::vector<ComparedMode> complex_modes_to_compare(const FrictionModes &friction)
  {
    std::vector<ComparedMode> modes;
    for (std::size_t j = 0; j < friction.labels.size(); ++j)
      modes.push_back({friction.labels[j], modal_quantities(friction.modes.lambda[j])});
    return modes;
  }

  std::string to_string(const Agreement &agreement)
  {
    return text(100. * agreement.difference, " % rms (", agreement.n, ")");
  }

  const std::array<PaperRange, 2> paper_ranges_damped = {{{F1, -1.76, -1.07, 2}, {T1, -2.34, -1.41, 1}}};

  std::optional<PaperDivergence> paper_divergence_damped(const ModeLabel &label)
  {
    const std::vector<ComparedMode> only = {{label, {}}};
    for (const Row &row : rows)
      if (row.damped.divergence && !row.label.is_of_pins() && find(row.damped, row.label, only))
        return PaperDivergence{row.label, *row.damped.divergence};
    return {};
  }

  TableOne table_one(const TableOneResults &results)
  {
    std::vector<Comparison> comparisons;
    for (const Row &row : rows)
      {
        const auto pair = [&](const Printed &printed, const std::vector<ComparedMode> &modes) {
          return Pair{printed, find(printed, row.label, modes)};
        };
        // Component modes are named without ambiguity.
        const bool    is_of_pins = row.label.is_of_pins();
        const Printed component  = {row.component, none, is_of_pins ? row.coupled.match : Match::label};
        comparisons.push_back({to_string(row.label) + row.suffix, pair(component, results.component), pair(row.coupled, results.coupled),
                               pair(row.undamped, results.undamped), pair(row.damped, results.damped)});
      }
    using C            = Comparison;
    Columns<C> columns = {{"label", "", &C::name}};
    add_frequencies(columns, "component", &C::component);
    add_frequencies(columns, "coupled", &C::coupled);
    add_complex_modes(columns, "without C_b", &C::undamped);
    add_complex_modes(columns, "with C_b", &C::damped);
    return {Table(columns, comparisons), agreement_of(comparisons, &C::component), agreement_of(comparisons, &C::coupled),
            agreement_of(comparisons, &C::undamped), agreement_of(comparisons, &C::damped)};
  }
} // namespace Squeal
