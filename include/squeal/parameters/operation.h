#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/parameters/declarations.h>

namespace Squeal
{
  /// Sense in which the disc turns about e_z: the sliding direction is t = ±e_θ.
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
    double            rotation_speed       = 4.;    ///< Ω [rad/s]
    double            load_per_side        = 1000.; ///< [N]
    RadialDissipation radial_dissipation   = RadialDissipation::none;
    double            friction_slope       = 0.;    ///< dμ/dw at w_0 [s/m]
    bool              rotating_disc        = false; ///< whether the equations of motion contain the rotation

    void declare(Declarations &declarations);

    /// Whether the contact damps or excites by the speed of sliding.
    bool has_contact_damping() const;

    /// ±Ω, positive about e_z [rad/s].
    double angular_velocity() const;
  };
} // namespace Squeal
