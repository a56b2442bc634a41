// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/geometry/gmsh_mesh.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>

#include <sstream>
#include <stdexcept>

namespace Squeal
{
  int GmshMesh::dimension() const
  {
    return groups.empty() ? 0 : groups.back().dimension;
  }

  std::string to_bytes(const GmshMesh &mesh)
  {
    std::ostringstream stream;
    boost::archive::binary_oarchive(stream) << mesh;
    return stream.str();
  }

  GmshMesh from_bytes(const std::string &bytes)
  {
    std::istringstream stream(bytes);
    GmshMesh           mesh;
    try
      {
        boost::archive::binary_iarchive(stream) >> mesh;
      }
    catch (const boost::archive::archive_exception &)
      {
        throw std::length_error("the mesh is incomplete");
      }
    return mesh;
  }
} // namespace Squeal
