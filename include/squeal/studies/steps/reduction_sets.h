// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/bases/basis_recipes.h>
#include <squeal/system/system_file.h>
#include <squeal/studies/steps/friction_modes.h>

namespace Squeal
{
  /// What a study of reduced bases measures, and on which problem.
  struct ReductionPlan
  {
    std::vector<const BasisRecipe *> recipes;
    bool                             has_friction;               ///< complex modes; else real ones
    double                           friction_coefficient;       ///< 0 without friction
    double                           largest_circular_frequency; ///< end of the band [rad/s]

    /// Whether one of the bases rests on something.
    bool rests_on(BasisSource source) const;
  };

  /// Throws ParameterError if the parameters name a basis that is none, or one that does not fit the problem.
  ReductionPlan reduction_plan(const Parameters &parameters);

  /// The same for a system file, at a value of its varied parameter.
  ReductionPlan reduction_plan(const Parameters &parameters, const SystemFile &file, const CoupledSystem &system, double value);

  /// When a study of reduced bases leaves parameters unused.
  std::vector<UsageRule> reduction_usage();

  /// What computing something that bases rest on has cost.
  struct Charge
  {
    BasisSource           source;
    std::string           variant;      ///< truncation, frequency or tolerance; empty where there is one only
    std::optional<int>    n_vectors;    ///< that a basis gets; none of a factor
    std::optional<double> end_of_band;  ///< of modes: all below it were solved for [Hz]
    std::optional<int>    n_solved;     ///< of modes: how many these are; more than a basis gets where the last one is multiple
    double                seconds = 0.; ///< of the processor
  };

  /**
   * The sets of vectors that the bases of a plan are made of, computed as steps of the run, with the processor seconds of each: a basis
   * pays for all that it rests on, and for nothing else.
   *
   * Modes are charged as to somebody who asks an eigensolver for the lowest k of them, or for those below a frequency: one solution, its
   * factorisation and its check by inertia included. Where the band ends that holds k modes is found beforehand and not charged; neither
   * are the matrices of the components.
   */
  class ReductionSets
  {
  public:
    /// Computes what does not change from basis to basis: static and complex modes, of a coupled @p system with the damping of the problem.
    /// All arguments must outlive the sets. Throws ParameterError or SolverError if there are no modes of a kind that is needed.
    ReductionSets(const ReductionPlan &plan, const FrictionlessModes &frictionless, const CoupledSystem &system, Run &run);

    /// Computes component modes in the place of those of an earlier truncation, and returns their numbers. Throws SolverError if there are
    /// too few.
    std::map<BasisSource, int> truncate(const ModeTruncation &truncation);

    /// Takes the real coupled modes below a frequency [Hz], those of the band for 0. Throws SolverError if there are none.
    void take_real_modes(double frequency);

    /// Grows a basis by residuals, until the estimated errors of λ are below a relative tolerance, in the place of an earlier one.
    void grow(double tolerance);

    /// Processor seconds of all that a basis rests on, each set counted once.
    double cost(const BasisRecipe &recipe) const;

    /// Processor seconds that the modes of full order need before they are solved for: the factor of K_c, with friction K_c⁻¹ A.
    double full_order_factorisation() const;

    /// What all sets have cost, those replaced by others included.
    Table cost_table() const;

    const ReductionPlan     &plan;
    const FrictionlessModes &frictionless;
    const CoupledSystem     &system;
    Run                     &run;
    BasisIngredients         ingredients; ///< everything computed so far

  private:
    /// From now on bases pay this for its source.
    void book(const Charge &charge);

    /// Books vectors that bases are made of from now on, in the place of an earlier set; returns their number.
    int keep(Charge charge, MultiVector set);

    void charge_coupled_factor();
    void compute_static_modes();
    void compute_snapshots();

    /// Keeps the lowest modes of a component: @p count of them, or, where that is zero, all up to @p frequency [Hz].
    int keep_lowest(Charge charge, Component component, ContactBoundary boundary, double frequency, int count);

    const Linearisation &linearisation;

    std::vector<Charge>                                 charges; ///< of all sets
    std::map<BasisSource, double>                       seconds; ///< of the sets in use
    std::map<BasisSource, std::unique_ptr<MultiVector>> vectors;
    std::unique_ptr<InertiaRelief>                      response;
    std::unique_ptr<StaticModes>                        static_modes;
  };
} // namespace Squeal
