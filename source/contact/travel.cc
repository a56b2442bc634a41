// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/contact/travel.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace Squeal
{
  namespace
  {
    /// Cosine of the angle between travel and axis above which backplates are guided along the axis: 45 degrees, with a margin for
    /// rounding.
    constexpr double along_axis = 0.7;

    /// Smallest cosine of the angle between the normal of a contact node and the travel of its body; below it, the travel does not close
    /// a gap.
    constexpr double facing = 0.01;

    std::vector<Travel> mean_directions(const Model &model, const ContactInterface &interface)
    {
      std::vector<Travel> result(model.component_names().size());
      for (const ContactNode &node : interface)
        result[node.pin].direction -= node.area * node.normal;
      for (Travel &travel : result)
        {
          // If the normals cancel exactly, the direction stays zero, and facing_away() reports the body
          if (const double size = travel.direction.norm(); size > 0.)
            travel.direction /= size;
          if (std::abs(travel.direction[2]) > along_axis)
            {
              travel.side      = travel.direction[2] < 0. ? 1 : -1;
              travel.direction = {0., 0., static_cast<double>(-travel.side)};
            }
        }
      return result;
    }

    /// Contact nodes that do not face in the direction of travel of their body.
    std::vector<const ContactNode *> facing_away(const std::vector<Travel> &travels, const ContactInterface &interface)
    {
      std::vector<const ContactNode *> result;
      for (const ContactNode &node : interface)
        if (!(travels[node.pin].closing(node) > facing))
          result.push_back(&node);
      return result;
    }
  } // namespace

  std::vector<Travel> travels(const Model &model, const ContactInterface &interface)
  {
    const std::vector<Travel> result = mean_directions(model, interface);
    if (const auto away = facing_away(result, interface); !away.empty())
      {
        const unsigned int pin     = away.front()->pin;
        const auto         is_of   = [pin](const ContactNode &node) { return node.pin == pin; };
        const auto         n_away  = std::count_if(away.begin(), away.end(), [&](const ContactNode *node) { return is_of(*node); });
        const auto         n_nodes = std::count_if(interface.begin(), interface.end(), is_of);
        const auto        &p       = away.front()->position;
        throw MeshError(
          text("the contact faces of one body have no common direction of loading (contact nodes that do not face the mean direction: ",
               n_away, " of ", n_nodes, ", the first at (", p[0], ", ", p[1], ", ", p[2], ") m)"),
          "volume " + model.component_names()[pin],
          "divide the body into one part for each face; or set Operation/Radial dissipation = none, Operation/Friction slope "
          "= 0 and Steady sliding/Contact state = equal load, which require no direction of loading");
      }
    return result;
  }

  bool have_travels(const Model &model, const ContactInterface &interface)
  {
    return facing_away(mean_directions(model, interface), interface).empty();
  }

  std::vector<int> backplate_numbers(const std::vector<Travel> &travels, const bool one_for_each_pin)
  {
    std::map<int, int> of_side;
    std::vector<int>   result;
    int                n = 0;
    for (const Travel &travel : travels)
      if (travel.direction.isZero(0.))
        result.push_back(-1);
      else if (one_for_each_pin || travel.side == 0)
        result.push_back(n++);
      else
        {
          const auto [entry, is_new] = of_side.try_emplace(travel.side, n);
          n += is_new;
          result.push_back(entry->second);
        }
    return result;
  }

  std::vector<Eigen::Vector3d> backplate_displacements(const std::vector<Travel> &travels, const std::vector<double> &approach)
  {
    std::vector<Eigen::Vector3d> result;
    for (std::size_t k = 0; k < travels.size(); ++k)
      result.emplace_back(approach[k] * travels[k].direction);
    return result;
  }

  std::vector<double> equal_load_shares(const Model &model, const ContactInterface &interface, const OperationParameters &operation)
  {
    const std::vector<Travel> directions = travels(model, interface);
    const std::vector<int>    plates     = backplate_numbers(directions, false);
    // The areas of mortar nodes vary: distribute the load by area
    const bool are_pairs = std::all_of(interface.begin(), interface.end(), [](const ContactNode &node) { return node.is_pair(); });
    const auto unit      = [are_pairs](const ContactNode &node) { return are_pairs ? 1. : node.area; };
    std::map<int, double> forces; // load per backplate along its travel, for unit reactions
    for (const ContactNode &node : interface)
      forces[plates[node.pin]] += unit(node) * directions[node.pin].force(node, operation.friction_coefficient);
    std::vector<double> reactions;
    for (const ContactNode &node : interface)
      {
        const double force = forces[plates[node.pin]];
        if (!(force < 0.))
          throw ParameterError(
            text("friction on inclined contact faces balances or exceeds the load at a friction coefficient of ",
                 operation.friction_coefficient, ": equal reactions of the contact nodes cannot be determined"),
            "parameter Operation/Friction coefficient, volume " + model.component_names()[node.pin],
            "lower the friction coefficient, or set Operation/Radial dissipation = none and Operation/Friction slope = 0");
        reactions.push_back(operation.load_per_side / force * unit(node));
      }
    return reactions;
  }
} // namespace Squeal
