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
   * Share [-] of selected dofs in the energy of each mode u e^(λt), the sum of kinetic and strain energy,
   *
   *   Σ_i ū_i (|λ|² M u + K u)_i / uᴴ (|λ|² M + K) u, sum over the selected dofs i.
   *
   * M and K must not couple the selected dofs with the others. This holds for the dofs of one body.
   *
   * @param selection n × 1, one at the selected dofs, zero at the others
   * @param lambda    λ of each mode [rad/s]
   * @param real_part, imaginary_part displacements u, n × k, on the dofs of the uncoupled bodies
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
   * Groups of modes of the frictionless problem (figures 10 to 13 of the paper): `disc` if the disc has at least half of the energy, else
   * the family and rank of the pin mode (`F1`, `T1`).
   *
   * @param disc_shares see disc_shares()
   * @param pin_labels  labels of the modes as pin modes; unused for modes of the group `disc`
   */
  std::vector<std::string> frictionless_groups(const std::vector<double> &disc_shares, const std::vector<ModeLabel> &pin_labels);

  /**
   * Groups of modes with friction (figures 14 to 18): `disc` if the disc has at least half of the energy; else `unstable pins` with
   * divergence rates above weak_divergence, `weakly unstable pins` that grow more slowly, and `other pins`.
   *
   * @param unstable for each mode: true if growth exceeds the uncertainty
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
   * @param C products of the first set with the second
   */
  Eigen::VectorXd squared_cosines(const ComplexDenseMatrix &A, const ComplexDenseMatrix &B, const ComplexDenseMatrix &C);

  /// ‖Pψ‖² / ‖ψ‖² for the projection P on the span of vectors with Gram matrix A; C: products of these vectors with all ψ, B: Gram matrix
  /// of all ψ.
  Eigen::RowVectorXd shares_in_span(const ComplexDenseMatrix &A, const ComplexDenseMatrix &C, const ComplexDenseMatrix &B);
} // namespace Squeal
