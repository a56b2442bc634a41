// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/common_points.h>
#include <squeal/studies/steps/friction_modes.h>

namespace Squeal
{
  /// First step in which a variant of a model differs from the reference; results of earlier steps are shared.
  enum class Departure
  {
    mesh,    ///< mesh, matrices and all later steps
    contact, ///< contact state for the linearisation
    modes,   ///< component modes, factorisation and real modes
    friction ///< contact and modal damping, complex modes
  };

  /// Cost of each step up to the modes of one model, as in a separate run.
  struct StepCosts
  {
    Cost mesh, assembly, sliding, modes, friction;

    /// Sum over all steps.
    double sum(double Cost::*quantity) const
    {
      return mesh.*quantity + assembly.*quantity + sliding.*quantity + modes.*quantity + friction.*quantity;
    }
  };

  /// A model with its complex modes.
  struct SolvedModel
  {
    Parameters                     parameters;
    std::shared_ptr<const Scene>   scene;
    FrictionModes                  friction;
    std::shared_ptr<ModesAtPoints> shapes; ///< shapes at the common points of the reference
    StepCosts                      costs;
  };

  /// The model as described by its parameters, with all data that variants may share.
  struct ReferenceModel : SolvedModel
  {
    FrictionlessModes                   frictionless;
    CommonPoints                        points;        ///< points of its own mesh
    std::shared_ptr<const SparseMatrix> displacements; ///< displacements at these points; see displacements_at()
  };

  /// Difference between a variant and the reference.
  struct Variation
  {
    Parameters parameters;
    Departure  departure = Departure::friction;

    /// All contact nodes stay closed, with the reactions of steady sliding.
    bool without_lift_off = false;

    /// Name of the recipe of a reduced basis; empty: full order.
    std::string basis = "";

    /// The basis contains real modes up to (1 + margin) times the end of the band.
    double margin = 0.;
  };

  /// Solves a meshed model, as steps of the run.
  ReferenceModel solve_reference(Scene &&scene, Run &run);

  /**
   * Solves a variant without output. Only the differing steps are computed; shared steps are charged at their cost in the reference.
   *
   * Throws ParameterError, MeshError or SolverError if the variant cannot be solved.
   */
  SolvedModel solve_variant(const ReferenceModel &reference, const Variation &variation, const Run &run);

  /// Type of a model change.
  enum class ChangeKind
  {
    removes, ///< simplifies the model: a candidate for the cheapest model
    adds,    ///< adds a feature that the model lacks
    speeds,  ///< another method for the same modes: a candidate for the cheapest model if it is faster
    shows    ///< for information only: not a candidate for the cheapest model
  };

  /// A model feature that can be varied individually: removed, added or replaced.
  struct Ingredient
  {
    const char *name;

    /// Current value and trial value of the feature, in a few words.
    std::function<std::string(const Parameters &)> here, tried;

    /// True if the change does not apply, for example because the model already has the trial value.
    std::function<bool(const Parameters &)> is_present;

    /// Makes the change in the parameters or, if no parameter can express it, in other members of the variation.
    std::function<void(Variation &)> change;

    ChangeKind kind;
    Departure  departure;

    /// Returns the reason why the change is impossible; null if it is possible. Without this function, the change is always possible.
    Reason (*obstacle)(const Parameters &, const std::optional<SlidingState> &) = nullptr;
  };

  /// All ingredients; the simplest variant of an ingredient comes first.
  const std::vector<Ingredient> &ingredients();

  /// Ingredients that are not present in the model, in the order of the list.
  std::vector<const Ingredient *> ingredients_to_try(const Parameters &parameters);

  /// Variation with several changed ingredients; it departs from the reference at the earliest step that any of them affects.
  Variation combined(const Parameters &parameters, const std::vector<const Ingredient *> &changed);

  /// A mode of the reference and its counterpart in a variant; either may be missing.
  struct ModeChange
  {
    ModeLabel                           label;              ///< label in the reference; in the variant if there is no counterpart
    std::optional<std::complex<double>> reference, variant; ///< λ [rad/s]
    bool                                unstable_reference = false, unstable_variant = false;
    double                              overlap    = 0.;    ///< overlap of both shapes, see PairedMode [-]
    bool                                in_cluster = false; ///< the mode has no individual counterpart by shape

    /// Change in the frequency [%]; for a mode without counterpart, the distance from @p band_end, the end of the band [rad/s].
    double frequency(double band_end) const;

    /// Change in the divergence rate [percentage points]; empty without counterpart.
    std::optional<double> divergence() const;

    /// True if one of the two modes is unstable with a divergence rate of at least weak_divergence, and the other is not unstable or is
    /// missing.
    bool changes_verdict() const;
  };

  /// Largest change in a quantity, and its mode; null if there is none.
  struct LargestChange
  {
    double            amount = 0.;
    const ModeChange *mode   = nullptr;
  };

  /// Effect of a variant on all modes.
  struct Effect
  {
    std::vector<ModeChange> modes;    ///< modes in the order of the reference, then unpaired modes of the variant
    double                  band_end; ///< end of the band of the variant [rad/s]
    int                     n_growing_real_reference, n_growing_real_variant;

    LargestChange frequency() const;  ///< largest change over reference modes in the band of the variant [%]
    LargestChange divergence() const; ///< largest change over modes with a counterpart [percentage points]

    std::size_t n_unstable(bool in_variant) const;
    std::size_t n_lost() const; ///< number of reference modes without counterpart

    bool changes_verdict() const;

    /// Largest change relative to the required accuracy, acceptable up to 1; infinite if a verdict changes.
    double severity(const IngredientsParameters &accuracy) const;
  };

  /// Pairs the modes of a variant with modes of the reference by shape or label, and compares them. Collective.
  Effect effect_of(const SolvedModel &reference, const SolvedModel &variant);

  /// A change that makes a model cheaper.
  struct CheaperChange
  {
    std::string ingredient; ///< name; at most one change of each ingredient is made
    double      severity;   ///< its individual effect relative to the required accuracy; acceptable up to 1
  };

  /// Combined changes that meet the accuracy.
  struct ChangesTogether
  {
    std::vector<int> changes;       ///< indices, ascending; empty: the model is unchanged
    std::vector<int> put_back;      ///< changes that are acceptable individually but not in combination, in the order of removal
    int              n_solved = 0;  ///< number of combinations tried
    double           severity = 0.; ///< severity of the combination
  };

  /**
   * Combines the changes that are individually acceptable; of several changes of an ingredient, the first in the list is used. While the
   * accuracy is not met, the change with the largest individual effect is replaced by the next change of its ingredient with a smaller
   * effect, or removed if there is none.
   *
   * @param severity_of severity of a combination of at least two changes
   */
  ChangesTogether cheapest_changes(const std::vector<CheaperChange>                            &changes,
                                   const std::function<double(const std::vector<int> &chosen)> &severity_of);

  /// Result of a model change, or the reason why the change could not be made.
  struct IngredientResult
  {
    const Ingredient *ingredient; ///< null for combined changes
    std::string       name, here, tried;
    std::string       obstacle = {}; ///< empty if the change was made; otherwise the following members are unused
    Effect            effect   = {};
    double            severity = 0.; ///< see Effect::severity()
    StepCosts         costs    = {};
    int               n_dofs   = 0;

    std::vector<std::string> answer = {}; ///< verdict of the variant, line by line
  };
} // namespace Squeal
