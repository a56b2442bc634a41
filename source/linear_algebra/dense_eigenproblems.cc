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
                          "a small dense eigenvalue or singular value problem", "check that the reduced matrices are finite");
    }

    /// LAPACK stores the vector of a conjugate pair as two real columns, real part first.
    ComplexDenseMatrix unpacked(const DenseMatrix &packed, const std::vector<double> &imaginary)
    {
      const std::complex<double> i(0., 1.);
      ComplexDenseMatrix         vectors = packed.cast<std::complex<double>>();
      for (Eigen::Index j = 0; j + 1 < packed.cols(); ++j)
        if (imaginary[j] > 0.)
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
    DenseMatrix left(m, m);
    check_lapack(LAPACKE_dgesdd(LAPACK_COL_MAJOR, 'A', m, n, A.data(), m, result.values.data(), left.data(), m, result.right.data(), n),
                 "dgesdd");
    result.right.transposeInPlace();
    return result;
  }

  DenseEigenpairs eigenpairs(DenseMatrix A, const bool left_vectors)
  {
    const int n = A.rows();
    if (n == 0)
      return {};
    std::vector<double> real(n), imaginary(n);
    DenseMatrix         right(n, n), left(left_vectors ? n : 0, left_vectors ? n : 0);
    check_lapack(LAPACKE_dgeev(LAPACK_COL_MAJOR, left_vectors ? 'V' : 'N', 'V', n, A.data(), n, real.data(), imaginary.data(), left.data(),
                               n, right.data(), n),
                 "dgeev");

    DenseEigenpairs pairs;
    std::transform(real.begin(), real.end(), imaginary.begin(), std::back_inserter(pairs.values),
                   [](const double re, const double im) { return std::complex<double>(re, im); });
    pairs.right = unpacked(right, imaginary);
    if (left_vectors)
      pairs.left = unpacked(left, imaginary);
    return pairs;
  }
} // namespace Squeal
