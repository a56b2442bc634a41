// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/number_list.h>
#include <squeal/parameters/sliding.h>

#include <deal.II/base/utilities.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    const ListFormat gap_list  = {"Steady sliding/Gaps",
                                  "not the gap of a pin",
                                  "pin: gap; pin: gap, sliding taper, radial taper; ... [m, -, -]",
                                  "pin",
                                  {1, 3}};
    const ListFormat load_list = {"Steady sliding/Loads", "not the load of a pin", "pin: load; pin: load; ... [N]", "pin", {1}};
  } // namespace

  void SlidingParameters::declare(Declarations &declarations)
  {
    declarations.enter("Steady sliding");
    declarations.add(
      "Contact state", state,
      "Contact state about which the system is linearised. `equal load`: all contact nodes are closed, and the load of each side is shared "
      "equally by its nodes, or in proportion to their areas if the faces do not match. `steady sliding`: the quasi-static solution with "
      "unilateral contact and friction, in which nodes may lift off. All other parameters of this section apply to steady sliding only.");
    declarations.add(
      "Control", control,
      "Prescribed quantity. `load per side`: the force Operation/Load per side on the rigid backplate of each side. `displacement`: the "
      "travel of every backplate. `load per pin`: a force on each pin. `pressure`: a uniform pressure on Pressed faces; the bodies are "
      "held only by their mounts and may tilt and bend.");
    declarations.add(
      "Displacement", displacement, "m",
      "For Control = displacement: travel of each backplate towards the disc along the axis (for a shoe on a rim, along its mean contact "
      "normal), from the position in which a pin without a gap touches the disc.",
      {0.});
    declare_list(
      declarations, "Loads", pin_loads,
      "For Control = load per pin: forces on the pins, as a list `pin: load; ...`. A pin that is not in the list carries an equal share of "
      "Operation/Load per side; a shoe on a rim carries the whole load. Units: N.",
      load_list, {&PinLoad::load}, &PinLoad::pin);
    declarations.add_text(
      "Pressed faces",
      "For Control = pressure: surfaces with a uniform pressure, separated by commas, for example pad_outer_back, pad_inner_back. The "
      "resultant force on each surface is Operation/Load per side: the pressure is load / area on a flat face and load / |area integral of "
      "the normal| on a curved face.",
      [this] { return boost::algorithm::join(pressed_faces, ", "); },
      [this](const std::string &text) { pressed_faces = dealii::Utilities::split_string_list(text, ','); });
    declare_list(
      declarations, "Gaps", gaps,
      "Initial gaps of pins (height tolerance, wear), as a list `pin: gap; pin: gap, sliding taper, radial taper; ...`. A gap is measured "
      "along the travel of the backplate and is positive if the pin does not touch the disc. The tapers are the increases of the gap per "
      "distance from the centre of the face, along the sliding direction and radially outwards (for a shoe on a rim, along the axis; if "
      "the disc does not rotate about z, along b). Units: m, none, none.",
      gap_list, {&PinGap::gap, &PinGap::sliding_taper, &PinGap::radial_taper}, &PinGap::pin);
  }

  void SlidingParameters::check_steady() const
  {
    for (const PinLoad &entry : pin_loads)
      if (!(entry.load > 0.))
        throw ParameterError("the load is " + exact_text(entry.load) + " N, but must be positive",
                             "parameter Steady sliding/Loads, pin " + entry.pin,
                             "give a positive force, or remove the pin from the list for an equal share of Operation/Load per side");
    if (control == BackplateControl::displacement && !(displacement > 0.) && gaps.empty())
      throw ParameterError("the displacement of the backplates is zero, and no pin has an initial gap",
                           "parameter Steady sliding/Displacement",
                           "give a positive travel, or set Steady sliding/Control = load per side");
    if ((control == BackplateControl::pressure) == pressed_faces.empty())
      throw ParameterError(pressed_faces.empty() ? "Steady sliding/Control is `pressure`, but no face is pressed" :
                                                   "pressed faces are given, but `" + to_string(control) + "` is prescribed",
                           "parameter Steady sliding/Pressed faces",
                           "name the faces if Steady sliding/Control = pressure, and leave the list empty "
                           "otherwise");
    for (const std::string &face : pressed_faces)
      if (std::count(pressed_faces.begin(), pressed_faces.end(), face) > 1)
        throw ParameterError("the surface " + face + " is named twice", "parameter Steady sliding/Pressed faces", "name each face once");
    if (control != BackplateControl::load_per_pin && !pin_loads.empty())
      throw ParameterError("loads of individual pins are given, but `" + to_string(control) + "` is prescribed",
                           "parameter Steady sliding/Loads", "set Steady sliding/Control = load per pin, or remove the loads");
    if (control != BackplateControl::displacement && displacement != 0.)
      throw ParameterError("a displacement is given, but `" + to_string(control) + "` is prescribed",
                           "parameter Steady sliding/Displacement",
                           "set Steady sliding/Control = displacement, or remove the displacement");
  }
} // namespace Squeal
