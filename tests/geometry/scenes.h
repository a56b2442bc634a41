// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include "../input.h"

#include <squeal/base/exceptions.h>
#include <squeal/geometry/generate_mesh.h>

#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace Scenes
{
  using namespace Squeal;
  using Testing::expect_mentions;
  using Testing::File;
  using Testing::message;

  /// A small model with one pin on the upper face.
  inline GeometryParameters one_pin()
  {
    GeometryParameters parameters;
    parameters.top          = {{0.23}, {30.}};
    parameters.bottom       = {};
    parameters.element_size = 0.02;
    parameters.pin_layers   = 2;
    parameters.disc_layers  = 2;
    return parameters;
  }

  using Place = std::function<Mesh::Point(const Mesh::Point &)>;

  inline Mesh moved(Mesh mesh, const Place &motion)
  {
    for (Mesh::Point &point : mesh.points)
      point = motion(point);
    return mesh;
  }

  /// Parameters of a user-defined geometry.
  inline GeometryParameters of_file(const std::string &file)
  {
    GeometryParameters parameters;
    parameters.file = file;
    return parameters;
  }

  /// Script of two stacked blocks of 8 hexahedra each; @p names: lines that name volumes and surfaces.
  inline std::string blocks(const std::string &names, const std::string &before_names = "")
  {
    return R"(
      SetFactory("OpenCASCADE");
      Box(1) = {0, 0, 0, 1, 1, 0.5};
      Box(2) = {0, 0, 0.5, 1, 1, 0.25};
    )" + before_names +
           "Transfinite Curve{:} = 3; Transfinite Surface{:}; Recombine Surface{:}; Transfinite Volume{:};\n" + names;
  }

  const std::string volumes  = "Physical Volume(\"disc\") = {1}; Physical Volume(\"pin_1\") = {2};\n";
  const std::string surfaces = "Physical Surface(\"disc_contact\") = {6}; Physical Surface(\"pin_contact\") = {11}; "
                               "Physical Surface(\"pin_clamp\") = {12};\n";

  inline unsigned int surface(const Mesh &mesh, const std::string &name)
  {
    for (unsigned int s = 0; s < mesh.surface_names.size(); ++s)
      if (mesh.surface_names[s] == name)
        return s;
    ADD_FAILURE() << "no surface " << name;
    return -1;
  }

  inline std::set<unsigned int> nodes_on(const Mesh &mesh, const std::string &name)
  {
    const unsigned int     s = surface(mesh, name);
    std::set<unsigned int> nodes;
    for (const Mesh::Face &face : mesh.faces)
      if (face.surface == s)
        nodes.insert(face.nodes.begin(), face.nodes.end());
    return nodes;
  }

  /// Area of a surface with plane faces [m²].
  inline double area(const Mesh &mesh, const std::string &name)
  {
    const unsigned int s   = surface(mesh, name);
    double             sum = 0.;
    for (const Mesh::Face &face : mesh.faces)
      if (face.surface == s)
        sum += face_geometry(mesh, face).area_normal.norm();
    return sum;
  }

  /// Volume of the bodies whose names begin with @p prefix, by the divergence theorem for cells with plane faces [m³].
  inline double volume(const Mesh &mesh, const std::string &prefix)
  {
    double sum = 0.;
    for (const CellFace &face : all_faces(mesh))
      if (mesh.body_names[face.body].rfind(prefix, 0) == 0)
        {
          const auto [centre, normal] = face_geometry(mesh, face);
          sum += centre * normal / 3.;
        }
    return sum;
  }

  /// Number of contact nodes on one side of the disc that lie on the outline of the pin at this position.
  inline unsigned int n_on_outline(const Mesh &mesh, const double side, const double radius, const double angle, const double pin_radius)
  {
    const double x = radius * std::cos(angle * M_PI / 180.), y = radius * std::sin(angle * M_PI / 180.);
    unsigned int n = 0;
    for (const unsigned int node : nodes_on(mesh, "pin_contact"))
      if (const Mesh::Point &p = mesh.points[node]; side * p[2] > 0.)
        n += std::abs(std::hypot(p[0] - x, p[1] - y) - pin_radius) < 1e-9;
    return n;
  }
} // namespace Scenes
