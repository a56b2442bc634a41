#include <squeal/base/exceptions.h>
#include <squeal/eigen/dense_quadratic.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/reduction/reduced_model.h>
#include <squeal/stability/residual_iteration.h>

#include <Epetra_Vector.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Directions whose M-norm is below this part of the largest are taken for rounding errors.
    constexpr double dependence_tolerance = 1e-8;
    /// Principal axes of the residuals below this part of the largest are left to the next step.
    constexpr double compression_tolerance = 0.02;
    /// λ below this part of the largest frequency count as zero: a defective double zero splits into ± √(rounding).
    constexpr double zero_fraction = 1e-4;
    /// Im λ below this part of the largest frequency counts as zero: a multiple real λ splits into pairs by rounding.
    constexpr double real_fraction = 1e-7;

    DenseMatrix real_part(const ComplexDenseMatrix &X)
    {
      DenseMatrix result(X.n_rows(), X.n_columns());
      std::transform(X.column(), X.column(X.n_columns()), result.column(), [](const Complex &x) { return x.real(); });
      return result;
    }

    DenseMatrix imaginary_part(const ComplexDenseMatrix &X)
    {
      DenseMatrix result(X.n_rows(), X.n_columns());
      std::transform(X.column(), X.column(X.n_columns()), result.column(), [](const Complex &x) { return x.imag(); });
      return result;
    }

    MultiVector solve(const UpdatedInverse &inverse, const MultiVector &F)
    {
      MultiVector U(F.Map(), F.NumVectors());
      inverse.apply_frictionless(F, U);
      return U;
    }

    /// Φ_R with its static responses to friction and damping of first order. That to modal damping, K_c⁻¹ C_m Φ_R, lies in
    /// the span of Φ_R, which are eigenvectors; that to friction from the reactions to damping, μ A V_C, is of second order.
    MultiVector starting_vectors(const CoupledSystem &system, const UpdatedInverse &inverse, const MultiVector &Phi, const double mu)
    {
      // Epetra vectors cannot be assigned in another size: parts are collected first.
      std::vector<MultiVector> parts = {Phi};
      if (mu != 0.)
        {
          parts.push_back(inverse.attachment_modes() * replicate(*system.normal_stiffness * Phi));
          parts.push_back(solve(inverse, transpose_times(*system.normal_stiffness, transpose_times(*system.friction_forces, Phi))));
        }
      if (system.frictionless.damping)
        parts.push_back(solve(inverse, *system.frictionless.damping * Phi));

      std::vector<const MultiVector *> pointers;
      for (const MultiVector &part : parts)
        pointers.push_back(&part);
      return join(pointers);
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

    /// Smaller root of a δ² + b δ = e.
    double smaller_root(const Complex a, const Complex b, const Complex e)
    {
      const Complex root = std::sqrt(b * b + 4. * a * e);
      // 2 e / (b ± root) with the larger denominator does not cancel.
      const Complex denominator = std::abs(b + root) > std::abs(b - root) ? b + root : b - root;
      return std::abs(denominator) > 0. ? std::abs(2. * e / denominator) : 0.;
    }

    /// Principal axes in the M-norm of the columns of X outside of the basis, the small ones left out.
    MultiVector compress(const SparseMatrix &M, const MultiVector &basis, MultiVector X)
    {
      for (unsigned int pass = 0; pass < 2; ++pass)
        multiply_add(-1., basis, gram(basis, M * X), 1., X);
      DenseMatrix  axes    = gram(X, M * X);
      const auto   squares = symmetric_eigenvalues(axes); // ascending
      const int    k       = squares.size();
      const double limit   = compression_tolerance * compression_tolerance * squares.back();
      const int    first   = std::lower_bound(squares.begin(), squares.end(), limit) - squares.begin();
      return X * columns(axes, first, k - first);
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
     * Leaves only oscillating modes among the values: real ones join the
     * others of their kind, zeros, those of rigid-body motions, are taken out.
     * Returns how many zeros there are.
     */
    int separate_real(DenseQuadraticModes &modes, const double largest_frequency)
    {
      // What holds for an oscillating value holds for its conjugate, too
      const double         limit = zero_fraction * largest_frequency;
      std::vector<int>     others;
      std::vector<Complex> values;
      int                  n_zeros = 0;
      for (std::size_t j = 0; j < modes.values.size(); ++j)
        if (const Complex l = modes.values[j]; std::abs(l) <= limit)
          n_zeros += 2;
        else if (std::abs(l.imag()) <= real_fraction * largest_frequency)
          modes.real_values.insert(modes.real_values.end(), 2, l.real());
        else
          {
            others.push_back(static_cast<int>(j));
            values.push_back(l);
          }
      if (values.size() < modes.values.size())
        {
          modes.right  = selected(modes.right, others);
          modes.left   = selected(modes.left, others);
          modes.values = values;
        }

      const auto end = std::remove_if(modes.real_values.begin(), modes.real_values.end(), [limit](const double l) { return std::abs(l) <= limit; });
      n_zeros += static_cast<int>(modes.real_values.end() - end);
      modes.real_values.erase(end, modes.real_values.end());
      std::sort(modes.real_values.begin(), modes.real_values.end());
      return n_zeros;
    }

    struct Estimate
    {
      std::vector<double> errors;                  ///< |δλ| / |λ|
      MultiVector         right, left;             ///< displacement residuals, real then imaginary parts
    };

    Estimate estimate_errors(const CoupledSystem         &system,
                             const UpdatedInverse        &inverse,
                             const ReducedPencil         &pencil,
                             const double                 mu,
                             const DenseQuadraticModes   &pairs,
                             const MultiVector           &T)
    {
      const int         k      = pairs.values.size();
      const auto        force  = [&](const ComplexDenseMatrix &vectors, const bool left) {
        return force_residuals(system, mu, pairs.values, T * real_part(vectors), T * imaginary_part(vectors), left);
      };
      const MultiVector R = force(pairs.right, false), L = force(pairs.left, true);
      Estimate          result{std::vector<double>(k), solve(inverse, R), solve(inverse, L)};

      // L_Fᵀ K_c⁻¹ R_F, without conjugate
      std::vector<double> rr(2 * k), ri(k), ir(k);
      L.Dot(result.right, rr.data());
      view(L, 0, k).Dot(view(result.right, k, k), ri.data());
      view(L, k, k).Dot(view(result.right, 0, k), ir.data());
      for (int j = 0; j < k; ++j)
        {
          const Complex e(rr[j] - rr[k + j], ri[j] + ir[j]);
          const Complex a      = bilinear(pencil.mass, pairs.left, pairs.right, j);
          Complex       b      = 2. * pairs.values[j] * a;
          if (pencil.has_damping)
            b += bilinear(pencil.damping, pairs.left, pairs.right, j);
          result.errors[j] = smaller_root(a, b, e) / std::abs(pairs.values[j]);
        }
      return result;
    }

    /// Columns of the modes that miss the tolerance, right and left, each scaled to its mode.
    MultiVector inaccurate_residuals(const Estimate &estimate, const DenseQuadraticModes &pairs, const double tolerance)
    {
      const int        k = pairs.values.size();
      std::vector<int> chosen;
      for (int j = 0; j < k; ++j)
        if (!(estimate.errors[j] <= tolerance))
          chosen.push_back(j);
      const auto norm = [](const ComplexDenseMatrix &X, const int j) {
        double sum = 0.;
        for (int i = 0; i < X.n_rows(); ++i)
          sum += std::norm(X(i, j));
        return std::sqrt(sum);
      };
      MultiVector X(estimate.right.Map(), 4 * chosen.size());
      int         column = 0;
      for (const int j : chosen)
        {
          // Coefficients in an M-orthonormal basis: their norm is the mode's M-norm.
          const double right = norm(pairs.right, j), left = norm(pairs.left, j);
          X(column++)->Scale(1. / right, *estimate.right(j));
          X(column++)->Scale(1. / right, *estimate.right(k + j));
          X(column++)->Scale(1. / left, *estimate.left(j));
          X(column++)->Scale(1. / left, *estimate.left(k + j));
        }
      return X;
    }
  } // namespace

  ComplexModes residual_iteration(const CoupledSystem            &system,
                                  const UpdatedInverse           &inverse,
                                  const MultiVector              &real_modes,
                                  const double                    mu,
                                  const ResidualIterationOptions &options,
                                  Progress                       &progress)
  {
    const SparseMatrix &M = *system.frictionless.mass;
    ReducedModel        reduced(system);
    reduced.extend(orthonormalize(M, nullptr, starting_vectors(system, inverse, real_modes, mu), dependence_tolerance));

    for (int step = 0;; ++step)
      {
        const ReducedPencil pencil = reduced.at(mu);
        DenseQuadraticModes pairs =
          dense_quadratic_modes(pencil.mass, pencil.has_damping ? &pencil.damping : nullptr, pencil.stiffness, options.largest_frequency);
        const int n_zeros = separate_real(pairs, options.largest_frequency);
        if (pairs.values.empty())
          throw SolverError("no oscillating mode lies in the band", "complex modes", "raise Band/Maximum frequency");
        const Estimate estimate = estimate_errors(system, inverse, pencil, mu, pairs, reduced.basis());
        const double   worst    = *std::max_element(estimate.errors.begin(), estimate.errors.end());

        std::ostringstream state;
        state << reduced.size() << " vectors, estimated error " << worst;
        progress.update(state.str());

        if (worst <= options.tolerance)
          {
            ComplexModes modes;
            modes.lambda           = pairs.values;
            modes.estimated_errors = estimate.errors;
            modes.real_part        = std::make_shared<MultiVector>(reduced.basis() * real_part(pairs.right));
            modes.imaginary_part   = std::make_shared<MultiVector>(reduced.basis() * imaginary_part(pairs.right));
            modes.n_rigid_body     = n_zeros / 2;
            for (const double l : pairs.real_values)
              if (std::abs(l) <= options.largest_frequency)
                modes.overdamped.push_back(l);
            modes.summary          = state.str() + ", " + std::to_string(step) + " growths";
            finish_modes(system, mu, inverse, modes);
            return modes;
          }

        const MultiVector candidates =
          compress(M, reduced.basis(), inaccurate_residuals(estimate, pairs, options.tolerance));
        const auto fresh = orthonormalize_if_any(M, &reduced.basis(), candidates, dependence_tolerance);
        if (!fresh || step == options.maximum_steps || reduced.size() + fresh->NumVectors() > options.maximum_basis)
          {
            std::ostringstream what;
            what << "the residual iteration ends with an estimated error of lambda of " << worst << " where " << options.tolerance
                 << " was asked for (" << reduced.size() << " vectors, " << step << " growths)";
            throw SolverError(what.str(), "complex modes",
                              "raise Complex modes/Maximum basis or Complex modes/Iteration tolerance, or choose the Krylov solver");
          }
        reduced.extend(*fresh);
      }
  }
} // namespace Squeal
