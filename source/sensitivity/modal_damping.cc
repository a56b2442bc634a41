// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/sensitivity/modal_damping.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    /// Relative difference of two frequencies below which g' replaces the divided difference; balances truncation and rounding errors [-].
    constexpr double equal_frequencies = 1e-6;

    /// Highest power of (K_c + s² M_c)⁻¹ M_c.
    constexpr int krylov_steps = 3;

    /// Norm of the component of a unit vector outside a span, below which the vector counts as linearly dependent [-].
    constexpr double dependent = 1e-11;

    bool is_rate(const Term &term)
    {
      return term.power != 1 && term.symmetry == Symmetry::symmetric;
    }
  } // namespace

  void BodyRates::add_along(const std::vector<Term> &terms, const ParameterValues &values, const ParameterValues &rates)
  {
    for (const auto &[parameter, rate] : rates)
      for (const Term &term : terms)
        if (is_rate(term) && term.coefficient.contains(parameter))
          (term.power == 0 ? stiffness : mass).emplace_back(term.coefficient.derivative(parameter, values) * rate.front(), term.matrix);
  }

  void BodyRates::add(const std::vector<Term> &terms, const ParameterValues &values)
  {
    for (const Term &term : terms)
      if (is_rate(term))
        (term.power == 0 ? stiffness : mass).emplace_back(term.coefficient.at(values), term.matrix);
  }

  ModalDampingDerivatives::ModalDampingDerivatives(const CoupledSystem     &undamped,
                                                   const LinearOperator    &inverse,
                                                   const SymmetricModes    &modes,
                                                   const DampingParameters &damping,
                                                   const int                n_damped)
    : system(undamped)
    , inverse(inverse)
    , modes(modes)
    , damping(damping)
    , n_damped(n_damped)
    , M_modes(*undamped.mass * *modes.vectors)
    , apart(*undamped.kernel * *modes.vectors)
  {
    const auto n = static_cast<int>(modes.eigenvalues.size());
    for (int j = 0; j < n; ++j)
      {
        const double omega = std::sqrt(modes.eigenvalues[j]);
        d.push_back(j < n_damped ? 2. * damping.modal_ratio(hertz(omega)) * omega : 0.);
      }
    if (n_damped > 0 && n_damped < n)
      if (const double last = std::sqrt(modes.eigenvalues[n_damped - 1]), next = std::sqrt(modes.eigenvalues[n_damped]);
          next - last <= equal_frequencies * next)
        throw SolverError(text("the band ends between two modes of equal frequency, ", hertz(last), " Hz, and only one of them is damped"),
                          "derivatives of modal damping", "change Band/Maximum frequency slightly");
    const auto divided_difference = [&](const int i, const int j) {
      const double a = std::sqrt(modes.eigenvalues[i]), b = std::sqrt(modes.eigenvalues[j]), mean = 0.5 * (a + b);
      if (std::abs(a - b) > equal_frequencies * mean)
        return (d[i] - d[j]) / ((a - b) * (a + b));
      if (d[i] == 0. && d[j] == 0.)
        return 0.;
      // d(2 ζ ω)/d(ω²) = ζ/ω + dζ/dω
      const double step  = equal_frequencies * mean;
      const auto   ratio = [&](const double omega) { return damping.modal_ratio(hertz(omega)); };
      return ratio(mean) / mean + (ratio(mean + step) - ratio(mean - step)) / (2. * step);
    };
    g.resize(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        g(i, j) = divided_difference(i, j);
  }

  std::vector<double> ModalDampingDerivatives::rates_of_ratio(const int number) const
  {
    // Evaluate 2 ζ ω, which is linear in the ratios, for one ratio of 1 and the other ratios 0
    DampingParameters unit = damping;
    for (int i = 0; i < static_cast<int>(unit.modal_ratios.size()); ++i)
      unit.modal_ratios[i].ratio = i == number ? 1. : 0.;
    std::vector<double> result;
    for (int j = 0; j < n_damped; ++j)
      {
        const double omega = std::sqrt(modes.eigenvalues[j]);
        result.push_back(2. * omega * unit.modal_ratio(hertz(omega)));
      }
    return result;
  }

  DenseMatrix ModalDampingDerivatives::between_modes(const BodyRates::Sum &sum) const
  {
    const auto  n      = static_cast<Eigen::Index>(modes.eigenvalues.size());
    DenseMatrix result = DenseMatrix::Zero(n, n);
    for (const auto &[factor, matrix] : sum)
      {
        auto found = forms.find(matrix);
        if (found == forms.end())
          found = forms.emplace(matrix, gram(apart, *matrix * apart)).first;
        result += factor * found->second;
      }
    return result;
  }

  std::vector<ComplexDenseMatrix> ModalDampingDerivatives::along(const std::vector<BodyRates> &directions,
                                                                 const Eigentriples           &vectors) const
  {
    const auto        k   = static_cast<Eigen::Index>(vectors.lambda.size());
    const MultiVector all = join({&vectors.left, &vectors.right});
    const DenseMatrix Y   = gram(M_modes, all);
    const auto        n   = static_cast<Eigen::Index>(modes.eigenvalues.size());

    // Components of ψ and φ outside the modes, and the responses to these components
    std::vector<MultiVector> powers = {all - *modes.vectors * Y};
    for (int step = 0; step < krylov_steps; ++step)
      {
        const MultiVector load = *system.mass * powers.back();
        MultiVector       next(all.map(), all.n_columns());
        inverse.apply(load, next);
        powers.push_back(next - *modes.vectors * gram(M_modes, next));
      }
    const auto rest = orthonormalize_if_any(*system.mass, modes.vectors.get(), join_all(powers), dependent);

    // Coordinates of ψ and φ in the modes, and in Ritz vectors of the components outside them
    std::vector<double>          squares;
    DenseMatrix                  Z = Y;
    std::unique_ptr<MultiVector> ritz;
    if (rest)
      {
        const auto [values, axes] = agreed(all.communicator(), symmetric_eigenpairs(gram(*rest, *system.stiffness * *rest))); // ascending
        squares                   = values;
        ritz                      = std::make_unique<MultiVector>(*rest * axes);
        Z.conservativeResize(n + static_cast<Eigen::Index>(squares.size()), Eigen::NoChange);
        Z.bottomRows(static_cast<Eigen::Index>(squares.size())) = gram(*ritz, *system.mass * all);
      }
    const auto               m   = static_cast<Eigen::Index>(squares.size());
    const ComplexDenseMatrix psi = from_halves(Z.leftCols(2 * k)), phi = from_halves(Z.rightCols(2 * k));

    // Coefficients of K' and M' between two modes, and between a mode and a Ritz vector
    const Eigen::Map<const Eigen::VectorXd> s(modes.eigenvalues.data(), n), damped(d.data(), n);
    const DenseMatrix                       half_sum = 0.5 * (damped.replicate(1, n) + damped.transpose().replicate(n, 1));
    const DenseMatrix                       g_M      = half_sum - 0.5 * g.cwiseProduct(s.replicate(1, n) + s.transpose().replicate(n, 1));
    DenseMatrix                             h(n, m), h_M(n, m);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < m; ++j)
        {
          h(i, j)   = d[i] / (s[i] - squares[j]);
          h_M(i, j) = 0.5 * d[i] - 0.5 * (s[i] + squares[j]) * h(i, j);
        }

    const MultiVector               ritz_apart = *system.kernel * (ritz ? *ritz : MultiVector(all.map(), 0));
    std::vector<ComplexDenseMatrix> result;
    for (const BodyRates &direction : directions)
      {
        const auto beyond = [&](const BodyRates::Sum &sum) {
          MultiVector X(ritz_apart.map(), ritz_apart.n_columns());
          for (const auto &[factor, matrix] : sum)
            X += factor * (*matrix * ritz_apart);
          return gram(apart, X);
        };
        const DenseMatrix  within = between_modes(direction.stiffness).cwiseProduct(g) + between_modes(direction.mass).cwiseProduct(g_M);
        ComplexDenseMatrix C      = psi.topRows(n).transpose() * within * phi.topRows(n);
        if (m > 0)
          {
            const DenseMatrix across = beyond(direction.stiffness).cwiseProduct(h) + beyond(direction.mass).cwiseProduct(h_M);
            C += psi.topRows(n).transpose() * across * phi.bottomRows(m);
            C += psi.bottomRows(m).transpose() * across.transpose() * phi.topRows(n);
          }
        result.push_back(std::move(C));
      }
    return result;
  }
} // namespace Squeal
