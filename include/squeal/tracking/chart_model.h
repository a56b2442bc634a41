// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/residual_iteration.h>
#include <squeal/tracking/chart_point.h>

#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace Squeal
{
  /// Modes are followed up to (1 + this) times the end of the band, so that modes that enter or leave it are not lost.
  inline constexpr double band_margin = 0.05;

  /// A point at which a chart is evaluated.
  struct OperatingPoint
  {
    double          friction_coefficient = 0.;
    ParameterValues values;   ///< other parameters of the system, if different from its values
    int             line = 0; ///< of the chart: points of one line differ only in the friction coefficient and quantities that depend on it
  };

  /// A two-sided reduced model for all operating points of a chart: modes have full-order residuals, and the basis is extended if these are
  /// too large (see grow_residual_basis()).
  class ChartModel
  {
  public:
    /**
     * Starts from real modes Φ_R and their first-order responses, see starting_model().
     *
     * @param system            with parameters at a point of the chart: no term may be zero there that is nonzero at another point
     * @param inverse           factor of K_c, or of K_c + s² M_c without damping if the @p shift s [rad/s] is positive
     * @param real_modes        M_c-orthonormal, to slightly beyond the band
     * @param largest_circular_frequency end of the band [rad/s]
     *
     * @p system, @p inverse and @p real_modes must outlive the object.
     */
    ChartModel(const CoupledSystem  &system,
               const UpdatedInverse &inverse,
               double                shift,
               const MultiVector    &real_modes,
               double                largest_circular_frequency);

    /// Excludes modes that decay faster than this [1/s]; initially none.
    void leave_out_faster_decay(const double rate)
    {
      largest_decay = rate;
    }

    /**
     * For systems that differ from S in more than friction and damping, where parts of the estimate for a mode in a dense cluster may
     * cancel. Errors are then at least κ/2 √(ε_R ε_L), from the energies of the right and left residuals, which is the estimate without
     * cancellation; norms of a sketch suffice for it, see ProjectedResiduals::use_sketch().
     */
    void estimate_without_cancellation()
    {
      allows_cancellation = false;
      residuals.use_sketch();
    }

    /// Number of vectors in the basis.
    int size() const
    {
      return model.size();
    }

    const ReducedModel &reduced() const
    {
      return model;
    }

    /// Computes shared data for evaluate() in advance; call before several threads evaluate.
    void prepare() const;

    /// Modes with their error estimates. Not collective. After prepare() several threads may call.
    ChartPoint evaluate(const OperatingPoint &point) const;

    /// Zero of the function of a search between two points, predicted by the reduced model in the span of the right and left vectors of the
    /// modes involved at both points, which reproduces λ and dλ/dμ there. The other parameters of the system vary linearly between the
    /// points. Not collective.
    std::optional<double> predicted_zero(const ZeroSearch &search, const OperatingPoint &first, const OperatingPoint &second) const;

    /// Largest estimated |δλ| / |λ| of the modes in the band.
    double largest_error(const ChartPoint &point) const;

    /// Modes of @p chart in the band with errors above @p tolerance.
    std::vector<int> inaccurate_modes(const ChartPoint &chart, double tolerance) const;

    /// Some modes at an operating point.
    struct ModesAt
    {
      OperatingPoint    point;
      const ChartPoint *chart;
      std::vector<int>  modes;
    };

    /// New basis vectors from the residuals of modes; nothing if they lie in the basis. Collective.
    std::optional<MultiVector> new_vectors(const std::vector<ModesAt> &modes) const;

    /// Appends vectors to the basis. Collective.
    void extend(MultiVector vectors);

    /**
     * Principal axes in the K_c-norm of the components of right and left modes of the @p charts, at unit strain energy, outside the span of
     * the real modes, as coordinates in the basis. Axes with squares below @p tolerance are dropped; errors of λ are products of errors of
     * right and left vectors. Collective.
     *
     * @param real_modes coordinates of the real modes
     */
    DenseMatrix principal_parts(const DenseMatrix &real_modes, const std::vector<ChartPoint> &charts, double tolerance) const;

    /// A smaller basis with about the same span: the real modes and their principal_parts(), truncated to @p maximum vectors. Collective.
    MultiVector compressed_basis(const std::vector<ChartPoint> &charts, double tolerance, int maximum) const;

    /// Starts again with another basis. Collective.
    void restart(MultiVector vectors);

  private:
    const CoupledSystem       &system;
    const UpdatedInverse      &inverse;
    const MultiVector         *real_modes;
    double                     shift, largest_circular_frequency, largest_decay = std::numeric_limits<double>::infinity();
    bool                       allows_cancellation = true;
    ReducedModel               model;
    mutable ProjectedResiduals residuals; ///< extended when needed
  };
} // namespace Squeal
