#include <squeal/parameters/enum_parameter.h>
#include <squeal/parameters/number_parameter.h>
#include <squeal/parameters/operation.h>

namespace Squeal
{
  void OperationParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    prm.enter_subsection("Operation");
    add_number_parameter(prm, "Friction coefficient", friction_coefficient, "Coulomb's coefficient mu. Units: none.", Double(0., 10.));
    add_enum_parameter(prm, "Rotation", rotation, "Sense of rotation about the z axis: the disc slides along +e_theta or -e_theta.");
    add_number_parameter(prm, "Rotation speed", rotation_speed, "Angular speed of the disc. Units: rad/s.", Double(0.));
    prm.add_parameter("Gyroscopic forces", rotating_disc,
                      "Whether the equations of motion of the disc contain its rotation, seen from the fixed frame: gyroscopic forces and "
                      "convective stiffness.",
                      dealii::Patterns::Bool());
    add_number_parameter(prm, "Load per side", load_per_side, "Normal force with which the pins of one side press. Units: N.", Double(0.));
    add_enum_parameter(
      prm, "Radial dissipation", radial_dissipation,
      "Contact damping along b per node: none; consistent, c_b = mu R_n0 / w_0 (linearised Coulomb friction); "
      "published, c_b = R_n0 / w_0 (as the paper prints it). R_n0 follows from Steady sliding/Contact state. c_b in N s/m.");
    add_number_parameter(prm, "Friction slope", friction_slope,
                         "Slope dmu/dw of the friction coefficient at the sliding speed w_0; damps along the sliding direction with "
                         "c_t = slope R_n0 per node, so that a falling slope destabilises. Units: s/m.",
                         Double(-10., 10.));
    prm.leave_subsection();
  }

  double OperationParameters::angular_velocity() const
  {
    return rotation == Rotation::positive ? rotation_speed : -rotation_speed;
  }
} // namespace Squeal
