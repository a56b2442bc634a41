#include "blas.h"

#include <squeal/base/decision.h>
#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/dense_matrix.h>

#include <lapacke.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace Squeal
{
  namespace
  {
    /// A matrix that is singular leaves 10⁻¹⁷ to 10⁻¹⁵.
    const Decision regular("reciprocal condition number of a dense matrix", 1e-14);
    /// Of Q(λ), which is nearly singular close to an eigenvalue.
    const Decision complex_regular("reciprocal condition number of a dense complex matrix", 1e-16);

    /// LAPACK wants leading dimensions of at least one, also for empty matrices.
    template <typename Number>
    int leading_dimension(const DenseMatrixOf<Number> &A)
    {
      return std::max(1, A.n_rows());
    }

    void require(const bool condition, const char *operation)
    {
      if (!condition)
        throw SolverError("the shapes of two dense matrices do not fit together", operation,
                          "this is a mistake in the program: please report it");
    }

    void check_lapack(const lapack_int info, const char *routine)
    {
      if (info != 0)
        throw SolverError(std::string(routine) + " failed with info = " + std::to_string(info),
                          "a small dense eigenvalue or singular value problem", "check that the reduced matrices are finite");
    }
  } // namespace



  DenseMatrix multiply(const DenseMatrix &A, const DenseMatrix &B, const bool transpose_A, const bool transpose_B, const double alpha)
  {
    const int m = transpose_A ? A.n_columns() : A.n_rows();
    const int k = transpose_A ? A.n_rows() : A.n_columns();
    const int n = transpose_B ? B.n_rows() : B.n_columns();
    require(k == (transpose_B ? B.n_columns() : B.n_rows()), "product of two dense matrices");

    DenseMatrix C(m, n);
    if (m > 0 && n > 0 && k > 0)
      gemm(transpose_A, transpose_B, m, n, k, alpha, A.column(), leading_dimension(A), B.column(), leading_dimension(B), 0., C.column(),
           leading_dimension(C));
    return C;
  }



  ComplexDenseMatrix multiply(const ComplexDenseMatrix &A, const ComplexDenseMatrix &B, const bool conjugate_transpose_A)
  {
    const int m = conjugate_transpose_A ? A.n_columns() : A.n_rows();
    const int k = conjugate_transpose_A ? A.n_rows() : A.n_columns();
    const int n = B.n_columns();
    require(k == B.n_rows(), "product of two dense matrices");

    ComplexDenseMatrix C(m, n);
    if (m > 0 && n > 0 && k > 0)
      gemm(conjugate_transpose_A, m, n, k, A.column(), leading_dimension(A), B.column(), leading_dimension(B), C.column(),
           leading_dimension(C));
    return C;
  }



  ComplexDenseMatrix multiply(const DenseMatrix &A, const ComplexDenseMatrix &X)
  {
    const int   n = X.n_rows(), k = X.n_columns();
    DenseMatrix halves(n, 2 * k);
    for (int j = 0; j < k; ++j)
      for (int i = 0; i < n; ++i)
        {
          halves(i, j)     = X(i, j).real();
          halves(i, k + j) = X(i, j).imag();
        }
    const DenseMatrix  products = multiply(A, halves);
    ComplexDenseMatrix result(A.n_rows(), k);
    for (int j = 0; j < k; ++j)
      for (int i = 0; i < A.n_rows(); ++i)
        result(i, j) = {products(i, j), products(i, k + j)};
    return result;
  }



  ComplexDenseMatrix transpose_multiply(const ComplexDenseMatrix &X, const ComplexDenseMatrix &Y)
  {
    ComplexDenseMatrix conjugate = X;
    std::for_each(conjugate.column(), conjugate.column(X.n_columns()), [](std::complex<double> &x) { x = std::conj(x); });
    return multiply(conjugate, Y, true);
  }



  DenseMatrix real_part(const ComplexDenseMatrix &X)
  {
    DenseMatrix result(X.n_rows(), X.n_columns());
    std::transform(X.column(), X.column(X.n_columns()), result.column(), [](const std::complex<double> &x) { return x.real(); });
    return result;
  }



  DenseMatrix imaginary_part(const ComplexDenseMatrix &X)
  {
    DenseMatrix result(X.n_rows(), X.n_columns());
    std::transform(X.column(), X.column(X.n_columns()), result.column(), [](const std::complex<double> &x) { return x.imag(); });
    return result;
  }



  DenseMatrix add(const DenseMatrix &A, const DenseMatrix &B, const double factor)
  {
    require(A.n_rows() == B.n_rows() && A.n_columns() == B.n_columns(), "sum of two dense matrices");
    DenseMatrix C = A;
    for (int j = 0; j < C.n_columns(); ++j)
      for (int i = 0; i < C.n_rows(); ++i)
        C(i, j) += factor * B(i, j);
    return C;
  }



  DenseMatrix append_columns(const DenseMatrix &X, const DenseMatrix &Y)
  {
    require(X.n_columns() == 0 || X.n_rows() == Y.n_rows(), "dense matrices side by side");
    DenseMatrix result(Y.n_rows(), X.n_columns() + Y.n_columns());
    std::copy(X.column(), X.column(X.n_columns()), result.column());
    std::copy(Y.column(), Y.column(Y.n_columns()), result.column(X.n_columns()));
    return result;
  }



  void border(DenseMatrix &matrix, const DenseMatrix &new_columns, const double sign)
  {
    const int r = new_columns.n_rows(), old = matrix.n_rows();
    require(old + new_columns.n_columns() == r, "bordered matrix");
    DenseMatrix result(r, r);
    for (int j = 0; j < old; ++j)
      std::copy(matrix.column(j), matrix.column(j) + old, result.column(j));
    for (int j = old; j < r; ++j)
      for (int i = 0; i < r; ++i)
        {
          result(i, j) = new_columns(i, j - old);
          if (i != j)
            result(j, i) = sign * result(i, j);
        }
    matrix = std::move(result);
  }



  ComplexDenseMatrix from_halves(const DenseMatrix &products)
  {
    const int          k = products.n_rows() / 2;
    ComplexDenseMatrix result(k, k);
    for (int j = 0; j < k; ++j)
      for (int i = 0; i < k; ++i)
        result(i, j) = {products(i, j) - products(k + i, k + j), products(i, k + j) + products(k + i, j)};
    return result;
  }



  DenseMatrix transpose(const DenseMatrix &A)
  {
    DenseMatrix B(A.n_columns(), A.n_rows());
    for (int j = 0; j < A.n_columns(); ++j)
      for (int i = 0; i < A.n_rows(); ++i)
        B(j, i) = A(i, j);
    return B;
  }



  DenseMatrix identity(const int n)
  {
    DenseMatrix I(n, n);
    for (int i = 0; i < n; ++i)
      I(i, i) = 1.;
    return I;
  }



  DenseMatrix columns(const DenseMatrix &A, const int first, const int n)
  {
    require(first >= 0 && n >= 0 && first + n <= A.n_columns(), "columns of a dense matrix");
    DenseMatrix B(A.n_rows(), n);
    std::copy(A.column(first), A.column(first + n), B.column());
    return B;
  }



  double max_norm(const DenseMatrix &A)
  {
    double largest = 0.;
    for (int j = 0; j < A.n_columns(); ++j)
      for (int i = 0; i < A.n_rows(); ++i)
        {
          const double entry = std::abs(A(i, j));
          // A comparison with NaN is false: let NaN through instead of hiding it.
          if (!(entry <= largest))
            largest = entry;
        }
    return largest;
  }



  DenseLU::DenseLU(DenseMatrix A, const char *what)
    : factors(std::move(A))
    , pivots(factors.n_rows())
  {
    const int n = factors.n_rows();
    require(n == factors.n_columns(), "LU factors of a dense matrix");
    if (n == 0)
      {
        rcond = 1.;
        return;
      }

    double norm = 0.;
    for (int j = 0; j < n; ++j)
      {
        double sum = 0.;
        for (int i = 0; i < n; ++i)
          sum += std::abs(factors(i, j));
        if (!(sum <= norm))
          norm = sum;
      }

    const lapack_int info = LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, factors.column(), n, pivots.data());
    if (info == 0)
      {
        std::vector<double>     work(4 * static_cast<std::size_t>(n));
        std::vector<lapack_int> iwork(n);
        LAPACKE_dgecon_work(LAPACK_COL_MAJOR, '1', n, factors.column(), n, norm, &rcond, work.data(), iwork.data());
      }
    if (info != 0 || !regular.exceeded_by(rcond) || !std::isfinite(norm))
      throw SolverError("a dense matrix of size " + std::to_string(n) + " is singular to working precision", what,
                        "check for linearly dependent vectors or a parameter value at which the problem degenerates");
  }



  void DenseLU::solve(DenseMatrix &B, const bool transpose) const
  {
    const int n = factors.n_rows();
    require(n == B.n_rows(), "solution with dense LU factors");
    if (n == 0 || B.n_columns() == 0)
      return;
    LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, transpose ? 'T' : 'N', n, B.n_columns(), factors.column(), n, pivots.data(), B.column(), n);
  }



  double DenseLU::reciprocal_condition() const
  {
    return rcond;
  }



  ComplexDenseLU::ComplexDenseLU(ComplexDenseMatrix A)
    : factors(std::move(A))
    , pivots(factors.n_rows())
  {
    const int n = factors.n_rows();
    require(n == factors.n_columns(), "LU factors of a complex dense matrix");
    if (n == 0)
      return;

    double norm = 0.;
    for (int j = 0; j < n; ++j)
      {
        double sum = 0.;
        for (int i = 0; i < n; ++i)
          sum += std::abs(factors(i, j));
        if (!(sum <= norm))
          norm = sum;
      }

    const auto entries = [](std::complex<double> *values) { return reinterpret_cast<lapack_complex_double *>(values); };
    double     rcond   = 0.;
    if (LAPACKE_zgetrf_work(LAPACK_COL_MAJOR, n, n, entries(factors.column()), n, pivots.data()) == 0)
      {
        std::vector<std::complex<double>> work(2 * static_cast<std::size_t>(n));
        std::vector<double>               rwork(2 * static_cast<std::size_t>(n));
        LAPACKE_zgecon_work(LAPACK_COL_MAJOR, '1', n, entries(factors.column()), n, norm, &rcond, entries(work.data()), rwork.data());
      }
    // Written so that a NaN counts as singular, too.
    norm_of_inverse =
      complex_regular.exceeded_by(rcond) && std::isfinite(norm) ? 1. / (rcond * norm) : std::numeric_limits<double>::infinity();
  }



  void ComplexDenseLU::solve(ComplexDenseMatrix &B) const
  {
    const int n = factors.n_rows();
    require(n == B.n_rows(), "solution with complex dense LU factors");
    if (n == 0 || B.n_columns() == 0)
      return;
    LAPACKE_zgetrs_work(LAPACK_COL_MAJOR, 'N', n, B.n_columns(), reinterpret_cast<const lapack_complex_double *>(factors.column()), n,
                        pivots.data(), reinterpret_cast<lapack_complex_double *>(B.column()), n);
  }



  std::complex<double> ComplexDenseLU::log_determinant() const
  {
    double modulus = 0., argument = 0.;
    for (int i = 0; i < factors.n_rows(); ++i)
      {
        modulus += std::log(std::abs(factors(i, i)));
        argument += std::arg(factors(i, i)) + (pivots[i] != i + 1 ? M_PI : 0.);
      }
    return {modulus, std::remainder(argument, 2. * M_PI)};
  }



  double ComplexDenseLU::inverse_norm() const
  {
    return norm_of_inverse;
  }



  ComplexDenseMatrix balanced(ComplexDenseMatrix A)
  {
    const int n = A.n_rows();
    require(n == A.n_columns(), "balancing of a dense matrix");
    // A few sweeps do: nobody asks for the very minimum.
    for (int sweep = 0; sweep < 5; ++sweep)
      for (int k = 0; k < n; ++k)
        {
          double row = 0., column = 0.;
          for (int i = 0; i < n; ++i)
            if (i != k)
              {
                row += std::norm(A(k, i));
                column += std::norm(A(i, k));
              }
          const double scale = std::pow(row / column, 0.25);
          if (!(scale > 0.) || !std::isfinite(scale))
            continue;
          for (int i = 0; i < n; ++i)
            if (i != k)
              {
                A(i, k) *= scale;
                A(k, i) /= scale;
              }
        }
    return A;
  }



  double frobenius_norm(const ComplexDenseMatrix &A)
  {
    double square = 0.;
    for (int j = 0; j < A.n_columns(); ++j)
      for (int i = 0; i < A.n_rows(); ++i)
        square += std::norm(A(i, j));
    return std::sqrt(square);
  }



  std::vector<double> symmetric_eigenvalues(DenseMatrix &A)
  {
    const int n = A.n_rows();
    require(n == A.n_columns(), "eigenvalues of a symmetric dense matrix");
    std::vector<double> values(n);
    if (n > 0)
      check_lapack(LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'U', n, A.column(), n, values.data()), "LAPACK's dsyevd");
    return values;
  }



  std::vector<double> symmetric_eigenvalues(DenseMatrix &A, DenseMatrix B)
  {
    const int n = A.n_rows();
    require(n == A.n_columns() && n == B.n_rows() && n == B.n_columns(), "eigenvalues of a symmetric dense pair");
    std::vector<double> values(n);
    if (n > 0)
      check_lapack(LAPACKE_dsygvd(LAPACK_COL_MAJOR, 1, 'V', 'U', n, A.column(), n, B.column(), n, values.data()), "LAPACK's dsygvd");
    return values;
  }



  SingularValues singular_values(DenseMatrix A)
  {
    const int      m = A.n_rows(), n = A.n_columns(), k = std::min(m, n);
    SingularValues result{std::vector<double>(k), identity(n)};
    if (k == 0)
      return result;
    DenseMatrix left(m, m);
    check_lapack(
      LAPACKE_dgesdd(LAPACK_COL_MAJOR, 'A', m, n, A.column(), m, result.values.data(), left.column(), m, result.right.column(), n),
      "LAPACK's dgesdd");
    result.right = transpose(result.right);
    return result;
  }



  DenseEigenpairs eigenpairs(DenseMatrix A, const bool left_vectors)
  {
    const int n = A.n_rows();
    require(n == A.n_columns(), "eigenvalues of a dense matrix");

    DenseEigenpairs pairs;
    pairs.values.resize(n);
    pairs.right = ComplexDenseMatrix(n, n);
    if (left_vectors)
      pairs.left = ComplexDenseMatrix(n, n);
    if (n == 0)
      return pairs;

    std::vector<double> real(n), imaginary(n);
    DenseMatrix         right(n, n), left(left_vectors ? n : 0, left_vectors ? n : 0);
    check_lapack(LAPACKE_dgeev(LAPACK_COL_MAJOR, left_vectors ? 'V' : 'N', 'V', n, A.column(), n, real.data(), imaginary.data(),
                               left_vectors ? left.column() : nullptr, n, right.column(), n),
                 "LAPACK's dgeev");

    // LAPACK stores the vector of a conjugate pair as two real columns, real part first.
    const auto unpack = [&](const DenseMatrix &packed, const int j, ComplexDenseMatrix &vectors) {
      if (imaginary[j] == 0.)
        for (int i = 0; i < n; ++i)
          vectors(i, j) = packed(i, j);
      else
        for (int i = 0; i < n; ++i)
          {
            vectors(i, j)     = {packed(i, j), packed(i, j + 1)};
            vectors(i, j + 1) = std::conj(vectors(i, j));
          }
    };
    for (int j = 0; j < n; j += (imaginary[j] == 0. ? 1 : 2))
      {
        unpack(right, j, pairs.right);
        if (left_vectors)
          unpack(left, j, pairs.left);
      }
    for (int j = 0; j < n; ++j)
      pairs.values[j] = {real[j], imaginary[j]};
    return pairs;
  }
} // namespace Squeal
