// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <complex>
#include <memory>

namespace Squeal
{
  /// det(K + λ C + λ² M) of real sparse matrices at complex λ, from the pivots of a sparse complex LU factorisation for each λ (UMFPACK;
  /// one process).
  class SparseDeterminant
  {
  public:
    /// C may be null. Throws SolverError on several processes.
    SparseDeterminant(const SparseMatrix &M, const SparseMatrix *C, const SparseMatrix &K);

    ~SparseDeterminant();

    /// Logarithm of the determinant, imaginary part in [−π, π]; −∞ if it vanishes. Throws SolverError if UMFPACK fails.
    std::complex<double> logarithm(std::complex<double> lambda) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation;
  };
} // namespace Squeal
