// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense.h>
#include <squeal/linear_algebra/multivector.h>

#include <complex>
#include <functional>
#include <memory>
#include <vector>

namespace Squeal
{
  /// Eigenpairs of the projected operator H of a CompactKrylov, by descending |ν|.
  struct RitzPairs
  {
    std::vector<std::complex<double>> values; ///< ν; conjugate pairs with Im ν > 0 first
    std::vector<double>               errors; ///< ‖S x - ν x‖₂ for ‖x‖₂ = 1

    /// Real Schur form H = Z T Zᵀ, m × m, in LAPACK's order.
    DenseMatrix schur_form, schur_vectors;
    /// Eigenvectors of H, m × m in LAPACK's order: real and imaginary part of a conjugate pair in two adjacent columns.
    DenseMatrix eigenvectors;
    /// Column of T and of the eigenvectors for each value (the first column for both members of a pair).
    std::vector<int> positions;
  };

  /**
   * Block Krylov–Schur process in real arithmetic for an operator S on states x = [x_0; ...; x_{d-1}] of d vectors of length n. S shifts
   * the parts down and computes a new first part:
   *
   *     S [x_0; x_1; ...] = [f(x_0, x_1, ...); x_0; ...; x_{d-2}].
   *
   * The linearisation of a polynomial eigenproblem of degree d = 2 has this form; d = 1 is the ordinary block Krylov–Schur method. The
   * orthonormal basis of states is stored as V = (I_d ⊗ U) G with one orthonormal basis U, n × r, for all parts, and small coordinates G, d
   * r × m: the two-level orthogonal Arnoldi process. For d = 2, U needs about half the memory of a basis of full states, and fewer inner
   * products. The process maintains the relation
   *
   *     S V = V H + V_a B,
   *
   * where V_a is the active block, to which the next step is applied.
   *
   * Sources: D. Lu, Y. Su, Z. Bai, SIAM J. Matrix Anal. Appl. 37 (2016)
   * 195 (two levels); D. Kressner, J. E. Roman, Numer. Linear Algebra Appl.
   * 21 (2014) 569 (compact restarts); G. W. Stewart, SIAM J. Matrix Anal.
   * Appl. 23 (2001) 601 (Krylov–Schur).
   */
  class CompactKrylov
  {
  public:
    /// f: receives the d parts of b states side by side, n × d b, and returns their images in @p image, n × b.
    using Operator = std::function<void(const MultiVector &states, MultiVector &image)>;

    /// Creates an empty process of degree @p degree and allocates @p n_reserved vectors.
    CompactKrylov(const RowMap &map, int degree, int n_reserved);

    /**
     * Widens the active block by the states [x; 0; ...] of the columns x of @p directions: to create the first block, and to find
     * eigenvectors without a component in the block, for example of eigenvalues whose multiplicity exceeds the block size. Returns the
     * number of new directions.
     */
    int inject(const MultiVector &directions);

    /// Applies S to the active block, which becomes part of the basis. The new active block has at most block_size states.
    void expand(const Operator &apply);

    /// Eigenpairs of H. Throws SolverError if the QR algorithm fails.
    RitzPairs ritz_pairs() const;

    /// Reduces the basis to the Schur vectors of the first @p n_kept Ritz values (one more if n_kept would split a pair).
    void restart(const RitzPairs &ritz, int n_kept);

    /**
     * Creates a process with the Schur vectors of the first @p n_locked Ritz values, which have converged, and an empty active block, to
     * search for missing eigenpairs from injected directions. It has space for @p n_more vectors.
     */
    CompactKrylov deflated(const RitzPairs &ritz, int n_locked, int n_more) const;

    /**
     * Upper parts of S x, n × k, for the Ritz vectors x in the columns @p positions of the eigenvectors. Applying S once more damps
     * components with small |ν| and needs no solves, because S V is known.
     */
    MultiVector ritz_vectors(const RitzPairs &ritz, const std::vector<int> &positions) const;

    int n_vectors  = 0; ///< r, number of columns of U
    int dimension  = 0; ///< m, the number of basis states without the active block
    int block_size = 0; ///< b, the number of active states; 0 if the basis spans an invariant subspace

  private:
    /// Orthonormalises @p X against U, appends the new directions to U, and returns the coordinates of X in the new U, r × b.
    DenseMatrix absorb(MultiVector &X, const std::vector<double> &magnitudes);

    /// Appends the orthonormalised columns of @p states, d r × b in coordinates, to the active block; returns [VᵀX; R].
    DenseMatrix append_active(const DenseMatrix &states, int n_basis);

    /// U as a view.
    MultiVector basis() const;

    /// Allocates space for @p n vectors in U.
    void reserve(int n);

    /// Copies the active block of @p from, which may be *this, and the Schur vectors of its first @p n_kept Ritz values.
    void take_schur_vectors(const CompactKrylov &from, const RitzPairs &ritz, int n_kept, int n_reserved);

    RowMap                       map;
    int                          degree;
    std::unique_ptr<MultiVector> U;
    DenseMatrix                  G; ///< d r × (m + b)
    DenseMatrix                  H; ///< [H; B], (m + b) × m
  };
} // namespace Squeal
