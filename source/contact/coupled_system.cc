// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/contact/coupled_system.h>
#include <squeal/linear_algebra/dense.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace Squeal
{
  namespace
  {
    using Matrix = std::shared_ptr<const SparseMatrix>;

    /// Contact damping along b and t with the factors P_bᵀ and P_tᵀ, on coupled or uncoupled dofs.
    std::vector<Term> contact_damping_terms(const std::shared_ptr<const LowRankFactor> &radial,
                                            const std::shared_ptr<const LowRankFactor> &tangential)
    {
      const auto term = [](const char *weights, const std::shared_ptr<const LowRankFactor> &factor) {
        return low_rank_term(weights, 1, {}, factor, factor, weights, TermKind::contact_damping);
      };
      return {term(SystemParameter::radial_damping, radial), term(SystemParameter::sliding_damping, tangential)};
    }

    /// True for the form −μ A V; friction of a system file may have a sparse matrix instead.
    bool is_friction(const Term &term)
    {
      return term.kind == TermKind::friction && !term.matrix;
    }
  } // namespace

  ParameterValues ContactDamping::values() const
  {
    return {{SystemParameter::radial_damping, radial}, {SystemParameter::sliding_damping, sliding}};
  }

  const RowMap &CoupledSystem::map() const
  {
    return stiffness ? stiffness->rows() : kernel->columns();
  }

  ParameterValues CoupledSystem::at(const double value, const ParameterValues &others) const
  {
    ParameterValues result = others;
    result.insert(values.begin(), values.end()); // keeps the values of @p others
    result[varied] = {value};
    return result;
  }

  bool CoupledSystem::has_damping() const
  {
    return !terms_of(terms, values, 1).empty();
  }

  Matrix contact_damping(const ContactOperators &contact, const ContactDamping &damping)
  {
    const auto radial = std::make_shared<LowRankFactor>(contact.radial), tangential = std::make_shared<LowRankFactor>(contact.tangential);
    return sparse_matrices(contact_damping_terms(radial, tangential), damping.values()).damping;
  }

  CoupledSystem coupled_system(const std::vector<CoupledTerm> &bodies,
                               Matrix                          tangential,
                               Matrix                          radial,
                               const ContactDamping           &damping,
                               const ParameterValues          &values)
  {
    CoupledSystem result;
    result.values = damping.values();
    result.values.insert(values.begin(), values.end());
    result.values[SystemParameter::friction] = {0.};
    result.friction_forces                   = std::make_shared<LowRankFactor>(std::move(tangential));
    for (const CoupledTerm &body : bodies)
      result.terms.push_back(body.term);
    for (const CoupledTerm &body : bodies)
      if (body.reaction && max_norm(*body.reaction) > 0.)
        result.terms.push_back(low_rank_term(
          "friction, " + body.term.name, body.term.power, body.term.coefficient * Coefficient(-1., {{SystemParameter::friction, 1}}),
          result.friction_forces, std::make_shared<LowRankFactor>(body.reaction), "", TermKind::friction));
    for (Term &term : contact_damping_terms(std::make_shared<LowRankFactor>(std::move(radial)), result.friction_forces))
      result.terms.push_back(std::move(term));

    set_frictionless_matrices(result);
    return result;
  }

  void set_frictionless_matrices(CoupledSystem &system)
  {
    const auto of_power = [&system](const int power) {
      std::vector<std::pair<double, Matrix>> summands;
      for (const Term &term : system.terms)
        if (term.matrix && term.is_frictionless() && term.power == power)
          summands.emplace_back(term.coefficient.at(system.values), term.matrix);
      return sum(summands);
    };
    system.mass          = of_power(2);
    system.stiffness     = of_power(0);
    system.hidden_square = unresolved_square(*system.stiffness, *system.mass);
  }

  CoupledSystem couple(const std::vector<Term> &bodies,
                       const ContactOperators  &contact,
                       const ContactDamping    &damping,
                       const ParameterValues   &values)
  {
    const SparseMatrix      &T_c = *contact.kernel;
    std::vector<CoupledTerm> coupled;
    for (const Term &body : bodies)
      {
        coupled.push_back({body, multiply(*multiply(*contact.reaction, *body.matrix), T_c)});
        coupled.back().term.matrix = congruence(*body.matrix, T_c);
      }
    ParameterValues all_values = values;
    for (const ContactSpring &spring : contact.springs)
      {
        coupled.push_back(
          {sparse_term(spring.name, 0, {1., {{spring.name, 1}}}, congruence(*spring.matrix, T_c)), multiply(*spring.reaction, T_c)});
        all_values[spring.name] = {spring.stiffness};
      }
    CoupledSystem result = coupled_system(coupled, multiply(*contact.tangential, T_c), multiply(*contact.radial, T_c), damping, all_values);
    result.kernel        = contact.kernel;
    return result;
  }

  CoupledSystem with_values(CoupledSystem system, const ParameterValues &others)
  {
    for (const auto &[name, value] : others)
      system.values[name] = value;
    return system;
  }

  CoupledSystem undamped(CoupledSystem system)
  {
    auto &terms = system.terms;
    terms.erase(std::remove_if(terms.begin(), terms.end(), [](const Term &term) { return term.power == 1; }), terms.end());
    return system;
  }

  void add_modal_damping(CoupledSystem             &system,
                         const MultiVector         &modes,
                         const std::vector<double> &eigenvalues,
                         const std::vector<double> &ratios)
  {
    const auto          factor = std::make_shared<LowRankFactor>(*system.mass * modes);
    std::vector<double> coefficients;
    for (std::size_t j = 0; j < eigenvalues.size(); ++j)
      coefficients.push_back(eigenvalues[j] > 0. ? 2. * ratios[j] * std::sqrt(eigenvalues[j]) : 0.);
    system.values[SystemParameter::modal_damping] = coefficients;
    system.terms.push_back(
      low_rank_term(SystemParameter::modal_damping, 1, {}, factor, factor, SystemParameter::modal_damping, TermKind::modal_damping));
  }

  SecondOrderSystem with_friction(const CoupledSystem &system, const double mu)
  {
    return sparse_matrices(system.terms, system.at(mu));
  }

  Matrix pencil_at(const SecondOrderSystem &system, const double shift)
  {
    if (shift == 0.)
      return system.stiffness;
    Matrix result = add(1., *system.stiffness, shift * shift, *system.mass);
    if (system.damping)
      result = add(1., *result, shift, *system.damping);
    return result;
  }

  Matrix normal_reactions(const CoupledSystem &system, const double shift)
  {
    std::vector<std::pair<double, Matrix>> parts;
    for (const Term &term : system.terms)
      if (is_friction(term) && (term.power == 0 || shift != 0.))
        parts.emplace_back(std::pow(shift, term.power) * term.coefficient.at(system.at(-1.)), term.right->sparse_transpose());
    return sum(parts);
  }

  ComplexDenseMatrix normal_reactions(const CoupledSystem                     &system,
                                      const std::vector<std::complex<double>> &lambda,
                                      const MultiVector                       &real_part,
                                      const MultiVector                       &imaginary_part)
  {
    const std::complex<double> i(0., 1.);
    const ParameterValues      values    = system.at(-1.); // −μ A V equals A V at μ = −1
    ComplexDenseMatrix         reactions = ComplexDenseMatrix::Zero(system.n_contact(), lambda.size());
    for (const Term &term : system.terms)
      if (is_friction(term))
        {
          const DenseMatrix re = term.right->transpose_times(real_part), im = term.right->transpose_times(imaginary_part);
          for (Eigen::Index j = 0; j < re.cols(); ++j)
            reactions.col(j) += term.factor(lambda[j], values) * (re.col(j) + i * im.col(j));
        }
    return reactions;
  }

  CoupledSystem coupled_family(const TermFamily &bodies, const ContactOperators &contact, const ContactDamping &damping)
  {
    return couple(bodies.terms, contact, damping, bodies.values);
  }
} // namespace Squeal
