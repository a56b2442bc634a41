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
  /// Modes are followed up to (1 + this) times the end of the band, so that none is lost that enters or leaves it.
  inline constexpr double band_margin = 0.05;

  /// Tolerance of λ from which on single precision will do for its estimates [-].
  inline constexpr double single_precision_tolerance = 1e-6;

  /// Where a chart is evaluated.
  struct OperatingPoint
  {
    double          friction_coefficient = 0.;
    ParameterValues values;   ///< of other parameters of the system, where they differ from its own
    int             line = 0; ///< of the chart: points of one line differ in the friction coefficient, with all that follows from it
  };

  /// A two-sided reduced model that serves every operating point of a chart: what it says of a mode comes with the residuals of that mode
  /// at full order, and it grows where they are too large (grow_residual_basis() says how).
  class ChartModel
  {
  public:
    /**
     * Starts from real modes Φ_R and their responses of first order, see starting_model().
     *
     * @param system            with parameters as they are somewhere on the chart: no term may vanish that the chart has elsewhere
     * @param inverse           factor of K_c, or of K_c + s² M_c without damping if the @p shift s [rad/s] is positive
     * @param real_modes        M_c-orthonormal, somewhat beyond the band
     * @param largest_circular_frequency end of the band [rad/s]
     *
     * @p system, @p inverse and @p real_modes must outlive it.
     */
    ChartModel(const CoupledSystem  &system,
               const UpdatedInverse &inverse,
               double                shift,
               const MultiVector    &real_modes,
               double                largest_circular_frequency);

    /// Leaves out modes that decay faster than this [1/s]; at first none is.
    void leave_out_faster_decay(const double rate)
    {
      largest_decay = rate;
    }

    /**
     * For systems that differ from S in more than friction and damping: of a mode in a dense cluster that they change, the parts of its
     * estimate may cancel each other. Errors are then no less than κ/2 √(ε_R ε_L), with the energies of the right and left residuals, which is
     * what they would be without cancellation.
     */
    void estimate_without_cancellation()
    {
      allows_cancellation = false;
    }

    /// For estimates that need not be right below single_precision_tolerance.
    void estimate_in_single_precision()
    {
      residuals.use_single_precision();
    }

    /// Vectors in the basis.
    int size() const
    {
      return model.size();
    }

    const ReducedModel &reduced() const
    {
      return model;
    }

    /// What evaluate() needs at every point, for which it would be found by the first; before several threads evaluate.
    void prepare() const;

    /// Modes with their estimates. Only this process works, and no other need. After prepare() several threads may call.
    ChartPoint evaluate(const OperatingPoint &point) const;

    /// Where between two points the function of a search is zero by the reduced model in the span of the modes concerned, right and left,
    /// at both points: it has their λ and dλ/dμ there. The other parameters of the system vary linearly between the points. Only this
    /// process works, and no other need.
    std::optional<double> predicted_zero(const ZeroSearch &search, const OperatingPoint &first, const OperatingPoint &second) const;

    /// Largest estimated |δλ| / |λ| of the modes inside the band.
    double largest_error(const ChartPoint &point) const;

    /// Modes of @p chart in the band whose errors exceed @p tolerance.
    std::vector<int> inaccurate_modes(const ChartPoint &chart, double tolerance) const;

    /// Some modes of a result at an operating point.
    struct ModesAt
    {
      OperatingPoint    point;
      const ChartPoint *chart;
      std::vector<int>  modes;
    };

    /// New vectors from the residuals of modes; nothing if they lie in the basis. All processes must call.
    std::optional<MultiVector> new_vectors(const std::vector<ModesAt> &modes) const;

    /// Extends the basis. All processes must call.
    void extend(MultiVector vectors);

    /**
     * Principal axes in the K_c-norm of what modes of the @p charts, right and left, of unit strain energy, have outside of the
     * real modes, as coordinates in the basis. Axes are left out whose squares are below @p tolerance; errors of λ are products of
     * those of right and left vectors. All processes must call.
     *
     * @param real_modes their coordinates
     */
    DenseMatrix principal_parts(const DenseMatrix &real_modes, const std::vector<ChartPoint> &charts, double tolerance) const;

    /// A smaller basis for about the same: the real modes, and their principal_parts(), the last ones left out where there would be more
    /// than @p maximum vectors. All processes must call.
    MultiVector compressed_basis(const std::vector<ChartPoint> &charts, double tolerance, int maximum) const;

    /// Begins anew with another basis. All processes must call.
    void restart(MultiVector vectors);

  private:
    const CoupledSystem  &system;
    const UpdatedInverse &inverse;
    const MultiVector    *real_modes;
    double                shift, largest_circular_frequency, largest_decay = std::numeric_limits<double>::infinity();
    bool                  allows_cancellation = true;
    ReducedModel          model;
    ProjectedResiduals    residuals;
  };
} // namespace Squeal
