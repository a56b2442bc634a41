// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/model/model.h>
#include <squeal/parameters/contact.h>
#include <squeal/parameters/operation.h>
#include <squeal/parameters/sliding_velocity.h>

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace Squeal
{
  /// A node and its weight in a sum.
  struct WeightedNode
  {
    Node   node; ///< the same on every process, except is_own
    double weight;
  };

  using WeightedNodes = std::vector<WeightedNode>;

  /// A contact node of a pin, the opposite point of the disc, and their local frame. Matching faces give pairs of coincident nodes with
  /// weight 1; other faces are coupled by mortar(), with one contact node for each MortarRow.
  struct ContactNode
  {
    WeightedNodes   on_disc, on_pin; ///< Σ weight u: displacements of both sides
    WeightedNodes   forces_of_pin;   ///< Σ weight f: contact force at this node, from nodal forces f on the pin
    Node            pin_node;
    unsigned int    pin;       ///< component of the pin node
    Eigen::Vector3d position;  ///< [m]
    Eigen::Vector3d normal;    ///< n: outward unit normal of the disc
    Eigen::Vector3d sliding;   ///< t: direction in which the disc moves relative to the pin
    Eigen::Vector3d radial;    ///< b = n × t
    double          lever;     ///< |v| = w_0 / Ω [m]: distance from the axis if the disc rotates about z
    bool            turns;     ///< true if the disc rotates about z
    double          area;      ///< share of the contact area [m²]
    double          friction;  ///< friction factor of the pair of surfaces: multiplies the friction coefficient [-]
    unsigned int    pair;      ///< number of the pair of surfaces
    double          stiffness; ///< k of the pair [N/m³]; zero: rigid contact

    bool is_rigid() const
    {
      return stiffness == 0.;
    }

    bool is_pair() const
    {
      return on_disc.size() == 1 && on_pin.size() == 1;
    }

    /// Distance from the disc's axis [m].
    double axis_distance() const
    {
      return std::hypot(position[0], position[1]);
    }
  };

  /// The contact nodes, the same on every process.
  using ContactInterface = std::vector<ContactNode>;

  /// Contact nodes, and notes for the user about their detection.
  struct FoundContact
  {
    ContactInterface         interface;
    std::vector<std::string> notes;
  };

  /**
   * Contact nodes of pairs of surfaces: node pairs if each node of the pins has its own disc node within @p tolerance [m] and vice versa;
   * mortar nodes otherwise, see mortar(). The normal of a node pair is the area average over the adjacent contact faces of the
   * disc; for a mortar node, the average is over the faces of the pin. t is the direction of the velocity in the tangent plane.
   *
   * Throws MeshError if a contact node is clamped, tied or in two pairs; if its velocity is zero, not finite or normal to the face; if too
   * little of a body's face is opposite the disc; or if mortar() fails.
   */
  FoundContact contact_nodes(const Model &model, const std::vector<ContactPair> &pairs, const SlidingVelocity &velocity, double tolerance);

  /**
   * Viscous contact damping of each node [N s/m] in a state with reactions R_n0:
   *
   *   along b  c_b = μ f |R_n0| / w_0 (consistent) or |R_n0| / w_0 (published), w_0 = Ω |v|;  zeros for `none`
   *   along t  c_t = |R_n0| dμ/dw / f, for rows f t·(u_D − u_P) of P_t, with the friction factor f of the pair
   */
  std::vector<double> radial_dissipation(const ContactInterface    &interface,
                                         const std::vector<double> &reactions,
                                         const OperationParameters &operation);
  std::vector<double> sliding_dissipation(const ContactInterface    &interface,
                                          const std::vector<double> &reactions,
                                          const OperationParameters &operation);
} // namespace Squeal
