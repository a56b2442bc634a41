#pragma once

#include <squeal/assembly/second_order_system.h>
#include <squeal/contact/contact_operators.h>
#include <squeal/contact/modal_damping.h>

#include <complex>
#include <vector>

namespace Squeal
{
  /// Viscous damping of the contact nodes, one coefficient for each [N s/m]; an empty list means zeros.
  struct ContactDamping
  {
    std::vector<double> radial;  ///< c_b, along b
    std::vector<double> sliding; ///< c_t, along t

    /// Whether all coefficients vanish.
    bool is_zero() const;
  };

  /**
   * The bodies coupled by contact, with friction as a term of rank n_c that is
   * affine in μ (eqs. (5) to (8) of the paper, with the sign of r_n ≤ 0 in
   * compression and t the direction of the disc's motion relative to the pin):
   *
   *   (λ² (M_c − μ A V_M) + λ (C_c + C_m − μ A V_C) + K_c − μ A V_K) φ_c = 0
   *
   *   M_c = T_cᵀ M T_c, K_c = T_cᵀ K T_c, C_c = T_cᵀ (C + C_f) T_c
   *   A = T_cᵀ P_tᵀ,  V_K = ½ P_n K T_c,  V_C = ½ P_n C T_c,  V_M = ½ P_n M T_c
   *
   * C is the damping of the bodies, C_f that of the contact (contact_damping()),
   * which has no part in V_C because P_n P_bᵀ = P_n P_tᵀ = 0. With R = P_b T_c
   *
   *   C_c = T_cᵀ C T_c + Rᵀ diag(c_b) R + A diag(c_t) Aᵀ.
   *
   * Modal damping C_m joins C_c. It is known in coupled coordinates only and takes no part in the
   * reactions: what C of the bodies it stands for, the ratios do not tell.
   */
  struct CoupledSystem
  {
    SecondOrderSystem                   frictionless;      ///< M_c, C_c (null: no damping), K_c; n × n
    std::shared_ptr<const SparseMatrix> body_damping;      ///< T_cᵀ C T_c, n × n; null: the bodies have no damping
    ContactDamping                      contact_damping;   ///< c_b and c_t
    std::shared_ptr<const SparseMatrix> friction_forces;   ///< A, n × n_c
    std::shared_ptr<const SparseMatrix> radial_motion;     ///< R = P_b T_c, n_c × n
    std::shared_ptr<const SparseMatrix> normal_stiffness;  ///< V_K, n_c × n
    std::shared_ptr<const SparseMatrix> normal_damping;    ///< V_C, n_c × n; null: the bodies have no damping
    std::shared_ptr<const SparseMatrix> normal_mass;       ///< V_M, n_c × n
    std::shared_ptr<const SparseMatrix> kernel;            ///< T_c, n_uncoupled × n
    std::shared_ptr<const ModalDamping> modal_damping;     ///< C_m; null: none

    /// Distribution of the coupled dofs.
    const Epetra_Map &map() const;

    /// Whether there is C_c or C_m.
    bool has_damping() const;

    /// (C_c + C_m) X; only if has_damping().
    MultiVector damping_times(const MultiVector &X) const;
  };

  /**
   * C_f = P_bᵀ diag(c_b) P_b + P_tᵀ diag(c_t) P_t [N s/m] on the uncoupled dofs;
   * null if all coefficients vanish. With a friction coefficient μ(w) that falls
   * with the sliding speed, c_t = μ'(w_0) |R_n0| is negative.
   */
  std::shared_ptr<const SparseMatrix> contact_damping(const ContactOperators &contact, const ContactDamping &damping);

  /// Couples the @p system.
  CoupledSystem couple(const SecondOrderSystem &system, const ContactOperators &contact, const ContactDamping &damping = {});

  /// The same system with other contact damping.
  CoupledSystem with_contact_damping(const CoupledSystem &system, const ContactDamping &damping);

  /// The system without any damping and without friction's share in it.
  CoupledSystem undamped(const CoupledSystem &system);

  /// M_c − μ A V_M, C_c − μ A V_C (without C_m) and K_c − μ A V_K as sparse matrices, at friction coefficient @p mu.
  SecondOrderSystem with_friction(const CoupledSystem &system, double mu);

  /// Q(s) = K + s C + s² M at a real shift s [rad/s]; K itself for s = 0.
  std::shared_ptr<const SparseMatrix> pencil_at(const SecondOrderSystem &system, double shift);

  /**
   * r_n = ½ P_n (λ² M + λ C + K) u as V_K u_c + λ V_C u_c + λ² V_M u_c: normal
   * contact reactions [N] (compression negative) of complex modes, n_c × k each
   * part. Modal damping has no part in them.
   */
  void normal_reactions(const CoupledSystem                     &system,
                        const std::vector<std::complex<double>> &lambda,
                        const MultiVector                       &real_part,
                        const MultiVector                       &imaginary_part,
                        DenseMatrix                             &reaction_real,
                        DenseMatrix                             &reaction_imaginary);
} // namespace Squeal
