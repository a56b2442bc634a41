#pragma once

#include <squeal/estimates/body_frames.h>
#include <squeal/linear_algebra/dense_serialization.h>
#include <squeal/studies/steps/frictionless_modes.h>

#include <complex>
#include <string>
#include <vector>

namespace Squeal
{
  /**
   * Modes of a scene without friction, by which those of its designs are named: their displacements at the centres of its cells, in
   * cylindrical components.
   */
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

  /**
   * Names of modes of a design: their shapes are compared at the points of the reference, carried over to the bodies that
   * both have.
   */
  std::vector<ReferenceName> names_by(const ReferenceModes &reference,
                                      const Model          &model,
                                      const SparseMatrix   &kernel,
                                      const ComplexModes   &modes);
} // namespace Squeal
