// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/groups.h>
#include <squeal/base/text.h>
#include <squeal/estimates/reduction_errors.h>
#include <squeal/estimates/mode_groups.h>
#include <squeal/linear_algebra/communication.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Weight of individual MAC-M relative to the share in the span of the cluster [-].
    constexpr double member_weight = 0.1;
    /// A reduced mode with a larger |λ̂ − λ| / |λ| becomes a counterpart only if there is no other candidate [-].
    constexpr double far = 0.3;

    /// |ω̂ − ω| / ω
    double frequency_difference(const Complex &found, const Complex &exact)
    {
      return std::abs(found.imag() - exact.imag()) / exact.imag();
    }

    /// |ξ_1 − ξ_2|
    double divergence_difference(const Complex &lambda_1, const Complex &lambda_2)
    {
      return std::abs(modal_quantities(lambda_1).divergence_rate - modal_quantities(lambda_2).divergence_rate);
    }

    /// Includes a mode in the maxima of a group.
    void add(const ModeError &error, GroupError &group)
    {
      using E = ErrorMeasures;
      for (const auto measure :
           {&E::residual, &E::shape, &E::frequency, &E::divergence, &E::closest_shape, &E::closest_frequency, &E::closest_divergence,
            &E::eigenvalue, &E::subspace, &E::corrected_error, &E::estimated_divergence, &E::corrected_divergence})
        group.*measure = std::max(group.*measure, error.*measure);
      ++group.n_modes;
      group.n_other += error.closest != error.match;
    }
  } // namespace

  ComplexModes undamped_modes(const SymmetricModes &modes)
  {
    ComplexModes result;
    result.n_rigid_body = modes.n_rigid_body;
    const int k         = static_cast<int>(modes.eigenvalues.size()) - modes.n_rigid_body;
    if (k == 0)
      return result;
    for (int j = 0; j < k; ++j)
      result.lambda.emplace_back(0., std::sqrt(modes.eigenvalues[modes.n_rigid_body + j]));
    const MultiVector elastic = view(*modes.vectors, modes.n_rigid_body, k);
    result.real_part          = std::make_shared<MultiVector>(elastic);
    result.imaginary_part     = std::make_shared<MultiVector>(elastic.map(), k);
    result.residuals.assign(modes.residuals.begin() + modes.n_rigid_body, modes.residuals.end());
    return result;
  }

  /// Sets the errors relative to the counterpart and to the mode closest in shape.
  static void set_differences(const Complex              exact,
                              const ReducedModes        &chosen,
                              const EigenvalueEstimates &estimates,
                              const int                  i,
                              const Complex              closest,
                              ModeError                 &error)
  {
    const Complex found = chosen.lambda[i], corrected = found + estimates.corrections[i];
    error.reference            = exact;
    error.reduced              = found;
    error.residual             = estimates.energy_residuals[i];
    error.frequency            = frequency_difference(found, exact);
    error.divergence           = divergence_difference(found, exact);
    error.closest_frequency    = frequency_difference(closest, exact);
    error.closest_divergence   = divergence_difference(closest, exact);
    error.estimated_divergence = divergence_difference(corrected, found);
    error.corrected_divergence = divergence_difference(corrected, exact);
    error.eigenvalue           = std::abs(found - exact) / std::abs(exact);
    error.corrected            = corrected;
    error.corrected_error      = std::abs(corrected - exact) / std::abs(exact);
    error.estimated_error      = estimates.errors[i];
    error.estimate_ratio =
      found != exact ? std::abs(estimates.corrections[i]) / std::abs(found - exact) : std::numeric_limits<double>::infinity();
    error.condition = estimates.conditions[i];
    error.claimed   = estimates.claimed[i];
    error.verdict   = estimates.verdicts[i];
  }

  std::vector<ModeError> reduction_errors(const CoupledSystem  &system,
                                          const UpdatedInverse &inverse,
                                          const ReducedModel   &model,
                                          const ReducedModes   &modes,
                                          const ComplexModes   &reference,
                                          const double          cluster_tolerance)
  {
    return reduction_errors(
      *system.mass, model, modes, reference,
      [&](const ReducedModes &chosen) { return estimate_eigenvalues(chosen, residual_vectors(system, inverse, model, chosen).products()); },
      cluster_tolerance);
  }

  std::vector<ModeError> reduction_errors(const SparseMatrix                                             &mass,
                                          const ReducedModel                                             &model,
                                          const ReducedModes                                             &modes,
                                          const ComplexModes                                             &reference,
                                          const std::function<EigenvalueEstimates(const ReducedModes &)> &estimate,
                                          const double                                                    cluster_tolerance)
  {
    const int k = reference.lambda.size(), n_reduced = modes.lambda.size();
    if (k == 0)
      return {};
    if (n_reduced < k)
      throw SolverError("the reduced model has " + counted(n_reduced, "oscillating mode") + ", fewer than the " + std::to_string(k) +
                          " modes of the reference",
                        "errors of a reduced model", "use a larger basis and all of its modes");

    // M-inner products of reference modes, of reduced modes, and of reference with reduced modes
    const MultiVector        X  = join({reference.real_part.get(), reference.imaginary_part.get()});
    const MultiVector        MX = mass * X;
    const ComplexDenseMatrix A  = hermitian_products(gram(X, MX));
    const ComplexDenseMatrix B  = modes.right.adjoint() * multiply(modes.mass, modes.right);
    const DenseMatrix        XT = gram(MX, model.basis());
    const ComplexDenseMatrix C  = from_halves(append_columns(XT.topRows(k), -XT.bottomRows(k))) * modes.right;

    const auto &lambda  = reference.lambda;
    const auto  cluster = connected_groups(
       k, [&](const int i, const int j) { return std::abs(lambda[i] - lambda[j]) <= cluster_tolerance * std::abs(lambda[i]); });
    const auto members = members_of(cluster);

    // Counterparts: shares in the span of a cluster select the reduced modes, and MAC-M of individual modes assigns them to members
    std::vector<Eigen::RowVectorXd> shares(k); // for each cluster, at the index of its first member
    for (const std::vector<int> &all : members)
      shares[all.front()] = shares_in_span(A(all, all), C(all, Eigen::placeholders::all), B);
    const auto mac  = [&](const int i, const int j) { return std::norm(C(i, j)) / (A(i, i).real() * B(j, j).real()); };
    const auto gain = [&](const int i, const int j) {
      const double distance = std::abs(modes.lambda[j] - lambda[i]) / std::abs(lambda[i]);
      return distance < far ? shares[cluster[i]][j] + member_weight * mac(i, j) : -1.;
    };
    std::vector<int> match = best_assignment(k, n_reduced, gain);
    std::vector<int> closest;
    for (int i = 0; i < k; ++i)
      {
        closest.push_back(0);
        for (int j = 1; j < n_reduced; ++j)
          if (mac(i, j) > mac(i, closest[i]))
            closest[i] = j;
      }
    for (std::vector<int> *choice : {&match, &closest})
      agree(X.communicator(), choice->data(), k); // rounding may decide ties differently on each process
    const ReducedModes        chosen    = selected(modes, match);
    const EigenvalueEstimates estimates = estimate(chosen);

    std::vector<ModeError> errors(k);
    for (const std::vector<int> &all : members)
      {
        std::vector<int> counterparts;
        for (const int i : all)
          counterparts.push_back(match[i]);
        const double angle =
          std::max(0., 1. - squared_cosines(A(all, all), B(counterparts, counterparts), C(all, counterparts)).minCoeff());
        for (const int i : all)
          {
            errors[i].cluster_size = all.size();
            errors[i].subspace     = angle;
          }
      }

    for (int i = 0; i < k; ++i)
      {
        set_differences(lambda[i], chosen, estimates, i, modes.lambda[closest[i]], errors[i]);
        errors[i].match         = match[i];
        errors[i].shape         = std::max(0., 1. - mac(i, match[i]));
        errors[i].closest       = closest[i];
        errors[i].closest_shape = std::max(0., 1. - mac(i, closest[i]));
      }
    return errors;
  }

  std::vector<GroupError> largest_errors(const std::vector<ModeError>                &errors,
                                         const std::vector<std::string>              &groups,
                                         const std::vector<std::vector<std::string>> &joined)
  {
    const auto errors_of = [&](const std::string &name, const std::vector<std::string> &members) {
      GroupError group{{}, name};
      for (std::size_t j = 0; j < errors.size(); ++j)
        if (std::find(members.begin(), members.end(), groups[j]) != members.end())
          add(errors[j], group);
      return group;
    };
    std::vector<std::string> present;
    for (std::size_t j = 0; j < errors.size(); ++j)
      if (std::find(present.begin(), present.end(), groups[j]) == present.end())
        present.push_back(groups[j]);

    std::vector<GroupError> result;
    for (const std::string &group : present)
      result.push_back(errors_of(group, {group}));
    for (const std::vector<std::string> &members : joined)
      if (std::all_of(members.begin(), members.end(),
                      [&](const std::string &member) { return std::find(present.begin(), present.end(), member) != present.end(); }))
        result.push_back(errors_of(boost::algorithm::join(members, " and "), members));
    return result;
  }
} // namespace Squeal
