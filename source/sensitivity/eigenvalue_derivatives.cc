#include <squeal/sensitivity/eigenvalue_derivatives.h>

#include <Eigen/LU>

namespace Squeal
{
  using Complex = std::complex<double>;

  Complex eigenvalue_derivative(const ComplexDenseMatrix &N, const ComplexDenseMatrix &D, const int mode)
  {
    return -N(mode, mode) / D(mode, mode);
  }

  Complex mean_derivative(const ComplexDenseMatrix &N, const ComplexDenseMatrix &D, const std::vector<int> &modes)
  {
    const ComplexDenseMatrix N_m = N(modes, modes), D_m = D(modes, modes);
    return -D_m.partialPivLu().solve(N_m).trace() / static_cast<double>(modes.size());
  }

  Complex squared_difference_derivative(const ComplexDenseMatrix   &N,
                                        const ComplexDenseMatrix   &D,
                                        const std::vector<Complex> &lambda,
                                        const int                   first,
                                        const int                   second)
  {
    return 2. * (lambda[first] - lambda[second]) * (eigenvalue_derivative(N, D, first) - eigenvalue_derivative(N, D, second));
  }

  ValueAtCentre value_at_centre(const std::array<Complex, 3> &means)
  {
    // Richardson's extrapolation to h = 0 of powers h² and h⁴
    const Complex of_two   = (4. * means[0] - means[1]) / 3.;
    const Complex of_three = 1.5 * means[0] - 0.6 * means[1] + 0.1 * means[2];
    return {of_three, std::abs(of_three - of_two)};
  }
} // namespace Squeal
