// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/bases/rigid_body.h>
#include <squeal/contact/contact_operators.h>
#include <squeal/linear_algebra/dense.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/parameters/operation.h>
#include <squeal/parameters/sliding.h>
#include <squeal/sliding/contact_problem.h>

#include <memory>
#include <vector>

namespace Squeal
{
  /// Residuals of a steady sliding state, computed from the displacements of the full model.
  struct SlidingChecks
  {
    double residual;        ///< ‖K u − P_nᵀ r_n − μ P_tᵀ r_n − f_p‖ / ‖P_nᵀ r_n‖ without the drive's force [-]
    double load;            ///< largest relative error of the load of a backplate; 0 if none is prescribed [-]
    double tension;         ///< largest r_n relative to the largest load of a backplate or pressed face; ≤ 0 without tension [-]
    double overlap;         ///< largest g from P_n u, relative to the travel: the largest |P_n u| (with pressed faces: the largest |u|) [-]
    double complementarity; ///< largest |r_n g| relative to load × travel [-]
    double force_balance;   ///< resultant of contact, pressure and support forces of each component, relative to the load [-]
    double moment_balance;  ///< resultant moment about the origin, relative to load × largest axis distance [-]
  };

  /// Quasi-static state for the linearisation: contact forces, gaps and displacements.
  struct SlidingState
  {
    std::vector<double>          reactions;          ///< R_n0 [N] ≤ 0, one for each contact node
    std::vector<double>          gaps;               ///< g [m] ≤ 0
    std::vector<bool>            closed;             ///< true for closed nodes, the set S_0
    std::vector<double>          approach;           ///< travel of the backplate of each component [m]; 0 for the disc
    std::shared_ptr<MultiVector> displacement;       ///< u [m], n × 1, elastic, relative to the moved backplates
    std::shared_ptr<MultiVector> total_displacement; ///< u with the travel of the backplates [m], n × 1
    SlidingChecks                checks;
    ContactUniqueness            uniqueness;
    int                          n_steps; ///< number of iterations of the active-set method
  };

  /// Data common to all steady sliding states of a model.
  struct SlidingModel
  {
    /**
     * Computes the attachment modes. All arguments except the last two must outlive this object.
     *
     * @param largest_circular_frequency end of the band [rad/s], see static_response()
     */
    SlidingModel(const Model             &model,
                 const ContactInterface  &interface,
                 const ContactOperators  &contact,
                 const SecondOrderSystem &system,
                 double                   largest_circular_frequency,
                 FactorizationLibrary     library);

    const Model                            &model;
    const ContactInterface                 &interface;
    const ContactOperators                 &contact;
    const SecondOrderSystem                &system;
    std::vector<std::optional<MultiVector>> free_motions; ///< unconstrained rigid-body motions of each body
    InertiaRelief                           response;
    MultiVector                             normal, tangential; ///< attachment modes K⁻¹ P_nᵀ and K⁻¹ P_tᵀ [m/N], n × n_c
  };

  /**
   * Quasi-static steady sliding, eqs. (1) to (3) of the paper with u̇ = 0:
   *
   *   K u = P_nᵀ r_n + P_tᵀ r_t,   r_t = μ r_n,   r_n ≤ 0,  g ≤ 0,  r_n g = 0
   *   g = P_n u + a (d − gap)
   *
   * u is the elastic displacement relative to the backplates, which are rigid, guided along their travel e (contact/travel.h), and
   * displaced towards the disc by d; a = −e·n; the gaps in @p parameters are along e. Each load is the force on its backplate along e, Σ
   * e·n r_n + Σ e·t r_t. Friction acts along t at every closed node; a drive balances the moment of friction on the disc.
   *
   * With BackplateControl::pressure there are no backplates, d = 0, and f_p from pressed_faces.h is added to the forces. Bodies may then
   * have free motions N z, which are part of u and follow from equilibrium, Nᵀ (P_nᵀ r_n + P_tᵀ r_t + f_p) = 0.
   *
   * The problem is condensed to the contact nodes by the normal and tangential attachment modes, F_nn = P_n K⁻¹ P_nᵀ and F_nt = P_n K⁻¹
   * P_tᵀ.
   *
   * Throws MeshError if a body has no direction of travel; ParameterError if there is no pin with a given name, if a gap is not
   * smaller than the height of the pin, or if the displacement closes no gap of a backplate; SolverError if no state is found, or if
   * loads or friction act on a free motion without resistance (see floating_disc.h).
   */
  SlidingState steady_sliding(const SlidingModel &sliding, const OperationParameters &operation, const SlidingParameters &parameters);

  /**
   * Derivatives of the reactions with respect to k parameters of the bodies at constant friction coefficient, loads, travel and closed
   * nodes, n_c × k [N per unit]:
   *
   *   K u' = f' + P_nᵀ r' + μ P_tᵀ r',   P_n u' + a d' − a gap' = 0 at closed nodes,   r' = 0 at open nodes
   *
   * where the free motions R of the bodies remain in equilibrium, Rᵀ (f' + P_nᵀ r' + μ P_tᵀ r') = 0, and loads are constant. No full-order
   * solve is necessary, because the attachment modes also give the gaps due to f', P_n K⁻¹ f' = (K⁻¹ P_nᵀ)ᵀ f'. Normals and the component
   * of t along the travel are constant.
   *
   * @param state       steady sliding state at these parameters
   * @param force_rates f' = −K' u + μ (P_t')ᵀ r plus other changes of the forces on the bodies, n × k [N per unit]
   * @param gap_rates   derivatives of initial_gaps(), n_c × k [m per unit]
   */
  DenseMatrix reaction_rates(const SlidingModel        &sliding,
                             const OperationParameters &operation,
                             const SlidingParameters   &parameters,
                             const SlidingState        &state,
                             const MultiVector         &force_rates,
                             const DenseMatrix         &gap_rates);

  /// Gap of each node along its travel, before the backplates move [m].
  Eigen::VectorXd initial_gaps(const Model &model, const ContactInterface &interface, const SlidingParameters &parameters);

  /// Throws ParameterError for parameters of the section `Steady sliding` that are inconsistent with the pins, and MeshError for bodies
  /// without a direction of travel.
  void check_sliding(const Model               &model,
                     const ContactInterface    &interface,
                     const OperationParameters &operation,
                     const SlidingParameters   &parameters);

  struct PinContact
  {
    std::string  pin;
    int          side; ///< ±1: above or below the disc; 0: the pin travels along the normal of its face
    unsigned int n_nodes, n_open;
    double       load;             ///< −Σ r_n [N]
    double       sliding_offset;   ///< offset of the centre of pressure from the centre of the face along t [m]
    double       radial_offset;    ///< offset outwards; along the axis if side = 0, and along b if the disc does not rotate about z [m]
    double       largest_pressure; ///< largest −r_n / area of the node [Pa]
    double       sliding_speed;    ///< mean of w_0, weighted by the load [m/s]
    double       radial_damping;   ///< Σ c_b [N s/m]
    double       sliding_damping;  ///< Σ c_t [N s/m]
    double       approach;         ///< travel of the backplate [m]
    double       largest_gap;      ///< largest gap of its nodes [m]
  };

  /// Contact quantities of each pin. For a pin without load, offsets are zero and the speed is taken at the centre of the face.
  std::vector<PinContact> pin_contacts(const Model               &model,
                                       const ContactInterface    &interface,
                                       const SlidingState        &state,
                                       const OperationParameters &operation);
} // namespace Squeal
