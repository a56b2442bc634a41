// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/parameters/declarations.h>

#include <string>

namespace Squeal
{
  /// Sign of the sliding velocity: the sense in which the disc turns about e_z.
  enum class Rotation
  {
    positive,
    negative
  };

  template <>
  inline constexpr EnumName<Rotation> enum_table<Rotation>[] = {{Rotation::positive, "positive"}, {Rotation::negative, "negative"}};

  /// Viscous contact damping along b, c_b [N s/m] per node: from the linearisation of R_t = μ R_n w/|w| it is μ |R_n0| / w_0 (consistent);
  /// the paper prints R_n0 / w_0 below its eq. (3) (published).
  enum class RadialDissipation
  {
    none,
    consistent,
    published
  };

  template <>
  inline constexpr EnumName<RadialDissipation> enum_table<RadialDissipation>[] = {{RadialDissipation::none, "none"},
                                                                                  {RadialDissipation::consistent, "consistent"},
                                                                                  {RadialDissipation::published, "published"}};

  /// The braking conditions (section `Operation`).
  struct OperationParameters
  {
    double            friction_coefficient = 0.4; ///< μ [-]
    Rotation          rotation             = Rotation::positive;
    std::string       sliding_direction    = "-y, x, 0"; ///< velocity v of the disc per rotation speed [m], see SlidingVelocity
    double            rotation_speed       = 4.;         ///< Ω [rad/s]
    double            load_per_side        = 1000.;      ///< [N]
    RadialDissipation radial_dissipation   = RadialDissipation::none;
    double            friction_slope       = 0.;    ///< dμ/dw at w_0 [s/m]
    bool              rotating_disc        = false; ///< whether the equations of motion contain the rotation

    void declare(Declarations &declarations);

    /// Throws ParameterError if the sliding direction cannot be understood or does not go with gyroscopic forces.
    void check() const;

    /// Whether the contact damps or excites by the speed of sliding.
    bool has_contact_damping() const;

    /// ±Ω, positive about e_z [rad/s].
    double angular_velocity() const;
  };
} // namespace Squeal
