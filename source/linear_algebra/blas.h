#pragma once

#include <complex>

// Fortran's BLAS, not CBLAS: deal.II brings in the GNU Scientific Library,
// whose reference CBLAS would be found before that of OpenBLAS and is many
// times slower. The trailing arguments of Fortran are the lengths of strings.
extern "C"
{
  void dgemm_(const char   *transpose_A,
              const char   *transpose_B,
              const int    *m,
              const int    *n,
              const int    *k,
              const double *alpha,
              const double *A,
              const int    *lda,
              const double *B,
              const int    *ldb,
              const double *beta,
              double       *C,
              const int    *ldc,
              std::size_t,
              std::size_t);
  void zgemm_(const char                 *transpose_A,
              const char                 *transpose_B,
              const int                  *m,
              const int                  *n,
              const int                  *k,
              const std::complex<double> *alpha,
              const std::complex<double> *A,
              const int                  *lda,
              const std::complex<double> *B,
              const int                  *ldb,
              const std::complex<double> *beta,
              std::complex<double>       *C,
              const int                  *ldc,
              std::size_t,
              std::size_t);
}

namespace Squeal
{
  /// C = alpha op(A) op(B) + beta C, column-major.
  inline void gemm(const bool    transpose_A,
                   const bool    transpose_B,
                   const int     m,
                   const int     n,
                   const int     k,
                   const double  alpha,
                   const double *A,
                   const int     lda,
                   const double *B,
                   const int     ldb,
                   const double  beta,
                   double       *C,
                   const int     ldc)
  {
    dgemm_(transpose_A ? "T" : "N", transpose_B ? "T" : "N", &m, &n, &k, &alpha, A, &lda, B, &ldb, &beta, C, &ldc, 1, 1);
  }

  /// C = op(A) B, op = conjugate transpose where asked, column-major.
  inline void gemm(const bool                  conjugate_transpose_A,
                   const int                   m,
                   const int                   n,
                   const int                   k,
                   const std::complex<double> *A,
                   const int                   lda,
                   const std::complex<double> *B,
                   const int                   ldb,
                   std::complex<double>       *C,
                   const int                   ldc)
  {
    const std::complex<double> one = 1., zero = 0.;
    zgemm_(conjugate_transpose_A ? "C" : "N", "N", &m, &n, &k, &one, A, &lda, B, &ldb, &zero, C, &ldc, 1, 1);
  }
} // namespace Squeal
