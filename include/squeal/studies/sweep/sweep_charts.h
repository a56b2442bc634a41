#pragma once

#include <squeal/output/chart_checkpoint.h>
#include <squeal/studies/sweep/sweep_model.h>
#include <squeal/tracking/branches.h>

#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// Modes over the friction coefficient at one load and speed, as far as the contact set is the same.
  struct SweepChart
  {
    StabilityChart         chart;
    std::vector<ModeLabel> labels; ///< one for each branch

    std::optional<GrowthOnset> onset;      ///< where the first mode begins to grow
    std::optional<GrowthOnset> weak_onset; ///< where the first divergence rate exceeds weak_divergence
  };

  /// Where squeal begins on a line, in one of its charts.
  struct SquealOnset
  {
    double      divergence_rate; ///< that is exceeded from there on [-]
    GrowthOnset onset;
    ModeLabel   label;
  };

  /// The version of the program, parameters and a mesh, but for threads and for output that only adds to results or shows them otherwise.
  std::string identity(Parameters parameters, const HexMesh &mesh);

  /// Everything on which the results of a sweep depend.
  std::string sweep_identity(const Run &run, const Scene &scene);

  /// Where the results of a phase of the work on a contact set are kept.
  std::unique_ptr<ChartStore> store_of(const SweepModel &model, ChartCheckpoint &checkpoint, const std::string &phase);

  /**
   * Follows the branches of a line over known friction coefficients, with their thresholds, as a step of the run.
   *
   * @param store keeps points, and what the basis grows by for thresholds; null: neither is done
   */
  SweepChart follow_branches(SweepModel &model, int line, const std::vector<double> &friction_coefficients, ChartStore *store);

  /// Follows the branches on all lines but those of the map, with their thresholds, as steps of the run; appends to the @p charts of each line.
  void follow_branches(SweepModel &model, ChartCheckpoint &checkpoint, std::vector<std::vector<SweepChart>> &charts);

  /// The first onsets of all stretches of a line: of growth and of divergence rates beyond weak_divergence, where there are such.
  std::vector<SquealOnset> squeal_onsets(const std::vector<SweepChart> &charts);

  /// From which friction coefficient on there is squeal, and what grows most: of the stretches of the main line, of @p n_asked values.
  std::string verdict(const std::vector<SweepChart> &charts, std::size_t n_asked, double largest_circular_frequency);
} // namespace Squeal
