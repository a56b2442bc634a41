// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include "scenes.h"

#include <squeal/base/exceptions.h>

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

namespace Squeal::Testing
{
  /// Slopes the contact faces towards the rim and tilts them about x, so that all faces differ.
  inline Mesh sloped(const Mesh &mesh, const double slope)
  {
    return mapped(mesh, [slope](const Point3 &p) {
      return Point3{{p[0], p[1], p[2] + slope * (std::hypot(p[0], p[1]) - 0.2) + 0.3 * slope * p[1]}};
    });
  }

  /// Mounts that hold the bore in all directions.
  inline const std::vector<Mount> held = {{"disc_bore", 1e9, 7.80e10, 1.88e10}};

  /// A test case: contact faces, element and mounts.
  struct Case
  {
    const char        *name;
    double             slope   = 0.; ///< slope of the contact faces
    Element            element = Element::trilinear;
    std::vector<Mount> mounts  = held;
    int                n_free  = 0; ///< number of rigid-body motions of the disc on its mounts
  };

  inline void PrintTo(const Case &c, std::ostream *stream)
  {
    *stream << c.name;
  }

  inline const std::vector<Case> held_cases = {{"flat"},
                                               {"flat, quadratic", 0., Element::quadratic},
                                               {"cone", 0.3},
                                               {"cone, quadratic", 0.3, Element::quadratic},
                                               {"steep cone", 1.5}},
                                 free_cases = {{"free disc, flat", 0., Element::trilinear, {}, 6},
                                               {"free disc, cone", 0.3, Element::trilinear, {}, 6},
                                               {"turns freely", 0., Element::trilinear, {{"disc_bore", 0., 7.80e10, 0.}}, 1}};

  /// Expects an exception whose message contains all @p parts.
  template <typename Exception = Error, typename Action>
  void expect_refusal(const Action &action, const std::vector<std::string> &parts)
  {
    std::string message = "nothing was refused";
    try
      {
        action();
      }
    catch (const Exception &error)
      {
        message = error.what();
      }
    for (const std::string &part : parts)
      EXPECT_NE(message.find(part), std::string::npos) << message;
  }
} // namespace Squeal::Testing
