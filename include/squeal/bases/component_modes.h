// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/bases/mode_labels.h>
#include <squeal/contact/contact_operators.h>
#include <squeal/eigen/symmetric_modes.h>
#include <squeal/system/terms.h>

#include <map>
#include <memory>

namespace Squeal
{
  /// Normal modes of the disc or of all pins, on the uncoupled dofs.
  struct ComponentModes
  {
    std::vector<ModeLabel>       labels;
    std::vector<double>          eigenvalues; ///< ω² [rad²/s²], ascending
    std::vector<double>          residuals;   ///< see SymmetricModes::residuals [-]
    std::shared_ptr<MultiVector> vectors;     ///< n_free × k, orthonormal in M, zero on the other components
  };

  /// Lumped masses [kg] of all nodes: zero for clamped nodes and for nodes whose rows belong to other processes. The masses are row sums of
  /// M; if some sums are not positive, as at the corners of quadratic tetrahedra, the total mass is distributed in proportion to the
  /// diagonal (E. Hinton, T. Rock, O. C. Zienkiewicz 1976).
  std::vector<double> nodal_masses(const Model &model, const SparseMatrix &mass);

  /**
   * All modes of a component with ω² ≤ @p largest_eigenvalue, with free or sliding contact nodes, labelled by shape. Throws SolverError if
   * their number differs from the inertia count.
   *
   * @param interface all contact nodes, closed or open, which define the axes of the pins
   * @param closed    closed contact nodes
   */
  ComponentModes component_modes(const Model                 &model,
                                 const ContactInterface      &interface,
                                 const ContactInterface      &closed,
                                 const SecondOrderSystem     &system,
                                 Component                    component,
                                 ContactBoundary              boundary,
                                 double                       largest_eigenvalue,
                                 const SymmetricModesOptions &options);

  /// Contribution of each shape of component modes to a mode: |v_iᵀ M φ|² / φᴴ M φ, summed over the v_i of the shape [-].
  using ShapeShares = std::map<ModeShape, double>;

  /**
   * Contribution of every shape to real or complex modes.
   *
   * @param references     disc modes with free contact nodes, pin modes with sliding contact
   * @param mass           M of the uncoupled bodies
   * @param real_part      n_free × k
   * @param imaginary_part n_free × k; null for real modes
   */
  std::vector<ShapeShares> shape_shares(const std::vector<const ComponentModes *> &references,
                                        const SparseMatrix                        &mass,
                                        const MultiVector                         &real_part,
                                        const MultiVector                         *imaginary_part);

  /// Products VᵀMX of the component modes V in each of the @p references with the vectors X, n_free × r.
  std::vector<DenseMatrix> products_with(const std::vector<const ComponentModes *> &references,
                                         const SparseMatrix                        &mass,
                                         const MultiVector                         &X);

  /**
   * Contribution of every shape to modes Xy of a reduced model, from their coordinates y.
   *
   * @param products       products_with() of the basis X
   * @param mass           XᵀMX
   * @param coordinates    [Re y, Im y], r × 2k
   */
  std::vector<ShapeShares> shape_shares(const std::vector<const ComponentModes *> &references,
                                        const std::vector<DenseMatrix>            &products,
                                        const DenseMatrix                         &mass,
                                        const DenseMatrix                         &coordinates);

  /**
   * Labels real or complex coupled modes by their M-inner products with component modes; modes of one shape (a doublet, the F1 modes of all
   * pins) count together. If each mode is dominated by a different component mode, it gets the label of this component mode. If several
   * modes compete (an A0-5 mode with larger motion of the pins), labels are assigned so that the sum of all participations is largest. No
   * label occurs more often than there are component modes with this label. Modes with a participation below 0.1 remain unnamed.
   *
   * @param references component modes, as for shape_shares()
   * @param shares     result of shape_shares(), one entry per coupled mode
   */
  std::vector<ModeLabel> identify(const std::vector<const ComponentModes *> &references, const std::vector<ShapeShares> &shares);
} // namespace Squeal
