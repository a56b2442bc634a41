#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/system/term_families.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace Squeal
{
  namespace
  {
    /// Scales that differ by less are the same: they come from products of the same parameters.
    constexpr double same_scale = 1e-13;

    /// Terms whose coefficients have the same ratios to their means in all members.
    struct Group
    {
      const Term                                                         *first;
      std::vector<double>                                                 scales; ///< for each member
      std::vector<std::pair<double, std::shared_ptr<const SparseMatrix>>> summands;
    };

    bool agree(const std::vector<double> &x, const std::vector<double> &y)
    {
      return std::equal(x.begin(), x.end(), y.begin(), [](const double a, const double b) { return std::abs(a - b) <= same_scale; });
    }
  } // namespace

  TermFamily term_family(const std::vector<Term> &terms, const std::vector<ParameterValues> &members)
  {
    std::vector<Group> groups;
    for (const Term &term : terms)
      {
        std::vector<double> coefficients;
        for (const ParameterValues &values : members)
          coefficients.push_back(term.coefficient.at(values));
        const double mean = std::accumulate(coefficients.begin(), coefficients.end(), 0.) / static_cast<double>(members.size());
        if (mean == 0.)
          continue;
        for (double &x : coefficients)
          x /= mean;
        auto group = std::find_if(groups.begin(), groups.end(), [&](const Group &other) {
          return other.first->power == term.power && other.first->symmetry == term.symmetry && agree(other.scales, coefficients);
        });
        if (group == groups.end())
          group = groups.insert(group, {&term, coefficients, {}});
        group->summands.emplace_back(mean, term.matrix);
      }

    TermFamily result{{}, {}, std::vector<ParameterValues>(members.size())};
    for (const Group &group : groups)
      {
        Coefficient coefficient;
        if (!agree(group.scales, std::vector<double>(members.size(), 1.)))
          {
            const std::string scale = "scale of " + group.first->name;
            coefficient             = Coefficient(1., {{scale, 1}});
            result.values[scale]    = {1.};
            for (std::size_t m = 0; m < members.size(); ++m)
              result.members[m][scale] = {group.scales[m]};
          }
        result.terms.push_back(
          sparse_term(group.first->name, group.first->power, coefficient, sum(group.summands), group.first->symmetry, group.first->kind));
      }
    return result;
  }
} // namespace Squeal
