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

  /// Springs or dashpots between a named surface and the ground, per area [N/m³] or [N s/m³]. Their directions are those of the disc's axis
  /// (z): radial, tangential (circumferential) and axial.
  struct Mount
  {
    std::string surface;
    double      radial, tangential, axial;

    /// The number of direction 0, 1 or 2.
    double along(const int direction) const
    {
      return direction == 0 ? radial : direction == 1 ? tangential : axial;
    }
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
    Material                 disc = {210e9, 0.3, 7850.};
    Material                 pin  = {1.90e9, 0.25, 3070.};
    std::vector<PinMaterial> single_pins;                                    ///< of pins that differ from the others
    std::vector<Mount>       mounts = {{"disc_bore", 0., 7.80e10, 1.88e10}}; ///< springs
    std::vector<Mount>       dashpots;

    void declare(Declarations &declarations);

    /// Throws ParameterError.
    void check() const;

    /// Material of a body, which is the disc or a pin.
    Material of(const std::string &body) const;

    /// All materials, each with the section and the pin that set it.
    std::vector<std::pair<std::string, Material>> all() const;

    /// The numbers of all springs and dashpots.
    std::vector<double *> mount_values();

    /// Names of the surfaces that carry springs or dashpots.
    std::vector<std::string> mounted_surfaces() const;
  };

  /// Damping ratio of modes of one frequency.
  struct ModalDampingRatio
  {
    double frequency; ///< [Hz]
    double ratio;     ///< ζ [-]
  };

  /// Damping given mode by mode (section `Damping`). That of the materials is with the materials, that of the contact with the operation.
  struct DampingParameters
  {
    std::vector<ModalDampingRatio> modal_ratios; ///< ascending frequencies; empty: none

    /// ζ of a mode of @p frequency [Hz]: linear between the entries, constant beyond the first and last; 0 if there are none.
    double modal_ratio(double frequency) const;

    void declare(Declarations &declarations);

    /// Throws ParameterError.
    void check() const;
  };
} // namespace Squeal
