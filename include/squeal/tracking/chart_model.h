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
  /// Modes are followed up to (1 + band_margin) times the end of the band, so that modes that enter or leave the band are not lost.
  inline constexpr double band_margin = 0.05;

  /// A point at which a chart is evaluated.
  struct OperatingPoint
  {
    double          friction_coefficient = 0.;
    ParameterValues values;   ///< values of other parameters that differ from the values of the system
    int             line = 0; ///< line of the chart; points on a line differ only in μ and in quantities that depend on μ
  };

  /// A two-sided reduced model for all operating points of a chart: residuals are computed at full order, and the basis is extended if the
  /// residuals are too large (see grow_residual_basis()).
  class ChartModel
  {
  public:
    /**
     * Starts with the real modes Φ_R and their first-order responses, see starting_model().
     *
     * @param system            system at a point of the chart at which all terms that occur in the chart are nonzero
     * @param inverse           factor of K_c, or of K_c + s² M_c without damping if the @p shift s [rad/s] is positive
     * @param real_modes        M_c-orthonormal real modes up to slightly beyond the band
     * @param largest_circular_frequency end of the band [rad/s]
     *
     * @p system, @p inverse and @p real_modes must outlive this object.
     */
    ChartModel(const CoupledSystem  &system,
               const UpdatedInverse &inverse,
               double                shift,
               const MultiVector    &real_modes,
               double                largest_circular_frequency);

    /// Excludes modes that decay faster than @p rate [1/s]; initially, no modes are excluded.
    void leave_out_faster_decay(const double rate)
    {
      largest_decay = rate;
    }

    /**
     * Changes the error estimate for systems that differ from the factorised matrix in more than friction and damping: parts of the
     * estimate for a mode in a dense cluster might cancel. Errors are then at least κ/2 √(ε_R ε_L), with the energies of the right and left
     * residuals, which is the estimate without cancellation. This estimate requires only norms of a sketch, see
     * ProjectedResiduals::use_sketch().
     */
    void estimate_without_cancellation()
    {
      allows_cancellation = false;
      residuals.use_sketch();
    }

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

    /// Modes at an operating point with their error estimates. Not collective; several threads may call it after prepare().
    ChartPoint evaluate(const OperatingPoint &point) const;

    /// Predicted zero of the function of a search between two points. The prediction uses a reduced model in the span of the right and left
    /// vectors of the modes at both points, where it reproduces λ and dλ/dμ. The other parameters of the system vary linearly between the
    /// points. Not collective.
    std::optional<double> predicted_zero(const ZeroSearch &search, const OperatingPoint &first, const OperatingPoint &second) const;

    /// Largest estimated |δλ| / |λ| of the modes in the band.
    double largest_error(const ChartPoint &point) const;

    /// Modes of @p chart in the band with errors above @p tolerance.
    std::vector<int> inaccurate_modes(const ChartPoint &chart, double tolerance) const;

    /// Selected modes at an operating point.
    struct ModesAt
    {
      OperatingPoint    point;
      const ChartPoint *chart;
      std::vector<int>  modes;
    };

    /// New basis vectors from the residuals of modes; empty if the basis contains them already. Collective.
    std::optional<MultiVector> new_vectors(const std::vector<ModesAt> &modes) const;

    void extend(MultiVector vectors);

    /**
     * A smaller basis with about the same span: the real modes and the principal axes, in the K_c-norm, of the components of right and left
     * modes of the @p charts outside the span of the real modes, truncated to @p maximum vectors. Modes are scaled to unit strain energy.
     * Axes whose squared length is below 10 times the @p tolerance of λ are dropped: the error of λ is a product of the errors of a right
     * and a left vector. Collective.
     */
    MultiVector compressed_basis(const std::vector<ChartPoint> &charts, double tolerance, int maximum) const;

    /// A model on a basis like compressed_basis(), computed without products at full order. Collective.
    std::unique_ptr<ChartModel> restricted(const std::vector<ChartPoint> &charts, double tolerance) const;

    /// Replaces the basis. Collective.
    void restart(MultiVector vectors);

  private:
    /// Principal axes of the charts, see compressed_basis(), as coordinates in the basis; @p real_modes: coordinates of the real modes.
    DenseMatrix principal_parts(const DenseMatrix &real_modes, const std::vector<ChartPoint> &charts, double tolerance) const;

    /// Coordinates of the real modes in an M_c-orthonormal basis.
    DenseMatrix real_coordinates() const;

    const CoupledSystem       &system;
    const UpdatedInverse      &inverse;
    const MultiVector         *real_modes;
    double                     shift, largest_circular_frequency, largest_decay = std::numeric_limits<double>::infinity();
    bool                       allows_cancellation = true;
    ReducedModel               model;
    mutable ProjectedResiduals residuals; ///< extended with the basis when needed
  };
} // namespace Squeal
