#include <squeal/geometry/geometry_usage.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <sstream>

namespace Squeal
{
  namespace
  {
    /// Parameters by which a plan becomes a solid.
    const std::array<const char *, 4> of_the_extrusion = {{"Disc thickness", "Pin height", "Disc layers", "Pin layers"}};

    /// The variable by which a script takes over a parameter: "Pin height" is pin_height.
    std::string variable_name(std::string name)
    {
      std::transform(name.begin(), name.end(), name.begin(), [](const unsigned char c) { return c == ' ' ? '_' : std::tolower(c); });
      return name;
    }

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

  GeometryUsage::GeometryUsage(const GeometryParameters &parameters)
  {
    const std::string file = parameters.path();
    if (is_script(file))
      script.emplace(file);
    is_plan = script ? !script->find({"Physical Volume"}) : !has_volumes(file);
  }

  bool GeometryUsage::uses(const std::string &name) const
  {
    const bool is_extruded = is_plan && std::find(of_the_extrusion.begin(), of_the_extrusion.end(), name) != of_the_extrusion.end();
    return is_extruded || (script && script->find({variable_name(name)}));
  }
} // namespace Squeal
