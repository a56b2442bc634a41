#include <squeal/base/decision.h>
#include <squeal/eigen/dense_quadratic.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Corrections larger than this fraction of |λ| mean that ψᵀQ'(λ)φ vanishes: the value is defective.
    constexpr double largest_correction = 1e-6;
    /// λ oscillates; below, it is real.
    const Decision oscillating("Im / modulus of an eigenvalue of a dense quadratic problem", 1e-12);

    double frobenius_norm(const DenseMatrix &A)
    {
      double sum = 0.;
      for (int j = 0; j < A.n_columns(); ++j)
        for (int i = 0; i < A.n_rows(); ++i)
          sum += A(i, j) * A(i, j);
      return std::sqrt(sum);
    }

    /// The root of a real or complex square with Im λ ≥ 0.
    Complex upper_root(const Complex square)
    {
      if (square.imag() == 0.)
        return square.real() < 0. ? Complex(0., std::sqrt(-square.real())) : Complex(std::sqrt(square.real()), 0.);
      const Complex root = std::sqrt(square);
      return root.imag() < 0. ? -root : root;
    }

    /// ‖x‖₂ = 1, entry of largest modulus real and positive; ties to the first.
    void normalize(Complex *x, const int n)
    {
      double sum = 0., largest = 0.;
      for (int i = 0; i < n; ++i)
        {
          sum += std::norm(x[i]);
          largest = std::max(largest, std::abs(x[i]));
        }
      const Complex *pivot = std::find_if(x, x + n, [largest](const Complex &y) { return std::abs(y) >= (1. - 1e-8) * largest; });
      if (!(sum > 0.))
        return;
      const Complex factor = std::conj(*pivot) / (std::abs(*pivot) * std::sqrt(sum));
      std::for_each(x, x + n, [factor](Complex &y) { y *= factor; });
    }

    /// One step λ -= ψᵀQ(λ)φ / ψᵀQ'(λ)φ for each triple.
    void correct(DenseQuadraticModes &modes, const DenseMatrix &M, const DenseMatrix *C, const DenseMatrix &K)
    {
      const ComplexDenseMatrix m = multiply(M, modes.right), k = multiply(K, modes.right);
      const ComplexDenseMatrix c = C != nullptr ? multiply(*C, modes.right) : ComplexDenseMatrix(m.n_rows(), m.n_columns());
      for (std::size_t j = 0; j < modes.values.size(); ++j)
        {
          const Complex lambda = modes.values[j];
          Complex       value = 0., derivative = 0.;
          for (int i = 0; i < m.n_rows(); ++i)
            {
              const Complex psi = modes.left(i, j);
              value += psi * (lambda * (lambda * m(i, j) + c(i, j)) + k(i, j));
              derivative += psi * (2. * lambda * m(i, j) + c(i, j));
            }
          if (std::abs(value) < largest_correction * std::abs(lambda) * std::abs(derivative))
            modes.values[j] -= value / derivative;
        }
    }
  } // namespace

  DenseQuadraticModes dense_quadratic_modes(const DenseMatrix &mass,
                                            const DenseMatrix *damping,
                                            const DenseMatrix &stiffness,
                                            const double       largest_circular_frequency,
                                            const RealVectors  real_vectors)
  {
    DenseQuadraticModes modes;
    const int           r = mass.n_rows();
    if (r == 0)
      return modes;
    const double stiffness_norm = frobenius_norm(stiffness);
    const double unit           = stiffness_norm > 0. ? std::sqrt(stiffness_norm / frobenius_norm(mass)) : 1.;

    // ------------------------------------------------- companion form in units of the scale
    const DenseLU factors(mass, "mass matrix of a small quadratic pencil");
    DenseMatrix   K = stiffness;
    factors.solve(K);
    const bool  linear = damping == nullptr;
    DenseMatrix companion(linear ? r : 2 * r, linear ? r : 2 * r);
    const int   last = companion.n_rows() - r;
    for (int j = 0; j < r; ++j)
      for (int i = 0; i < r; ++i)
        companion(last + i, j) = -K(i, j) / (unit * unit);
    if (!linear)
      {
        DenseMatrix C = *damping;
        factors.solve(C);
        for (int j = 0; j < r; ++j)
          {
            companion(j, r + j) = 1.;
            for (int i = 0; i < r; ++i)
              companion(r + i, r + j) = -C(i, j) / unit;
          }
      }
    const DenseEigenpairs pairs = eigenpairs(companion, true);

    // ------------------------------------------------- values wanted, in order
    const auto       value = [&](const int j) { return unit * (linear ? upper_root(pairs.values[j]) : pairs.values[j]); };
    std::vector<int> wanted;
    for (int j = 0; j < companion.n_rows(); ++j)
      {
        const Complex lambda = value(j);
        if (!oscillating.exceeded_by(std::abs(lambda.imag()) / std::abs(lambda)))
          {
            modes.real_values.push_back(lambda.real());
            if (linear)
              modes.real_values.push_back(-lambda.real());
            if (real_vectors == RealVectors::wanted)
              wanted.push_back(j);
          }
        else if (lambda.imag() > 0. && lambda.imag() <= largest_circular_frequency)
          wanted.push_back(j);
      }
    std::sort(modes.real_values.begin(), modes.real_values.end());
    std::stable_sort(wanted.begin(), wanted.end(), [&value](const int a, const int b) {
      const Complex x = value(a), y = value(b);
      return x.imag() != y.imag() ? x.imag() < y.imag() : x.real() < y.real();
    });

    // ------------------------------------------------- vectors
    const int k = static_cast<int>(wanted.size());
    modes.right = ComplexDenseMatrix(r, k);
    DenseMatrix left_parts(r, 2 * k);
    for (int j = 0; j < k; ++j)
      {
        modes.values.push_back(value(wanted[j]));
        const Complex *y     = pairs.right.column(wanted[j]);
        const bool     lower = std::abs(modes.values[j]) > unit;
        std::copy_n(y + (lower ? last : 0), r, modes.right.column(j));
        normalize(modes.right.column(j), r);

        // yᴴ A = λ yᴴ, but ψᵀ without conjugate.
        const Complex *z = pairs.left.column(wanted[j]) + last;
        for (int i = 0; i < r; ++i)
          {
            left_parts(i, j)     = z[i].real();
            left_parts(i, k + j) = -z[i].imag();
          }
      }
    factors.solve(left_parts, true);
    modes.left = ComplexDenseMatrix(r, k);
    for (int j = 0; j < k; ++j)
      {
        for (int i = 0; i < r; ++i)
          modes.left(i, j) = {left_parts(i, j), left_parts(i, k + j)};
        normalize(modes.left.column(j), r);
      }
    correct(modes, mass, damping, stiffness);
    return modes;
  }
} // namespace Squeal
