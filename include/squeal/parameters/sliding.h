// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/parameters/declarations.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Contact state for the linearisation.
  enum class ContactState
  {
    equal_load,    ///< all nodes are closed and share the load of their side equally or, on non-matching faces, by area
    steady_sliding ///< quasi-static solution with unilateral contact and friction
  };

  template <>
  inline constexpr EnumName<ContactState> enum_table<ContactState>[] = {{ContactState::equal_load, "equal load"},
                                                                        {ContactState::steady_sliding, "steady sliding"}};

  /// Prescribed quantity: force or displacement of rigid backplates along their travel (contact/travel.h), or pressure on faces of the
  /// bodies.
  enum class BackplateControl
  {
    load_per_side, ///< one backplate for each side, with a given force
    displacement,  ///< one backplate for each side, with a given displacement
    load_per_pin,  ///< an individual actuator for every pin
    pressure       ///< no rigid backplate: pressure on faces of bodies that may tilt and bend
  };

  template <>
  inline constexpr EnumName<BackplateControl> enum_table<BackplateControl>[] = {{BackplateControl::load_per_side, "load per side"},
                                                                                {BackplateControl::displacement, "displacement"},
                                                                                {BackplateControl::load_per_pin, "load per pin"},
                                                                                {BackplateControl::pressure, "pressure"}};

  /**
   * Gap between the face of an unloaded pin and the disc, measured along the travel of its backplate in the initial position:
   *
   *   gap + sliding taper · s_t + radial taper · s_r
   *
   * with the distances s_t along t and s_r outwards from the centre of the face; s_r is measured along the disc axis if the travel is not
   * axial, and along b if the disc does not turn about z.
   */
  struct PinGap
  {
    std::string pin;
    double      gap;                ///< [m]
    double      sliding_taper = 0.; ///< [-]
    double      radial_taper  = 0.; ///< [-]
  };

  /// Force of the actuator of a pin.
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
    double               displacement = 0.; ///< displacement of each backplate towards the disc [m]
    std::vector<PinLoad> pin_loads;         ///< pins with a load other than an equal share of their side
    std::vector<PinGap>  gaps;

    std::vector<std::string> pressed_faces; ///< faces to which pressure control applies the load per side

    void declare(Declarations &declarations);

    /// Throws ParameterError for values that do not define a steady sliding state.
    void check_steady() const;
  };
} // namespace Squeal
