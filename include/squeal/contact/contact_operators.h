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
  /// Springs of stiffness k between a pair of surfaces whose contact is not rigid: r_n = −k diag(D) P_n, D the areas of the contact nodes.
  struct ContactSpring
  {
    std::string                         name;      ///< parameter of its term
    double                              stiffness; ///< k [N/m³]
    std::shared_ptr<const SparseMatrix> matrix;    ///< P_nᵀ diag(D) P_n [m²], n × n
    std::shared_ptr<const SparseMatrix> reaction;  ///< −diag(D) P_n [m²], n_c × n, rows of other pairs zero
  };

  /**
   * Relative displacements of the contact nodes and the kernel of the contact
   * constraints (section 2.3 of the paper):
   *
   *   P_n u = n·(u_D − u_P),  P_t u = f t·(u_D − u_P),  P_b u = b·(u_D − u_P)   n_c × n each
   *   T_c spans ker P_n of the rigid contact nodes                             n × (n − n_rigid)
   *
   * with the friction factor f of each pair of surfaces, 1 as a rule, and S that reads the reactions r_n from forces f = P_nᵀ r_n + P_tᵀ r_t + P_bᵀ r_b of the contact (n_c × n),
   *
   *   S P_nᵀ = I,   S P_tᵀ = 0,   S P_bᵀ = 0,   r_n = S (λ² M + λ C + K) u.
   *
   * Any S with these properties gives the same eigenvalues. Between pairs of nodes it is ½ P_n, where P_n P_nᵀ = 2 I; elsewhere it reads
   * the forces on the pins' nodes.
   *
   * In T_c one displacement component of each pin node, the one nearest to the
   * normal, follows from the others, so that T_c selects dofs where the
   * normal is a coordinate axis.
   */
  struct ContactOperators
  {
    std::shared_ptr<const SparseMatrix> normal;     ///< P_n
    std::shared_ptr<const SparseMatrix> tangential; ///< P_t
    std::shared_ptr<const SparseMatrix> radial;     ///< P_b
    std::shared_ptr<const SparseMatrix> kernel;     ///< T_c
    std::shared_ptr<const SparseMatrix> reaction;   ///< S, whose rows of contact nodes with springs are zero
    std::vector<ContactSpring>          springs;
  };

  /// Parameter of the springs of a pair of surfaces.
  std::string contact_stiffness_parameter(unsigned int pair);

  ContactOperators contact_operators(const Model &model, const ContactInterface &interface);

  /// Components of the paper.
  enum class Component
  {
    disc,
    pins ///< all of them together
  };

  bool belongs_to(const Node &node, Component component);

  /// Dofs of a component, with their contact nodes free or sliding on a rigid face.
  enum class ContactBoundary
  {
    free,   ///< no constraint at the contact nodes
    sliding ///< fixed along n, free in the tangent plane
  };

  /// Matrix whose columns span the admissible displacements of a component, the other being at rest: n × n_component. It selects the dofs
  /// of the component; with `sliding` n·u = 0 holds at its contact nodes; of the disc: at every node that takes part.
  std::shared_ptr<SparseMatrix> component_kernel(const Model            &model,
                                                 const ContactInterface &interface,
                                                 Component               component,
                                                 ContactBoundary         boundary);

  /// q with T q = u for displacements u, n × k, in the range of a kernel T (T_c or one of component_kernel()): the entries of u at the dofs
  /// that T selects.
  MultiVector coordinates(const SparseMatrix &T, const MultiVector &u);
} // namespace Squeal
