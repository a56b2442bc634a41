#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/rounding.h>

#include <array>
#include <cmath>
#include <limits>

namespace Squeal
{
  namespace
  {
    /// The sum of moduli of a row.
    double size_of_row(const SparseMatrix &A, const int place, SparseMatrix::Row &row)
    {
      A.get_row(place, row);
      double sum = 0.;
      for (const auto &[column, value] : row)
        sum += std::abs(value);
      return sum;
    }
  } // namespace

  double unresolved_square(const SparseMatrix &K, const SparseMatrix &M)
  {
    constexpr double      safety = 100.;
    std::array<double, 2> sums   = {}; // of m log ρ and of m
    SparseMatrix::Row     row;
    for (int i = 0; i < K.rows().n_local(); ++i)
      if (const double mass = size_of_row(M, i, row), stiffness = size_of_row(K, i, row); mass > 0. && stiffness > 0.)
        {
          sums[0] += mass * std::log(stiffness / mass);
          sums[1] += mass;
        }
    sum_over_processes(K.communicator(), sums.data(), sums.size());
    return sums[1] > 0. ? safety * std::numeric_limits<double>::epsilon() * std::exp(sums[0] / sums[1]) : 0.;
  }
} // namespace Squeal
