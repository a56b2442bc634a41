// SPDX-License-Identifier: GPL-3.0-or-later

#include "libraries.h"

#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/linear_algebra/sparse_determinant.h>

#include <umfpack.h>

#include <cmath>
#include <limits>
#include <string>

namespace Squeal
{
  namespace
  {
    const char *const what = "the determinant of a sparse matrix";

    /// Entries of A at the positions of a pattern that contains the pattern of A.
    std::vector<double> on_pattern(const SparseRows &pattern, const SparseMatrix &A)
    {
      std::vector<double> values(pattern.nonZeros(), 0.);
      for (int i = 0; i < A.n_rows(); ++i)
        {
          const int *place = pattern.innerIndexPtr() + pattern.outerIndexPtr()[i];
          for (SparseRows::InnerIterator entry(A.by_place(), i); entry; ++entry)
            {
              // Columns are ascending in both matrices: search forwards only
              while (*place != entry.col())
                ++place;
              values[place - pattern.innerIndexPtr()] = entry.value();
            }
        }
      return values;
    }

    /// Union of the patterns of all matrices; add() also keeps entries that cancel.
    std::shared_ptr<SparseMatrix> union_pattern(const SparseMatrix &M, const SparseMatrix *C, const SparseMatrix &K)
    {
      auto result = add(1., M, 1., K);
      return C ? add(1., *result, 1., *C) : result;
    }
  } // namespace

  struct SparseDeterminant::Implementation
  {
    Implementation(const SparseMatrix &M, const SparseMatrix *C, const SparseMatrix &K)
      : pattern(union_pattern(M, C, K)->by_place())
      , mass(on_pattern(pattern, M))
      , damping(C ? on_pattern(pattern, *C) : std::vector<double>())
      , stiffness(on_pattern(pattern, K))
      , control(UMFPACK_CONTROL)
    {
      umfpack_zi_defaults(control.data());
      control[UMFPACK_ORDERING] = UMFPACK_ORDERING_METIS;
      const int status = umfpack_zi_symbolic(pattern.rows(), pattern.rows(), pattern.outerIndexPtr(), pattern.innerIndexPtr(), nullptr,
                                             nullptr, &symbolic, control.data(), nullptr);
      if (status != UMFPACK_OK)
        throw_library_failure("UMFPACK", "status " + std::to_string(status) + " of the analysis", what);
    }

    ~Implementation()
    {
      umfpack_zi_free_symbolic(&symbolic);
    }

    const SparseRows          pattern;
    const std::vector<double> mass, damping, stiffness;
    std::vector<double>       control;
    void                     *symbolic = nullptr;
  };

  SparseDeterminant::SparseDeterminant(const SparseMatrix &M, const SparseMatrix *C, const SparseMatrix &K)
  {
    if (M.rows().n_processes() > 1)
      throw SolverError("UMFPACK, which computes determinants of sparse matrices, runs on one process only, not on " +
                          std::to_string(M.rows().n_processes()),
                        what, "run on one process, or use the determinant condensed to the contact nodes");
    implementation = std::make_unique<Implementation>(M, C, K);
  }

  SparseDeterminant::~SparseDeterminant() = default;

  std::complex<double> SparseDeterminant::logarithm(const std::complex<double> lambda) const
  {
    const SparseRows          &pattern = implementation->pattern;
    const std::complex<double> square  = lambda * lambda;
    std::vector<double>        real(pattern.nonZeros()), imaginary(pattern.nonZeros());
    for (std::size_t k = 0; k < real.size(); ++k)
      {
        std::complex<double> entry = implementation->stiffness[k] + square * implementation->mass[k];
        if (!implementation->damping.empty())
          entry += lambda * implementation->damping[k];
        real[k]      = entry.real();
        imaginary[k] = entry.imag();
      }

    // UMFPACK expects columns but receives rows: the determinant of the transpose is the same
    void     *numeric = nullptr;
    const int status  = umfpack_zi_numeric(pattern.outerIndexPtr(), pattern.innerIndexPtr(), real.data(), imaginary.data(),
                                           implementation->symbolic, &numeric, implementation->control.data(), nullptr);
    // determinant = (mantissa_re + i mantissa_im) · 10^exponent
    double mantissa_re = 0., mantissa_im = 0., exponent = 0.;
    int    evaluated = status;
    if (status == UMFPACK_OK)
      evaluated = umfpack_zi_get_determinant(&mantissa_re, &mantissa_im, &exponent, numeric, nullptr);
    umfpack_zi_free_numeric(&numeric);
    if (status == UMFPACK_WARNING_singular_matrix || evaluated == UMFPACK_WARNING_singular_matrix)
      return {-std::numeric_limits<double>::infinity(), 0.};
    if (evaluated != UMFPACK_OK)
      throw_library_failure("UMFPACK", "status " + std::to_string(evaluated) + " of the factorisation", what);
    return {std::log(std::hypot(mantissa_re, mantissa_im)) + exponent * std::log(10.), std::atan2(mantissa_im, mantissa_re)};
  }
} // namespace Squeal
