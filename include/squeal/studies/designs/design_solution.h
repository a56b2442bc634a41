// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/body_frames.h>
#include <squeal/parameters/design_plan.h>
#include <squeal/studies/designs/design_results.h>
#include <squeal/studies/steps/system_family.h>
#include <squeal/studies/sweep/sweep_charts.h>

namespace Squeal
{
  /// Frictionless modes of the given model, used to label the modes of its designs: displacements at the cell centres, in cylindrical
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

  /// Creates the reference modes; the shapes are on process 0 only.
  ReferenceModes reference_modes(const FrictionlessModes &modes, const MaterialParameters &materials);

  /// Label of a mode of a design, from the reference mode that it resembles.
  struct ReferenceName
  {
    std::string name;               ///< empty if no reference mode is similar
    double      overlap    = 0.;    ///< overlap of both shapes [-]
    bool        in_cluster = false; ///< true for one of several modes that mix between designs
  };

  /// Labels the modes of a design by comparing shapes at the reference points, mapped to the bodies that both models contain.
  std::vector<ReferenceName> names_by(const ReferenceModes &reference,
                                      const Model          &model,
                                      const SparseMatrix   &kernel,
                                      const ComplexModes   &modes);

  /// Key of a family of designs with the same mesh and matrices: all parameters except coefficients of terms. Empty if a design cannot
  /// belong to a family.
  std::string family_key(const Parameters &design);

  /**
   * One reduced model for several designs on one mesh, which differ in moduli, densities, Rayleigh coefficients, stiffnesses of mounts, load
   * and speed: coefficients θ of the terms of one system Q(λ; p) = Σ θ_k(p) λ^p A_k. Each design is a line of a sweep plan.
   *
   * The common basis starts from the real modes of the averaged design and is extended at a few points of every design, whose modes span a
   * smaller basis for this design. This basis is extended where estimated errors exceed Sweep/Tolerance. Within this tolerance, the results
   * of a design depend on the designs solved before it.
   */
  class DesignFamily
  {
  public:
    /// Meshes and assembles @p designs with the same family_key(), and computes the real modes of the averaged design. Designs and @p run
    /// must outlive the object.
    DesignFamily(const std::vector<Parameters> &designs, Run &run);

    /// The chart of a design, computed with the model of the family.
    struct Member
    {
      SweepModel &model;
      SweepChart  chart;
      int         n_counted; ///< number of real modes in the band by inertia
    };

    /// Follows the modes of a design over the friction coefficients of its sweep. Throws SolverError if the basis cannot be extended to the
    /// accuracy of Sweep/Tolerance.
    Member solve(std::size_t design);

    Scene scene;

  private:
    std::vector<OperatingPoint> points_of(std::size_t design) const;

    /// Evaluates points with a model, which is extended, within a part of Sweep/Tolerance.
    void solve(ChartModel &reduced, const std::vector<OperatingPoint> &points, double part_of_tolerance, const KeepPoint &keep);

    Run                        &run;
    std::unique_ptr<SweepPlan>  plan;
    std::unique_ptr<SweepModel> model;  ///< with the reduced model of the current design
    std::unique_ptr<ChartModel> common; ///< on the common basis
  };

  /// Parameters of the sweep of a design, without maps and other optional output.
  Parameters sweep_of(const Parameters &design);

  /// Follows the modes of a design over the friction coefficients of its sweep; modes are labelled by @p reference. Throws Error if this
  /// fails.
  DesignResult solve_design(const Parameters &parameters, const ReferenceModes &reference, Run &run);

  /// solve_design() for a member of a family.
  DesignResult solve_member(DesignFamily &family, std::size_t design, const ReferenceModes &reference);
} // namespace Squeal
