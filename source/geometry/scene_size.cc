// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/memory.h>
#include <squeal/base/text.h>
#include <squeal/geometry/scene_size.h>
#include <squeal/parameters/geometry.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace Squeal
{
  namespace
  {
    // Constants of ProblemSize::memory(), fitted to measurements [byte]
    constexpr double program          = 1.8e8;
    constexpr double bytes_per_entry  = 90.;   ///< memory of all matrices per entry of K
    constexpr double factor_per_dof   = 3100.; ///< memory of the factor per dof at reference_dofs
    constexpr double reference_dofs   = 3e4;
    constexpr double factor_growth    = 0.4; ///< exponent of the growth of factor_per_dof with the number of dofs
    constexpr double vectors_per_node = 1., vectors_per_mode = 3.;

    /// ProblemSize::row_length for meshes of one cell shape.
    double row_length(const Shape shape, const unsigned int degree)
    {
      switch (shape)
        {
          case Shape::tetrahedron:
            return degree > 1 ? 75. : 40.;
          case Shape::pyramid:
            return degree > 1 ? 100. : 50.;
          case Shape::wedge:
            return degree > 1 ? 120. : 55.;
          default:
            return degree > 1 ? 160. : 65.;
        }
    }

    /// Size of an extruded plan from its numbers of faces and nodes, in total and under all pins.
    ProblemSize extruded(const double              faces,
                         const double              nodes,
                         const double              pin_faces,
                         const double              pin_nodes,
                         const GeometryParameters &parameters)
    {
      return {faces * parameters.disc_layers + pin_faces * parameters.pin_layers,
              3. * (nodes * (parameters.disc_layers + 1.) + pin_nodes * (parameters.pin_layers + 1.)), pin_nodes};
    }
  } // namespace

  double ProblemSize::memory(const double n_modes) const
  {
    const double matrices = row_length * bytes_per_entry + factor_per_dof * std::pow(dofs / reference_dofs, factor_growth);
    const double kept     = dofs * sizeof(double) * vectors_per_node * contact_nodes;
    const double of_nodes = kept <= largest_part_of_attachment_modes * available_memory() ? kept : 0.;
    return program + of_nodes + dofs * (matrices + sizeof(double) * vectors_per_mode * n_modes);
  }

  ProblemSize expected_size(const GeometryParameters &parameters)
  {
    const auto   squared    = [](const double x) { return x * x; };
    const double annulus    = dealii::numbers::PI * (squared(parameters.disc_outer_radius) - squared(parameters.disc_inner_radius));
    const double plan_nodes = annulus / squared(parameters.element_size);
    const double pin_face   = parameters.nodes_per_pin_face + parameters.pin_rings * 6. * blocks_of_pin_face(parameters.nodes_per_pin_face);
    const double pin_nodes  = pin_face * double(parameters.top.radii.size() + parameters.bottom.radii.size());
    return extruded(plan_nodes, plan_nodes, pin_nodes, pin_nodes, parameters);
  }

  ProblemSize expected_size(const Plan &plan, const GeometryParameters &parameters)
  {
    double pin_faces = 0., pin_nodes = 0.;
    for (const Plan::Pin &pin : plan.pins)
      {
        pin_faces += pin.faces.size();
        pin_nodes += nodes_of(plan.faces_of(pin)).size();
      }
    return extruded(plan.faces.size(), plan.points.size(), pin_faces, pin_nodes, parameters);
  }

  namespace
  {
    /// Number of nodes added in degree 2: at middles of edges, at centres of quadrilaterals and hexahedra.
    template <typename Elements>
    std::size_t n_added_nodes(const Elements &elements)
    {
      using Part = std::array<unsigned int, 4>; // nodes of an edge, or corners of a face
      std::vector<Part> parts;
      std::size_t       n_inside = 0;
      for (const auto &element : elements)
        {
          const auto add = [&, &nodes = element.nodes](const auto &corners) {
            Part part;
            for (unsigned int i = 0; i < 4; ++i)
              part[i] = nodes[corners[std::min<std::size_t>(i, corners.size() - 1)]];
            std::sort(part.begin(), part.begin() + corners.size());
            std::fill(part.begin() + corners.size(), part.end(), part[corners.size() - 1]);
            parts.push_back(part);
          };
          for (const auto &edge : topology(element.shape).edges)
            add(edge);
          for (const auto &face : topology(element.shape).faces)
            if (face.size() == 4)
              add(face);
          n_inside += element.shape == Shape::hexahedron;
        }
      std::sort(parts.begin(), parts.end());
      return std::unique(parts.begin(), parts.end()) - parts.begin() + n_inside;
    }
  } // namespace

  ProblemSize expected_size(const Mesh &mesh, const unsigned int degree)
  {
    std::set<unsigned int>  contact;
    std::vector<Mesh::Face> contact_faces;
    for (const Mesh::Face &face : mesh.faces)
      if (mesh.surface_names[face.surface] == PhysicalNames::pin_contact)
        {
          contact.insert(face.nodes.begin(), face.nodes.end());
          contact_faces.push_back(face);
        }
    double row_lengths = 0.;
    for (const Mesh::Cell &cell : mesh.cells)
      row_lengths += row_length(cell.shape, degree);
    const bool adds_nodes = degree > mesh.degree;
    return {double(mesh.cells.size()), 3. * (mesh.points.size() + (adds_nodes ? n_added_nodes(mesh.cells) : 0)),
            double(contact.size() + (adds_nodes ? n_added_nodes(contact_faces) : 0)), row_lengths / mesh.cells.size()};
  }

  void check_memory(const ProblemSize &size, const double n_modes, const std::string &where, const MPI_Comm communicator)
  {
    const double needed = size.memory(n_modes), available = available_memory(communicator);
    if (!(needed > available))
      return;
    throw MeshError(
      text("The model has about ", size.cells, " cells and ", size.dofs, " dofs, which need about ", needed / 1e9, " GB of memory; ",
           available / 1e9, " GB are available"),
      where,
      "use a coarser mesh (raise Geometry/Element size; lower Geometry/Disc layers, Geometry/Pin layers or Geometry/Nodes per "
      "pin face); a lower Band/Maximum frequency reduces the memory of the modes");
  }

  namespace
  {
    /// Area fraction of the disc's faces that a rotation about an axis maps onto themselves, n·(a × (x − c)) ≈ 0: the smaller of the
    /// fractions for lateral faces, which determine the position of the axis, and for other faces, which determine its direction.
    double round_share(const Mesh &mesh, const std::vector<CellFace> &faces, const Mesh::Point &c, const dealii::Tensor<1, 3> &a)
    {
      constexpr double largest_lateral_cosine = 0.5, fitting_motion = 5e-3;
      double           all[2] = {0., 0.}, fitting[2] = {0., 0.};
      for (const CellFace &face : faces)
        {
          const auto [centre, normal]           = face_geometry(mesh, face);
          const dealii::Tensor<1, 3> motion     = cross_product_3d(a, centre - c);
          const double               area       = normal.norm();
          const bool                 is_lateral = std::abs(normal * a) < largest_lateral_cosine * area;
          all[is_lateral] += area;
          double least = std::numeric_limits<double>::infinity(), most = -least; // normal motion at the corners
          for (unsigned int v = 0; v < face.n_corners; ++v)
            {
              const double value = normal * cross_product_3d(a, mesh.points[face.corners[v]] - c);
              least              = std::min(least, value);
              most               = std::max(most, value);
            }
          // A chord is parallel to its circle only at its midpoint, which need not be the centre of a triangle: use the mean of the
          // extremes
          if (std::abs(least + most) / 2. < fitting_motion * area * motion.norm())
            fitting[is_lateral] += area;
        }
      return std::min(all[0] > 0. ? fitting[0] / all[0] : 0., all[1] > 0. ? fitting[1] / all[1] : 0.);
    }
  } // namespace

  bool is_round_about_z(const Mesh &mesh, const std::string &where)
  {
    constexpr double clearly_rounder = 0.1, least_round = 0.5;          // fractions of the surface
    constexpr double negligible_angle = 5e-3, negligible_offset = 5e-3; // angle [rad], offset relative to the outer radius [-]

    // Second moments of each face, exact for triangles and parallelograms: each corner has the weight 1/12, the centre has the remainder
    std::vector<CellFace> faces = outer_faces(mesh);
    faces.erase(std::remove_if(faces.begin(), faces.end(), [](const CellFace &face) { return face.body != 0; }), faces.end());
    double          area = 0., radius = 0.;
    Eigen::Vector3d centre  = Eigen::Vector3d::Zero();
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    const auto      add     = [&](const Mesh::Point &p, const double weight) {
      const Eigen::Vector3d x = Eigen::Vector3d::Map(p.begin_raw());
      centre += weight * x;
      moments += weight * x * x.transpose();
      area += weight;
      radius = std::max(radius, std::hypot(p[0], p[1]));
    };
    for (const CellFace &face : faces)
      {
        const auto [middle, normal] = face_geometry(mesh, face);
        add(middle, (1. - face.n_corners / 12.) * normal.norm());
        for (unsigned int v = 0; v < face.n_corners; ++v)
          add(mesh.points[face.corners[v]], normal.norm() / 12.);
      }
    centre /= area;

    // The axis of a body of revolution is the eigenvector of the eigenvalue that differs from the other two
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moments / area - centre * centre.transpose());
    const Eigen::Vector3d                                s    = axes.eigenvalues(); // ascending
    Eigen::Vector3d                                      axis = axes.eigenvectors().col(s[1] - s[0] < s[2] - s[1] ? 2 : 0);
    axis *= axis[2] < 0. ? -1. : 1.;
    const double about_z = round_share(mesh, faces, Mesh::Point(), dealii::Tensor<1, 3>({0., 0., 1.}));
    const double about_axis =
      round_share(mesh, faces, Mesh::Point(centre[0], centre[1], centre[2]), dealii::Tensor<1, 3>({axis[0], axis[1], axis[2]}));
    const double angle = std::atan2(std::hypot(axis[0], axis[1]), axis[2]), offset = std::hypot(centre[0], centre[1]);
    if ((angle > negligible_angle || offset > negligible_offset * radius) && about_axis > about_z + clearly_rounder)
      {
        const auto print = [](const Eigen::Vector3d &x, const double unit) {
          const auto rounded = [unit](const double value) { return std::round(value / unit) * unit + 0.; };
          return text("(", rounded(x[0]), ", ", rounded(x[1]), ", ", rounded(x[2]), ")");
        };
        throw MeshError(
          "The disc rotates about the z axis, but its axis of revolution passes through " +
            print(centre, std::pow(10., std::floor(std::log10(1e-3 * radius)))) + " m in direction " + print(axis, 1e-3),
          where, "move and rotate all volumes so that the axis of the disc is the z axis, for example with Translate and Rotate in Gmsh");
      }
    return about_z >= least_round;
  }

  void check_wave_resolution(const Mesh               &mesh,
                             const MaterialParameters &materials,
                             const unsigned int        degree,
                             const double              largest_circular_frequency)
  {
    std::vector<double> longest_edges(mesh.volume_names.size(), 0.);
    for (const Mesh::Cell &cell : mesh.cells)
      for (const auto &[a, b] : topology(cell.shape).edges)
        longest_edges[cell.volume] = std::max(longest_edges[cell.volume], mesh.corner(cell, a).distance(mesh.corner(cell, b)));
    for (unsigned int volume = 0; volume < mesh.volume_names.size(); ++volume)
      {
        const std::string &name      = mesh.volume_names[volume];
        const Material     material  = materials.of(name);
        const double       frequency = hertz(largest_circular_frequency), edge = longest_edges[volume];
        const double       wave = std::sqrt(material.least_wave_modulus() / material.density) / frequency;
        if (wave * degree >= edge)
          continue;
        throw ParameterError(text(material.orthotropy ? "the slowest waves of " : "shear waves of ", frequency, " Hz are ", wave,
                                  " m long in ", name, ", whose elements measure up to ", edge,
                                  " m: the mesh does not resolve the modes of the band"),
                             "parameter Band/Maximum frequency",
                             text("lower this parameter below ", wave * degree / edge * frequency,
                                  " Hz, choose smaller elements, or correct the modulus and density in ", materials.section_of(name)));
      }
  }
} // namespace Squeal
