#include <squeal/base/conventions.h>
#include <squeal/base/decision.h>
#include <squeal/eigen/dense_quadratic.h>
#include <squeal/stability/reduced_modes.h>

#include <Epetra_Comm.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// A defective double zero splits into ± √(rounding).
    const Decision nonzero("|lambda| of a reduced mode / end of the band", zero_frequency);
    /// A multiple real λ splits into pairs by rounding.
    const Decision oscillating("Im lambda of a reduced mode / end of the band", 1e-7);
    /// Estimates of ill-conditioned eigenvalues are not claimed.
    constexpr double largest_condition = 1e3;
    /// An estimated error may be that much too small.
    constexpr double safety = 3.;

    MultiVector solve(const UpdatedInverse &inverse, const MultiVector &F)
    {
      MultiVector U(F.Map(), F.NumVectors());
      inverse.apply_frictionless(F, U);
      return U;
    }

    /// Columns of X.
    ComplexDenseMatrix selected(const ComplexDenseMatrix &X, const std::vector<int> &chosen)
    {
      ComplexDenseMatrix result(X.n_rows(), static_cast<int>(chosen.size()));
      for (std::size_t j = 0; j < chosen.size(); ++j)
        std::copy(X.column(chosen[j]), X.column(chosen[j]) + X.n_rows(), result.column(static_cast<int>(j)));
      return result;
    }

    bool is_real(const Complex lambda, const double largest_frequency)
    {
      return !oscillating.exceeded_by(std::abs(lambda.imag()) / largest_frequency);
    }

    /**
     * Leaves only oscillating modes: real values of rounding join the others
     * of their kind, zeros, those of rigid-body motions, are counted.
     */
    void separate_real(ReducedModes &modes, const double largest_frequency)
    {
      // What holds for an oscillating value holds for its conjugate, too
      std::vector<int> others;
      for (std::size_t j = 0; j < modes.lambda.size(); ++j)
        if (const Complex l = modes.lambda[j]; !nonzero.exceeded_by(std::abs(l) / largest_frequency))
          modes.n_zeros += 2;
        else if (is_real(l, largest_frequency))
          modes.real_values.insert(modes.real_values.end(), 2, l.real());
        else
          others.push_back(static_cast<int>(j));
      if (others.size() < modes.lambda.size())
        modes = selected(modes, others);

      auto      &values = modes.real_values;
      const auto end =
        std::remove_if(values.begin(), values.end(), [&](const double l) { return !nonzero.exceeded_by(std::abs(l) / largest_frequency); });
      modes.n_zeros += static_cast<int>(values.end() - end);
      values.erase(end, values.end());
      std::sort(values.begin(), values.end());
    }

    /// Replaces the modes by those of process 0: vectors of a multiple eigenvalue may differ between processes.
    void agree_on_modes(const Epetra_Comm &comm, ReducedModes &modes)
    {
      if (comm.NumProc() == 1)
        return;
      const int r         = modes.mass.n_rows();
      int       counts[3] = {static_cast<int>(modes.lambda.size()), static_cast<int>(modes.real_values.size()), modes.n_zeros};
      comm.Broadcast(counts, 3, 0);
      const int k = counts[0];
      modes.lambda.resize(k);
      modes.real_values.resize(counts[1]);
      modes.n_zeros = counts[2];
      if (modes.right.n_columns() != k)
        modes.right = modes.left = ComplexDenseMatrix(r, k);
      const auto broadcast = [&](Complex *values, const int n) { comm.Broadcast(reinterpret_cast<double *>(values), 2 * n, 0); };
      broadcast(modes.lambda.data(), k);
      broadcast(modes.right.column(), r * k);
      broadcast(modes.left.column(), r * k);
      comm.Broadcast(modes.real_values.data(), counts[1], 0);
    }

    /// Every eigenvalue that dense_quadratic_modes() gives.
    ReducedModes all_modes(const ReducedModel    &model,
                           const ParameterValues &values,
                           const double           largest_frequency,
                           const RealVectors      real_vectors)
    {
      ReducedModes modes;
      modes.values    = values;
      modes.pencil    = model.at(values);
      modes.mass      = model.mass();
      modes.stiffness = model.stiffness();

      DenseQuadraticModes found = dense_quadratic_modes(modes.pencil.mass, modes.pencil.has_damping ? &modes.pencil.damping : nullptr,
                                                        modes.pencil.stiffness, largest_frequency, real_vectors);
      modes.lambda              = std::move(found.values);
      modes.right               = std::move(found.right);
      modes.left                = std::move(found.left);
      modes.real_values         = std::move(found.real_values);
      return modes;
    }

    double band_limit(const double largest_frequency, const BandEnd end)
    {
      return end == BandEnd::cut ? largest_frequency : std::numeric_limits<double>::infinity();
    }

    /// ψ_jᵀ A φ_j for every column, no conjugate; null A counts as zero.
    std::vector<Complex> bilinear(const DenseMatrix *A, const ComplexDenseMatrix &psi, const ComplexDenseMatrix &phi)
    {
      std::vector<Complex> result(phi.n_columns());
      if (A == nullptr)
        return result;
      const ComplexDenseMatrix A_phi = multiply(*A, phi);
      for (int j = 0; j < phi.n_columns(); ++j)
        for (int i = 0; i < phi.n_rows(); ++i)
          result[j] += psi(i, j) * A_phi(i, j);
      return result;
    }

    /// x_jᴴ A x_j for every column, A symmetric.
    std::vector<double> squares(const DenseMatrix &A, const ComplexDenseMatrix &X)
    {
      const ComplexDenseMatrix AX = multiply(A, X);
      std::vector<double>      result(X.n_columns());
      for (int j = 0; j < X.n_columns(); ++j)
        for (int i = 0; i < X.n_rows(); ++i)
          result[j] += (std::conj(X(i, j)) * AX(i, j)).real();
      return result;
    }

    /// Smaller root of a δ² + b δ = e.
    Complex smaller_root(const Complex a, const Complex b, const Complex e)
    {
      const Complex root = std::sqrt(b * b + 4. * a * e);
      // 2 e / (b ± root) with the larger denominator does not cancel.
      const Complex denominator = std::abs(b + root) > std::abs(b - root) ? b + root : b - root;
      return std::abs(denominator) > 0. ? 2. * e / denominator : 0.;
    }

    Verdict verdict(const Complex lambda, const double uncertainty, const bool well_conditioned, const bool neutral)
    {
      const double negligible = negligible_divergence * lambda.imag();
      if (!well_conditioned)
        return Verdict::undecided;
      if (lambda.real() - safety * uncertainty > negligible)
        return Verdict::unstable;
      if (lambda.real() + safety * uncertainty <= negligible || (neutral && lambda.real() <= negligible))
        return Verdict::stable;
      return Verdict::undecided;
    }
  } // namespace

  ReducedModes local_reduced_modes(const ReducedModel    &model,
                                   const ParameterValues &values,
                                   const double           largest_frequency,
                                   const BandEnd          end)
  {
    ReducedModes modes = all_modes(model, values, band_limit(largest_frequency, end), RealVectors::none);
    separate_real(modes, largest_frequency);
    return modes;
  }

  ReducedModes reduced_modes(const ReducedModel &model, const double mu, const double largest_frequency, const BandEnd end)
  {
    ReducedModes modes = local_reduced_modes(model, model.full_order().at(mu), largest_frequency, end);
    agree_on_modes(model.basis().Comm(), modes);
    return modes;
  }

  ReducedModes real_eigenvalue_modes(const ReducedModel &model, const double mu, const double largest_frequency, const double radius)
  {
    ReducedModes     modes = all_modes(model, model.full_order().at(mu), largest_frequency, RealVectors::wanted);
    std::vector<int> real;
    for (std::size_t j = 0; j < modes.lambda.size(); ++j)
      if (const double size = std::abs(modes.lambda[j]);
          is_real(modes.lambda[j], largest_frequency) && size > zero_frequency * largest_frequency && size <= radius)
        real.push_back(static_cast<int>(j));
    modes = selected(modes, real);
    agree_on_modes(model.basis().Comm(), modes);
    return modes;
  }

  ReducedModes reduced_real_modes(const ReducedModel &model, const double largest_frequency, const BandEnd end)
  {
    ReducedModes modes;
    modes.values    = model.full_order().values;
    modes.mass      = model.mass();
    modes.stiffness = model.stiffness();
    modes.pencil    = {modes.mass, DenseMatrix(), modes.stiffness, false};

    DenseMatrix               vectors = modes.stiffness;
    const std::vector<double> squares = symmetric_eigenvalues(vectors, modes.mass);
    const double              limit   = band_limit(largest_frequency, end);
    std::vector<int>          kept;
    for (std::size_t j = 0; j < squares.size(); ++j)
      if (!nonzero.exceeded_by(std::sqrt(std::max(squares[j], 0.)) / largest_frequency))
        modes.n_zeros += 2;
      else if (squares[j] <= limit * limit)
        {
          kept.push_back(static_cast<int>(j));
          modes.lambda.emplace_back(0., std::sqrt(squares[j]));
        }
    modes.right = ComplexDenseMatrix(vectors.n_rows(), static_cast<int>(kept.size()));
    for (std::size_t j = 0; j < kept.size(); ++j)
      std::copy(vectors.column(kept[j]), vectors.column(kept[j]) + vectors.n_rows(), modes.right.column(static_cast<int>(j)));
    modes.left = modes.right;
    agree_on_modes(model.basis().Comm(), modes);
    return modes;
  }

  ReducedModes selected(const ReducedModes &modes, const std::vector<int> &chosen)
  {
    ReducedModes result = modes;
    result.lambda.clear();
    for (const int j : chosen)
      result.lambda.push_back(modes.lambda[j]);
    result.right = selected(modes.right, chosen);
    result.left  = selected(modes.left, chosen);
    return result;
  }

  ResidualVectors residual_vectors(const CoupledSystem  &system,
                                   const UpdatedInverse &inverse,
                                   const ReducedModel   &model,
                                   const ReducedModes   &modes)
  {
    const MultiVector &T     = model.basis();
    const auto         force = [&](const ComplexDenseMatrix &vectors, const bool left) {
      return force_residuals(system, modes.values, modes.lambda, T * real_part(vectors), T * imaginary_part(vectors), left);
    };
    const MultiVector R = force(modes.right, false), L = force(modes.left, true);
    return {R, L, solve(inverse, R), solve(inverse, L)};
  }

  ResidualProducts ResidualVectors::products() const
  {
    const auto energies = [](const MultiVector &F, const MultiVector &U) {
      const int           k = F.NumVectors() / 2;
      std::vector<double> result(2 * k);
      F.Dot(U, result.data());
      for (int j = 0; j < k; ++j)
        result[j] += result[k + j];
      result.resize(k);
      return result;
    };
    return {from_halves(gram(left_forces, right_displacements)), energies(right_forces, right_displacements),
            energies(left_forces, left_displacements)};
  }

  EigenvalueEstimates estimate_eigenvalues(const CoupledSystem  &system,
                                           const UpdatedInverse &inverse,
                                           const ReducedModel   &model,
                                           const ReducedModes   &modes)
  {
    return estimate_eigenvalues(modes, residual_vectors(system, inverse, model, modes).products());
  }

  EigenvalueEstimates estimate_eigenvalues(const ReducedModes &modes, const ResidualProducts &products)
  {
    const int                 k = modes.lambda.size();
    const ComplexDenseMatrix &E = products.coupling;
    EigenvalueEstimates       result;

    // δλ and κ
    const auto           mass        = bilinear(&modes.pencil.mass, modes.left, modes.right);
    const auto           damping     = bilinear(modes.pencil.has_damping ? &modes.pencil.damping : nullptr, modes.left, modes.right);
    const auto           left_masses = squares(modes.mass, modes.left), right_masses = squares(modes.mass, modes.right);
    const auto           left_stiffnesses = squares(modes.stiffness, modes.left), right_stiffnesses = squares(modes.stiffness, modes.right);
    std::vector<Complex> derivatives(k);
    for (int j = 0; j < k; ++j)
      {
        const Complex lambda = modes.lambda[j], b = 2. * lambda * mass[j] + damping[j];
        derivatives[j] = b;
        result.corrections.push_back(smaller_root(mass[j], b, E(j, j)));
        result.errors.push_back(std::abs(result.corrections[j]) / std::abs(lambda));
        const double norms = std::sqrt(left_masses[j] * right_masses[j]);
        result.conditions.push_back(std::abs(b) > 0. ? 2. * std::abs(lambda) * norms / std::abs(b) :
                                                       std::numeric_limits<double>::infinity());
        result.energy_residuals.push_back(products.right_energies[j] / right_stiffnesses[j]);
        result.left_residuals.push_back(products.left_energies[j] / left_stiffnesses[j]);
      }
    result.couplings = E;
    for (int j = 0; j < k; ++j)
      for (int i = 0; i < k; ++i)
        result.couplings(i, j) /= derivatives[i];

    // Modes that may coalesce
    for (int i = 0; i < k; ++i)
      {
        bool   alone = true, apart = true;
        double uncertainty = std::abs(result.corrections[i]);
        for (int j = 0; j < k; ++j)
          {
            // Two neutral modes may meet where their errors differ by more than what separates them
            const double shift = safety * std::abs(result.corrections[i] - result.corrections[j]);
            if (shift >= std::abs(modes.lambda[i] - modes.lambda[j]) && shift > negligible_divergence * std::abs(modes.lambda[i]))
              apart = false;
            if (j != i && 4. * safety * safety * std::abs(E(i, j) * E(j, i)) >=
                            std::norm(modes.lambda[i] - modes.lambda[j]) * std::abs(derivatives[i] * derivatives[j]))
              {
                alone = false;
                uncertainty += std::abs(E(i, j)) / std::abs(derivatives[i]);
              }
          }
        const bool well_conditioned = result.conditions[i] <= largest_condition;
        result.claimed.push_back(alone && well_conditioned);
        result.uncertainties.push_back(uncertainty);
        result.verdicts.push_back(verdict(modes.lambda[i], uncertainty, well_conditioned, alone && apart && !modes.pencil.has_damping));
      }
    return result;
  }

  ComplexModes full_order_modes(const CoupledSystem       &system,
                                const UpdatedInverse      &inverse,
                                const ReducedModel        &model,
                                const ReducedModes        &modes,
                                const EigenvalueEstimates *estimates)
  {
    const auto   full = [&](const DenseMatrix &coefficients) { return std::make_shared<MultiVector>(model.basis() * coefficients); };
    ComplexModes result;
    result.lambda              = modes.lambda;
    result.real_part           = full(real_part(modes.right));
    result.imaginary_part      = full(imaginary_part(modes.right));
    result.left_real_part      = full(real_part(modes.left));
    result.left_imaginary_part = full(imaginary_part(modes.left));
    result.n_rigid_body        = modes.n_zeros / 2;
    if (estimates != nullptr)
      result.estimated_errors = estimates->errors;
    finish_modes(system, modes.values, inverse, result);
    return result;
  }
} // namespace Squeal
