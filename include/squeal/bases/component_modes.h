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
  /// Normal modes of the disc, or of the whole set of pins, on the uncoupled dofs.
  struct ComponentModes
  {
    std::vector<ModeLabel>       labels;
    std::vector<double>          eigenvalues; ///< ω² [rad²/s²], ascending
    std::vector<double>          residuals;   ///< as in SymmetricModes [-]
    std::shared_ptr<MultiVector> vectors;     ///< n_free × k, orthonormal in M, zero on the other components
  };

  /// Masses lumped to the nodes [kg] whose rows this process has; zero of the others, and of clamped ones. They are row sums, or, where some of
  /// these are not positive as at the corners of quadratic tetrahedra, shares of the whole mass in proportion to the diagonal (E. Hinton,
  /// T. Rock, O. C. Zienkiewicz 1976).
  std::vector<double> nodal_masses(const Model &model, const SparseMatrix &mass);

  /**
   * All modes of a component with ω² ≤ @p largest_eigenvalue, contact nodes
   * free or sliding, labelled by shape. The number of modes is certified by
   * inertia. Throws SolverError where it is not met.
   *
   * @param interface all contact nodes, which give the pins their axes, whether they are closed or not
   * @param closed    those in contact
   */
  ComponentModes component_modes(const Model                 &model,
                                 const ContactInterface      &interface,
                                 const ContactInterface      &closed,
                                 const SecondOrderSystem     &system,
                                 Component                    component,
                                 ContactBoundary              boundary,
                                 double                       largest_eigenvalue,
                                 const SymmetricModesOptions &options);

  /// Part of each shape of component modes in a mode: |v_iᵀ M φ|² / φᴴ M φ, summed over the v_i of the shape [-].
  using ShapeShares = std::map<ModeShape, double>;

  /**
   * The shares of every shape in each of some real or complex modes.
   *
   * @param references     disc modes with contact free, pin modes with contact sliding
   * @param mass           M of the uncoupled bodies
   * @param real_part      n_free × k
   * @param imaginary_part n_free × k; null for real modes
   */
  std::vector<ShapeShares> shape_shares(const std::vector<const ComponentModes *> &references,
                                        const SparseMatrix                        &mass,
                                        const MultiVector                         &real_part,
                                        const MultiVector                         *imaginary_part);

  /// VᵀMX of the component modes V of each of the @p references, with vectors X, n_free × r.
  std::vector<DenseMatrix> products_with(const std::vector<const ComponentModes *> &references,
                                         const SparseMatrix                        &mass,
                                         const MultiVector                         &X);

  /**
   * The same for modes Xy of a reduced model, from their coordinates y.
   *
   * @param products       products_with() its basis X
   * @param mass           XᵀMX
   * @param coordinates    [Re y, Im y], r × 2k
   */
  std::vector<ShapeShares> shape_shares(const std::vector<const ComponentModes *> &references,
                                        const std::vector<DenseMatrix>            &products,
                                        const DenseMatrix                         &mass,
                                        const DenseMatrix                         &coordinates);

  /**
   * Identities of real or complex coupled modes by their M-inner products with
   * component modes; those of one shape (a doublet, the F1 modes of all
   * pins) count together. Where each mode is dominated by another component
   * mode it gets that one's label; where several compete (an A0-5 mode that
   * shakes the pins more than itself), the labels are distributed so that the
   * sum of all participations is largest and none is given more often than there are
   * component modes of it. A participation below a tenth gives no name.
   *
   * @param references the component modes that were given to shape_shares()
   * @param shares     what it returned, an entry for each coupled mode
   */
  std::vector<ModeLabel> identify(const std::vector<const ComponentModes *> &references, const std::vector<ShapeShares> &shares);
} // namespace Squeal
