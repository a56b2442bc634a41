#include <squeal/geometry/geometry_usage.h>

#include <fstream>
#include <optional>
#include <sstream>

namespace Squeal
{
  namespace
  {
    /// Whether a Gmsh mesh has physical volumes; their names are text in binary files, too.
    bool has_volumes(const std::string &mesh)
    {
      std::ifstream stream(mesh, std::ios::binary);
      std::string   line;
      while (std::getline(stream, line) && line.rfind("$PhysicalNames", 0) != 0)
        ;
      std::getline(stream, line); // their number
      while (std::getline(stream, line) && line.rfind("$End", 0) != 0)
        if (int dimension; std::istringstream(line) >> dimension && dimension == 3)
          return true;
      return false;
    }
  } // namespace

  std::set<std::string> used_variables(const GeometryParameters &parameters)
  {
    const std::string             file = parameters.path();
    std::optional<GeometryScript> script;
    if (is_script(file))
      script.emplace(file);
    std::set<std::string> used = {"pairing_tolerance"};
    if (script ? !script->find({"Physical Volume"}) : !has_volumes(file))
      used.insert({"disc_thickness", "pin_height", "disc_layers", "pin_layers"});
    for (const auto &[name, value] : parameters.script_variables())
      if (script && script->find({name}))
        used.insert(name);
    return used;
  }
} // namespace Squeal
