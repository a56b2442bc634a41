// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/contact_operators.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/system/terms.h>

#include <complex>
#include <vector>

namespace Squeal
{
  /// Parameters of a coupled system that stay free; those of the bodies have their values.
  namespace SystemParameter
  {
    inline constexpr const char *friction        = "mu";                             ///< μ [-]
    inline constexpr const char *radial_damping  = "damping along b of the contact"; ///< c_b of each contact node [N s/m]
    inline constexpr const char *sliding_damping = "damping along t of the contact"; ///< c_t of each contact node [N s/m]
    inline constexpr const char *modal_damping   = "modal damping";                  ///< 2 ζ ω of each damped mode [1/s]

  } // namespace SystemParameter

  /// Viscous damping of the contact nodes, one coefficient for each [N s/m]; an empty list means zeros.
  struct ContactDamping
  {
    std::vector<double> radial;  ///< c_b, along b
    std::vector<double> sliding; ///< c_t, along t

    /// As values of the parameters of a coupled system.
    ParameterValues values() const;
  };

  /**
   * The bodies coupled by contact, with friction as a term of rank n_c that is
   * affine in μ (eqs. (5) to (8) of the paper, with the sign of r_n ≤ 0 in
   * compression and t the direction of the disc's motion relative to the pin):
   *
   *   (λ² (M_c − μ A V_M) + λ (C_c − μ A V_C) + K_c − μ A V_K) φ_c = 0
   *
   * as a list of terms. Of each term X of the bodies, such as K, it has
   *
   *   X_c = T_cᵀ X T_c   and   −μ A V_X,   A = T_cᵀ P_tᵀ,  V_X = S X T_c,
   *
   * and of the contact's own damping, which has no part in the reactions because S P_bᵀ = S P_tᵀ = 0,
   *
   *   Rᵀ diag(c_b) R   and   A diag(c_t) Aᵀ,   R = P_b T_c.
   *
   * Springs of the contact are a term of the stiffness, T_cᵀ P_nᵀ k diag(D) P_n T_c, whose V is −k diag(D) P_n T_c.
   *
   * add_modal_damping() appends a term of its own.
   */
  struct CoupledSystem
  {
    std::vector<Term>                   terms;
    ParameterValues                     values;                             ///< of all parameters, with μ = 0
    std::string                         varied = SystemParameter::friction; ///< parameter over which charts follow the modes
    std::shared_ptr<const SparseMatrix> mass, stiffness;                    ///< M_c and K_c, n × n: the symmetric terms without friction
    double hidden_square = 0.; ///< |λ|² up to this is zero: rounding errors of K_c, see unresolved_square() [rad²/s²]
    std::shared_ptr<const LowRankFactor> friction_forces; ///< A, n × n_c
    std::shared_ptr<const SparseMatrix>  kernel;          ///< T_c, n_uncoupled × n

    /// Distribution of the coupled dofs.
    const RowMap &map() const;

    /// n_c
    int n_contact() const
    {
      return friction_forces->rank();
    }

    /// The values with one of the varied parameter, which is μ of a mesh, and with others in place of those that are given.
    ParameterValues at(double value, const ParameterValues &others = {}) const;

    /// Whether there is damping without friction.
    bool has_damping() const;
  };

  /// C_f = P_bᵀ diag(c_b) P_b + P_tᵀ diag(c_t) P_t [N s/m] on the uncoupled dofs; null if all coefficients vanish. With a friction
  /// coefficient μ(w) that falls with the sliding speed, c_t = μ'(w_0) |R_n0| is negative.
  std::shared_ptr<const SparseMatrix> contact_damping(const ContactOperators &contact, const ContactDamping &damping);

  /// A term of the coupled bodies, and its part V in the normal reactions, n_c × n; null: none.
  struct CoupledTerm
  {
    Term                                term;
    std::shared_ptr<const SparseMatrix> reaction;
  };

  /**
   * The list of terms from those of the coupled bodies, with those of friction and of damping of the contact.
   *
   * @param tangential Aᵀ = P_t T_c, n_c × n
   * @param radial     R = P_b T_c, n_c × n
   * @param values     of the parameters of the bodies' coefficients
   */
  CoupledSystem coupled_system(const std::vector<CoupledTerm>     &bodies,
                               std::shared_ptr<const SparseMatrix> tangential,
                               std::shared_ptr<const SparseMatrix> radial,
                               const ContactDamping               &damping = {},
                               const ParameterValues              &values  = {});

  /// Finds the mass, the stiffness and what follows from them of a system with other terms or values.
  void set_frictionless_matrices(CoupledSystem &system);

  /// Couples bodies, given by merged() terms, or by others with the values of their parameters.
  CoupledSystem couple(const std::vector<Term> &bodies,
                       const ContactOperators  &contact,
                       const ContactDamping    &damping = {},
                       const ParameterValues   &values  = {});

  /// The same system with other values of some parameters.
  CoupledSystem with_values(CoupledSystem system, const ParameterValues &others);

  /// The system without its terms in λ.
  CoupledSystem undamped(CoupledSystem system);

  /**
   * Damping of the real coupled modes Φ (n × k, M_c-orthonormal), each by its own ratio ζ_j of the critical one,
   *
   *   C_m = M_c Φ diag(2 ζ_j ω_j) Φᵀ M_c     n × n, symmetric, of rank k, never formed
   *
   * so that Φᵀ C_m Φ = diag(2 ζ_j ω_j) and, without friction and other damping,
   * λ_j = −ζ_j ω_j ± i ω_j √(1 − ζ_j²). Known in coupled coordinates only, it takes no part in the
   * reactions: what damping of the bodies it stands for, the ratios do not tell.
   *
   * @param eigenvalues ω² [rad²/s²], one for each mode; a mode with ω = 0 gets no damping
   * @param ratios      ζ [-], one for each mode
   */
  void add_modal_damping(CoupledSystem             &system,
                         const MultiVector         &modes,
                         const std::vector<double> &eigenvalues,
                         const std::vector<double> &ratios);

  /// M_c − μ A V_M, C_c − μ A V_C and K_c − μ A V_K as sparse matrices; see sparse_matrices().
  SecondOrderSystem with_friction(const CoupledSystem &system, double mu);

  /// Q(s) = K + s C + s² M at a real shift s [rad/s]; K itself for s = 0.
  std::shared_ptr<const SparseMatrix> pencil_at(const SecondOrderSystem &system, double shift);

  /// V_K + s V_C + s² V_M at a real shift s [rad/s], n_c × n; null where there is no friction.
  std::shared_ptr<const SparseMatrix> normal_reactions(const CoupledSystem &system, double shift);

  /// r_n = S (λ² M + λ C + K) u as V_K u_c + λ V_C u_c + λ² V_M u_c: normal contact reactions [N] (compression negative) of complex modes,
  /// n_c × k.
  ComplexDenseMatrix normal_reactions(const CoupledSystem                     &system,
                                      const std::vector<std::complex<double>> &lambda,
                                      const MultiVector                       &real_part,
                                      const MultiVector                       &imaginary_part);

  /// The system of a family of terms: bodies coupled as couple() does, each term with its own part in the reactions. Its mass and
  /// stiffness, the parameter values with it, are those in the middle of the family.
  CoupledSystem coupled_family(const TermFamily &bodies, const ContactOperators &contact, const ContactDamping &damping = {});
} // namespace Squeal
