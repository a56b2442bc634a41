// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/parameters/operation.h>

#include <deal.II/base/function_parser.h>

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <string>

namespace Squeal
{
  /// Velocity of the disc relative to the other bodies per unit of rotation speed, v(x) [m]: ±e_z × x, or from Operation/Sliding direction.
  class SlidingVelocity
  {
  public:
    /// Throws ParameterError if @p expressions are not three expressions in x, y, z.
    SlidingVelocity(Rotation rotation = Rotation::positive, const std::string &expressions = OperationParameters().sliding_direction);
    SlidingVelocity(const OperationParameters &operation);

    /// v at a point [m]; a component that is undefined there is not finite.
    Eigen::Vector3d operator()(const Eigen::Vector3d &position) const;

    /// |v| = w_0 / Ω at a point [m].
    double lever(const Eigen::Vector3d &position) const;

    /// v as a rigid-body motion: translation along and rotation about x, y, z; empty if v is not a rigid-body motion.
    std::optional<Eigen::Matrix<double, 6, 1>> rigid_motion() const;

    /// True if v = ±e_z × x.
    bool turns_about_z() const;

  private:
    std::shared_ptr<const dealii::FunctionParser<3>> function;
    double                                           sign;
  };
} // namespace Squeal
