#include <squeal/contact/system_family.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    /// Whether both terms may be written as one, whatever the parameters that are left free.
    bool are_alike(const Term &x, const Term &y)
    {
      if (x.power != y.power || (x.matrix == nullptr) != (y.matrix == nullptr) || x.weights != y.weights)
        return false;
      return x.matrix ? x.symmetry == y.symmetry : x.weights.empty() && x.left == y.left;
    }

    /// What is left of the coefficient of a term when all but the friction coefficient have their values.
    Coefficient in_friction(const Term &term)
    {
      return term.kind == TermKind::friction ? Coefficient(-1., {{SystemParameter::friction, 1}}) : Coefficient();
    }

    Term sum_of(const std::vector<Term> &family, const TermShares &shares)
    {
      Term result        = family[shares.front().first];
      result.coefficient = in_friction(result);
      std::vector<std::pair<double, std::shared_ptr<const SparseMatrix>>> summands;
      for (const auto &[number, factor] : shares)
        summands.emplace_back(factor, result.matrix ? family[number].matrix : family[number].right->sparse_transpose());
      if (result.matrix)
        result.matrix = sum(summands);
      else if (result.weights.empty())
        result.right = std::make_shared<LowRankFactor>(sum(summands));
      return result;
    }
  } // namespace

  CoupledSystem coupled_family(const TermFamily &bodies, const ContactOperators &contact, const ContactDamping &damping)
  {
    return couple(bodies.terms, contact, damping, bodies.values);
  }

  SystemMember member_of(const CoupledSystem &family, const ParameterValues &values)
  {
    const ParameterValues with_friction = family.at(1., values);
    SystemMember          result;
    for (std::size_t k = 0; k < family.terms.size(); ++k)
      {
        const Term &term = family.terms[k];
        // The sign of friction belongs to the term
        const double factor = term.coefficient.at(with_friction) / in_friction(term).at(with_friction);
        if (factor == 0.)
          continue;
        const auto alike = std::find_if(result.shares.begin(), result.shares.end(),
                                        [&](const TermShares &shares) { return are_alike(family.terms[shares.front().first], term); });
        if (alike == result.shares.end())
          result.shares.push_back({{k, factor}});
        else
          alike->emplace_back(k, factor);
      }
    result.system.friction_forces = family.friction_forces;
    result.system.kernel          = family.kernel;
    for (const char *free : {SystemParameter::friction, SystemParameter::radial_damping, SystemParameter::sliding_damping})
      result.system.values[free] = family.values.at(free);
    for (const TermShares &shares : result.shares)
      result.system.terms.push_back(sum_of(family.terms, shares));
    set_frictionless_matrices(result.system);
    return result;
  }
} // namespace Squeal
