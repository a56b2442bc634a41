#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/contact/contact_interface.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_values.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    /// Direction cosine of a normal up to which it is a rounding error of the coordinates [-].
    constexpr double not_inclined = 1e-12;

    /// Nodes closer to the axis, compared with the outermost one, have no sliding direction but that of rounding errors [-].
    constexpr double smallest_axis_distance = 1e-8;

    /// A node of a contact surface with the area-weighted normal of the faces that meet there.
    struct SurfaceNode
    {
      Node            node;
      Eigen::Vector3d area_normal = Eigen::Vector3d::Zero();
      double          area        = 0.;

      Eigen::Vector3d position() const
      {
        return Eigen::Vector3d::Map(node.position.data());
      }

      template <class Archive>
      void serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &node &area_normal[0] & area_normal[1] & area_normal[2] & area;
      }
    };

    /// Those that this process owns; it has all their faces.
    std::vector<SurfaceNode> own_surface_nodes(const Model &model, const char *surface)
    {
      const auto     &ids = model.surface_ids(surface);
      const auto     &fe  = model.dof_handler().get_fe();
      FEFaceValues<3> values(model.mapping(), fe, QGauss<2>(model.degree() + 1), update_values | update_normal_vectors | update_JxW_values);
      std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
      std::map<unsigned int, SurfaceNode>  nodes;
      for (const auto &cell : model.dof_handler().active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          if (!cell->is_artificial() && cell->at_boundary(f) && ids.count(cell->face(f)->boundary_id()) > 0)
            {
              values.reinit(cell, f);
              cell->get_dof_indices(dofs);
              for (unsigned int i = 0; i < fe.n_dofs_per_cell(); ++i)
                if (fe.system_to_component_index(i).first == 0 && fe.has_support_on_face(i, f))
                  {
                    const unsigned int number = model.node_of_dof(dofs[i]);
                    SurfaceNode       &entry  = nodes[number];
                    entry.node                = model.nodes()[number];
                    for (unsigned int q = 0; q < values.n_quadrature_points; ++q)
                      {
                        entry.area += values.shape_value(i, q) * values.JxW(q);
                        entry.area_normal += values.JxW(q) * Eigen::Vector3d::Map(values.normal_vector(q).begin_raw());
                      }
                  }
            }
      std::vector<SurfaceNode> result;
      for (const auto &[number, entry] : nodes)
        if (entry.node.is_own)
          result.push_back(entry);
      return result;
    }

    /// Nodes of a named surface on every process, in the order of their numbers.
    std::vector<SurfaceNode> surface_nodes(const Model &model, const char *surface)
    {
      std::vector<SurfaceNode> result;
      for (const std::vector<SurfaceNode> &part : Utilities::MPI::all_gather(model.communicator(), own_surface_nodes(model, surface)))
        result.insert(result.end(), part.begin(), part.end());
      std::sort(result.begin(), result.end(), [](const SurfaceNode &a, const SurfaceNode &b) { return a.node.number < b.node.number; });
      return result;
    }

    std::string place(const Eigen::Vector3d &p)
    {
      return text("(", p[0], ", ", p[1], ", ", p[2], ") m");
    }

    /// n, t, b of a contact node; @p outermost is the largest distance of one from the axis [m].
    void set_frame(ContactNode &node, Eigen::Vector3d normal, const double outermost, const Rotation rotation)
    {
      normal *= 1. / normal.norm();
      for (double &cosine : normal)
        if (!(std::abs(cosine) > not_inclined))
          cosine = 0.;
      node.normal = (1. / normal.norm()) * normal;

      const double r = node.axis_distance();
      if (!(r > smallest_axis_distance * outermost))
        throw MeshError("a contact node lies on the disc's axis, where nothing slides", "surface disc_contact",
                        "move the pins away from the axis");
      const Eigen::Vector3d e_theta = Eigen::Vector3d(-node.position[1], node.position[0], 0.) / (rotation == Rotation::negative ? -r : r);
      const Eigen::Vector3d sliding = e_theta - e_theta.dot(node.normal) * node.normal;
      if (!(sliding.norm() > 1e-6))
        throw MeshError("the sliding direction is normal to the contact face", "contact node at " + place(node.position),
                        "contact faces must not be perpendicular to the circumferential direction");
      node.sliding = (1. / sliding.norm()) * sliding;
      node.radial  = node.normal.cross(node.sliding);
    }
  } // namespace

  ContactInterface pair_contact_nodes(const Model &model, const Rotation rotation, const double tolerance)
  {
    const auto disc_nodes = surface_nodes(model, PhysicalNames::disc_contact);
    const auto pin_nodes  = surface_nodes(model, PhysicalNames::pin_contact);

    // Disc nodes sorted by x: a partner is looked for among the neighbours only
    std::vector<std::pair<double, unsigned int>> sorted;
    double                                       outermost = 0.;
    for (unsigned int d = 0; d < disc_nodes.size(); ++d)
      {
        const Eigen::Vector3d p = disc_nodes[d].position();
        sorted.emplace_back(p[0], d);
        outermost = std::max(outermost, std::hypot(p[0], p[1]));
      }
    std::sort(sorted.begin(), sorted.end());

    // Partners
    ContactInterface            interface;
    std::map<unsigned int, int> partners;
    unsigned int                n_single = 0;
    std::string                 example; // of a node without one
    for (const SurfaceNode &pin_node : pin_nodes)
      {
        const Eigen::Vector3d p       = pin_node.position();
        unsigned int          nearest = 0;
        double                gap     = std::numeric_limits<double>::infinity();
        // Far partners are sought in a wider window so that the message can name the distance.
        const double window = std::max(tolerance, 1e-2);
        for (auto it = std::lower_bound(sorted.begin(), sorted.end(), std::make_pair(p[0] - window, 0u));
             it != sorted.end() && it->first <= p[0] + window; ++it)
          if (const double distance = (disc_nodes[it->second].position() - p).norm(); distance < gap)
            {
              gap     = distance;
              nearest = it->second;
            }
        if (gap > tolerance)
          {
            if (n_single++ == 0)
              example = place(p) + (std::isinf(gap) ? " no node of the disc is within 10 mm" :
                                                      text(" the nearest node of the disc is ", gap, " m away"));
            continue;
          }
        if (partners[nearest]++ > 0)
          throw MeshError("a node of the disc touches two pin nodes", "contact node at " + place(p),
                          "separate the pins, so that no two of them share a point of the disc");

        ContactNode node;
        node.disc_node = disc_nodes[nearest].node;
        node.pin_node  = pin_node.node;
        node.pin       = pin_node.node.component;
        node.position  = disc_nodes[nearest].position();
        node.area      = pin_node.area;
        set_frame(node, disc_nodes[nearest].area_normal, outermost, rotation);
        for (const Node *partner : {&node.disc_node, &node.pin_node})
          for (const int dof : partner->dofs)
            if (dof < 0)
              throw MeshError("a node of disc_contact and pin_contact is clamped by pin_clamp", "contact node at " + place(p),
                              "keep pin_clamp and the contact surfaces apart, with at least one layer of elements between them");
        interface.push_back(node);
      }

    // Nothing may be left over on either side
    const auto refuse = [](const std::string &what, const char *where) {
      throw MeshError(what, where, "mesh both contact faces from the same plan, or raise Geometry/Pairing tolerance");
    };
    if (n_single > 0)
      refuse(text(n_single, " of ", pin_nodes.size(), " nodes of pin_contact have no partner on disc_contact; e.g. at ", example),
             "pairing of contact nodes");
    if (interface.size() != disc_nodes.size())
      refuse(text(disc_nodes.size() - interface.size(), " of ", disc_nodes.size(), " nodes of disc_contact have no partner on pin_contact"),
             "pairing of contact nodes");
    if (interface.empty())
      refuse("disc and pins share no contact node", "surfaces disc_contact and pin_contact");
    return interface;
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
    std::vector<double> c_t;
    for (const double reaction : reactions)
      c_t.push_back(std::abs(reaction) * operation.friction_slope);
    return c_t;
  }
} // namespace Squeal
