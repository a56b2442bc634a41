// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/bases/mode_labels.h>
#include <squeal/linear_algebra/dense.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/model/model.h>
#include <squeal/modes/complex_modes.h>
#include <squeal/system/terms.h>

#include <complex>
#include <string>
#include <vector>

namespace Squeal
{
  /**
   * Share [-] of a set of dofs in the energy of each mode u e^(λt), kinetic and strain energy together,
   *
   *   Σ_i ū_i (|λ|² M u + K u)_i / uᴴ (|λ|² M + K) u,   i over those dofs.
   *
   * M and K must not couple these dofs with the others: for example dofs of different bodies.
   *
   * @param selection n × 1, one at these dofs, zero at the others
   * @param lambda    of the modes [rad/s]
   * @param real_part, imaginary_part of u, n × k, on the dofs of the uncoupled bodies
   */
  std::vector<double> energy_shares(const SecondOrderSystem                 &bodies,
                                    const MultiVector                       &selection,
                                    const std::vector<std::complex<double>> &lambda,
                                    const MultiVector                       &real_part,
                                    const MultiVector                       &imaginary_part);

  /// Share of the disc and its mounts in the energy of coupled modes; the remainder belongs to the pins [-].
  std::vector<double> disc_shares(const Model             &model,
                                  const SecondOrderSystem &bodies,
                                  const SparseMatrix      &kernel,
                                  const ComplexModes      &modes);

  /**
   * Groups of the frictionless problem (figures 10 to 13 of the paper): `disc` if the disc has at least half of the energy, else family and
   * rank of the pin modes (`F1`, `T1`).
   *
   * @param disc_shares see disc_shares()
   * @param pin_labels  of each mode among the modes of the pins alone; unused if the disc has the energy
   */
  std::vector<std::string> frictionless_groups(const std::vector<double> &disc_shares, const std::vector<ModeLabel> &pin_labels);

  /**
   * Groups with friction (figures 14 to 18): `disc` if the disc has at least half of the energy; else `unstable pins` with divergence rates
   * above weak_divergence, `weakly unstable pins` that grow more slowly, and `other pins`.
   *
   * @param unstable for each mode, growth exceeds the uncertainty
   */
  std::vector<std::string> friction_groups(const std::vector<double>               &disc_shares,
                                           const std::vector<std::complex<double>> &lambda,
                                           const std::vector<bool>                 &unstable);

  /// Xᴴ M Y from the Gram matrix of [Re X, Im X] and [Re Y, Im Y].
  ComplexDenseMatrix hermitian_products(const DenseMatrix &G);

  /**
   * cos² of the principal angles between the spans of two sets of vectors, ascending.
   *
   * @param A, B Gram matrices of both sets, Hermitian positive semidefinite
   * @param C    products of the first with the second
   */
  Eigen::VectorXd squared_cosines(const ComplexDenseMatrix &A, const ComplexDenseMatrix &B, const ComplexDenseMatrix &C);

  /// ‖Pψ‖² / ‖ψ‖² for the projection P on the span of vectors with Gram matrix A; C: their products with all ψ, B: products of ψ.
  Eigen::RowVectorXd shares_in_span(const ComplexDenseMatrix &A, const ComplexDenseMatrix &C, const ComplexDenseMatrix &B);
} // namespace Squeal
