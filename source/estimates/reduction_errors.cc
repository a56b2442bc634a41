#include <squeal/base/assignment.h>
#include <squeal/base/conventions.h>
#include <squeal/base/decision.h>
#include <squeal/base/exceptions.h>
#include <squeal/estimates/reduction_errors.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    const Decision independent("squared norm of a direction of a cluster / largest", 1e-12);
    /// Weight of MAC-M of single modes beside the share in the span of their cluster.
    constexpr double member_weight = 0.1;
    /// |λ̂ − λ| / |λ| beyond which a reduced mode is a counterpart only if there is no other.
    constexpr double far = 0.3;

    /// Xᴴ M Y from the Gram matrix of [Re X, Im X] and [Re Y, Im Y].
    ComplexDenseMatrix hermitian_products(const DenseMatrix &G)
    {
      const Eigen::Index m = G.rows() / 2, n = G.cols() / 2;
      ComplexDenseMatrix result(m, n);
      result.real() = G.topLeftCorner(m, n) + G.bottomRightCorner(m, n);
      result.imag() = G.topRightCorner(m, n) - G.bottomLeftCorner(m, n);
      return result;
    }

    /// W with Wᴴ G W = 1 for a Hermitian positive semidefinite G, without the directions that are rounding errors.
    ComplexDenseMatrix whitening(const ComplexDenseMatrix &G)
    {
      const Eigen::SelfAdjointEigenSolver<ComplexDenseMatrix> pairs(G);
      const Eigen::VectorXd                                  &values = pairs.eigenvalues(); // ascending
      const Eigen::Index                                      n_kept = std::count_if(
                                             values.begin(), values.end(), [&values](const double value) { return independent.exceeded_by(value / values[values.size() - 1]); });
      return pairs.eigenvectors().rightCols(n_kept) * values.tail(n_kept).cwiseSqrt().cwiseInverse().asDiagonal();
    }

    /// sin² of the largest principal angle between two sets of vectors with Gram matrices A and B and products C.
    double largest_angle(const ComplexDenseMatrix &A, const ComplexDenseMatrix &B, const ComplexDenseMatrix &C)
    {
      const ComplexDenseMatrix products = whitening(A).adjoint() * C * whitening(B);
      const ComplexDenseMatrix squares =
        products.cols() <= products.rows() ? ComplexDenseMatrix(products.adjoint() * products) : products * products.adjoint();
      return std::max(0., 1. - squares.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff());
    }

    /// Parts of ψᴴMψ that lie in the span of vectors with Gram matrix A, of which C are the products with all ψ; B those of ψ.
    Eigen::RowVectorXd shares_in_span(const ComplexDenseMatrix &A, const ComplexDenseMatrix &C, const ComplexDenseMatrix &B)
    {
      return (whitening(A).adjoint() * C).colwise().squaredNorm().cwiseQuotient(B.diagonal().real().transpose());
    }

    /// Number of the cluster of each λ: chains of neighbours within the tolerance.
    std::vector<int> clusters(const std::vector<Complex> &lambda, const double tolerance)
    {
      std::vector<int> cluster(lambda.size());
      std::iota(cluster.begin(), cluster.end(), 0);
      for (std::size_t i = 0; i < lambda.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
          if (cluster[i] != cluster[j] && std::abs(lambda[i] - lambda[j]) <= tolerance * std::abs(lambda[i]))
            std::replace(cluster.begin(), cluster.end(), cluster[i], cluster[j]);
      return cluster;
    }

    /// Group of a mode: the @p pins have one of their own.
    std::string group(const ModeLabel &label, const std::string &pins)
    {
      return label.is_of_pins() ? pins : label.family == ModeFamily::unnamed ? to_string(label.family) : "disc";
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
    result.imaginary_part     = std::make_shared<MultiVector>(elastic.Map(), k);
    result.residuals.assign(modes.residuals.begin() + modes.n_rigid_body, modes.residuals.end());
    return result;
  }

  std::vector<ModeError> reduction_errors(const CoupledSystem  &system,
                                          const UpdatedInverse &inverse,
                                          const ReducedModel   &model,
                                          const ReducedModes   &modes,
                                          const ComplexModes   &reference,
                                          const ErrorOptions   &options)
  {
    const int k = reference.lambda.size(), n_reduced = modes.lambda.size();
    if (k == 0)
      return {};
    if (n_reduced < k)
      throw SolverError("the reduced model has " + std::to_string(n_reduced) + " oscillating modes, the reference " + std::to_string(k),
                        "errors of a reduced model", "take a larger basis, and all of its modes");

    // Inner products in the mass of the reference modes, of the reduced ones, and of both
    const MultiVector        X  = join({reference.real_part.get(), reference.imaginary_part.get()});
    const MultiVector        MX = *system.mass * X;
    const ComplexDenseMatrix A  = hermitian_products(gram(X, MX));
    const ComplexDenseMatrix B  = modes.right.adjoint() * multiply(modes.mass, modes.right);
    const DenseMatrix        XT = gram(MX, model.basis());
    const ComplexDenseMatrix C  = from_halves(append_columns(XT.topRows(k), -XT.bottomRows(k))) * modes.right;

    // Clusters
    const std::vector<int>        cluster = clusters(reference.lambda, options.cluster_tolerance);
    std::vector<std::vector<int>> members(k);
    for (int i = 0; i < k; ++i)
      members[cluster[i]].push_back(i);

    // Counterparts: the span of the cluster decides which reduced modes belong to it, MAC-M of single modes to which member
    std::vector<Eigen::RowVectorXd> shares(k);
    for (int c = 0; c < k; ++c)
      if (!members[c].empty())
        shares[c] = shares_in_span(A(members[c], members[c]), C(members[c], Eigen::all), B);
    const auto mac  = [&](const int i, const int j) { return std::norm(C(i, j)) / (A(i, i).real() * B(j, j).real()); };
    const auto gain = [&](const int i, const int j) {
      const double distance = std::abs(modes.lambda[j] - reference.lambda[i]) / std::abs(reference.lambda[i]);
      return distance < far ? shares[cluster[i]][j] + member_weight * mac(i, j) : -1.;
    };
    std::vector<int> match = best_assignment(k, n_reduced, gain);
    X.Comm().Broadcast(match.data(), k, 0); // ties may go either way
    const ReducedModes        chosen    = selected(modes, match);
    const EigenvalueEstimates estimates = estimate_eigenvalues(system, inverse, model, chosen);

    // Angles
    std::vector<double> angle(k);
    for (int c = 0; c < k; ++c)
      if (!members[c].empty())
        {
          std::vector<int> counterparts;
          for (const int i : members[c])
            counterparts.push_back(match[i]);
          angle[c] = largest_angle(A(members[c], members[c]), B(counterparts, counterparts), C(members[c], counterparts));
        }

    std::vector<ModeError> errors;
    for (int i = 0; i < k; ++i)
      {
        const Complex         lambda = reference.lambda[i], found = chosen.lambda[i], corrected = found + estimates.corrections[i];
        const ModalQuantities exact = modal_quantities(lambda), reduced = modal_quantities(found);
        ModeError             error;
        error.reference       = lambda;
        error.reduced         = found;
        error.match           = match[i];
        error.residual        = estimates.energy_residuals[i];
        error.shape           = std::max(0., 1. - mac(i, match[i]));
        error.frequency       = std::abs(found.imag() - lambda.imag()) / lambda.imag();
        error.divergence      = std::abs(reduced.divergence_rate - exact.divergence_rate);
        error.eigenvalue      = std::abs(found - lambda) / std::abs(lambda);
        error.cluster_size    = members[cluster[i]].size();
        error.subspace        = angle[cluster[i]];
        error.corrected       = corrected;
        error.corrected_error = std::abs(corrected - lambda) / std::abs(lambda);
        error.estimated_error = estimates.errors[i];
        error.estimate_ratio =
          found != lambda ? std::abs(estimates.corrections[i]) / std::abs(found - lambda) : std::numeric_limits<double>::infinity();
        error.condition = estimates.conditions[i];
        error.claimed   = estimates.claimed[i];
        error.verdict   = estimates.verdicts[i];
        errors.push_back(error);
      }
    return errors;
  }

  std::vector<std::string> frictionless_groups(const std::vector<ModeLabel> &labels)
  {
    std::vector<std::string> groups;
    for (const ModeLabel &label : labels)
      groups.push_back(group(label, shape_text(label)));
    return groups;
  }

  std::vector<std::string> friction_groups(const std::vector<ModeLabel> &labels, const std::vector<bool> &unstable)
  {
    std::vector<std::string> groups;
    for (std::size_t j = 0; j < labels.size(); ++j)
      groups.push_back(group(labels[j], unstable[j] ? "unstable pins" : "other pins"));
    return groups;
  }

  std::vector<GroupError> largest_errors(const std::vector<ModeError> &errors, const std::vector<std::string> &groups)
  {
    std::vector<GroupError> result;
    for (std::size_t j = 0; j < errors.size(); ++j)
      {
        auto it = std::find_if(result.begin(), result.end(), [&](const GroupError &group) { return group.group == groups[j]; });
        if (it == result.end())
          it = result.insert(result.end(), GroupError{groups[j], 0, 0., 0., 0., 0., 0., 0., 0., 0., 0.});
        ++it->n_modes;
        const auto raise = [](double &largest, const double value) { largest = std::max(largest, value); };
        raise(it->residual, errors[j].residual);
        raise(it->shape, errors[j].shape);
        raise(it->frequency, errors[j].frequency);
        raise(it->divergence, errors[j].divergence);
        raise(it->eigenvalue, errors[j].eigenvalue);
        raise(it->subspace, errors[j].subspace);
        raise(it->corrected_error, errors[j].corrected_error);
        const double corrected = modal_quantities(errors[j].corrected).divergence_rate;
        raise(it->estimated_divergence, std::abs(corrected - modal_quantities(errors[j].reduced).divergence_rate));
        raise(it->corrected_divergence, std::abs(corrected - modal_quantities(errors[j].reference).divergence_rate));
      }
    return result;
  }
} // namespace Squeal
