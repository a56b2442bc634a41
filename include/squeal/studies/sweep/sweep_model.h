#pragma once

#include <squeal/studies/steps/frictionless_modes.h>
#include <squeal/studies/sweep/sweep_plan.h>
#include <squeal/tracking/error_controlled_sweep.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace Squeal
{
  /// The coupled system of a contact set with its basis, and what is known of its modes.
  struct SweepModel
  {
    /// Linearises where contact damps most: the basis starts from the responses to that damping. All arguments must outlive the model.
    SweepModel(const SweepPlan &plan, const ContactRegime &regime, Run &run);

    /// From what is found already; @p reduced is a model of the system that @p frictionless has.
    SweepModel(const SweepPlan            &plan,
               const ContactRegime        &regime,
               Run                        &run,
               FrictionlessModes           frictionless,
               std::unique_ptr<ChartModel> reduced);

    /// Modes of a line, known ones or new ones, which @p store keeps unless it is null. All processes must call.
    std::vector<ChartPoint> evaluate(int line, const std::vector<double> &friction_coefficients, ChartStore *store = nullptr);

    /// Right vectors of some modes of a point at full order, real and imaginary parts.
    std::pair<MultiVector, MultiVector> shapes(const ChartPoint &point, const std::vector<int> &modes) const;

    /// Identities of some modes of a point, without the signs of doublets.
    std::vector<ModeLabel> labels(const ChartPoint &point, const std::vector<int> &modes) const;

    /// The linearised scene with the contact damping at a point of the main line.
    Linearisation linearisation_at(double friction_coefficient) const;

    bool is_in_band(const std::complex<double> &lambda) const
    {
      return lambda.imag() <= largest_circular_frequency;
    }

    const SweepPlan                             &plan;
    const ContactRegime                         &regime;
    Run                                         &run;
    const double                                 largest_circular_frequency; ///< end of the band [rad/s]
    FrictionlessModes                            frictionless;
    std::unique_ptr<ChartModel>                  reduced;
    std::map<std::pair<int, double>, ChartPoint> known; ///< by line and friction coefficient

  private:
    /// What names the modes of a point, from products with the basis or, where the basis is only a part of another one, at full order.
    std::vector<ShapeShares> shape_shares(const ChartPoint &point, const std::vector<int> &modes) const;

    mutable std::vector<DenseMatrix> reference_products; ///< with the basis as it was when modes were last named
  };

  /// Places among n friction coefficients at which a basis learns most: the ends, the middle and the quarters, the last one first.
  std::vector<int> ends_and_quarters(int n);

  /// The damping of the contact where a sweep's is largest.
  const OperatingPoint &most_damped(const ContactRegime &regime);

  /// Evaluates all points of the contact set to the tolerance that the parameters ask for, as a step of the run.
  void evaluate_points(SweepModel &model, ChartStore &store);
} // namespace Squeal
