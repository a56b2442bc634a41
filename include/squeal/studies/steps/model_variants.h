#pragma once

#include <squeal/estimates/common_points.h>
#include <squeal/studies/steps/friction_modes.h>

#include <memory>

namespace Squeal
{
  /// The step from which on a variant of a model differs from it; what comes before serves both.
  enum class Departure
  {
    mesh,    ///< mesh, matrices and all that follows
    contact, ///< the state about which the system is linearised
    modes,   ///< component modes, factorisation and real modes
    friction ///< damping of contact and modes, complex modes
  };

  /// What the steps to the modes of one model take, as in a run of its own.
  struct StepCosts
  {
    Cost mesh, assembly, sliding, modes, friction;

    double seconds() const;     ///< wall time [s]
    double cpu_seconds() const; ///< processor time [s]
  };

  /// A model of a scene, solved for its complex modes.
  struct SolvedModel
  {
    Parameters                     parameters;
    std::shared_ptr<const Scene>   scene;
    FrictionModes                  friction;
    std::shared_ptr<ModesAtPoints> shapes; ///< at the common points of the reference
    StepCosts                      costs;

    /// Dofs of the uncoupled bodies.
    int n_dofs() const;
  };

  /// The scene as its parameters describe it, with all that variants of it may share.
  struct ReferenceModel : SolvedModel
  {
    FrictionlessModes                   frictionless;
    CommonPoints                        points;        ///< of its mesh
    std::shared_ptr<const SparseMatrix> displacements; ///< there; see displacements_at()
  };

  /// How a variant differs from the reference.
  struct Variation
  {
    Parameters parameters;
    Departure  departure = Departure::friction;

    /// All contact nodes stay closed, with the reactions of steady sliding.
    bool without_lift_off = false;

    /// Reduced model in the place of the full one: name of a recipe; empty: none.
    std::string basis = "";

    /// The basis has real modes up to (1 + margin) times the end of the band.
    double margin = 0.;
  };

  /// Solves a meshed scene, as steps of the run.
  ReferenceModel solve_reference(Scene &&scene, Run &run);

  /**
   * Solves a variant; only what it does not share with the reference is computed, and shared steps are charged as the reference
   * took them. Nothing is printed.
   *
   * Throws ParameterError, MeshError or SolverError where there is no such model.
   */
  SolvedModel solve_variant(const ReferenceModel &reference, const Variation &variation, const Run &run);
} // namespace Squeal
