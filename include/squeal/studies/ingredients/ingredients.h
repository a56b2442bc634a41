// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/common_points.h>
#include <squeal/studies/steps/friction_modes.h>

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

    /// Of all steps.
    double sum(double Cost::*quantity) const
    {
      return mesh.*quantity + assembly.*quantity + sliding.*quantity + modes.*quantity + friction.*quantity;
    }
  };

  /// A model of a scene, solved for its complex modes.
  struct SolvedModel
  {
    Parameters                     parameters;
    std::shared_ptr<const Scene>   scene;
    FrictionModes                  friction;
    std::shared_ptr<ModesAtPoints> shapes; ///< at the common points of the reference
    StepCosts                      costs;
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
   * Solves a variant; only what it does not share with the reference is computed, and shared steps are charged as the reference took them.
   * Nothing is printed.
   *
   * Throws ParameterError, MeshError or SolverError where there is no such model.
   */
  SolvedModel solve_variant(const ReferenceModel &reference, const Variation &variation, const Run &run);

  /// What a change of the model is good for.
  enum class ChangeKind
  {
    removes, ///< makes the model simpler: the cheapest one may have it
    adds,    ///< what the scene leaves out
    speeds,  ///< another way to the same modes: the cheapest model may have it where it is faster
    shows    ///< what matters, no more: no parameters make a model of that kind
  };

  /// A part of the model that may be switched on, off, or over to something else, by itself.
  struct Ingredient
  {
    const char *name;

    /// What the scene has, and what is tried in its place, in a few words.
    std::function<std::string(const Parameters &)> here, tried;

    /// Whether the scene is that way already, so that there is nothing to try.
    std::function<bool(const Parameters &)> is_present;

    /// Makes the change. What no parameter expresses is changed in the variation.
    std::function<void(Variation &)> change;

    ChangeKind kind;
    Departure  departure;

    /// Why the scene cannot have it; null if it can. Null: it always can.
    Reason (*obstacle)(const Parameters &, const std::optional<SlidingState> &) = nullptr;
  };

  /// All ingredients; of those with one name the simplest first.
  const std::vector<Ingredient> &ingredients();

  /// Those of which a scene differs, in the order of the list.
  std::vector<const Ingredient *> ingredients_to_try(const Parameters &parameters);

  /// The scene with some ingredients changed, from the earliest of their departures.
  Variation combined(const Parameters &parameters, const std::vector<const Ingredient *> &changed);

  /// A mode of the reference beside its counterpart in a variant. Where there is only one of them the other has no value.
  struct ModeChange
  {
    ModeLabel                           label;              ///< in the reference; in the variant if it has no counterpart there
    std::optional<std::complex<double>> reference, variant; ///< λ [rad/s]
    bool                                unstable_reference = false, unstable_variant = false;
    double                              overlap    = 0.;    ///< of the shapes; see PairedMode [-]
    bool                                in_cluster = false; ///< single modes have no counterpart by shape: λ decides within the cluster

    /// Change of the frequency [%]; of a mode without counterpart what takes it to the end of the band at @p band_end [rad/s].
    double frequency(double band_end) const;

    /// Change of the divergence rate [percentage points]; nothing for a mode without counterpart.
    std::optional<double> divergence() const;

    /// One grows by more than a weak divergence rate where the other one does not grow, or is not there.
    bool changes_verdict() const;
  };

  /// The largest change of a quantity, and its mode; null if there is none.
  struct LargestChange
  {
    double            amount = 0.;
    const ModeChange *mode   = nullptr;
  };

  /// What a variant changes, in all modes.
  struct Effect
  {
    std::vector<ModeChange> modes;    ///< in the order of the reference, then those that only the variant has
    double                  band_end; ///< of the variant [rad/s]
    int                     n_growing_real_reference, n_growing_real_variant;

    LargestChange frequency() const;  ///< of the modes in the band of both [%]
    LargestChange divergence() const; ///< likewise [percentage points]

    std::size_t n_unstable(bool in_variant) const;
    std::size_t n_lost() const; ///< modes of the reference without counterpart

    bool changes_verdict() const;

    /// The largest change in units of the accuracy asked for: up to 1 a model keeps it; infinite where the verdict changes.
    double severity(const IngredientsParameters &accuracy) const;
  };

  /// Pairs the modes of a variant with those of the reference by pair_modes() and compares them. All processes must call.
  Effect effect_of(const SolvedModel &reference, const SolvedModel &variant);

  /// A change that makes a model cheaper.
  struct CheaperChange
  {
    std::string ingredient; ///< of several changes of one ingredient at most one is made
    double      severity;   ///< its effect by itself in units of the accuracy asked for; up to 1 it keeps it
  };

  /// Changes that keep the accuracy together.
  struct ChangesTogether
  {
    std::vector<int> changes;       ///< by their numbers, ascending; empty: the model as it is
    std::vector<int> put_back;      ///< of changes that keep it by themselves but not together, in the order of their removal
    int              n_solved = 0;  ///< combinations that were tried
    double           severity = 0.; ///< of all together
  };

  /**
   * Makes all changes that keep the accuracy by themselves, of one ingredient the first in the list, and tries them together. While the
   * accuracy is not kept the change with the largest effect by itself is replaced by the next one of its ingredient with a smaller effect,
   * or left out if there is none.
   *
   * @param severity_of of changes made together; not asked for none, and for one alone it is that of the change
   */
  ChangesTogether cheapest_changes(const std::vector<CheaperChange>                            &changes,
                                   const std::function<double(const std::vector<int> &chosen)> &severity_of);

  /// What came of a change of the model, or why it could not be made.
  struct IngredientResult
  {
    const Ingredient *ingredient; ///< null for several changes together
    std::string       name, here, tried;
    std::string       obstacle = {}; ///< empty if it was made; else nothing below has a meaning
    Effect            effect   = {};
    double            severity = 0.; ///< see Effect::severity()
    StepCosts         costs    = {};
    int               n_dofs   = 0;

    std::vector<std::string> answer = {}; ///< the verdict of the variant, line by line
  };
} // namespace Squeal
