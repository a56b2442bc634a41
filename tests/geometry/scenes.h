#pragma once

#include <squeal/base/exceptions.h>
#include <squeal/geometry/generate_mesh.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <unistd.h>

namespace Scenes
{
  using namespace Squeal;

  /// One pin on the upper face: small and quick.
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

  /// A file in a directory of its own that vanishes with the test.
  class File
  {
  public:
    explicit File(const std::string &name, const std::string &content = "")
    {
      std::string pattern = (std::filesystem::temp_directory_path() / "squeal-test-XXXXXX").string();
      directory           = ::mkdtemp(pattern.data());
      path                = directory / name;
      if (!content.empty())
        std::ofstream(path) << content;
    }
    ~File()
    {
      std::filesystem::remove_all(directory);
    }

    std::string string() const
    {
      return path.string();
    }

    std::filesystem::path directory, path;
  };

  inline unsigned int surface(const HexMesh &mesh, const std::string &name)
  {
    for (unsigned int s = 0; s < mesh.surface_names.size(); ++s)
      if (mesh.surface_names[s] == name)
        return s;
    ADD_FAILURE() << "no surface " << name;
    return -1;
  }

  inline std::set<unsigned int> nodes_on(const HexMesh &mesh, const std::string &name)
  {
    const unsigned int     s = surface(mesh, name);
    std::set<unsigned int> nodes;
    for (const HexMesh::Quadrilateral &quadrilateral : mesh.quadrilaterals)
      if (quadrilateral.surface == s)
        nodes.insert(quadrilateral.nodes.begin(), quadrilateral.nodes.end());
    return nodes;
  }

  /// Area of a surface whose faces are plane [m²].
  inline double area(const HexMesh &mesh, const std::string &name)
  {
    const unsigned int s   = surface(mesh, name);
    double             sum = 0.;
    for (const HexMesh::Quadrilateral &quadrilateral : mesh.quadrilaterals)
      if (quadrilateral.surface == s)
        sum += face_geometry(mesh, quadrilateral.nodes).area_normal.norm();
    return sum;
  }

  /// Volume of all cells of the volumes whose name begins so, of each by Gauss' theorem over its faces, which are plane [m³].
  inline double volume(const HexMesh &mesh, const std::string &prefix)
  {
    double sum = 0.;
    for (const HexFace &face : all_faces(mesh))
      if (mesh.volume_names[face.volume].rfind(prefix, 0) == 0)
        {
          const auto [centre, normal] = face_geometry(mesh, face.nodes);
          sum += centre * normal / 3.;
        }
    return sum;
  }

  /// Nodes of the contact faces on one side of the disc that lie on the outline of the pin at this place.
  inline unsigned int n_on_outline(const HexMesh &mesh, const double side, const double radius, const double angle, const double pin_radius)
  {
    const double x = radius * std::cos(angle * M_PI / 180.), y = radius * std::sin(angle * M_PI / 180.);
    unsigned int n = 0;
    for (const unsigned int node : nodes_on(mesh, "pin_contact"))
      if (const HexMesh::Point &p = mesh.points[node]; side * p[2] > 0.)
        n += std::abs(std::hypot(p[0] - x, p[1] - y) - pin_radius) < 1e-9;
    return n;
  }

  /// The text of the Exception that the action throws; fails if it throws none.
  template <typename Exception, typename Action>
  std::string message(const Action &action)
  {
    try
      {
        action();
      }
    catch (const Exception &exception)
      {
        return exception.what();
      }
    ADD_FAILURE() << "nothing was thrown";
    return "";
  }

  inline void expect_mentions(const std::string &text, const std::vector<std::string> &parts)
  {
    for (const std::string &part : parts)
      EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is missing in:\n" << text;
  }
} // namespace Scenes
