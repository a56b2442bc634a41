#include <squeal/base/conventions.h>
#include <squeal/studies/reduction_tables.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    /// Estimates count as good within this factor of the true error.
    constexpr double good_factor = 3.;

    /// Relative differences of λ below this are rounding errors of the reference and say nothing about an estimate.
    constexpr double reference_accuracy = 1e-11;
  } // namespace

  Table reduction_error_table(const std::vector<Candidate> &candidates, const std::vector<std::string> &groups)
  {
    Table table({{"basis", ""},
                 {"n_r0", "-"},
                 {"n_r", "-"},
                 {"group", ""},
                 {"res", "-", 1, true},
                 {"mac", "-", 1, true},
                 {"frq", "-", 1, true},
                 {"div", "-", 1, true},
                 {"div estimated", "-", 1, true},
                 {"div corrected", "-", 1, true},
                 {"build time", "s", 2},
                 {"solve time", "s", 3},
                 {"subspace", "-", 1, true},
                 {"lambda", "-", 1, true},
                 {"component modes", ""}});
    for (const Candidate &candidate : candidates)
      for (const GroupError &m : largest_errors(candidate.errors, groups))
        table.add_row({candidate.name, static_cast<long>(candidate.basis.n_r0), static_cast<long>(candidate.n_r), m.group, m.residual,
                       m.shape, m.frequency, m.divergence, m.estimated_divergence, m.corrected_divergence, candidate.build_seconds,
                       candidate.solve_seconds, m.subspace, m.eigenvalue, candidate.truncation});
    return table;
  }

  Table reduction_basis_table(const std::vector<Candidate> &candidates, const int n, const double full_seconds)
  {
    Table table({{"basis", ""},
                 {"columns", ""},
                 {"component modes", ""},
                 {"n_r0", "-"},
                 {"n_r by formula", "-"},
                 {"n_r", "-"},
                 {"dropped", "-"},
                 {"rank tolerance", "-", 0, true},
                 {"condition", "-", 1, true},
                 {"orthonormality", "-", 1, true},
                 {"rank of P_n T_r0", "-"},
                 {"smallest kept", "-", 1, true},
                 {"largest dropped", "-", 1, true},
                 {"G_n", "-", 1},
                 {"build time", "s", 2},
                 {"solve time", "s", 3},
                 {"G_t", "-", 2}});
    for (const Candidate &candidate : candidates)
      {
        const ReducedBasis &b = candidate.basis;
        // A Gram matrix can be singular to rounding: its condition is then not a number to be printed.
        table.add_row({candidate.name, candidate.recipe->columns(), candidate.truncation, static_cast<long>(b.n_r0),
                       static_cast<long>(b.n_nominal), static_cast<long>(candidate.n_r), static_cast<long>(b.n_dropped), b.tolerance,
                       std::isfinite(b.condition) ? Cell(b.condition) : Cell(), b.orthonormality, static_cast<long>(b.connection.rank),
                       b.connection.smallest_kept, b.connection.largest_dropped, static_cast<double>(n) / candidate.n_r,
                       candidate.build_seconds, candidate.solve_seconds,
                       full_seconds / (candidate.build_seconds + candidate.solve_seconds)});
      }
    return table;
  }

  Table reduction_mode_table(const std::vector<Candidate>   &candidates,
                             const std::vector<std::string> &labels,
                             const std::vector<std::string> &groups)
  {
    Table table({{"basis", ""},
                 {"component modes", ""},
                 {"label", ""},
                 {"group", ""},
                 {"frequency", "Hz", 3},
                 {"divergence rate", "%", 4},
                 {"error bar of frequency", "Hz", 1, true},
                 {"error bar of divergence rate", "%", 1, true},
                 {"verdict", ""},
                 {"reference frequency", "Hz", 3},
                 {"reference divergence rate", "%", 4},
                 {"eps_res", "-", 1, true},
                 {"eps_mac", "-", 1, true},
                 {"eps_frq", "-", 1, true},
                 {"eps_div", "-", 1, true},
                 {"error of lambda", "-", 1, true},
                 {"estimated error of lambda", "-", 1, true},
                 {"error of corrected lambda", "-", 1, true},
                 {"condition", "-", 1, true},
                 {"estimate claimed", ""},
                 {"cluster", "-"},
                 {"subspace", "-", 1, true}});
    for (const Candidate &candidate : candidates)
      for (std::size_t j = 0; j < labels.size(); ++j)
        {
          const ModeError      &e    = candidate.errors[j];
          const ModalQuantities mode = modal_quantities(e.reduced), reference = modal_quantities(e.reference),
                                better = modal_quantities(e.corrected);
          table.add_row({candidate.name,
                         candidate.truncation,
                         labels[j],
                         groups[j],
                         mode.frequency,
                         100. * mode.divergence_rate,
                         std::abs(better.frequency - mode.frequency),
                         100. * std::abs(better.divergence_rate - mode.divergence_rate),
                         to_string(e.verdict),
                         reference.frequency,
                         100. * reference.divergence_rate,
                         e.residual,
                         e.shape,
                         e.frequency,
                         e.divergence,
                         e.eigenvalue,
                         e.estimated_error,
                         e.corrected_error,
                         std::isfinite(e.condition) ? Cell(e.condition) : Cell(),
                         std::string(e.claimed ? "yes" : "no"),
                         static_cast<long>(e.cluster_size),
                         e.subspace});
        }
    return table;
  }

  Table reduction_estimate_table(const std::vector<Candidate> &candidates, const std::vector<bool> &unstable)
  {
    Table table({{"basis", ""},
                 {"component modes", ""},
                 {"modes", "-"},
                 {"claimed", "-"},
                 {"judged", "-"},
                 {"median ratio to the true error", "-", 2},
                 {"within a factor of 3", "%", 0},
                 {"median gain of the correction", "-", 1},
                 {"undecided", "-"},
                 {"wrong verdicts", "-"}});
    for (const Candidate &candidate : candidates)
      {
        std::vector<double> ratios, gains;
        long                n_claimed = 0, n_good = 0, n_undecided = 0, n_wrong = 0;
        for (std::size_t j = 0; j < candidate.errors.size(); ++j)
          {
            const ModeError &e = candidate.errors[j];
            n_undecided += e.verdict == Verdict::undecided;
            n_wrong += e.verdict == (unstable[j] ? Verdict::stable : Verdict::unstable);
            n_claimed += e.claimed;
            if (!e.claimed || !(e.eigenvalue > reference_accuracy))
              continue;
            ratios.push_back(e.estimate_ratio);
            n_good += e.estimate_ratio > 1. / good_factor && e.estimate_ratio < good_factor;
            if (e.corrected_error > 0.)
              gains.push_back(e.eigenvalue / e.corrected_error);
          }
        const auto median = [](std::vector<double> values) {
          if (values.empty())
            return Cell();
          std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
          return Cell(values[values.size() / 2]);
        };
        table.add_row({candidate.name, candidate.truncation, static_cast<long>(candidate.errors.size()), n_claimed,
                       static_cast<long>(ratios.size()), median(ratios), ratios.empty() ? Cell() : Cell(100. * n_good / ratios.size()),
                       median(gains), n_undecided, n_wrong});
      }
    return table;
  }
} // namespace Squeal
