#include <squeal/contact/modal_damping.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  MultiVector ModalDamping::operator*(const MultiVector &X) const
  {
    DenseMatrix velocities = gram(mass_times_modes, X);
    for (int j = 0; j < velocities.n_columns(); ++j)
      for (int i = 0; i < velocities.n_rows(); ++i)
        velocities(i, j) *= coefficients[i];
    return mass_times_modes * velocities;
  }

  std::shared_ptr<const ModalDamping> modal_damping(const SparseMatrix        &mass,
                                                    const MultiVector         &modes,
                                                    const std::vector<double> &eigenvalues,
                                                    const std::vector<double> &ratios)
  {
    const std::size_t k = modes.NumVectors();
    AssertDimension(eigenvalues.size(), k);
    AssertDimension(ratios.size(), k);
    std::vector<double> coefficients;
    for (std::size_t j = 0; j < k; ++j)
      coefficients.push_back(eigenvalues[j] > 0. ? 2. * ratios[j] * std::sqrt(eigenvalues[j]) : 0.);
    if (std::all_of(coefficients.begin(), coefficients.end(), [](const double c) { return c == 0.; }))
      return nullptr;
    return std::make_shared<ModalDamping>(ModalDamping{mass * modes, coefficients});
  }
} // namespace Squeal
