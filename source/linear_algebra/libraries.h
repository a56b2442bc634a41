// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/factorization.h>

#include <memory>
#include <string>

namespace Squeal
{
  // Factorisations of each library; factorization.cc chooses between them

  /// CHOLMOD's supernodal LLᵀ on one process.
  std::unique_ptr<Factorization> cholmod_factorization(const SparseMatrix &A, const std::string &what);

  /// MUMPS's LDLᵀ without numerical pivoting (positive definite) or LU (general).
  std::unique_ptr<Factorization> mumps_factorization(const SparseMatrix &A, bool positive_definite, const std::string &what);

  [[noreturn]] void throw_not_positive_definite(const std::string &library, const std::string &what);

  [[noreturn]] void throw_singular(const std::string &library, const std::string &what);

  [[noreturn]] void throw_library_failure(const std::string &library, const std::string &failure, const std::string &what);

  /// Pivots below this fraction of the original diagonal entry are rounding errors [-].
  constexpr double relative_pivot_tolerance = 1e-12;
} // namespace Squeal
