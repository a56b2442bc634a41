#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/mesh_family.h>
#include <squeal/parameters/pin_face.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    /// The number times the factor, rounded, at least one.
    unsigned int scaled(const double number, const double factor)
    {
      return std::max(1L, std::lround(number * factor));
    }
  } // namespace

  void check_follows(const GeometryParameters &geometry)
  {
    const auto used = geometry.used_variables();
    for (const auto &[variable, parameter] : {std::make_pair("element_size", "Element size"), std::make_pair("disc_layers", "Disc layers"),
                                              std::make_pair("pin_layers", "Pin layers")})
      if (used.count(variable) == 0)
        throw ParameterError(
          text("the mesh of Geometry/File = ", in_quotes(geometry.file), " cannot be refined: it does not follow Geometry/", parameter),
          "parameter Geometry/File",
          text("give a plan, which the program extrudes, or a script (.geo) that uses the variables element_size, "
               "disc_layers and pin_layers; or do without meshes of other widths"));
  }

  GeometryParameters refined(const GeometryParameters &geometry, const double factor)
  {
    if (factor == 1.)
      return geometry;
    check_follows(geometry);
    GeometryParameters result = geometry;
    result.element_size       = geometry.element_size / factor;
    result.disc_layers        = scaled(geometry.disc_layers, factor);
    result.pin_layers         = scaled(geometry.pin_layers, factor);
    if (geometry.pin_rings > 0)
      result.pin_rings = scaled(geometry.pin_rings, factor);
    result.pin_grading        = std::pow(geometry.pin_grading, 1. / factor);
    result.nodes_per_pin_face = nodes_of_pin_face(scaled(blocks_of_pin_face(geometry.nodes_per_pin_face), factor));
    return result;
  }
} // namespace Squeal
