// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/common_points.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Where a body is and how large: by it a point of one design is carried over to another one.
  struct BodyFrame
  {
    std::string      name;
    dealii::Point<3> lower, upper;               ///< corners of its bounding box [m]
    double           inner_radius, outer_radius; ///< of the disc, about z [m]; zeros for pins

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &name &lower &upper &inner_radius &outer_radius;
    }
  };

  /// Those of the disc and the pins.
  std::vector<BodyFrame> body_frames(const Model &model);

  /// Points at the same places of the bodies of another design, with the same masses; bodies that it does not have are left out. In the
  /// disc at the same angle, at the same parts of width and thickness; in a pin at the same parts of its bounding box.
  CommonPoints carried_over(const CommonPoints &points, const std::vector<BodyFrame> &from, const std::vector<BodyFrame> &to);
} // namespace Squeal
