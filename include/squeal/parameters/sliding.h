// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/parameters/declarations.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// The state about which the system is linearised.
  enum class ContactState
  {
    equal_load,    ///< every node of a side carries the same share of the load, all are closed
    steady_sliding ///< quasi-static solution with unilateral contact and friction
  };

  template <>
  inline constexpr EnumName<ContactState> enum_table<ContactState>[] = {{ContactState::equal_load, "equal load"},
                                                                        {ContactState::steady_sliding, "steady sliding"}};

  /// What is prescribed: at rigid backplates, which move along their travel (contact/travel.h), or a pressure on faces of the bodies.
  enum class BackplateControl
  {
    load_per_side, ///< one backplate for each side, pressed with a given force
    displacement,  ///< one backplate for each side, at a given displacement
    load_per_pin,  ///< every pin has an actuator of its own
    pressure       ///< no rigid backplate: a pressure on faces, which may tilt and bend
  };

  template <>
  inline constexpr EnumName<BackplateControl> enum_table<BackplateControl>[] = {{BackplateControl::load_per_side, "load per side"},
                                                                                {BackplateControl::displacement, "displacement"},
                                                                                {BackplateControl::load_per_pin, "load per pin"},
                                                                                {BackplateControl::pressure, "pressure"}};

  /**
   * Gap between the face of an unloaded pin and the disc, measured along the
   * travel of its backplate before it moves:
   *
   *   gap + sliding taper · s_t + radial taper · s_r
   *
   * with the distances s_t along t and s_r outwards from the centre of the face;
   * s_r is along the axis where the travel is not, along b where the disc does not turn about z.
   */
  struct PinGap
  {
    std::string pin;
    double      gap;                ///< [m]
    double      sliding_taper = 0.; ///< [-]
    double      radial_taper  = 0.; ///< [-]
  };

  /// Force with which the actuator of a pin presses.
  struct PinLoad
  {
    std::string pin;
    double      load; ///< [N]
  };

  /// The steady sliding state (section `Steady sliding`).
  struct SlidingParameters
  {
    ContactState         state        = ContactState::equal_load;
    BackplateControl     control      = BackplateControl::load_per_side;
    double               displacement = 0.; ///< of each backplate towards the disc [m]
    std::vector<PinLoad> pin_loads;         ///< of pins that do not carry an equal share of the load of their side
    std::vector<PinGap>  gaps;              ///< of pins that do not touch the disc at first

    std::vector<std::string> pressed_faces; ///< each with the load per side, where the control is pressure

    void declare(Declarations &declarations);

    /// Refuses values that leave no steady sliding state; throws ParameterError.
    void check_steady() const;
  };
} // namespace Squeal
