// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/parameters/declarations.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// Engineering constants in addition to E_1 and ν_12, where ν_ij = −ε_j/ε_i under stress along axis i and ν_ij/E_i = ν_ji/E_j.
  struct Orthotropy
  {
    double E2 = 0., E3 = 0.;             ///< [Pa]
    double nu13 = 0., nu23 = 0.;         ///< [-]
    double G12 = 0., G13 = 0., G23 = 0.; ///< [Pa]

    /// A vector along axis 1 and a second vector in the plane of axes 1 and 2; none: 1 radial, 2 tangential, 3 axial about the z axis.
    std::optional<std::array<double, 6>> axes = {};
  };

  /// Linear elasticity with Rayleigh damping α M + β K.
  struct Material
  {
    double young_modulus  = 0.; ///< E [Pa]; E_1 if orthotropic
    double poisson_ratio  = 0.; ///< ν [-]; ν_12 if orthotropic
    double density        = 0.; ///< ρ [kg/m³]
    double rayleigh_alpha = 0.; ///< α [1/s]
    double rayleigh_beta  = 0.; ///< β [s]

    std::optional<Orthotropy> orthotropy = {}; ///< none: isotropic

    bool is_damped() const;

    bool has_fixed_axes() const;

    /// Lower bound of ρ c² of the slowest wave along an axis [Pa]: G, or the smallest of the shear and Young's moduli if orthotropic.
    double least_wave_modulus() const;

    /// Mean Poisson's ratio, weighted so that it is 1/2 for an incompressible material; ν if isotropic.
    double mean_poisson_ratio() const;
  };

  /// Coefficients of springs or dashpots between a named surface and the ground, per area [N/m³] or [N s/m³], in the radial, tangential
  /// (circumferential) and axial directions about the z axis.
  struct Mount
  {
    std::string surface;
    double      radial, tangential, axial;

    /// Coefficient in radial (0), tangential (1) or axial (2) direction.
    double along(const int direction) const
    {
      return direction == 0 ? radial : direction == 1 ? tangential : axial;
    }
  };

  /// Material of a volume, such as the lining or the backplate of a pad.
  struct VolumeMaterial : Material
  {
    std::string volume;
  };

  /// Material axes of an orthotropic volume, as in Orthotropy::axes.
  struct MaterialAxes
  {
    std::string           volume;
    std::array<double, 6> vectors = {};
  };

  /// True for the names of volumes of the disc: `disc`, or names that begin with `disc_`.
  bool is_of_disc(const std::string &volume);

  /// Mass per area that moves with a named surface.
  struct SurfaceMass
  {
    std::string surface;
    double      mass; ///< [kg/m²]
  };

  /// Materials and supports (sections `Disc material`, `Pin material`, `Materials`, `Mounts`).
  struct MaterialParameters
  {
    Material                    disc = {210e9, 0.3, 7850.};
    Material                    pin  = {1.90e9, 0.25, 3070.};
    std::vector<VolumeMaterial> volumes;
    std::vector<VolumeMaterial> orthotropic;                                    ///< orthotropic volumes, without their axes
    std::vector<MaterialAxes>   axes;                                           ///< material axes that are not cylindrical
    std::vector<Mount>          mounts = {{"disc_bore", 0., 7.80e10, 1.88e10}}; ///< springs
    std::vector<Mount>          dashpots;
    std::vector<SurfaceMass>    masses;

    void declare(Declarations &declarations);

    /// Throws ParameterError.
    void check() const;

    /// Material of a volume: its individual material or, by default, the material of the disc or of the pins.
    Material of(const std::string &volume) const;

    bool has_own(const std::string &volume) const;

    /// Parameter that sets the material of a volume: "Materials/Orthotropic", "Pin material", ...
    std::string section_of(const std::string &volume) const;

    bool is_damped() const;

    /// Mutable pointers to all materials: disc, pins, volumes, orthotropic volumes.
    std::vector<Material *> each();

    /// All materials, each with its section and volume.
    std::vector<std::pair<std::string, Material>> all() const;

    /// Mutable pointers to the values of all springs, dashpots and masses.
    std::vector<double *> mount_values();

    std::vector<std::string> mounted_surfaces() const;
  };

  /// Damping ratio of modes at a frequency.
  struct ModalDampingRatio
  {
    double frequency; ///< [Hz]
    double ratio;     ///< ζ [-]
  };

  /// Modal damping (section `Damping`). Material damping is part of MaterialParameters, contact damping of OperationParameters.
  struct DampingParameters
  {
    std::vector<ModalDampingRatio> modal_ratios; ///< in order of ascending frequency; empty: no modal damping

    /// ζ of a mode of @p frequency [Hz]: linear between the entries, constant beyond the first and last; 0 if there are none.
    double modal_ratio(double frequency) const;

    void declare(Declarations &declarations);

    /// Throws ParameterError.
    void check() const;
  };
} // namespace Squeal
