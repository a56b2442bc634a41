// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/common_points.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Position and size of a body, for mapping points from one design to another.
  struct BodyFrame
  {
    std::string      name;
    dealii::Point<3> lower, upper;               ///< corners of its bounding box [m]
    double           inner_radius, outer_radius; ///< radii of the disc about z [m]; zero for pins

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &name &lower &upper &inner_radius &outer_radius;
    }
  };

  std::vector<BodyFrame> body_frames(const Model &model);

  /// Maps points to the corresponding positions in another design, with the same masses; bodies that do not exist in the other design
  /// are omitted. Points of the disc keep their angle and their relative radial and axial positions; points of pins keep their relative
  /// positions in the bounding box.
  CommonPoints carried_over(const CommonPoints &points, const std::vector<BodyFrame> &from, const std::vector<BodyFrame> &to);
} // namespace Squeal
