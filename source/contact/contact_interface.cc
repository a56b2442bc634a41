// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/contact/contact_interface.h>
#include <squeal/geometry/surface_overlap.h>

#include <deal.II/base/mpi.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    /// Components of a unit normal below this limit are rounding errors of the coordinates [-].
    constexpr double not_inclined = 1e-12;

    /// Sliding velocities below this fraction of the largest velocity have no reliable direction because of rounding errors [-].
    constexpr double smallest_lever = 1e-8;

    struct SentFace
    {
      Shape             shape;
      std::int64_t      number;
      std::vector<Node> nodes;

      template <class Archive>
      void serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &shape &number &nodes;
      }
    };

    /// A contact surface, the same on every process: nodes in the order of their numbers, each with the area and the area-weighted normal
    /// of the adjacent faces.
    struct ContactSurface
    {
      std::vector<Node>            nodes;
      SurfacePatch                 patch;
      std::vector<double>          areas;
      std::vector<Eigen::Vector3d> area_normals;

      Eigen::Vector3d position(const std::size_t i) const
      {
        return Eigen::Vector3d::Map(nodes[i].position.data());
      }
    };

    std::vector<SentFace> all_faces_of(const Model &model, const std::string &surface)
    {
      std::vector<SentFace> own, all;
      for (const Face *face : model.faces_of(surface))
        if (face->is_own)
          {
            own.push_back({face->shape, face->number, {}});
            for (const unsigned int node : face->nodes)
              own.back().nodes.push_back(model.nodes()[node]);
          }
      for (const std::vector<SentFace> &part : Utilities::MPI::all_gather(model.communicator(), own))
        all.insert(all.end(), part.begin(), part.end());
      std::sort(all.begin(), all.end(), [](const SentFace &a, const SentFace &b) { return a.number < b.number; });
      return all;
    }

    ContactSurface contact_surface(const Model &model, const std::string &name)
    {
      const std::vector<SentFace>    faces = all_faces_of(model, name);
      std::map<std::int64_t, Node>   sorted;
      std::map<std::int64_t, size_t> places;
      for (const SentFace &face : faces)
        for (const Node &node : face.nodes)
          sorted.emplace(node.number, node);
      ContactSurface surface;
      for (const auto &[number, node] : sorted)
        {
          places[number] = surface.nodes.size();
          surface.nodes.push_back(node);
          surface.patch.points.emplace_back(node.position[0], node.position[1], node.position[2]);
        }
      surface.areas.assign(surface.nodes.size(), 0.);
      surface.area_normals.assign(surface.nodes.size(), Eigen::Vector3d::Zero());
      for (const SentFace &face : faces)
        {
          SurfaceElement element{face.shape, {}};
          for (const Node &node : face.nodes)
            element.nodes.push_back(places.at(node.number));
          surface.patch.elements.push_back(element);
          const WholeElement whole = whole_element(surface.patch, element);
          for (unsigned int i = 0; i < element.nodes.size(); ++i)
            {
              surface.areas[element.nodes[i]] += whole.functions[i];
              surface.area_normals[element.nodes[i]] += whole.area_normal;
            }
        }
      return surface;
    }

    std::string place(const Eigen::Vector3d &p)
    {
      return text("(", p[0], ", ", p[1], ", ", p[2], ") m");
    }

    /// Sets n, t and b of a contact node; @p longest is the largest lever [m].
    void set_frame(ContactNode &node, Eigen::Vector3d normal, const double longest, const SlidingVelocity &velocity)
    {
      normal *= 1. / normal.norm();
      for (double &cosine : normal)
        if (!(std::abs(cosine) > not_inclined))
          cosine = 0.;
      node.normal = (1. / normal.norm()) * normal;

      const std::string where = "parameter Operation/Sliding direction, contact node at " + place(node.position);
      if (!(node.lever > smallest_lever * longest && std::isfinite(node.lever)))
        throw MeshError("the sliding velocity of the disc is zero or undefined at a contact node", where,
                        "move the bodies away from this point (it may be on the axis of the disc), or change the sliding direction");
      const Eigen::Vector3d along   = velocity(node.position) / node.lever;
      const Eigen::Vector3d sliding = along - along.dot(node.normal) * node.normal;
      if (!(sliding.norm() > 1e-6))
        throw MeshError("the sliding velocity of the disc is normal to the contact face", where,
                        "change the sliding direction, or make the contact faces parallel to it");
      node.sliding = (1. / sliding.norm()) * sliding;
      node.radial  = node.normal.cross(node.sliding);
    }

    void refuse_clamped(const ContactNode &node)
    {
      for (const WeightedNodes *side : {&node.on_disc, &node.on_pin})
        for (const auto &[partner, weight] : *side)
          if (!partner.masters.empty())
            throw MeshError("a contact node is tied to another body",
                            "contact node at " + place(node.position) + ", parameter Contact/Tied",
                            "keep tied and contact faces apart, with at least one layer of elements between them");
          else if (partner.is_clamped())
            throw MeshError("a contact node is clamped by pin_clamp", "contact node at " + place(node.position),
                            "keep pin_clamp and the contact surfaces apart, with at least one layer of elements between them");
    }

    /// Disc node within the tolerance of each pin node; empty if a node of either side has no unique partner.
    std::optional<std::vector<std::size_t>> partners(const ContactSurface &disc, const ContactSurface &pins, const double tolerance)
    {
      if (disc.nodes.size() != pins.nodes.size())
        return {};
      // Sort by x to limit the search to neighbours
      std::vector<std::pair<double, std::size_t>> sorted;
      for (std::size_t d = 0; d < disc.nodes.size(); ++d)
        sorted.emplace_back(disc.position(d)[0], d);
      std::sort(sorted.begin(), sorted.end());
      std::vector<std::size_t> result;
      std::vector<bool>        is_taken(disc.nodes.size());
      for (std::size_t p = 0; p < pins.nodes.size(); ++p)
        {
          const Eigen::Vector3d x  = pins.position(p);
          auto                  it = std::lower_bound(sorted.begin(), sorted.end(), std::make_pair(x[0] - tolerance, std::size_t(0)));
          while (it != sorted.end() && it->first <= x[0] + tolerance && (disc.position(it->second) - x).norm() > tolerance)
            ++it;
          if (it == sorted.end() || it->first > x[0] + tolerance || is_taken[it->second])
            return {};
          is_taken[it->second] = true;
          result.push_back(it->second);
        }
      return result;
    }

    WeightedNodes weighted(const ContactSurface &surface, const std::vector<std::pair<unsigned int, double>> &weights)
    {
      WeightedNodes result;
      for (const auto &[node, weight] : weights)
        result.push_back({surface.nodes[node], weight});
      return result;
    }

    /// Contact nodes of matching faces, without t and b; n is not yet normalised.
    ContactInterface pairs(const ContactSurface &disc, const ContactSurface &pins, const std::vector<std::size_t> &of_disc)
    {
      ContactInterface result(pins.nodes.size());
      for (std::size_t p = 0; p < pins.nodes.size(); ++p)
        {
          ContactNode &node  = result[p];
          node.pin_node      = pins.nodes[p];
          node.on_disc       = {{disc.nodes[of_disc[p]], 1.}};
          node.on_pin        = {{node.pin_node, 1.}};
          node.forces_of_pin = node.on_pin;
          node.position      = disc.position(of_disc[p]);
          node.normal        = disc.area_normals[of_disc[p]];
          node.area          = pins.areas[p];
        }
      return result;
    }

    /// Smallest admissible fraction of a body's contact face that is opposite the disc [-].
    constexpr double least_of_body = 0.2;

    void check_overlap(const Model &model, const ContactSurface &pins, const ContactInterface &found)
    {
      std::vector<double> whole(model.component_names().size(), 0.), covered = whole;
      for (std::size_t node = 0; node < pins.nodes.size(); ++node)
        whole[pins.nodes[node].component] += pins.areas[node];
      for (const ContactNode &node : found)
        covered[node.pin_node.component] += node.area;
      for (std::size_t body = 0; body < whole.size(); ++body)
        if (covered[body] < least_of_body * whole[body])
          throw MeshError(text("only ", std::round(100. * covered[body] / whole[body]), " % of the contact face of ",
                               model.component_names()[body], " lies on the opposite contact surface"),
                          "contact of " + model.component_names()[body],
                          text("correct the positions of the surfaces: at least ", 100. * least_of_body,
                               " % of this face must lie on the opposite surface, with gaps well below the size of its elements"));
    }

    FoundContact mortar_nodes(const Model &model, const ContactPair &pair, const ContactSurface &disc, const ContactSurface &pins)
    {
      const double gap      = largest_gap(pins.patch);
      const Mortar coupling = mortar(pins.patch, disc.patch, gap);
      FoundContact result;
      for (const MortarRow &row : coupling.rows)
        {
          ContactNode node;
          node.pin_node      = pins.nodes[row.node];
          node.on_disc       = weighted(disc, row.master);
          node.on_pin        = weighted(pins, row.slave);
          node.forces_of_pin = weighted(pins, row.left_inverse);
          node.position      = pins.position(row.node);
          node.normal        = -pins.area_normals[row.node];
          node.area          = row.area;
          result.interface.push_back(node);
        }
      check_overlap(model, pins, result.interface);
      result.notes    = coupling_notes(coupling, gap, pair.pin, pair.disc);
      result.notes[0] = "faces do not match node by node: " + result.notes[0];
      return result;
    }

    FoundContact nodes_of_pair(const Model &model, const ContactPair &pair, const SlidingVelocity &velocity, const double tolerance)
    {
      const ContactSurface disc = contact_surface(model, pair.disc), pins = contact_surface(model, pair.pin);
      const auto           of_disc = partners(disc, pins, tolerance);
      const bool           turns   = velocity.turns_about_z();
      double               longest = 0.;
      FoundContact         result;
      try
        {
          result = of_disc ? FoundContact{pairs(disc, pins, *of_disc), {}} : mortar_nodes(model, pair, disc, pins);
        }
      catch (const MeshError &error)
        {
          throw MeshError(error.reason, "surfaces " + pair.disc + " and " + pair.pin, error.change);
        }
      for (ContactNode &node : result.interface)
        {
          node.lever = velocity.lever(node.position);
          node.turns = turns;
          longest    = std::max(longest, node.lever);
        }
      for (ContactNode &node : result.interface)
        {
          node.pin       = node.pin_node.component;
          node.friction  = pair.friction_factor;
          node.stiffness = pair.normal_stiffness;
          refuse_clamped(node);
          set_frame(node, node.normal, longest, velocity);
        }
      for (std::string &note : result.notes)
        note = pair.disc + " / " + pair.pin + ": " + note;
      return result;
    }
  } // namespace

  FoundContact contact_nodes(const Model                    &model,
                             const std::vector<ContactPair> &pairs,
                             const SlidingVelocity          &velocity,
                             const double                    tolerance)
  {
    FoundContact           result;
    std::set<std::int64_t> known;
    for (const ContactPair &pair : pairs)
      {
        FoundContact found = nodes_of_pair(model, pair, velocity, tolerance);
        for (ContactNode &node : found.interface)
          node.pair = static_cast<unsigned int>(&pair - pairs.data());
        for (const ContactNode &node : found.interface)
          if (!known.insert(node.pin_node.number).second)
            throw MeshError("a node of " + pair.pin + " is in contact twice",
                            "parameter Contact/Pairs, contact node at " + place(node.position),
                            "use every face of a body in one pair only, and keep elements between faces of different pairs");
        result.interface.insert(result.interface.end(), found.interface.begin(), found.interface.end());
        result.notes.insert(result.notes.end(), found.notes.begin(), found.notes.end());
      }
    return result;
  }

  std::vector<double> radial_dissipation(const ContactInterface    &interface,
                                         const std::vector<double> &reactions,
                                         const OperationParameters &operation)
  {
    std::vector<double> c_b(interface.size(), 0.);
    if (operation.radial_dissipation == RadialDissipation::none)
      return c_b;
    for (unsigned int c = 0; c < interface.size(); ++c)
      {
        const bool   is_consistent = operation.radial_dissipation == RadialDissipation::consistent;
        const double factor        = is_consistent ? operation.friction_coefficient * interface[c].friction : 1.;
        c_b[c]                     = factor * std::abs(reactions[c]) / (operation.rotation_speed * interface[c].lever);
      }
    return c_b;
  }

  std::vector<double> sliding_dissipation(const ContactInterface    &interface,
                                          const std::vector<double> &reactions,
                                          const OperationParameters &operation)
  {
    std::vector<double> c_t;
    for (std::size_t c = 0; c < interface.size(); ++c)
      c_t.push_back(std::abs(reactions[c]) * operation.friction_slope / interface[c].friction);
    return c_t;
  }
} // namespace Squeal
