// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/contact_interface.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <memory>
#include <string>
#include <vector>

namespace Squeal
{
  /// Compliant contact of a pair of surfaces, with springs k: r_n = −k diag(D) P_n u, with the areas D of the contact nodes.
  struct ContactSpring
  {
    std::string                         name;      ///< name of its parameter
    double                              stiffness; ///< k [N/m³]
    std::shared_ptr<const SparseMatrix> matrix;    ///< P_nᵀ diag(D) P_n [m²], n × n
    std::shared_ptr<const SparseMatrix> reaction;  ///< −diag(D) P_n [m²], n_c × n, zero rows for other pairs
  };

  /**
   * Relative displacements of the contact nodes and the kernel of the contact
   * constraints (section 2.3 of the paper):
   *
   *   P_n u = n·(u_D − u_P),  P_t u = f t·(u_D − u_P),  P_b u = b·(u_D − u_P)   n_c × n each
   *   T_c spans ker P_n of the rigid contact nodes                             n × (n − n_rigid)
   *
   * with the friction factor f of each pair of surfaces (1 by default). S, n_c × n, extracts the reactions r_n from the contact forces
   * P_nᵀ r_n + P_tᵀ r_t + P_bᵀ r_b:
   *
   *   S P_nᵀ = I,   S P_tᵀ = 0,   S P_bᵀ = 0,   r_n = S (λ² M + λ C + K) u.
   *
   * Any S with these properties gives the same eigenvalues. If all contact nodes are node pairs, S = ½ P_n, because P_n P_nᵀ = 2 I.
   * Otherwise, S is a weighted sum of the forces on the nodes of the pin.
   *
   * At each rigid contact node of a pin, T_c eliminates the displacement component closest to the normal. For node pairs whose normal is a
   * coordinate axis, T_c selects dofs.
   */
  struct ContactOperators
  {
    std::shared_ptr<const SparseMatrix> normal;     ///< P_n
    std::shared_ptr<const SparseMatrix> tangential; ///< P_t
    std::shared_ptr<const SparseMatrix> radial;     ///< P_b
    std::shared_ptr<const SparseMatrix> kernel;     ///< T_c
    std::shared_ptr<const SparseMatrix> reaction;   ///< S; rows of contact nodes with springs are zero
    std::vector<ContactSpring>          springs;
  };

  /// Parameter of the springs of a pair of surfaces.
  std::string contact_stiffness_parameter(unsigned int pair);

  ContactOperators contact_operators(const Model &model, const ContactInterface &interface);

  /// Components of the brake, as in the paper.
  enum class Component
  {
    disc,
    pins ///< all pins together
  };

  bool belongs_to(const Node &node, Component component);

  /// Boundary condition at the contact nodes of a component: free, or sliding on a rigid face.
  enum class ContactBoundary
  {
    free,   ///< no constraint at the contact nodes
    sliding ///< fixed along n, free in the tangent plane
  };

  /// Basis of the admissible displacements of a component, n × n_component; the other component is at rest. The basis selects the dofs of
  /// the component. With `sliding`, n·u = 0 at its contact nodes; on the disc, these are all nodes that occur in a contact constraint.
  std::shared_ptr<SparseMatrix> component_kernel(const Model            &model,
                                                 const ContactInterface &interface,
                                                 Component               component,
                                                 ContactBoundary         boundary);

  /// Coordinates q with T q = u for displacements u, n × k, in the range of a kernel T (T_c or component_kernel()): q contains the entries
  /// of u at the dofs that T selects.
  MultiVector coordinates(const SparseMatrix &T, const MultiVector &u);
} // namespace Squeal
