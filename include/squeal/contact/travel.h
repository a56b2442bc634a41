// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/contact_interface.h>
#include <squeal/model/model.h>

#include <vector>

namespace Squeal
{
  /// Travel of the backplate of a pin towards the disc: the direction of the load.
  struct Travel
  {
    Eigen::Vector3d direction = Eigen::Vector3d::Zero(); ///< e, a unit vector; zero for the disc
    int             side      = 0; ///< ±1: along the axis, from above or below the disc; 0: along the normal of the body's face

    /// a = −e·n: closure of the normal gap at a node per unit of travel [-].
    double closing(const ContactNode &node) const
    {
      return -direction.dot(node.normal);
    }

    /// e·(n + μ f t): force along e on the backplate per unit reaction at a node with friction [-]. It is negative unless friction on an
    /// inclined face exceeds the normal force, because reactions in compression are negative.
    double force(const ContactNode &node, const double mu) const
    {
      return direction.dot(node.normal + mu * node.friction * node.sliding);
    }
  };

  /**
   * Travel of each component: e = −N/|N|, N = Σ area n over its contact nodes. If e is within 45 degrees of the disc's axis, the backplate
   * is guided along the axis.
   *
   * Throws MeshError if a body has no direction of travel: some of its contact nodes face perpendicular to it or away from it, for
   * example if the body touches both faces of the disc.
   */
  std::vector<Travel> travels(const Model &model, const ContactInterface &interface);

  /// True if every body has a direction of travel.
  bool have_travels(const Model &model, const ContactInterface &interface);

  /// Backplate of each component, numbered from 0; −1: none. Pins that travel along the axis share the backplate of their side, unless @p
  /// one_for_each_pin is set.
  std::vector<int> backplate_numbers(const std::vector<Travel> &travels, bool one_for_each_pin);

  /// Displacement of the backplate of each component [m] for given travels towards the disc [m].
  std::vector<Eigen::Vector3d> backplate_displacements(const std::vector<Travel> &travels, const std::vector<double> &approach);

  /**
   * Static reactions R_n0 ≤ 0 [N], equal at all nodes of a backplate; proportional to their areas if any faces do not match. The force
   * of a backplate along its travel, including friction, is the load per side: Σ e·(n + μ f t) R_n0 = load.
   *
   * Throws MeshError if travels() fails, ParameterError if friction balances or exceeds the load.
   */
  std::vector<double> equal_load_shares(const Model &model, const ContactInterface &interface, const OperationParameters &operation);
} // namespace Squeal
