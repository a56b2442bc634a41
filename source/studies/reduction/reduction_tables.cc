// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/studies/reduction/reduction_tables.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    /// An estimate counts as good if it differs from the true error by at most this factor.
    constexpr double good_factor = 3.;

    /// Smallest relative difference of λ for which an estimate is assessed; smaller differences are rounding errors of the reference [-].
    constexpr double reference_accuracy = 1e-11;

    /// A condition number; empty if the matrix is numerically singular.
    Entry condition_cell(const double condition)
    {
      return std::isfinite(condition) ? Entry(condition) : Entry();
    }
  } // namespace

  double largest_error(const MeasuredBasis &candidate)
  {
    double result = 0.;
    for (const ModeError &e : candidate.errors)
      result = std::max(result, e.eigenvalue);
    return result;
  }

  void write_reduced_system(const ReducedModel  &model,
                            const ReductionPlan &plan,
                            const MeasuredBasis &candidate,
                            const int            number,
                            Run                 &run)
  {
    if (run.parameters.output.write_system != SystemOutput::reduced)
      return;
    Columns<double> columns;
    for (const FileParameter &parameter : plan.parameters)
      columns.push_back({parameter.name, parameter.unit, [value = parameter.value](double) { return value; }});
    columns.push_back({"largest error of lambda", "-", [](const double error) { return error; }, 1, true});
    const double      largest = largest_error(candidate);
    const std::string name    = candidate.truncation.empty() ? candidate.name : candidate.name + ", " + candidate.truncation;
    write_reduced_system(model, {plan.parameters, "reduced model with the basis " + name, largest, Table(columns, std::vector{largest})},
                         nullptr, text("system_", number, "/"), run);
  }

  Table reduction_error_table(const std::vector<MeasuredBasis> &candidates, const ReferenceSolution &reference)
  {
    struct Row : GroupError
    {
      const MeasuredBasis &candidate;
    };
    std::vector<Row> rows;
    for (const MeasuredBasis &candidate : candidates)
      for (const GroupError &largest : largest_errors(candidate.errors, reference.groups, reference.joined))
        rows.push_back({largest, candidate});
    return Table(Columns<Row>{{"basis", "", [](const Row &row) { return row.candidate.name; }},
                              {"n_r0", "-", [](const Row &row) { return row.candidate.basis.n_r0; }},
                              {"n_r", "-", [](const Row &row) { return row.candidate.n_r; }},
                              {"group", "", &Row::group},
                              {"res", "-", &Row::residual, 1, true},
                              {"mac", "-", &Row::shape, 1, true},
                              {"frq", "-", &Row::frequency, 1, true},
                              {"div", "-", &Row::divergence, 1, true},
                              {"div estimated", "-", &Row::estimated_divergence, 1, true},
                              {"div corrected", "-", &Row::corrected_divergence, 1, true},
                              {"build time", "s", [](const Row &row) { return row.candidate.build_seconds; }, 2},
                              {"solve time", "s", [](const Row &row) { return row.candidate.solve_seconds; }, 3},
                              {"subspace", "-", &Row::subspace, 1, true},
                              {"lambda", "-", &Row::eigenvalue, 1, true},
                              {"component modes", "", [](const Row &row) { return row.candidate.truncation; }},
                              {"modes", "-", &Row::n_modes},
                              {"mac by eq. 17", "-", &Row::closest_shape, 1, true},
                              {"frq by eq. 17", "-", &Row::closest_frequency, 1, true},
                              {"div by eq. 17", "-", &Row::closest_divergence, 1, true},
                              {"other by eq. 17", "-", &Row::n_other}},
                 rows);
  }

  Table reduction_basis_table(const std::vector<MeasuredBasis> &candidates, const int n, const double full_seconds)
  {
    using Row = MeasuredBasis;
    return Table(
      Columns<Row>{{"basis", "", &Row::name},
                   {"columns", "", [](const Row &row) { return row.recipe->columns(); }},
                   {"component modes", "", &Row::truncation},
                   {"n_r0", "-", [](const Row &row) { return row.basis.n_r0; }},
                   {"n_r by formula", "-", [](const Row &row) { return row.basis.n_nominal; }},
                   {"n_r", "-", &Row::n_r},
                   {"dropped", "-", [](const Row &row) { return row.basis.n_dropped; }},
                   {"rank tolerance", "-", [](const Row &row) { return row.basis.tolerance; }, 0, true},
                   {"condition", "-", [](const Row &row) { return condition_cell(row.basis.condition); }, 1, true},
                   {"orthonormality", "-", [](const Row &row) { return row.basis.orthonormality; }, 1, true},
                   {"rank of P_n T_r0", "-", [](const Row &row) { return row.basis.connection.rank; }},
                   {"smallest kept", "-", [](const Row &row) { return row.basis.connection.smallest_kept; }, 1, true},
                   {"largest dropped", "-", [](const Row &row) { return row.basis.connection.largest_dropped; }, 1, true},
                   {"G_n", "-", [n](const Row &row) { return static_cast<double>(n) / row.n_r; }, 1},
                   {"build time", "s", &Row::build_seconds, 2},
                   {"solve time", "s", &Row::solve_seconds, 3},
                   {"G_t", "-", [full_seconds](const Row &row) { return full_seconds / (row.build_seconds + row.solve_seconds); }, 2}},
      candidates);
  }

  Table reduction_mode_table(const std::vector<MeasuredBasis> &candidates, const ReferenceSolution &reference)
  {
    struct Row : ModeError
    {
      const MeasuredBasis &candidate;
      ModeLabel            label;
      std::string          group;
      Entry                disc_share;
      ModalQuantities      mode, exact, better;
    };
    std::vector<Row> rows;
    for (const MeasuredBasis &candidate : candidates)
      for (std::size_t j = 0; j < reference.labels.size(); ++j)
        {
          const ModeError &e = candidate.errors[j];
          rows.push_back({e, candidate, reference.labels[j], reference.groups[j],
                          reference.disc_shares.empty() ? Entry() : Entry(reference.disc_shares[j]), modal_quantities(e.reduced),
                          modal_quantities(e.reference), modal_quantities(e.corrected)});
        }
    const auto frequency_bar  = [](const Row &row) { return std::abs(row.better.frequency - row.mode.frequency); };
    const auto divergence_bar = [](const Row &row) { return 100. * std::abs(row.better.divergence_rate - row.mode.divergence_rate); };
    return Table(Columns<Row>{{"basis", "", [](const Row &row) { return row.candidate.name; }},
                              {"component modes", "", [](const Row &row) { return row.candidate.truncation; }},
                              {"label", "", &Row::label},
                              {"group", "", &Row::group},
                              {"frequency", "Hz", [](const Row &row) { return row.mode.frequency; }, 3},
                              {"divergence rate", "%", [](const Row &row) { return 100. * row.mode.divergence_rate; }, 4},
                              {"error bar of frequency", "Hz", frequency_bar, 1, true},
                              {"error bar of divergence rate", "%", divergence_bar, 1, true},
                              {"verdict", "", &Row::verdict},
                              {"reference frequency", "Hz", [](const Row &row) { return row.exact.frequency; }, 3},
                              {"reference divergence rate", "%", [](const Row &row) { return 100. * row.exact.divergence_rate; }, 4},
                              {"eps_res", "-", &Row::residual, 1, true},
                              {"eps_mac", "-", &Row::shape, 1, true},
                              {"eps_frq", "-", &Row::frequency, 1, true},
                              {"eps_div", "-", &Row::divergence, 1, true},
                              {"error of lambda", "-", &Row::eigenvalue, 1, true},
                              {"estimated error of lambda", "-", &Row::estimated_error, 1, true},
                              {"error of corrected lambda", "-", &Row::corrected_error, 1, true},
                              {"condition", "-", [](const Row &row) { return condition_cell(row.condition); }, 1, true},
                              {"estimate claimed", "", [](const Row &row) { return row.claimed ? "yes" : "no"; }},
                              {"cluster", "-", &Row::cluster_size},
                              {"subspace", "-", &Row::subspace, 1, true},
                              {"disc share", "-", &Row::disc_share, 3},
                              {"reduced mode", "-", [](const Row &row) { return row.match + 1; }},
                              {"reduced mode by eq. 17", "-", [](const Row &row) { return row.closest + 1; }},
                              {"eps_mac by eq. 17", "-", &Row::closest_shape, 1, true},
                              {"eps_frq by eq. 17", "-", &Row::closest_frequency, 1, true},
                              {"eps_div by eq. 17", "-", &Row::closest_divergence, 1, true}},
                 rows);
  }

  Table reduction_estimate_table(const std::vector<MeasuredBasis> &candidates, const ReferenceSolution &reference)
  {
    struct Row
    {
      const MeasuredBasis &candidate;
      int                  n_claimed = 0, n_good = 0, n_undecided = 0, n_wrong = 0;
      std::vector<double>  ratios = {}, gains = {};
    };
    std::vector<Row> rows;
    for (const MeasuredBasis &candidate : candidates)
      {
        rows.push_back({candidate});
        Row &row = rows.back();
        for (std::size_t j = 0; j < candidate.errors.size(); ++j)
          {
            const ModeError &e = candidate.errors[j];
            row.n_undecided += e.verdict == Verdict::undecided;
            row.n_wrong += e.verdict != Verdict::undecided && (e.verdict == Verdict::unstable) != reference.unstable[j];
            row.n_claimed += e.claimed;
            if (!e.claimed || !(e.eigenvalue > reference_accuracy))
              continue;
            row.ratios.push_back(e.estimate_ratio);
            row.n_good += e.estimate_ratio > 1. / good_factor && e.estimate_ratio < good_factor;
            if (e.corrected_error > 0.)
              row.gains.push_back(e.eigenvalue / e.corrected_error);
          }
      }
    const auto median = [](std::vector<double> values) {
      std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
      return values.empty() ? Entry() : Entry(values[values.size() / 2]);
    };
    const auto good_share = [](const Row &row) { return row.ratios.empty() ? Entry() : Entry(100. * row.n_good / row.ratios.size()); };
    return Table(Columns<Row>{{"basis", "", [](const Row &row) { return row.candidate.name; }},
                              {"component modes", "", [](const Row &row) { return row.candidate.truncation; }},
                              {"modes", "-", [](const Row &row) { return row.candidate.errors.size(); }},
                              {"claimed", "-", &Row::n_claimed},
                              {"judged", "-", [](const Row &row) { return row.ratios.size(); }},
                              {"median ratio to the true error", "-", [&](const Row &row) { return median(row.ratios); }, 2},
                              {"within a factor of 3", "%", good_share, 0},
                              {"median gain of the correction", "-", [&](const Row &row) { return median(row.gains); }, 1},
                              {"undecided", "-", &Row::n_undecided},
                              {"wrong verdicts", "-", &Row::n_wrong}},
                 rows);
  }

  Table reduction_truncation_table(const std::vector<TruncatedModes> &truncations)
  {
    using Row          = TruncatedModes;
    const auto n_modes = [](const BasisSource source, const BasisSource other) {
      return [=](const Row &row) {
        for (const BasisSource asked : {source, other})
          if (const auto found = row.n.find(asked); found != row.n.end() && found->second > 0)
            return Entry(found->second);
        return Entry();
      };
    };
    using Source = BasisSource;
    return Table(Columns<Row>{{"component modes", "", [](const Row &row) { return row.truncation.text(); }},
                              {"disc", "-", n_modes(Source::disc_free, Source::disc_sliding)},
                              {"pins free", "-", n_modes(Source::pins_free, Source::pins_free)},
                              {"pins sliding", "-", n_modes(Source::pins_sliding, Source::pins_sliding)}},
                 truncations);
  }
} // namespace Squeal
