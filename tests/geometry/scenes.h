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

  /// Area of a surface whose faces are plane and convex [m²].
  inline double area(const HexMesh &mesh, const std::string &name)
  {
    const unsigned int s   = surface(mesh, name);
    double             sum = 0.;
    for (const HexMesh::Quadrilateral &quadrilateral : mesh.quadrilaterals)
      if (quadrilateral.surface == s)
        {
          const auto &p = quadrilateral.nodes;
          double      a[3], b[3];
          for (unsigned int d = 0; d < 3; ++d)
            {
              a[d] = mesh.points[p[2]][d] - mesh.points[p[0]][d];
              b[d] = mesh.points[p[3]][d] - mesh.points[p[1]][d];
            }
          sum += 0.5 * std::sqrt(std::pow(a[1] * b[2] - a[2] * b[1], 2) + std::pow(a[2] * b[0] - a[0] * b[2], 2) +
                                 std::pow(a[0] * b[1] - a[1] * b[0], 2));
        }
    return sum;
  }

  /// Volume of all hexahedra of the volumes whose name begins so, by 2 x 2 x 2 Gauss points [m³].
  inline double volume(const HexMesh &mesh, const std::string &prefix)
  {
    constexpr double corner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
    double           sum          = 0.;
    for (const HexMesh::Hexahedron &hexahedron : mesh.hexahedra)
      if (mesh.volume_names[hexahedron.volume].rfind(prefix, 0) == 0)
        for (const auto &gauss : corner)
          {
            double x[3], J[3][3] = {};
            for (unsigned int d = 0; d < 3; ++d)
              x[d] = gauss[d] / std::sqrt(3.);
            for (unsigned int v = 0; v < 8; ++v)
              for (unsigned int d = 0; d < 3; ++d)
                {
                  double gradient = corner[v][d] / 8.;
                  for (unsigned int e = 0; e < 3; ++e)
                    if (e != d)
                      gradient *= 1. + corner[v][e] * x[e];
                  for (unsigned int i = 0; i < 3; ++i)
                    J[i][d] += mesh.points[hexahedron.nodes[v]][i] * gradient;
                }
            sum += J[0][0] * (J[1][1] * J[2][2] - J[1][2] * J[2][1]) - J[0][1] * (J[1][0] * J[2][2] - J[1][2] * J[2][0]) +
                   J[0][2] * (J[1][0] * J[2][1] - J[1][1] * J[2][0]);
          }
    return sum;
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
