// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/sliding_velocity.h>

#include <Eigen/Geometry>

#include <cmath>
#include <iostream>
#include <mutex>
#include <sstream>
#include <vector>

namespace Squeal
{
  namespace
  {
    /// Relative deviation of v from a rigid-body motion that counts as rounding [-].
    constexpr double rigid_velocity = 1e-12;

    /// Parts of a list separated by commas outside parentheses.
    std::vector<std::string> outer_parts(const std::string &list)
    {
      std::vector<std::string> parts(1);
      int                      depth = 0;
      for (const char c : list)
        {
          depth += (c == '(') - (c == ')');
          if (c == ',' && depth == 0)
            parts.emplace_back();
          else
            parts.back() += c;
        }
      return parts;
    }

    /// Function of three expressions; null if an expression is invalid or their number is not three.
    std::shared_ptr<const dealii::FunctionParser<3>> parsed(const std::string &expressions)
    {
      const std::vector<std::string> parts = outer_parts(expressions);
      if (parts.size() != 3)
        return nullptr;
      auto                              function = std::make_shared<dealii::FunctionParser<3>>(3);
      static std::mutex                 one_stream; // std::cerr is shared by all threads
      const std::lock_guard<std::mutex> lock(one_stream);
      std::ostringstream                unread; // discards the exception messages that deal.II prints
      std::streambuf                   *shown = std::cerr.rdbuf(unread.rdbuf());
      try
        {
          function->initialize("x,y,z", parts, {{"pi", M_PI}});
          for (const unsigned int component : {0, 1, 2}) // deal.II parses on first evaluation
            function->value(dealii::Point<3>(1., 1., 1.), component);
        }
      catch (const std::exception &)
        {
          function = nullptr;
        }
      std::cerr.rdbuf(shown);
      return function;
    }
  } // namespace

  SlidingVelocity::SlidingVelocity(const Rotation rotation, const std::string &expressions)
    : function(parsed(expressions))
    , sign(rotation == Rotation::negative ? -1. : 1.)
  {
    if (!function)
      throw ParameterError(in_quotes(expressions) + " is not a list of three valid expressions in x, y, z",
                           "parameter Operation/Sliding direction",
                           "give the components of the velocity of the disc for a rotation speed of 1 rad/s, for example -y, x, 0 for a "
                           "disc that turns about the z axis, or 1, 0, 0 for a rail along x");
  }

  SlidingVelocity::SlidingVelocity(const OperationParameters &operation)
    : SlidingVelocity(operation.rotation, operation.sliding_direction)
  {}

  Eigen::Vector3d SlidingVelocity::operator()(const Eigen::Vector3d &position) const
  {
    const dealii::Point<3> p(position[0], position[1], position[2]);
    return sign * Eigen::Vector3d(function->value(p, 0), function->value(p, 1), function->value(p, 2));
  }

  double SlidingVelocity::lever(const Eigen::Vector3d &position) const
  {
    const Eigen::Vector3d v = (*this)(position);
    return std::hypot(std::hypot(v[0], v[1]), v[2]);
  }

  std::optional<Eigen::Matrix<double, 6, 1>> SlidingVelocity::rigid_motion() const
  {
    const SlidingVelocity      &v  = *this;
    const Eigen::Vector3d       v0 = v(Eigen::Vector3d::Zero());
    const Eigen::Matrix3d       e  = Eigen::Matrix3d::Identity();
    Eigen::Matrix<double, 6, 1> motion;
    motion << v0, v(e.col(1))[2] - v0[2], v(e.col(2))[0] - v0[0], v(e.col(0))[1] - v0[1];
    for (const Eigen::Vector3d &x : {Eigen::Vector3d(1., 2., 3.), {-0.7, 0.1, 0.3}, {0.02, -0.5, 0.9}, {0.3, 0.6, -1.1}})
      if (const Eigen::Vector3d rigid = v0 + motion.tail<3>().cross(x); !((v(x) - rigid).norm() <= rigid_velocity * rigid.norm()))
        return {};
    return motion;
  }

  bool SlidingVelocity::turns_about_z() const
  {
    const auto motion = rigid_motion();
    return motion && (*motion - sign * Eigen::Matrix<double, 6, 1>::Unit(5)).norm() <= rigid_velocity;
  }
} // namespace Squeal
