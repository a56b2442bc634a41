#pragma once

#include <squeal/studies/frictionless_modes.h>
#include <squeal/studies/reduction_plan.h>

#include <map>
#include <memory>

namespace Squeal
{
  /**
   * The sets of vectors that the bases of a plan are made of, computed as steps of the run, with the processor seconds of each:
   * a basis pays for all that it rests on.
   */
  class ReductionSets
  {
  public:
    /**
     * Computes what does not change from basis to basis: real, static and complex modes.
     *
     * @param system coupled, with the damping of the problem. It and all other arguments must outlive the sets.
     *
     * Throws ParameterError or SolverError if there are no modes of a kind that is needed.
     */
    ReductionSets(const ReductionPlan &plan, const FrictionlessModes &frictionless, const CoupledSystem &system, Run &run);

    /// Computes component modes in the place of those of an earlier truncation. Throws SolverError if there are too few.
    void truncate(const ModeTruncation &truncation);

    /// Grows a basis by residuals, until the estimated errors of λ are below a relative tolerance, in the place of an earlier one.
    void grow(double tolerance);

    /// Everything computed so far.
    const BasisIngredients &ingredients() const
    {
      return available;
    }

    /// Processor seconds of all that a basis rests on, each set counted once.
    double cost(const BasisRecipe &recipe) const;

    const ReductionPlan     &plan;
    const FrictionlessModes &frictionless;
    const CoupledSystem     &system;
    Run                     &run;

  private:
    /// Computes something and books its processor seconds.
    template <typename Function>
    auto timed(BasisSource source, Function &&function);

    /// The same for a set of vectors, which is kept in the place of an earlier one; returns their number.
    template <typename Function>
    int compute(BasisSource source, Function &&function);

    void compute_real_modes();
    void compute_static_modes();
    void compute_snapshots();

    /// The lowest modes of a component: @p count of them, or, where that is zero, all up to @p frequency [Hz].
    MultiVector lowest_modes(Component component, ContactBoundary boundary, double frequency, int count) const;

    const Scene         &scene;
    const Linearisation &linearisation;

    std::map<BasisSource, double>                       seconds;
    std::map<BasisSource, std::unique_ptr<MultiVector>> vectors;
    std::unique_ptr<InertiaRelief>                      response;
    std::unique_ptr<StaticModes>                        static_modes;
    BasisIngredients                                    available;
  };
} // namespace Squeal
