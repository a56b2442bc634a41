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

    /// λ below this part of the largest frequency count as zero: a defective double zero splits into ± √(rounding).
    constexpr double zero_fraction = 1e-4;
    /// Im λ below this part of the largest frequency counts as zero: a multiple real λ splits into pairs by rounding.
    constexpr double real_fraction = 1e-7;
    /// Estimates of ill-conditioned eigenvalues are not claimed.
    constexpr double largest_condition = 1e3;
    /// An estimated error may be that much too small.
    constexpr double safety = 3.;
    /// Divergence rates below this are rounding errors of a neutral mode [-].
    constexpr double negligible_divergence = 1e-8;

    DenseMatrix part(const ComplexDenseMatrix &X, double (*of)(const Complex &))
    {
      DenseMatrix result(X.n_rows(), X.n_columns());
      std::transform(X.column(), X.column(X.n_columns()), result.column(), of);
      return result;
    }

    DenseMatrix real_part(const ComplexDenseMatrix &X)
    {
      return part(X, [](const Complex &x) { return x.real(); });
    }

    DenseMatrix imaginary_part(const ComplexDenseMatrix &X)
    {
      return part(X, [](const Complex &x) { return x.imag(); });
    }

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

    /**
     * Leaves only oscillating modes: real values of rounding join the others
     * of their kind, zeros, those of rigid-body motions, are counted.
     */
    void separate_real(ReducedModes &modes, const double largest_frequency)
    {
      // What holds for an oscillating value holds for its conjugate, too
      const double     limit = zero_fraction * largest_frequency;
      std::vector<int> others;
      for (std::size_t j = 0; j < modes.lambda.size(); ++j)
        if (const Complex l = modes.lambda[j]; std::abs(l) <= limit)
          modes.n_zeros += 2;
        else if (std::abs(l.imag()) <= real_fraction * largest_frequency)
          modes.real_values.insert(modes.real_values.end(), 2, l.real());
        else
          others.push_back(static_cast<int>(j));
      if (others.size() < modes.lambda.size())
        modes = selected(modes, others);

      auto      &values = modes.real_values;
      const auto end    = std::remove_if(values.begin(), values.end(), [limit](const double l) { return std::abs(l) <= limit; });
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

    double band_limit(const double largest_frequency, const BandEnd end)
    {
      return end == BandEnd::cut ? largest_frequency : std::numeric_limits<double>::infinity();
    }

    /// ψᵀ A φ for complex columns j, no conjugate.
    Complex bilinear(const DenseMatrix &A, const ComplexDenseMatrix &psi, const ComplexDenseMatrix &phi, const int j)
    {
      Complex sum = 0.;
      for (int c = 0; c < A.n_columns(); ++c)
        {
          Complex row = 0.;
          for (int r = 0; r < A.n_rows(); ++r)
            row += psi(r, j) * A(r, c);
          sum += row * phi(c, j);
        }
      return sum;
    }

    /// xᴴ A x of column j for symmetric A.
    double square(const DenseMatrix &A, const ComplexDenseMatrix &X, const int j)
    {
      double sum = 0.;
      for (int c = 0; c < A.n_columns(); ++c)
        {
          Complex row = 0.;
          for (int r = 0; r < A.n_rows(); ++r)
            row += std::conj(X(r, j)) * A(r, c);
          sum += (row * X(c, j)).real();
        }
      return sum;
    }

    /// Smaller root of a δ² + b δ = e.
    Complex smaller_root(const Complex a, const Complex b, const Complex e)
    {
      const Complex root = std::sqrt(b * b + 4. * a * e);
      // 2 e / (b ± root) with the larger denominator does not cancel.
      const Complex denominator = std::abs(b + root) > std::abs(b - root) ? b + root : b - root;
      return std::abs(denominator) > 0. ? 2. * e / denominator : 0.;
    }

    /// L_iᵀ K_c⁻¹ R_j, no conjugate, from real and imaginary halves.
    ComplexDenseMatrix products(const MultiVector &L, const MultiVector &U)
    {
      const DenseMatrix  G = gram(L, U);
      const int          k = L.NumVectors() / 2;
      ComplexDenseMatrix result(k, k);
      for (int j = 0; j < k; ++j)
        for (int i = 0; i < k; ++i)
          result(i, j) = {G(i, j) - G(k + i, k + j), G(i, k + j) + G(k + i, j)};
      return result;
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

  ReducedModes reduced_modes(const ReducedModel &model, const double mu, const double largest_frequency, const BandEnd end)
  {
    ReducedModes modes;
    modes.friction_coefficient = mu;
    modes.pencil               = model.at(mu);
    ReducedPencil symmetric    = model.at(0.);
    modes.mass                 = std::move(symmetric.mass);
    modes.stiffness            = std::move(symmetric.stiffness);

    DenseQuadraticModes found = dense_quadratic_modes(modes.pencil.mass, modes.pencil.has_damping ? &modes.pencil.damping : nullptr,
                                                      modes.pencil.stiffness, band_limit(largest_frequency, end));
    modes.lambda              = std::move(found.values);
    modes.right               = std::move(found.right);
    modes.left                = std::move(found.left);
    modes.real_values         = std::move(found.real_values);
    separate_real(modes, largest_frequency);
    agree_on_modes(model.basis().Comm(), modes);
    return modes;
  }

  ReducedModes reduced_real_modes(const ReducedModel &model, const double largest_frequency, const BandEnd end)
  {
    ReducedModes modes;
    modes.pencil             = model.at(0.);
    modes.pencil.damping     = DenseMatrix();
    modes.pencil.has_damping = false;
    modes.mass               = modes.pencil.mass;
    modes.stiffness          = modes.pencil.stiffness;

    DenseMatrix               vectors = modes.stiffness;
    const std::vector<double> squares = symmetric_eigenvalues(vectors, modes.mass);
    const double              limit   = band_limit(largest_frequency, end), zero = zero_fraction * largest_frequency;
    std::vector<int>          kept;
    for (std::size_t j = 0; j < squares.size(); ++j)
      if (squares[j] <= zero * zero)
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

  EigenvalueEstimates
  estimate_eigenvalues(const CoupledSystem &system, const UpdatedInverse &inverse, const ReducedModel &model, const ReducedModes &modes)
  {
    const int         k     = modes.lambda.size();
    const MultiVector &T    = model.basis();
    const auto        force = [&](const ComplexDenseMatrix &vectors, const bool left) {
      return force_residuals(system, modes.friction_coefficient, modes.lambda, T * real_part(vectors), T * imaginary_part(vectors), left);
    };
    const MultiVector   R = force(modes.right, false), L = force(modes.left, true);
    EigenvalueEstimates result{{}, {}, {}, {}, {}, {}, {}, solve(inverse, R), solve(inverse, L)};

    // Residual energies R_Uᴴ R_F
    std::vector<double> energies(2 * k);
    R.Dot(result.right, energies.data());

    // δλ and κ
    const ComplexDenseMatrix E = products(L, result.right);
    std::vector<Complex>     derivatives(k);
    for (int j = 0; j < k; ++j)
      {
        const Complex lambda = modes.lambda[j];
        const Complex a      = bilinear(modes.pencil.mass, modes.left, modes.right, j);
        Complex       b      = 2. * lambda * a;
        if (modes.pencil.has_damping)
          b += bilinear(modes.pencil.damping, modes.left, modes.right, j);
        derivatives[j] = b;
        result.corrections.push_back(smaller_root(a, b, E(j, j)));
        result.errors.push_back(std::abs(result.corrections[j]) / std::abs(lambda));
        const double norms = std::sqrt(square(modes.mass, modes.left, j) * square(modes.mass, modes.right, j));
        result.conditions.push_back(std::abs(b) > 0. ? 2. * std::abs(lambda) * norms / std::abs(b) : std::numeric_limits<double>::infinity());
        result.energy_residuals.push_back((energies[j] + energies[k + j]) / square(modes.stiffness, modes.right, j));
      }

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
    finish_modes(system, modes.friction_coefficient, inverse, result);
    return result;
  }
} // namespace Squeal
