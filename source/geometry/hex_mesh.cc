#include <squeal/base/checksum.h>
#include <squeal/base/exceptions.h>
#include <squeal/geometry/hex_mesh.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  std::uint64_t checksum(const HexMesh &mesh)
  {
    double size = 0.;
    for (const HexMesh::Point &point : mesh.points)
      size = std::max(size, point.norm());
    // A power of ten, which rounding of the size does not change
    const double unit = 1e-8 * std::pow(10., std::floor(std::log10(size)));
    std::string  places;
    for (const HexMesh::Point &point : mesh.points)
      for (unsigned int d = 0; d < 3; ++d)
        places += std::to_string(std::llround(point[d] / unit)) + ' ';
    return checksum(std::string_view(places));
  }

  std::vector<unsigned int> volume_of_nodes(const HexMesh &mesh)
  {
    std::vector<unsigned int> volumes(mesh.points.size(), 0);
    for (const HexMesh::Hexahedron &hexahedron : mesh.hexahedra)
      for (const unsigned int node : hexahedron.nodes)
        volumes[node] = hexahedron.volume;
    return volumes;
  }

  unsigned int pin_number(const std::vector<std::string> &volume_names, const std::string &pin, const char *parameter)
  {
    const std::vector<std::string> pins(volume_names.begin() + 1, volume_names.end());
    const auto                     found = std::find(pins.begin(), pins.end(), pin);
    if (found == pins.end())
      throw ParameterError("there is no pin `" + pin + "`", std::string("parameter ") + parameter,
                           "name one of " + boost::algorithm::join(pins, ", "));
    return found - pins.begin() + 1;
  }
} // namespace Squeal
