// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/contact_operators.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/system/terms.h>

#include <complex>
#include <vector>

namespace Squeal
{
  /// Parameters of a coupled system in addition to the parameters of the bodies.
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

    /// Values for the parameters of a coupled system.
    ParameterValues values() const;
  };

  /**
   * The bodies coupled by contact, as a list of terms of
   *
   *   (λ² (M_c − μ A V_M) + λ (C_c − μ A V_C) + K_c − μ A V_K) φ_c = 0
   *
   * with friction of rank n_c, proportional to μ (eqs. (5) to (8) of the paper, with r_n ≤ 0 in compression and t in the direction of the
   * disc's motion relative to the pin). Each term X of the bodies, for example K, gives
   *
   *   X_c = T_cᵀ X T_c   and   −μ A V_X,   A = T_cᵀ P_tᵀ,  V_X = S X T_c.
   *
   * Contact damping, which does not contribute to the reactions because S P_bᵀ = S P_tᵀ = 0, gives
   *
   *   Rᵀ diag(c_b) R   and   A diag(c_t) Aᵀ,   R = P_b T_c.
   *
   * Contact springs add a stiffness term, T_cᵀ P_nᵀ k diag(D) P_n T_c, with V = −k diag(D) P_n T_c.
   *
   * add_modal_damping() appends another term.
   */
  struct CoupledSystem
  {
    std::vector<Term>                   terms;
    ParameterValues                     values;                             ///< values of all parameters, with μ = 0
    std::string                         varied = SystemParameter::friction; ///< parameter that varies in charts
    std::shared_ptr<const SparseMatrix> mass, stiffness;                    ///< M_c and K_c, n × n: the symmetric terms without friction
    double hidden_square = 0.; ///< |λ|² up to this value counts as zero: rounding errors of K_c, see unresolved_square() [rad²/s²]
    std::shared_ptr<const LowRankFactor> friction_forces; ///< A, n × n_c
    std::shared_ptr<const SparseMatrix>  kernel;          ///< T_c, n_uncoupled × n

    /// Distribution of the coupled dofs.
    const RowMap &map() const;

    /// Number of contact nodes n_c.
    int n_contact() const
    {
      return friction_forces->rank();
    }

    /// Parameter values with @p value for the varied parameter (μ for a mesh) and the values @p others for other parameters.
    ParameterValues at(double value, const ParameterValues &others = {}) const;

    /// True if there is damping at the parameter `values`.
    bool has_damping() const;
  };

  /// C_f = P_bᵀ diag(c_b) P_b + P_tᵀ diag(c_t) P_t [N s/m] on the uncoupled dofs; null if all coefficients vanish. If μ(w) falls with the
  /// sliding speed, c_t is negative.
  std::shared_ptr<const SparseMatrix> contact_damping(const ContactOperators &contact, const ContactDamping &damping);

  /// A term of the coupled bodies, and its contribution V to the normal reactions, n_c × n; null: none.
  struct CoupledTerm
  {
    Term                                term;
    std::shared_ptr<const SparseMatrix> reaction;
  };

  /**
   * Coupled system from the terms of the coupled bodies, with added terms for friction and contact damping.
   *
   * @param tangential Aᵀ = P_t T_c, n_c × n
   * @param radial     R = P_b T_c, n_c × n
   * @param values     values of the parameters in the coefficients of the bodies' terms
   */
  CoupledSystem coupled_system(const std::vector<CoupledTerm>     &bodies,
                               std::shared_ptr<const SparseMatrix> tangential,
                               std::shared_ptr<const SparseMatrix> radial,
                               const ContactDamping               &damping = {},
                               const ParameterValues              &values  = {});

  /// Updates mass, stiffness and derived quantities after a change of terms or values.
  void set_frictionless_matrices(CoupledSystem &system);

  /// Couples bodies given by merged() terms, or by terms with parameter values.
  CoupledSystem couple(const std::vector<Term> &bodies,
                       const ContactOperators  &contact,
                       const ContactDamping    &damping = {},
                       const ParameterValues   &values  = {});

  /// The system with other values of some parameters.
  CoupledSystem with_values(CoupledSystem system, const ParameterValues &others);

  /// The system without its damping terms (λ¹).
  CoupledSystem undamped(CoupledSystem system);

  /**
   * Adds modal damping with a damping ratio ζ_j for each real coupled mode of Φ (n × k, M_c-orthonormal),
   *
   *   C_m = M_c Φ diag(2 ζ_j ω_j) Φᵀ M_c     n × n, symmetric, of rank k, never formed
   *
   * so that Φᵀ C_m Φ = diag(2 ζ_j ω_j) and, without friction and other damping,
   * λ_j = −ζ_j ω_j ± i ω_j √(1 − ζ_j²). Modal damping does not contribute to the reactions, because the ratios do not
   * determine which body dissipates.
   *
   * @param eigenvalues ω² [rad²/s²], one for each mode; modes with ω = 0 are undamped
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

  /// V_K + s V_C + s² V_M at a real shift s [rad/s], n_c × n; null without friction.
  std::shared_ptr<const SparseMatrix> normal_reactions(const CoupledSystem &system, double shift);

  /// r_n = S (λ² M + λ C + K) u = V_K u_c + λ V_C u_c + λ² V_M u_c: normal contact reactions [N] of complex modes, negative in compression,
  /// n_c × k.
  ComplexDenseMatrix normal_reactions(const CoupledSystem                     &system,
                                      const std::vector<std::complex<double>> &lambda,
                                      const MultiVector                       &real_part,
                                      const MultiVector                       &imaginary_part);

  /// couple() for the common terms of a family of systems. Mass, stiffness and parameter values are those of the averaged system.
  CoupledSystem coupled_family(const TermFamily &bodies, const ContactOperators &contact, const ContactDamping &damping = {});
} // namespace Squeal
