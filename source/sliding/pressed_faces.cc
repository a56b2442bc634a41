// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/contact/travel.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/model/element_values.h>
#include <squeal/sliding/pressed_faces.h>

#include <algorithm>
#include <set>

namespace Squeal
{
  namespace
  {
    /// A face has no direction of pressure if |∫ n dA| relative to its area is below this limit [-].
    constexpr double least_resultant = 0.1;

    Eigen::Vector3d as_vector(const dealii::Tensor<1, 3> &v)
    {
      return {v[0], v[1], v[2]};
    }

    /// Properties of a pressed face, identical on every process.
    struct PressedFace
    {
      Eigen::Matrix3Xd area_normals;    ///< ∫ n dA of each component [m²]
      double           area       = 0.; ///< [m²]
      double           of_disc    = 0.; ///< number of element faces of the disc
      double           in_contact = 0.; ///< number of element faces with contact nodes only
      double           clamped    = 0.; ///< number of element faces with clamped nodes
    };

    PressedFace pressed_face(const Model &model, const std::string &name, const std::set<std::int64_t> &contact_nodes)
    {
      PressedFace result;
      result.area_normals = Eigen::Matrix3Xd::Zero(3, model.component_names().size());
      ElementValues values(model);
      for (const Face *face : model.faces_of(name))
        if (face->is_own)
          {
            const auto &nodes = face->nodes;
            result.of_disc += face->component == 0;
            result.in_contact += std::all_of(nodes.begin(), nodes.end(),
                                             [&](const unsigned int node) { return contact_nodes.count(model.nodes()[node].number) > 0; });
            result.clamped +=
              std::any_of(nodes.begin(), nodes.end(), [&](const unsigned int node) { return model.nodes()[node].is_clamped(); });
            values.reinit(*face);
            for (unsigned int q = 0; q < values.n_points(); ++q)
              {
                result.area += values.JxW(q);
                result.area_normals.col(face->component) += values.JxW(q) * as_vector(values.normal(q));
              }
          }
      sum_over_processes(model.communicator(), result.area_normals.data(), result.area_normals.size());
      for (double *sum : {&result.area, &result.of_disc, &result.in_contact, &result.clamped})
        sum_over_processes(model.communicator(), sum, 1);
      return result;
    }

    void check_pressed(const Model &model, const std::string &name, const PressedFace &face, const std::vector<Travel> &directions)
    {
      const auto refuse = [&](const std::string &what, const std::string &change) {
        throw ParameterError(what, "parameter Steady sliding/Pressed faces, surface " + name, change);
      };
      if (face.of_disc > 0.)
        refuse("the pressed face includes faces of the disc", "use faces of the bodies that are pressed against the disc");
      if (face.in_contact > 0.)
        refuse("the pressed face includes faces in contact with the disc", "use the back of the body");
      if (face.clamped > 0.)
        refuse("the pressed face has clamped nodes, and the clamp would carry the load",
               "instead of pin_clamp, use Mounts/Elastic mounts without stiffness in the direction of the load");
      if (!(face.area_normals.rowwise().sum().norm() > least_resultant * face.area))
        refuse("the pressed face surrounds its body: a pressure on it has almost no resultant", "use a face on one side of the body");
      for (std::size_t body = 0; body < directions.size(); ++body)
        if (face.area_normals.col(body).dot(directions[body].direction) > 0.)
          refuse("a pressure on the face pushes " + model.component_names()[body] + " away from the disc", "use the back of the body");
    }
  } // namespace

  MultiVector pressing_forces(const Model             &model,
                              const ContactInterface  &interface,
                              const SlidingParameters &parameters,
                              const double             load_per_side)
  {
    std::set<std::int64_t> contact_nodes;
    for (const ContactNode &node : interface)
      for (const auto &[partner, weight] : node.on_pin)
        contact_nodes.insert(partner.number);
    const std::vector<Travel> directions = travels(model, interface);
    MultiVector               forces(model.free_map(), 1);
    ElementValues             values(model);
    for (const std::string &name : parameters.pressed_faces)
      {
        const PressedFace whole = pressed_face(model, name, contact_nodes);
        check_pressed(model, name, whole, directions);
        const double pressure = load_per_side / whole.area_normals.rowwise().sum().norm();
        // Include faces of other processes, because each process adds only to its own rows
        for (const Face *face : model.faces_of(name))
          {
            values.reinit(*face);
            for (unsigned int i = 0; i < values.n_nodes(); ++i)
              for (unsigned int q = 0; q < values.n_points(); ++q)
                for (unsigned int k = 0; k < 3; ++k)
                  model.nodes()[face->nodes[i]].for_each_dof(k, [&](const int dof, const double weight) {
                    if (const int row = forces.map().place(dof); row >= 0)
                      forces(row, 0) -= weight * pressure * values.JxW(q) * values.normal(q)[k] * values.value(i, q);
                  });
          }
      }
    return forces;
  }
} // namespace Squeal
