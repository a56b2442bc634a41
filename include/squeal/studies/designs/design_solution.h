// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/body_frames.h>
#include <squeal/parameters/design_plan.h>
#include <squeal/studies/designs/design_results.h>
#include <squeal/studies/steps/system_family.h>
#include <squeal/studies/sweep/sweep_charts.h>

namespace Squeal
{
  /// Frictionless modes of the given model, by which modes of its designs are labelled: displacements at the cell centres, in cylindrical
  /// components.
  struct ReferenceModes
  {
    std::vector<BodyFrame>            frames;
    CommonPoints                      points;
    std::vector<std::complex<double>> lambda; ///< i ω [rad/s]
    DenseMatrix                       shapes; ///< displacements times √m, one row for each component at each point
    std::vector<std::string>          names;

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &frames &points &lambda &shapes &names;
    }
  };

  /// Shapes are on process 0 only.
  ReferenceModes reference_modes(const FrictionlessModes &modes, const MaterialParameters &materials);

  /// Reference mode that resembles a mode of a design.
  struct ReferenceName
  {
    std::string name;               ///< empty if there is none
    double      overlap    = 0.;    ///< of both shapes [-]
    bool        in_cluster = false; ///< one of several modes that mix between designs
  };

  /// Labels modes of a design: shapes are compared at the points of the reference, mapped to the bodies that both models have.
  std::vector<ReferenceName> names_by(const ReferenceModes &reference,
                                      const Model          &model,
                                      const SparseMatrix   &kernel,
                                      const ComplexModes   &modes);

  /// Key of the parameters that designs must share to use the same mesh and matrices: all except coefficients of terms. Empty if a design
  /// cannot share them.
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
    /// Meshes and assembles @p designs with the same family_key(), and computes the real modes in the middle. Designs and @p run must
    /// outlive the object.
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

  /// Parameters of the sweep of a design, without optional output of a single run.
  Parameters sweep_of(const Parameters &design);

  /// Follows the modes over the friction coefficients of the sweep and extracts the results of a design, with labels by @p reference.
  /// Throws Error if this fails.
  DesignResult solve_design(const Parameters &parameters, const ReferenceModes &reference, Run &run);

  /// solve_design() for a member of a family.
  DesignResult solve_member(DesignFamily &family, std::size_t design, const ReferenceModes &reference);
} // namespace Squeal
