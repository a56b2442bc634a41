// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/body_frames.h>
#include <squeal/parameters/design_plan.h>
#include <squeal/studies/designs/design_results.h>
#include <squeal/studies/steps/system_family.h>
#include <squeal/studies/sweep/sweep_charts.h>

namespace Squeal
{
  /// Modes of a scene without friction, by which those of its designs are named: their displacements at the centres of its cells, in
  /// cylindrical components.
  struct ReferenceModes
  {
    std::vector<BodyFrame>            frames;
    CommonPoints                      points;
    std::vector<std::complex<double>> lambda; ///< i ω [rad/s]
    DenseMatrix                       shapes; ///< times √m, a row for each component at each point
    std::vector<std::string>          names;

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &frames &points &lambda &shapes &names;
    }
  };

  /// On process 0 with their shapes; the others have none.
  ReferenceModes reference_modes(const FrictionlessModes &modes, const MaterialParameters &materials);

  /// The reference mode that a mode of a design resembles.
  struct ReferenceName
  {
    std::string name;               ///< empty if there is none
    double      overlap    = 0.;    ///< of both shapes [-]
    bool        in_cluster = false; ///< the design decides which of several modes is the partner
  };

  /// Names of modes of a design: their shapes are compared at the points of the reference, carried over to the bodies that both have.
  std::vector<ReferenceName> names_by(const ReferenceModes &reference,
                                      const Model          &model,
                                      const SparseMatrix   &kernel,
                                      const ComplexModes   &modes);

  /// What must agree for designs to share a mesh and its matrices: their parameters but for those that are coefficients of terms. Empty
  /// where a design cannot share them.
  std::string family_key(const Parameters &design);

  /**
   * One reduced model for several designs on one mesh, which differ in moduli, densities, Rayleigh coefficients, stiffnesses of mounts, load
   * and speed: coefficients θ of the terms of one system Q(λ; p) = Σ θ_k(p) λ^p A_k. Each design is a line of a sweep plan.
   *
   * The basis starts from the real modes in the middle of the family, is compressed at the last friction coefficients of all designs, and
   * grows where a point misses Sweep/Tolerance. The results of a design depend on those solved before it, within the tolerance.
   */
  class DesignFamily
  {
  public:
    /// Meshes and assembles what @p designs of the same family_key() share, and finds the real modes in the middle. They and @p run must
    /// outlive it.
    DesignFamily(const std::vector<Parameters> &designs, Run &run);

    /// The chart of a design by the model of the family.
    struct Member
    {
      SweepModel &model;
      SweepChart  chart;
      int         n_counted; ///< real modes in the band by inertia
    };

    /// Follows the modes of a design over the friction coefficients of its sweep. Throws SolverError if the design is too far from the
    /// others for one basis.
    Member solve(std::size_t design);

    Scene scene;

  private:
    std::vector<OperatingPoint> points_of(std::size_t design) const;

    /// Evaluates points to the tolerance; @p training as in error_controlled_sweep().
    void solve(const std::vector<OperatingPoint> &points, const std::vector<int> &training);

    Run                        &run;
    std::unique_ptr<SweepPlan>  plan;
    std::unique_ptr<SweepModel> model;
  };

  /// The sweep of a design: what only adds to the results of a single run is left out.
  Parameters sweep_of(const Parameters &design);

  /// Follows the modes of a scene over the friction coefficients of the sweep, and says what a study of designs wants to know of them, which
  /// are named by @p reference. Throws Error where it cannot be.
  DesignResult solve_design(const Parameters &parameters, const ReferenceModes &reference, Run &run);

  /// The same of a design of a family.
  DesignResult solve_member(DesignFamily &family, std::size_t design, const ReferenceModes &reference);
} // namespace Squeal
