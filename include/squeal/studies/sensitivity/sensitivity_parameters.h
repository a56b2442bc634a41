#pragma once

#include <squeal/studies/steps/scene.h>

#include <memory>
#include <string>
#include <vector>

namespace Squeal
{
  /// The contact before and after a motion of its nodes in the plane of the disc.
  struct ContactMotion
  {
    ContactInterface before, after;                     ///< all pairs
    ContactOperators operators_before, operators_after; ///< on the dofs of the scene
    double           step;                              ///< change of the parameter between them
  };

  /**
   * A parameter p of the parameter file with the direction in which it changes the terms of the bodies and the contact: dQ/dp is the sum of
   * the derivatives along the rates, and of the terms.
   */
  struct SensitivityParameter
  {
    std::string path;  ///< "Pin material/Young modulus"
    std::string body;  ///< the only pin that changes; empty: all that the parameter sets
    std::string unit;  ///< "-" for none
    double      value; ///< in this unit

    ParameterValues   body_rates; ///< dq/dp of the parameters q of the bodies' terms
    std::vector<Term> derivative; ///< dX/dp where X is not a product of powers of p, with coefficients in the parameters of the bodies
    double OperationParameters::        *operation   = nullptr; ///< on which contact damping, or friction itself, depends; null: none
    std::shared_ptr<const ContactMotion> contact     = {};      ///< null: contact nodes stay where they are but for the axial direction
    int                                  modal_ratio = -1;      ///< number of the entry of Damping/Modal damping ratio; −1: none
  };

  /**
   * Every continuous parameter but those of the geometry that the scene depends on: materials of the disc and of the pins, of each pin by itself
   * Young's modulus and density, mounts, ratios of modal damping, friction coefficient, load, rotation speed, friction slope. Assembles the bodies with neighbouring Poisson's
   * ratios.
   */
  std::vector<SensitivityParameter> sensitivity_parameters(const Scene &scene, const Parameters &parameters);

  /**
   * Lengths and angles of the built-in geometry: differences of the terms of the bodies on meshes whose nodes have moved a little to either side
   * (sensitivity/mesh_motions.h), as a step of the run. Empty for other geometries.
   *
   * @param bodies terms of the scene
   */
  std::vector<SensitivityParameter> geometry_sensitivity_parameters(const Scene &scene, const BodyTerms &bodies, Run &run);
} // namespace Squeal
