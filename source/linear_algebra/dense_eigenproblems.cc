// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/dense_eigenproblems.h>

#include <lapacke.h>

#include <algorithm>
#include <string>

namespace Squeal
{
  namespace
  {
    void check_lapack(const lapack_int info, const std::string &routine)
    {
      if (info != 0)
        throw SolverError("LAPACK's " + routine + " failed with info = " + std::to_string(info),
                          "a small dense eigenvalue or singular value problem",
                          "check that the matrices are finite and that mass matrices are positive definite");
    }

    /// LAPACK stores the vector of a conjugate pair as two real columns, real part first.
    ComplexDenseMatrix unpacked(const DenseMatrix &packed, const std::vector<std::complex<double>> &values)
    {
      const std::complex<double> i(0., 1.);
      ComplexDenseMatrix         vectors = packed.cast<std::complex<double>>();
      for (Eigen::Index j = 0; j + 1 < packed.cols(); ++j)
        if (values[j].imag() > 0.)
          {
            vectors.col(j)     = packed.col(j) + i * packed.col(j + 1);
            vectors.col(j + 1) = vectors.col(j).conjugate();
          }
      return vectors;
    }
  } // namespace

  RealPairs symmetric_eigenpairs(DenseMatrix A)
  {
    const int           n = A.rows();
    std::vector<double> values(n);
    if (n > 0)
      check_lapack(LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'U', n, A.data(), n, values.data()), "dsyevd");
    return {std::move(values), std::move(A)};
  }

  RealPairs symmetric_eigenpairs(DenseMatrix A, DenseMatrix B)
  {
    const int           n = A.rows();
    std::vector<double> values(n);
    if (n > 0)
      check_lapack(LAPACKE_dsygvd(LAPACK_COL_MAJOR, 1, 'V', 'U', n, A.data(), n, B.data(), n, values.data()), "dsygvd");
    return {std::move(values), std::move(A)};
  }

  SingularValues singular_values(DenseMatrix A)
  {
    const int      m = A.rows(), n = A.cols(), k = std::min(m, n);
    SingularValues result{std::vector<double>(k), DenseMatrix::Identity(n, n)};
    if (k == 0)
      return result;
    // Compute all of V, but few left vectors, which are not used
    const bool  is_tall = m >= n;
    DenseMatrix left(m, is_tall ? n : m);
    check_lapack(LAPACKE_dgesdd(LAPACK_COL_MAJOR, is_tall ? 'S' : 'A', m, n, A.data(), m, result.values.data(), left.data(), m,
                                result.right.data(), n),
                 "dgesdd");
    result.right.transposeInPlace();
    return result;
  }

  DenseEigenpairs eigenpairs(DenseMatrix A, const std::function<bool(const std::complex<double> &)> &is_wanted)
  {
    const int       n = A.rows();
    DenseEigenpairs pairs;
    if (n == 0)
      return pairs;

    // A = D Q T Qᵀ D⁻¹ by the steps of dgeev, but with eigenvectors only for selected values
    std::vector<double> scale(n), tau(std::max(n - 1, 1)), real(n), imaginary(n);
    lapack_int          low = 0, high = 0;
    check_lapack(LAPACKE_dgebal(LAPACK_COL_MAJOR, 'B', n, A.data(), n, &low, &high, scale.data()), "dgebal");
    if (high > low) // skip a single row, which is in Hessenberg form: LAPACK 3.12 requests a workspace that is too small
      check_lapack(LAPACKE_dgehrd(LAPACK_COL_MAJOR, n, low, high, A.data(), n, tau.data()), "dgehrd");
    DenseMatrix Q = A;
    check_lapack(LAPACKE_dorghr(LAPACK_COL_MAJOR, n, low, high, Q.data(), n, tau.data()), "dorghr");
    check_lapack(LAPACKE_dhseqr(LAPACK_COL_MAJOR, 'S', 'V', n, low, high, A.data(), n, real.data(), imaginary.data(), Q.data(), n),
                 "dhseqr");
    for (int j = 0; j < n; ++j)
      pairs.values.emplace_back(real[j], imaginary[j]);

    std::vector<lapack_logical>       selected(n, 0);
    std::vector<std::complex<double>> of_vectors;
    for (int j = 0; j < n; ++j)
      {
        const int last = j + (imaginary[j] > 0. ? 1 : 0); // second member of a conjugate pair, or j
        if (is_wanted(pairs.values[j]) || is_wanted(pairs.values[last]))
          {
            selected[j] = 1;
            for (int i = j; i <= last; ++i)
              {
                pairs.numbers.push_back(i);
                of_vectors.push_back(pairs.values[i]);
              }
          }
        j = last;
      }
    const int  k = static_cast<int>(of_vectors.size());
    lapack_int m = 0;
    if (k == 0)
      return pairs;
    DenseMatrix right = DenseMatrix::Zero(n, k), left = right; // initialised because LAPACKE checks its arguments for NaN
    check_lapack(LAPACKE_dtrevc(LAPACK_COL_MAJOR, 'B', 'S', selected.data(), n, A.data(), n, left.data(), n, right.data(), n, k, &m),
                 "dtrevc");
    const auto of_matrix = [&](const DenseMatrix &of_triangle, const char side) {
      DenseMatrix vectors = Q * of_triangle;
      check_lapack(LAPACKE_dgebak(LAPACK_COL_MAJOR, 'B', side, n, low, high, scale.data(), k, vectors.data(), n), "dgebak");
      return ComplexDenseMatrix(unpacked(vectors, of_vectors).colwise().normalized());
    };
    pairs.right = of_matrix(right, 'R');
    pairs.left  = of_matrix(left, 'L');
    return pairs;
  }
} // namespace Squeal
