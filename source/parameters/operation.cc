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
      "Sense of rotation: the disc moves with the velocity v of Sliding direction times the rotation speed, or in the opposite direction.");
    declarations.add("Rotation speed", rotation_speed, "rad/s",
                     "Angular speed Omega of the disc, which multiplies the velocity v of Sliding direction.", {0.});
    declarations.add(
      "Sliding direction", sliding_direction,
      "Velocity v of the disc relative to the other bodies for a rotation speed of 1 rad/s, three expressions in x, y, z [m] separated "
      "by commas, with pi and functions of muParser: -y, x, 0 is rotation about the z axis, 1, 0, 0 a rail along x. t is the direction "
      "of its tangential part, the sliding speed w_0 is Omega |v|. Units: m.");
    declarations.add(
      "Gyroscopic forces", rotating_disc,
      "Includes the rotation of the disc, in the fixed frame, in the equations of motion: gyroscopic forces and convective stiffness, "
      "without centrifugal prestress.");
    declarations.add(
      "Load per side", load_per_side, "N",
      "Force of a backplate that presses its pins towards the disc. The pins above and those below the disc have one backplate each, "
      "along the axis; a body whose mean contact normal is more than 45 degrees from the axis, such as a shoe on a rim, has its own, "
      "along that normal.",
      {0.});
    declarations.add(
      "Radial dissipation", radial_dissipation,
      "Contact damping along b per node: none; consistent, c_b = mu R_n0 / w_0 (linearised Coulomb friction); "
      "published, c_b = R_n0 / w_0 (as printed in the paper). R_n0 follows from Steady sliding/Contact state. c_b in N s/m.");
    declarations.add(
      "Friction slope", friction_slope, "s/m",
      "Slope dmu/dw of the friction coefficient at the sliding speed w_0; adds damping c_t = slope R_n0 per node along the sliding "
      "direction, so that a negative slope destabilises.",
      {-10., 10.});
  }

  void OperationParameters::check() const
  {
    if (!SlidingVelocity(*this).turns_about_z() && rotating_disc)
      throw ParameterError("gyroscopic forces require a disc that turns about the z axis, but the disc moves along " + sliding_direction,
                           "parameters Operation/Gyroscopic forces and Sliding direction",
                           "set Operation/Gyroscopic forces = false, or leave Operation/Sliding direction at -y, x, 0");
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
