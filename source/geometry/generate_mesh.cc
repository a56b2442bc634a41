#include <squeal/base/exceptions.h>
#include <squeal/geometry/extrusion.h>
#include <squeal/geometry/generate_mesh.h>
#include <squeal/geometry/gmsh_session.h>
#include <squeal/geometry/mesh_check.h>
#include <squeal/geometry/mesh_file.h>
#include <squeal/geometry/plan.h>
#include <squeal/geometry/plan_smoothing.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

namespace Squeal
{
  namespace
  {
    namespace fs = std::filesystem;

    fs::path find_geometry(const std::string &name)
    {
      const fs::path given(name);
      if (fs::is_regular_file(given))
        return fs::absolute(given);
      const fs::path supplied = fs::path(SQUEAL_GEOMETRY_DIRECTORY) / given;
      if (!given.has_parent_path() && fs::is_regular_file(supplied))
        return supplied;
      throw MeshError("There is no geometry '" + name + "'",
                      given.has_parent_path() ?
                        fs::absolute(given).string() :
                        fs::current_path().string() + " and " + SQUEAL_GEOMETRY_DIRECTORY,
                      "set Geometry/File to an existing .geo or .msh");
    }

    /// A directory of its own that vanishes at the end.
    struct TemporaryDirectory
    {
      TemporaryDirectory()
      {
        std::string pattern = (fs::temp_directory_path() / "squeal-XXXXXX").string();
        if (::mkdtemp(pattern.data()) == nullptr)
          throw FileError("No temporary directory can be made", pattern, "set TMPDIR to a writable directory");
        path = pattern;
      }
      ~TemporaryDirectory()
      {
        std::error_code ignored;
        fs::remove_all(path, ignored);
      }
      TemporaryDirectory(const TemporaryDirectory &)            = delete;
      TemporaryDirectory &operator=(const TemporaryDirectory &) = delete;

      fs::path path;
    };

    /// A .geo that sets the parameters and includes the geometry, which keeps values that exist.
    void write_driver(const fs::path &driver, const fs::path &geometry, const GeometryParameters &parameters)
    {
      std::ofstream file(driver);
      file.precision(std::numeric_limits<double>::max_digits10);
      const auto scalar = [&](const char *name, const double value) { file << name << " = " << value << ";\n"; };
      const auto list   = [&](const char *name, const std::vector<double> &values) {
        file << name << "() = {";
        for (std::size_t i = 0; i < values.size(); ++i)
          file << (i > 0 ? ", " : "") << values[i];
        file << "};\n";
      };

      scalar("disc_inner_radius", parameters.disc_inner_radius);
      scalar("disc_outer_radius", parameters.disc_outer_radius);
      scalar("disc_thickness", parameters.disc_thickness);
      scalar("pin_diameter", parameters.pin_diameter);
      scalar("pin_height", parameters.pin_height);
      list("top_pin_radii", parameters.top.radii);
      list("top_pin_angles", parameters.top.angles);
      list("bottom_pin_radii", parameters.bottom.radii);
      list("bottom_pin_angles", parameters.bottom.angles);
      scalar("nodes_per_pin_face", parameters.nodes_per_pin_face);
      scalar("pin_layers", parameters.pin_layers);
      scalar("disc_layers", parameters.disc_layers);
      scalar("element_size", parameters.element_size);
      scalar("pairing_tolerance", parameters.pairing_tolerance);
      file << "Include \"" << geometry.string() << "\";\n";
      if (!file.flush())
        throw FileError("The values for Gmsh could not be written", driver.string(), "check space and permissions");
    }
  } // namespace

  HexMesh generate_mesh(const GeometryParameters &parameters, const std::vector<std::string> &additional_surfaces)
  {
    parameters.check();
    const fs::path    geometry = find_geometry(parameters.file);
    const std::string where    = geometry.string();

    // Open
    const TemporaryDirectory directory;
    GmshSession              gmsh;
    if (geometry.extension() == ".geo")
      {
        const fs::path driver = directory.path / "driver.geo";
        write_driver(driver, geometry, parameters);
        gmsh.open(driver.string(), where);
      }
    else
      gmsh.open(where, where);

    // Mesh: a solid as it is, a plan by extrusion
    HexMesh mesh;
    switch (gmsh.dimension())
      {
        case 3:
          if (!gmsh.is_meshed(3))
            gmsh.mesh_solid();
          mesh = make_hex_mesh(gmsh.mesh(), additional_surfaces, where);
          break;
        case 2:
          if (!gmsh.is_meshed(2))
            gmsh.mesh_plan();
          {
            Plan plan = make_plan(gmsh.mesh(), where);
            smooth(plan);
            mesh = extrude(plan, parameters);
            break;
          }
        default:
          throw MeshError("The geometry has neither physical volumes nor physical surfaces", where,
                          "name the volumes of a solid 'disc', 'pin_...', or the surface of a plan 'disc'");
      }

    // Check
    check_parts(mesh, additional_surfaces, where);
    check_mesh(mesh);
    return mesh;
  }
} // namespace Squeal
