#include <squeal/base/checksum.h>
#include <squeal/geometry/hex_mesh.h>

#include <cmath>

namespace Squeal
{
  std::uint64_t checksum(const HexMesh &mesh)
  {
    constexpr double nanometre = 1e-9;
    std::string      places;
    for (const HexMesh::Point &point : mesh.points)
      for (const double coordinate : point)
        places += std::to_string(std::llround(coordinate / nanometre)) + ' ';
    return checksum(std::string_view(places));
  }
} // namespace Squeal
