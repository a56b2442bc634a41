// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/parameters/operation.h>
#include <squeal/parameters/sliding_velocity.h>

namespace Squeal
{
  void OperationParameters::declare(Declarations &declarations)
  {
    declarations.enter("Operation");
    declarations.add("Friction coefficient", friction_coefficient, "none", "Coulomb friction coefficient mu.", {0., 10.});
    declarations.add(
      "Rotation", rotation,
      "Sense of rotation. `positive`: the disc moves with the velocity v of Sliding direction times the rotation speed. `negative`: the "
      "disc moves in the opposite direction.");
    declarations.add("Rotation speed", rotation_speed, "rad/s",
                     "Angular speed Omega of the disc, which multiplies the velocity v of Sliding direction.", {0.});
    declarations.add(
      "Sliding direction", sliding_direction,
      "Velocity v of the disc relative to the other bodies for a rotation speed of 1 rad/s: three expressions in x, y, z [m], separated by "
      "commas, which may contain pi and functions of muParser. For example, -y, x, 0 is a rotation about the z axis, and 1, 0, 0 is the "
      "motion of a rail along x. The sliding direction t is the direction of the tangential part of v, and the sliding speed w_0 is Omega "
      "|v|. Units: m.");
    declarations.add(
      "Gyroscopic forces", rotating_disc,
      "Includes the effects of the rotation of the disc in the equations of motion in the fixed frame: gyroscopic forces and convective "
      "stiffness, without centrifugal prestress.");
    declarations.add(
      "Load per side", load_per_side, "N",
      "Force with which a backplate presses its pins against the disc. The pins above the disc share one backplate, and the pins below the "
      "disc share another backplate; both backplates move along the axis. A body whose mean contact normal deviates by more than 45 "
      "degrees from the axis, for example a shoe on a rim, has a separate backplate that moves along this normal.",
      {0.});
    declarations.add(
      "Radial dissipation", radial_dissipation,
      "Contact damping c_b [N s/m] of each node along b. `none`: no damping. `consistent`: c_b = mu |R_n0| / w_0 (linearised Coulomb "
      "friction, with mu multiplied by the friction factor of the pair). `published`: c_b = |R_n0| / w_0 (in the paper: R_n0 / w_0). The "
      "reaction R_n0 is determined by Steady sliding/Contact state.");
    declarations.add(
      "Friction slope", friction_slope, "s/m",
      "Slope dmu/dw of the friction coefficient at the sliding speed w_0. At each node, the slope adds damping along the sliding direction "
      "with the coefficient c_t = slope |R_n0| (for a friction factor of 1). A negative slope destabilises.",
      {-10., 10.});
  }

  void OperationParameters::check() const
  {
    if (!SlidingVelocity(*this).turns_about_z() && rotating_disc)
      throw ParameterError(
        "gyroscopic forces require the sliding direction -y, x, 0 (rotation about the z axis), but Operation/Sliding direction is " +
          sliding_direction,
        "parameters Operation/Gyroscopic forces and Sliding direction",
        "set Operation/Gyroscopic forces = false, or Operation/Sliding direction = -y, x, 0");
  }

  bool OperationParameters::has_contact_damping() const
  {
    return radial_dissipation != RadialDissipation::none || friction_slope != 0.;
  }

  double OperationParameters::angular_velocity() const
  {
    return rotation == Rotation::positive ? rotation_speed : -rotation_speed;
  }
} // namespace Squeal
