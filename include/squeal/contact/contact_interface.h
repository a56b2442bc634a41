#pragma once

#include <squeal/model/model.h>
#include <squeal/parameters/operation.h>

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace Squeal
{
  /// A pair of coincident nodes, one of the disc and one of a pin, with its local frame.
  struct ContactNode
  {
    Node            disc_node, pin_node; ///< the same on every process, but for is_own
    unsigned int    pin;                 ///< component of the pin node
    Eigen::Vector3d position;            ///< [m]
    Eigen::Vector3d normal;              ///< n: outward unit normal of the disc
    Eigen::Vector3d sliding;             ///< t: direction in which the disc moves relative to the pin
    Eigen::Vector3d radial;              ///< b = n × t
    double          area;                ///< share of the contact area [m²]

    /// Distance from the disc's axis [m].
    double axis_distance() const
    {
      return std::hypot(position[0], position[1]);
    }
  };

  /// The contact nodes, the same on every process.
  using ContactInterface = std::vector<ContactNode>;

  /**
   * Pairs the nodes of `disc_contact` and `pin_contact`. The normal of a node
   * is the area average over the disc's contact faces that meet there; t is the
   * direction of ±e_θ in the tangent plane.
   *
   * Throws MeshError if nodes have no partner within @p tolerance [m], if a
   * node would belong to two pairs, or if a contact node is clamped.
   */
  ContactInterface pair_contact_nodes(const Model &model, Rotation rotation, double tolerance);

  /**
   * Viscous contact damping of each node [N s/m] in a state with reactions R_n0:
   *
   *   along b  c_b = μ |R_n0| / w_0 (consistent) or |R_n0| / w_0 (published), w_0 = Ω r;  zeros for `none`
   *   along t  c_t = |R_n0| dμ/dw
   */
  std::vector<double> radial_dissipation(const ContactInterface    &interface,
                                         const std::vector<double> &reactions,
                                         const OperationParameters &operation);
  std::vector<double> sliding_dissipation(const std::vector<double> &reactions, const OperationParameters &operation);
} // namespace Squeal
