#include <squeal/base/conventions.h>
#include <squeal/studies/paper_table.h>
#include <squeal/studies/parameter_usage.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>

namespace Squeal
{
  namespace
  {
    using Value = std::optional<double>;

    constexpr auto minus = DoubletSign::minus, plus = DoubletSign::plus;

    ModeLabel disc(const ModeFamily family, const int circles, const int diameters, const DoubletSign sign = DoubletSign::none)
    {
      return {family, circles, diameters, 0, sign};
    }

    constexpr auto  A = ModeFamily::axial, R = ModeFamily::radial, C = ModeFamily::circumferential;
    const ModeLabel F1 = {ModeFamily::flexural, 0, 0, 1}, T1 = {ModeFamily::torsional, 0, 0, 1};

    /// How a row of the paper finds its mode in a run.
    enum class Match
    {
      label,           ///< the mode of that label
      lowest,          ///< lowest frequency among the modes of the label
      highest,         ///< highest frequency among the modes of the label
      most_unstable,   ///< largest growth rate among the modes of the label
      second_unstable, ///< second largest
      frequency        ///< nearest frequency: the paper finds these coupled modes hard to name
    };
  } // namespace

  /// What the name of a row adds to its label.
  template <>
  inline constexpr EnumName<Match> enum_table<Match>[] = {{Match::label, ""},
                                                          {Match::lowest, " lowest"},
                                                          {Match::highest, " highest"},
                                                          {Match::most_unstable, " most unstable"},
                                                          {Match::second_unstable, " second unstable"},
                                                          {Match::frequency, ""}};

  namespace
  {
    struct Row
    {
      ModeLabel label;
      Match     match;
      Value     component, coupled, complex_undamped, divergence_undamped, complex_damped, divergence_damped;
    };

    constexpr auto none = std::nullopt;

    /// Relative difference of frequencies beyond which two modes without a name are not taken for the same.
    constexpr double largest_distance = 0.1;

    /// Frequencies in Hz, divergence rates in per cent; empty: not given or negligible.
    const std::vector<Row> rows = {{disc(A, 0, 1, minus), Match::label, 251, 295, 295, none, 296, none},
                                   {disc(A, 0, 1, plus), Match::frequency, 251, 312, 312, none, 313, none},
                                   {disc(A, 0, 0), Match::label, 352, none, none, none, none, none},
                                   {disc(A, 0, 2, minus), Match::label, 569, 489, 489, none, 489, none},
                                   {disc(A, 0, 2, plus), Match::label, 569, 697, 700, none, 700, none},
                                   {disc(C, 0, 0), Match::label, 644, 644, 645, none, 644, none},
                                   {disc(R, 0, 1, minus), Match::label, 649, 643, 644, none, 644, none},
                                   {disc(R, 0, 1, plus), Match::label, 649, 647, 648, none, 648, -0.093},
                                   {{}, Match::frequency, none, 1057, 1061, none, 1061, none},
                                   {disc(A, 0, 3, minus), Match::label, 1267, 1374, 1379, none, 1379, none},
                                   {disc(A, 0, 3, plus), Match::label, 1267, 1567, 1576, none, 1576, none},
                                   {disc(A, 1, 0), Match::label, 1404, 1449, 1450, none, 1450, none},
                                   {disc(R, 0, 2, minus), Match::label, 1822, 1823, 1823, none, 1823, none},
                                   {disc(R, 0, 2, plus), Match::label, 1822, 1825, 1826, none, 1826, none},
                                   {disc(A, 1, 1, minus), Match::label, 2082, 2087, 2087, none, 2087, none},
                                   {disc(A, 1, 1, plus), Match::label, 2082, 2150, 2153, none, 2153, none},
                                   {disc(A, 0, 4, minus), Match::label, 2220, 2284, 2297, -0.64, 2297, -0.67},
                                   {disc(A, 0, 4, plus), Match::label, 2220, 2305, 2297, 0.64, 2297, 0.65},
                                   {disc(A, 0, 5, minus), Match::label, 3345, 3380, 3376, -0.98, 3376, -1.02},
                                   {disc(A, 0, 5, plus), Match::label, 3345, 3392, 3376, 0.98, 3377, 0.95},
                                   {disc(A, 1, 2, minus), Match::label, 3365, 3350, 3352, none, 3352, none},
                                   {disc(A, 1, 2, plus), Match::label, 3365, 3371, 3386, none, 3387, -0.078},
                                   {F1, Match::lowest, 3553, 3551, 3516, none, 3521, none},
                                   {F1, Match::highest, 3553, 3562, 3564, none, 3563, none},
                                   {F1, Match::most_unstable, none, none, 3542, 0.89, 3537, 0.88},
                                   {F1, Match::second_unstable, none, none, 3550, 0.10, none, none},
                                   {disc(R, 0, 0), Match::label, 3704, 3704, 3704, none, 3704, none},
                                   {T1, Match::lowest, 3934, 3934, 3934, none, 3933, none},
                                   {T1, Match::highest, 3934, 3934, 3934, none, 3933, none},
                                   {disc(R, 0, 3, minus), Match::label, 3990, 3989, 3989, none, 3989, none},
                                   {disc(R, 0, 3, plus), Match::label, 3990, 3991, 3989, none, 3990, none},
                                   {disc(C, 0, 1, minus), Match::label, 4500, 4499, 4499, none, 4499, none},
                                   {disc(C, 0, 1, plus), Match::label, 4500, 4500, 4500, none, 4500, none},
                                   {disc(A, 0, 6, minus), Match::label, 4659, 4641, 4641, none, 4641, none},
                                   {disc(A, 0, 6, plus), Match::label, 4659, 4653, 4652, none, 4652, none},
                                   {disc(A, 1, 3, minus), Match::label, 4794, 4800, 4799, none, 4800, none},
                                   {disc(A, 1, 3, plus), Match::label, 4794, 4815, 4814, none, 4815, none}};

    /// The mode that a row asks for; null if the run has none.
    const ModalQuantities *find(const Row &row, const Match match, const std::vector<ComparedMode> &modes, const Value paper_frequency)
    {
      // Modes that carry the label; where there are several, with or without the sign of a doublet
      std::vector<const ModalQuantities *> candidates;
      for (const ComparedMode &mode : modes)
        if (match == Match::frequency || mode.label == row.label || (match != Match::label && mode.label.shape() == row.label.shape()))
          candidates.push_back(&mode.quantities);
      if (candidates.empty())
        return nullptr;

      switch (match)
        {
          case Match::label:
          case Match::lowest:
            return candidates.front();
          case Match::highest:
            return candidates.back();
          case Match::most_unstable:
          case Match::second_unstable:
            {
              const std::size_t place = match == Match::most_unstable ? 0 : 1;
              std::stable_sort(candidates.begin(), candidates.end(),
                               [](const auto *a, const auto *b) { return a->growth_rate > b->growth_rate; });
              return place < candidates.size() ? candidates[place] : nullptr;
            }
          case Match::frequency:
            {
              const auto distance = [&](const auto *mode) { return std::abs(mode->frequency / *paper_frequency - 1.); };
              const auto nearest  = *std::min_element(candidates.begin(), candidates.end(),
                                                      [&](const auto *a, const auto *b) { return distance(a) < distance(b); });
              return distance(nearest) < largest_distance ? nearest : nullptr;
            }
        }
      return nullptr;
    }

    /// Whether one of the parameters that the @p paths name, "Section/Name" or "Section/", differs from its default.
    bool differs(const Parameters &parameters, const std::vector<std::string> &paths)
    {
      for (const std::string &changed : changed_parameters(parameters))
        for (const std::string &path : paths)
          if (concerns(path, changed))
            return true;
      return false;
    }

    /// A quantity of a mode in the paper and in the run.
    struct Pair
    {
      Value paper, found = {};

      /// Relative difference [%].
      Value difference() const
      {
        return paper && found ? Value(100. * (*found / *paper - 1.)) : none;
      }
    };

    /// A row of the paper beside the mode of the run.
    struct Comparison
    {
      std::string name;
      Pair        component, coupled, complex, divergence;
    };

    Agreement agreement_of(const std::vector<Comparison> &comparisons, Pair Comparison::*frequency)
    {
      Agreement agreement;
      for (const Comparison &row : comparisons)
        if (const Value difference = (row.*frequency).difference())
          {
            agreement.difference += *difference * *difference / 1e4;
            ++agreement.n;
          }
      agreement.difference = std::sqrt(agreement.difference / std::max(agreement.n, 1u));
      return agreement;
    }
  } // namespace

  bool is_paper_scene(const Parameters &parameters)
  {
    return std::filesystem::path(parameters.geometry.file).filename() == Parameters().geometry.file &&
           !differs(parameters,
                    {"Geometry/Disc inner radius", "Geometry/Disc outer radius", "Geometry/Disc thickness", "Geometry/Pin diameter",
                     "Geometry/Pin height", "Geometry/Top pin radii", "Geometry/Top pin angles", "Geometry/Bottom pin radii",
                     "Geometry/Bottom pin angles", "Disc material/", "Pin material/", "Mounts/"}) &&
           (parameters.sliding.gaps.empty() || !parameters.needs_steady_sliding());
  }

  bool is_paper_operation(const Parameters &parameters)
  {
    // The sense of rotation changes nothing here, and Table 1 has modes both without and with radial dissipation.
    return !differs(parameters, {"Operation/Friction coefficient", "Operation/Rotation speed", "Operation/Load per side",
                                 "Operation/Friction slope", "Damping/"});
  }

  const std::array<PaperRange, 2> paper_ranges_damped = {{{F1, -1.76, -1.07, 2}, {T1, -2.34, -1.41, 1}}};

  std::optional<double> paper_divergence_damped(const ModeLabel &label)
  {
    for (const Row &row : rows)
      if (row.match == Match::label && row.label == label)
        return row.divergence_damped;
    return {};
  }

  TableOne table_one(const TableOneResults &results, const RadialDissipation dissipation)
  {
    const bool              damped = dissipation != RadialDissipation::none;
    std::vector<Comparison> comparisons;
    for (const Row &row : rows)
      {
        const auto frequency = [&](const Value paper, const std::vector<ComparedMode> &modes, const Match match) {
          const ModalQuantities *mode = paper ? find(row, match, modes, paper) : nullptr;
          return Pair{paper, mode ? Value(mode->frequency) : none};
        };
        // Component modes are named without ambiguity.
        const Match            component = row.match == Match::frequency ? Match::label : row.match;
        const Value            paper     = damped ? row.complex_damped : row.complex_undamped;
        const ModalQuantities *complex   = paper || row.match != Match::frequency ? find(row, row.match, results.complex, paper) : nullptr;
        comparisons.push_back(
          {to_string(row.label) + to_string(row.match),
           frequency(row.component, results.component, component),
           frequency(row.coupled, results.coupled, row.match),
           {paper, complex ? Value(complex->frequency) : none},
           {damped ? row.divergence_damped : row.divergence_undamped, complex ? Value(100. * complex->divergence_rate) : none}});
      }
    using C                  = Comparison;
    const Columns<C> columns = {{"label", "", &C::name},
                                {"component paper", "Hz", [](const C &c) { return c.component.paper; }, 0},
                                {"component", "Hz", [](const C &c) { return c.component.found; }, 1},
                                {"difference", "%", [](const C &c) { return c.component.difference(); }, 2},
                                {"coupled paper", "Hz", [](const C &c) { return c.coupled.paper; }, 0},
                                {"coupled", "Hz", [](const C &c) { return c.coupled.found; }, 1},
                                {"difference", "%", [](const C &c) { return c.coupled.difference(); }, 2},
                                {"complex paper", "Hz", [](const C &c) { return c.complex.paper; }, 0},
                                {"complex", "Hz", [](const C &c) { return c.complex.found; }, 1},
                                {"divergence paper", "%", [](const C &c) { return c.divergence.paper; }, 3},
                                {"divergence", "%", [](const C &c) { return c.divergence.found; }, 3}};
    return {Table(columns, comparisons), agreement_of(comparisons, &C::component), agreement_of(comparisons, &C::coupled)};
  }
} // namespace Squeal
