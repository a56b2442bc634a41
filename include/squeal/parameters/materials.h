#pragma once

#include <squeal/parameters/declarations.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Isotropic linear elasticity with Rayleigh damping α M + β K.
  struct Material
  {
    double young_modulus;       ///< E [Pa]
    double poisson_ratio;       ///< ν [-]
    double density;             ///< ρ [kg/m³]
    double rayleigh_alpha = 0.; ///< α [1/s]
    double rayleigh_beta  = 0.; ///< β [s]

    bool is_damped() const;
  };

  /**
   * Elastic foundation on a named surface. Its directions are those of the
   * disc's axis (z): radial, tangential (circumferential) and axial.
   */
  struct ElasticMount
  {
    std::string surface;
    double      radial;     ///< stiffness per area [N/m³]
    double      tangential; ///< stiffness per area [N/m³]
    double      axial;      ///< stiffness per area [N/m³]
  };

  /// Elastic constants and density of one pin; its damping is that of all pins.
  struct PinMaterial
  {
    std::string pin;
    double      young_modulus; ///< E [Pa]
    double      poisson_ratio; ///< ν [-]
    double      density;       ///< ρ [kg/m³]
  };

  /// Materials and supports (sections `Disc material`, `Pin material`, `Mounts`).
  struct MaterialParameters
  {
    Material                  disc = {210e9, 0.3, 7850.};
    Material                  pin  = {1.90e9, 0.25, 3070.};
    std::vector<PinMaterial>  single_pins; ///< of pins that differ from the others
    std::vector<ElasticMount> mounts = {{"disc_bore", 0., 7.80e10, 1.88e10}};

    void declare(Declarations &declarations);

    /// Throws ParameterError.
    void check() const;

    /// Material of a body, which is the disc or a pin.
    Material of(const std::string &body) const;

    /// All materials, each with the section and the pin that set it.
    std::vector<std::pair<std::string, Material>> all() const;

    /// Names of the surfaces that carry a mount.
    std::vector<std::string> mounted_surfaces() const;
  };
} // namespace Squeal
