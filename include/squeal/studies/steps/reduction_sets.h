// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/bases/basis_recipes.h>
#include <squeal/studies/steps/friction_modes.h>
#include <squeal/studies/steps/written_system.h>

namespace Squeal
{
  /// Eigenproblem of a study of reduced bases.
  struct ReductionPlan
  {
    std::vector<const BasisRecipe *> recipes;
    bool                             has_friction;               ///< complex modes; else real ones
    double                           friction_coefficient;       ///< 0 without friction
    double                           largest_circular_frequency; ///< end of the band [rad/s]
    std::vector<FileParameter>       parameters;                 ///< of the system, at their given values

    /// True if one of the bases needs this source.
    bool rests_on(BasisSource source) const;
  };

  /// Throws ParameterError if the parameters name an unknown basis, or one that does not fit the eigenproblem.
  ReductionPlan reduction_plan(const Parameters &parameters);

  /// reduction_plan() for a system file, at a value of its varied parameter.
  ReductionPlan reduction_plan(const Parameters &parameters, const SystemFile &file, const CoupledSystem &system, double value);

  /// Conditions under which parameters are unused in a study of reduced bases.
  std::vector<UsageRule> reduction_usage();

  /// Cost of a source of bases.
  struct Charge
  {
    BasisSource           source;
    std::string           variant;      ///< truncation, frequency or tolerance; empty if there is only one
    std::optional<int>    n_vectors;    ///< number of vectors in a basis; none for a factor
    std::optional<double> end_of_band;  ///< of modes: all below were computed [Hz]
    std::optional<int>    n_solved;     ///< of modes: number computed; larger than n_vectors if the last one is multiple
    double                seconds = 0.; ///< CPU time
  };

  /**
   * Sets of vectors for the bases of a plan, computed as steps of the run, with their CPU times: a basis is charged exactly the sources
   * that it needs.
   *
   * Modes cost as much as a stand-alone solve for the lowest k modes, or for those below a frequency: one solution including its
   * factorisation and inertia check. Finding the end of the band that contains k modes is not charged; neither are the matrices of the
   * components.
   */
  class ReductionSets
  {
  public:
    /// Computes sets that do not depend on the basis: static and complex modes of a coupled @p system with the damping of the eigenproblem.
    /// All arguments must outlive the object. Throws ParameterError or SolverError if required modes do not exist.
    ReductionSets(const ReductionPlan &plan, const FrictionlessModes &frictionless, const CoupledSystem &system, Run &run);

    /// Replaces the component modes by those of another truncation and returns their numbers. Throws SolverError if there are too few.
    std::map<BasisSource, int> truncate(const ModeTruncation &truncation);

    /// Selects the real coupled modes below a frequency [Hz], those of the band for 0. Throws SolverError if there are none.
    void take_real_modes(double frequency);

    /// Replaces the basis grown by residuals by one for which the estimated errors of λ are below a relative tolerance.
    void grow(double tolerance);

    /// CPU time of all sources of a basis, each set counted once [s].
    double cost(const BasisRecipe &recipe) const;

    /// CPU time needed by full-order modes before their solution [s]: the factor of K_c, with friction K_c⁻¹ A.
    double full_order_factorisation() const;

    /// Cost of all sets, including replaced ones.
    Table cost_table() const;

    const ReductionPlan     &plan;
    const FrictionlessModes &frictionless;
    const CoupledSystem     &system;
    Run                     &run;
    BasisIngredients         ingredients; ///< computed so far

  private:
    /// Charges bases with this cost for its source from now on.
    void book(const Charge &charge);

    /// Stores vectors in place of an earlier set with their cost; returns their number.
    int keep(Charge charge, MultiVector set);

    void charge_coupled_factor();
    void compute_static_modes();
    void compute_snapshots();

    /// Stores the lowest modes of a component: @p count of them, or all up to @p frequency [Hz] if zero.
    int keep_lowest(Charge charge, Component component, ContactBoundary boundary, double frequency, int count);

    const Linearisation &linearisation;

    std::vector<Charge>                                 charges; ///< of all sets
    std::map<BasisSource, double>                       seconds; ///< of the sets in use
    std::map<BasisSource, std::unique_ptr<MultiVector>> vectors;
    std::unique_ptr<InertiaRelief>                      response;
    std::unique_ptr<StaticModes>                        static_modes;
  };
} // namespace Squeal
