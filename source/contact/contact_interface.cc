#include <squeal/base/decision.h>
#include <squeal/base/exceptions.h>
#include <squeal/contact/contact_interface.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    const Decision inclined("direction cosine of the normal of a contact node", 1e-12);

    /// Nodes closer to the axis have no sliding direction but that of rounding errors [m].
    constexpr double smallest_axis_distance = 1e-9;

    /// A node of a contact surface with the area-weighted normal of the faces that meet there.
    struct SurfaceNode
    {
      unsigned int node;
      Tensor<1, 3> area_normal;
      double       area = 0.;
    };

    /// Nodes of a named surface, in the order of their numbers.
    std::vector<SurfaceNode> surface_nodes(const Model &model, const char *surface)
    {
      const types::boundary_id id = model.surface_id(surface);
      const auto              &fe = model.dof_handler().get_fe();
      FEFaceValues<3> values(model.mapping(), fe, QGauss<2>(model.degree() + 1), update_values | update_normal_vectors | update_JxW_values);
      std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
      std::map<unsigned int, SurfaceNode>  nodes;
      for (const auto &cell : model.dof_handler().active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f) && cell->face(f)->boundary_id() == id)
            {
              values.reinit(cell, f);
              cell->get_dof_indices(dofs);
              for (unsigned int i = 0; i < fe.n_dofs_per_cell(); ++i)
                if (fe.system_to_component_index(i).first == 0 && fe.has_support_on_face(i, f))
                  {
                    SurfaceNode &entry = nodes[model.node_of_dof(dofs[i])];
                    entry.node         = model.node_of_dof(dofs[i]);
                    for (unsigned int q = 0; q < values.n_quadrature_points; ++q)
                      {
                        entry.area += values.shape_value(i, q) * values.JxW(q);
                        entry.area_normal += values.normal_vector(q) * values.JxW(q);
                      }
                  }
            }
      std::vector<SurfaceNode> result;
      for (const auto &[number, node] : nodes)
        result.push_back(node);
      return result;
    }

    Point<3> position(const Model &model, const unsigned int node)
    {
      const auto &p = model.nodes()[node].position;
      return {p[0], p[1], p[2]};
    }

    std::string print(const Point<3> &p)
    {
      std::ostringstream text;
      text << "(" << p[0] << ", " << p[1] << ", " << p[2] << ") m";
      return text.str();
    }

    std::array<double, 3> to_array(const Tensor<1, 3> &v)
    {
      return {{v[0], v[1], v[2]}};
    }

    /// n, t, b of a contact node.
    void set_frame(ContactNode &node, Tensor<1, 3> normal, const Rotation rotation)
    {
      normal /= normal.norm();
      for (unsigned int k = 0; k < 3; ++k)
        if (!inclined.exceeded_by(std::abs(normal[k])))
          normal[k] = 0.;
      normal /= normal.norm();

      const double r = node.axis_distance();
      if (!(r > smallest_axis_distance))
        throw MeshError("a contact node lies on the disc's axis, where nothing slides", "surface disc_contact",
                        "move the pins away from the axis");
      Tensor<1, 3> e_theta({-node.position[1] / r, node.position[0] / r, 0.});
      if (rotation == Rotation::negative)
        e_theta *= -1.;
      Tensor<1, 3> sliding = e_theta - (e_theta * normal) * normal;
      if (!(sliding.norm() > 1e-6))
        throw MeshError("the sliding direction is normal to the contact face",
                        "contact node at " + print(Point<3>(Tensor<1, 3>({node.position[0], node.position[1], node.position[2]}))),
                        "contact faces must not be perpendicular to the circumferential direction");
      sliding /= sliding.norm();
      node.normal  = to_array(normal);
      node.sliding = to_array(sliding);
      node.radial  = to_array(cross_product_3d(normal, sliding));
    }
  } // namespace

  double ContactNode::axis_distance() const
  {
    return std::hypot(position[0], position[1]);
  }

  int ContactNode::side() const
  {
    return normal[2] > 0. ? 1 : -1;
  }

  ContactInterface pair_contact_nodes(const Model &model, const Rotation rotation, const double tolerance)
  {
    const auto  disc_nodes = surface_nodes(model, PhysicalNames::disc_contact);
    const auto  pin_nodes  = surface_nodes(model, PhysicalNames::pin_contact);
    const char *advice     = "mesh both contact faces from the same plan, or raise Geometry/Pairing tolerance";

    // Disc nodes sorted by x: a partner is looked for among the neighbours only
    std::vector<std::pair<double, const SurfaceNode *>> sorted;
    for (const SurfaceNode &node : disc_nodes)
      sorted.emplace_back(position(model, node.node)[0], &node);
    std::sort(sorted.begin(), sorted.end());

    // Partners
    ContactInterface            interface;
    std::map<unsigned int, int> partners;
    unsigned int                n_single    = 0;
    double                      largest_gap = 0.;
    Point<3>                    example;
    for (const SurfaceNode &pin_node : pin_nodes)
      {
        const Point<3>     p       = position(model, pin_node.node);
        const SurfaceNode *nearest = nullptr;
        double             gap     = std::numeric_limits<double>::max();
        // Far partners are sought in a wider window so that the message can name the distance.
        const double window = std::max(tolerance, 1e-2);
        for (auto it = std::lower_bound(sorted.begin(), sorted.end(), std::make_pair(p[0] - window, (const SurfaceNode *)nullptr));
             it != sorted.end() && it->first <= p[0] + window; ++it)
          if (const double distance = position(model, it->second->node).distance(p); distance < gap)
            {
              gap     = distance;
              nearest = it->second;
            }
        if (nearest == nullptr || gap > tolerance)
          {
            if (n_single++ == 0)
              {
                example     = p;
                largest_gap = gap;
              }
            continue;
          }
        if (partners[nearest->node]++ > 0)
          throw MeshError("a node of the disc touches two pin nodes", "contact node at " + print(p),
                          "separate the pins, so that no two of them share a point of the disc");

        ContactNode node;
        node.disc_node = nearest->node;
        node.pin_node  = pin_node.node;
        node.pin       = model.nodes()[pin_node.node].component;
        node.position  = model.nodes()[nearest->node].position;
        node.area      = pin_node.area;
        set_frame(node, nearest->area_normal, rotation);
        for (const unsigned int partner : {node.disc_node, node.pin_node})
          for (const int dof : model.nodes()[partner].dofs)
            if (dof < 0)
              throw MeshError("a contact node is clamped", "contact node at " + print(p),
                              "keep pin_clamp and the contact surfaces apart, with at least one layer of elements between them");
        interface.push_back(node);
      }

    // Nothing may be left over on either side
    if (n_single > 0)
      {
        std::ostringstream distance;
        if (largest_gap < std::numeric_limits<double>::max())
          distance << "the nearest node of the disc is " << largest_gap << " m away";
        else
          distance << "no node of the disc is within 10 mm";
        throw MeshError(std::to_string(n_single) + " of " + std::to_string(pin_nodes.size()) +
                          " nodes of pin_contact have no partner on disc_contact; e.g. at " + print(example) + " " + distance.str(),
                        "pairing of contact nodes", advice);
      }
    if (interface.size() != disc_nodes.size())
      throw MeshError(std::to_string(disc_nodes.size() - interface.size()) + " of " + std::to_string(disc_nodes.size()) +
                        " nodes of disc_contact have no partner on pin_contact",
                      "pairing of contact nodes", advice);
    if (interface.empty())
      throw MeshError("disc and pins share no contact node", "surfaces disc_contact and pin_contact", advice);
    return interface;
  }

  std::vector<double> equal_load_shares(const ContactInterface &interface, const double load_per_side)
  {
    std::map<int, unsigned int> nodes_per_side;
    for (const ContactNode &node : interface)
      ++nodes_per_side[node.side()];
    std::vector<double> reactions;
    for (const ContactNode &node : interface)
      reactions.push_back(-load_per_side / nodes_per_side[node.side()]);
    return reactions;
  }

  std::vector<double> radial_dissipation(const ContactInterface    &interface,
                                         const std::vector<double> &reactions,
                                         const OperationParameters &operation)
  {
    std::vector<double> c_b(interface.size(), 0.);
    if (operation.radial_dissipation == RadialDissipation::none)
      return c_b;
    const double factor = operation.radial_dissipation == RadialDissipation::consistent ? operation.friction_coefficient : 1.;
    for (unsigned int c = 0; c < interface.size(); ++c)
      c_b[c] = factor * std::abs(reactions[c]) / (operation.rotation_speed * interface[c].axis_distance());
    return c_b;
  }

  std::vector<double> sliding_dissipation(const std::vector<double> &reactions, const OperationParameters &operation)
  {
    std::vector<double> c_t(reactions.size(), 0.);
    if (operation.friction_slope != 0.)
      for (unsigned int c = 0; c < reactions.size(); ++c)
        c_t[c] = std::abs(reactions[c]) * operation.friction_slope;
    return c_t;
  }
} // namespace Squeal
