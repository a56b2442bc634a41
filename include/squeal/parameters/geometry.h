// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/parameters/declarations.h>
#include <squeal/parameters/geometry_file.h>

#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace Squeal
{
  /// Polygons of straight edges that stand for circles.
  enum class Outlines
  {
    inscribed, ///< nodes on the circle
    true_area  ///< nodes moved outwards until area and moments of area are the circle's
  };

  template <>
  inline constexpr EnumName<Outlines> enum_table<Outlines>[] = {{Outlines::inscribed, "inscribed"}, {Outlines::true_area, "true area"}};

  /// Where the pins of one side of the disc are.
  struct PinLayout
  {
    std::vector<double> radii;  ///< distance of each pin's axis from the disc's [m]
    std::vector<double> angles; ///< angle of each pin's axis [degree]
  };

  /// Shape and mesh of disc and pins (section `Geometry`).
  struct GeometryParameters
  {
    std::string  file                 = "disc_pins.geo"; ///< plan (.geo) or mesh (.geo, .msh)
    double       disc_inner_radius    = 0.1505;          ///< [m]
    double       disc_outer_radius    = 0.3155;          ///< [m]
    double       disc_thickness       = 0.0463;          ///< [m]
    double       pin_diameter         = 0.0520;          ///< [m]
    double       pin_height           = 0.0318;          ///< [m]
    PinLayout    top                  = {{0.1970, 0.1970, 0.1970, 0.2585, 0.2585, 0.2585}, {-18.4, 0., 18.4, -18.4, 0., 18.4}};
    PinLayout    bottom               = {{0.1970, 0.1970, 0.1970, 0.2585, 0.2585, 0.2585}, {-18.4, 0., 18.4, -18.4, 0., 18.4}};
    unsigned int nodes_per_pin_face   = 19;
    unsigned int pin_layers           = 4;
    unsigned int disc_layers          = 3;
    double       element_size         = 0.0115; ///< in the plane of the disc [m]
    Outlines     outlines             = Outlines::inscribed;
    unsigned int pin_rings            = 0;     ///< of elements along the outline of every pin
    double       pin_grading          = 1.;    ///< sizes of neighbouring layers and rings, towards the edge of the held end [-]
    double       pairing_tolerance    = 1e-6;  ///< distance of the two nodes of a contact pair [m]
    bool         allow_shell_commands = false; ///< whether a geometry may run programs and write files
    double       meshing_time_limit   = 600.;  ///< [s]
    double       meshing_memory_limit = 8.;    ///< [GB]

    /// A number of the user's own script, and the value it is given, if any.
    struct Variable
    {
      GeometryVariable      declaration;
      std::optional<double> value;
    };

    std::string           directory; ///< where the parameter file is; a relative file is looked for there first
    std::vector<Variable> variables; ///< of the script, those that parameters above set left out

    /// Takes over file and directory, and the variables of the file where it is a script that exists.
    void set_file(const std::string &name, const std::string &parameter_directory);

    /// Variables by which a script takes over these parameters, with their values as a script writes them.
    std::map<std::string, std::string> script_variables() const;

    /// Which of script_variables() matter to the geometry: a script of Gmsh names those that it uses, a plan is extruded by those of
    /// thickness, height and layers, and contact nodes are paired in every mesh. Reads the file, without running it. Throws MeshError if
    /// there is none.
    std::set<std::string> used_variables() const;

    /// Whether the file is a plan that is extruded, not a solid. Reads the file. Throws MeshError if there is none.
    bool is_plan() const;

    /// Path of the file. Throws MeshError if there is none.
    std::string path() const;

    void declare(Declarations &declarations);

    /// Throws ParameterError where values or their combination make no sense.
    void check() const;
  };

  /// Nodes of the face of a pin that is filled by three blocks of k × k elements: 3 k (k + 1) + 1.
  inline unsigned int nodes_of_pin_face(const unsigned int k)
  {
    return 3 * k * (k + 1) + 1;
  }

  /// The number k of elements on the edge of a block of a pin face with that many nodes, not rounded.
  inline double blocks_of_pin_face(const double nodes)
  {
    return (std::sqrt(12. * nodes - 3.) - 3.) / 6.;
  }

  /// Throws ParameterError for a geometry whose mesh does not follow the element size and the numbers of layers, and MeshError if there is no such file.
  void check_follows(const GeometryParameters &geometry);

  /**
   * The geometry with a mesh @p factor times as fine in every direction: elements of the size divided by it, layers times
   * it, and pin faces of as many blocks, k × k elements each with 3 k (k + 1) + 1 nodes, and of as many rings; numbers are rounded, and one at
   * least. Neighbouring graded layers and rings become as much more alike. A factor of 1 changes nothing.
   *
   * Throws as check_follows().
   */
  GeometryParameters refined(const GeometryParameters &geometry, double factor);
} // namespace Squeal
