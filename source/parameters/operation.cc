#include <squeal/parameters/operation.h>

namespace Squeal
{
  void OperationParameters::declare(Declarations &declarations)
  {
    declarations.enter("Operation");
    declarations.add("Friction coefficient", friction_coefficient, "none", "Coulomb's coefficient mu.", {0., 10.});
    declarations.add("Rotation", rotation, "Sense of rotation about the z axis: the disc slides along +e_theta or -e_theta.");
    declarations.add("Rotation speed", rotation_speed, "rad/s", "Angular speed of the disc.", {0.});
    declarations.add("Gyroscopic forces", rotating_disc,
                     "Whether the equations of motion of the disc contain its rotation, seen from the fixed frame: gyroscopic forces and "
                     "convective stiffness.");
    declarations.add("Load per side", load_per_side, "N",
                     "Force with which a backplate presses its pins towards the disc: those above and those below the disc have one "
                     "each, along the axis; a body whose mean contact normal is more than 45 degrees from the axis, such as a shoe on "
                     "a rim, has its own, along that normal.",
                     {0.});
    declarations.add("Radial dissipation", radial_dissipation,
                     "Contact damping along b per node: none; consistent, c_b = mu R_n0 / w_0 (linearised Coulomb friction); "
                     "published, c_b = R_n0 / w_0 (as the paper prints it). R_n0 follows from Steady sliding/Contact state. c_b in N s/m.");
    declarations.add("Friction slope", friction_slope, "s/m",
                     "Slope dmu/dw of the friction coefficient at the sliding speed w_0; damps along the sliding direction with c_t = "
                     "slope R_n0 per node, so that a falling slope destabilises.",
                     {-10., 10.});
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
