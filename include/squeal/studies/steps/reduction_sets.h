// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/bases/basis_recipes.h>
#include <squeal/studies/steps/friction_modes.h>
#include <squeal/studies/steps/written_system.h>

namespace Squeal
{
  /// Bases that a study compares, and the eigenproblem that they reduce.
  struct ReductionPlan
  {
    std::vector<const BasisRecipe *> recipes;
    bool                             has_friction;               ///< true: complex modes; false: real modes
    double                           friction_coefficient;       ///< 0 without friction
    double                           largest_circular_frequency; ///< end of the band [rad/s]
    std::vector<FileParameter>       parameters;                 ///< parameters of the system, fixed at their values

    /// True if one of the bases needs this source.
    bool rests_on(BasisSource source) const;
  };

  /// Throws ParameterError if the parameters name an unknown basis, or a basis that does not fit the eigenproblem.
  ReductionPlan reduction_plan(const Parameters &parameters);

  /// reduction_plan() for a system file, at a value of its varied parameter.
  ReductionPlan reduction_plan(const Parameters &parameters, const SystemFile &file, const CoupledSystem &system, double value);

  /// Conditions under which parameters are unused in a study of reduced bases.
  std::vector<UsageRule> reduction_usage();

  /// Cost of a source of bases.
  struct Charge
  {
    BasisSource           source;
    std::string           variant;      ///< truncation, frequency or tolerance; empty if there is only one variant
    std::optional<int>    n_vectors;    ///< number of vectors of the source; empty for a factor
    std::optional<double> end_of_band;  ///< for modes: all modes below this frequency were computed [Hz]
    std::optional<int>    n_solved;     ///< for modes: number of modes computed; larger than n_vectors if the last mode is multiple
    double                seconds = 0.; ///< CPU time
  };

  /**
   * Sets of vectors for the bases of a plan, computed as steps of the run, with their CPU times. A basis is charged only for the sources
   * that it needs.
   *
   * Modes are charged as a stand-alone solve for the lowest k modes, or for the modes below a frequency: one solution including its
   * factorisation and inertia check. The search for the frequency below which there are k modes and the assembly of the component matrices
   * are not charged.
   */
  class ReductionSets
  {
  public:
    /// Computes the sets that bases share: real modes, static modes and snapshots. @p system: coupled system of the eigenproblem. All
    /// arguments must outlive the object. Throws SolverError if required modes do not exist.
    ReductionSets(const ReductionPlan &plan, const FrictionlessModes &frictionless, const CoupledSystem &system, Run &run);

    /// Replaces the component modes by modes of another truncation and returns their numbers. Throws SolverError if there are too few.
    std::map<BasisSource, int> truncate(const ModeTruncation &truncation);

    /// Selects the real coupled modes below a frequency [Hz]; 0: the end of the band. Throws SolverError if there are none.
    void take_real_modes(double frequency);

    /// Replaces the residual-grown basis by a basis with estimated relative errors of λ below a tolerance.
    void grow(double tolerance);

    /// CPU time of all sources of a basis, each set counted once [s].
    double cost(const BasisRecipe &recipe) const;

    /// CPU time before full-order modes can be computed [s]: the factor of K_c and, with friction, K_c⁻¹ A.
    double full_order_factorisation() const;

    /// Cost of all sets, including replaced ones.
    Table cost_table() const;

    const ReductionPlan     &plan;
    const FrictionlessModes &frictionless;
    const CoupledSystem     &system;
    Run                     &run;
    BasisIngredients         ingredients; ///< vectors computed so far

  private:
    /// Records the cost of a source, which is charged to later bases that use this source.
    void book(const Charge &charge);

    /// Stores a set of vectors with its cost, replacing an earlier set; returns the number of vectors.
    int keep(Charge charge, MultiVector set);

    void charge_coupled_factor();
    void compute_static_modes();
    void compute_snapshots();

    /// Stores the lowest modes of a component: @p count modes or, if @p count is zero, all up to @p frequency [Hz].
    int keep_lowest(Charge charge, Component component, ContactBoundary boundary, double frequency, int count);

    const Linearisation &linearisation;

    std::vector<Charge>                                 charges; ///< costs of all sets
    std::map<BasisSource, double>                       seconds; ///< CPU time of each set in use
    std::map<BasisSource, std::unique_ptr<MultiVector>> vectors;
    std::unique_ptr<InertiaRelief>                      response;
    std::unique_ptr<StaticModes>                        static_modes;
  };
} // namespace Squeal
