// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/factorization.h>
#include <squeal/linear_algebra/multivector.h>

#include <memory>
#include <optional>
#include <string>

namespace Squeal
{
  /// The operator (K + s M)⁻¹ M on the M-orthogonal complement of deflated modes: its largest eigenvalues 1 / (ω² + s) belong to the lowest
  /// remaining modes. It is self-adjoint in the inner product of M.
  class ShiftInvert : public LinearOperator
  {
  public:
    /// @p deflated, M-orthonormal, may be null; the arguments must outlive this object.
    ShiftInvert(const LinearOperator &inverse, const SparseMatrix &mass, const MultiVector *deflated)
      : mass(mass)
      , inverse(inverse)
      , deflated(deflated)
    {}

    /// Y = (I - ΦΦᵀM) (K + s M)⁻¹ M X.
    void apply(const MultiVector &X, MultiVector &Y) const override
    {
      apply_to_image(mass * X, Y);
    }

    const RowMap &map() const override
    {
      return mass.map();
    }

    /// Y = (I - ΦΦᵀM) (K + s M)⁻¹ B for B = M X that has already been computed.
    void apply_to_image(const MultiVector &B, MultiVector &Y) const
    {
      inverse.apply(B, Y);
      project(Y);
    }

    /// X ← (I - ΦΦᵀM) X.
    void project(MultiVector &X) const
    {
      if (deflated != nullptr)
        multiply_add(-1., *deflated, gram(*deflated, mass * X), 1., X);
    }

    /// Dimension of the complement.
    int n_free() const
    {
      return mass.n_rows() - (deflated != nullptr ? deflated->n_columns() : 0);
    }

    const SparseMatrix &mass; ///< M

  private:
    const LinearOperator &inverse;
    const MultiVector    *deflated;
  };

  struct KrylovRequest
  {
    int          n_wanted;
    double       tolerance; ///< relative residual of the inverted problem
    int          block_size;
    unsigned int seed;
    int          attempt; ///< number of previous starts without new modes, which enlarges the space of Lanczos and Anasazi
    std::string  what;
  };

  /// Approximate eigenvectors of the largest eigenvalues by Anasazi: at most n_wanted, empty if none converged.
  std::optional<MultiVector> anasazi_vectors(const ShiftInvert &A, const KrylovRequest &request);

  /// Converged eigenvectors by block Lanczos, in descending order of the eigenvalues, before the first eigenvalue that has not converged.
  std::optional<MultiVector> lanczos_vectors(const ShiftInvert &A, const KrylovRequest &request);

  std::optional<MultiVector> arpack_vectors(const ShiftInvert &A, const KrylovRequest &request);
} // namespace Squeal
