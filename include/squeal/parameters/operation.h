// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/parameters/declarations.h>

#include <string>

namespace Squeal
{
  /// Sense of the disc motion, which determines the sign of the sliding velocity.
  enum class Rotation
  {
    positive,
    negative
  };

  template <>
  inline constexpr EnumName<Rotation> enum_table<Rotation>[] = {{Rotation::positive, "positive"}, {Rotation::negative, "negative"}};

  /// Viscous contact damping along b, c_b [N s/m] per node: μ |R_n0| / w_0 from the linearisation of R_t = μ R_n w/|w| (consistent), or
  /// R_n0 / w_0 as printed below eq. (3) of the paper (published).
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
    bool              rotating_disc        = false; ///< include rotation terms in the equations of motion

    void declare(Declarations &declarations);

    /// Throws ParameterError if the sliding direction is invalid or incompatible with gyroscopic forces.
    void check() const;

    /// True with radial dissipation or a friction slope.
    bool has_contact_damping() const;

    /// Signed rotation speed ±Ω about e_z [rad/s].
    double angular_velocity() const;
  };
} // namespace Squeal
