#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/rounding.h>

#include <cmath>
#include <limits>

namespace Squeal
{
  double unresolved_square(const SparseMatrix &K, const SparseMatrix &M)
  {
    constexpr double safety   = 100.;
    const auto       row_sums = [](const SparseMatrix &A) -> Eigen::ArrayXd {
      return A.by_place().cwiseAbs() * Eigen::VectorXd::Ones(A.by_place().cols());
    };
    const Eigen::ArrayXd stiffness = row_sums(K), mass = row_sums(M);
    const auto           counts  = mass > 0. && stiffness > 0.;
    double               sums[2] = {counts.select(mass * (stiffness / mass).log(), 0.).sum(), counts.select(mass, 0.).sum()};
    sum_over_processes(K.communicator(), sums, 2);
    return sums[1] > 0. ? safety * std::numeric_limits<double>::epsilon() * std::exp(sums[0] / sums[1]) : 0.;
  }
} // namespace Squeal
