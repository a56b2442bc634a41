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
  /// Approximation of circles by polygons.
  enum class Outlines
  {
    inscribed, ///< nodes on the circle
    true_area  ///< nodes moved outwards so that the area is the same as for the circle
  };

  template <>
  inline constexpr EnumName<Outlines> enum_table<Outlines>[] = {{Outlines::inscribed, "inscribed"}, {Outlines::true_area, "true area"}};

  /// Positions of the pins on one side of the disc.
  struct PinLayout
  {
    std::vector<double> radii;  ///< distance of each pin axis from the disc axis [m]
    std::vector<double> angles; ///< angle of each pin axis [degree]
  };

  /// Shape and mesh of disc and pins (section `Geometry`).
  struct GeometryParameters
  {
    std::string  file                 = "disc_pins.geo"; ///< plan to be extruded or solid model (.geo, .msh)
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
    double       element_size         = 0.0115; ///< element size in the plane of the disc [m]
    Outlines     outlines             = Outlines::inscribed;
    unsigned int pin_rings            = 0;  ///< rings of elements along the outline of each pin
    double       pin_grading          = 1.; ///< size ratio of neighbouring layers and rings, finer towards the edge of the clamped end [-]
    double       pairing_tolerance    = 1e-6;  ///< largest distance between the two nodes of a contact pair [m]
    bool         allow_shell_commands = false; ///< allow a geometry to run programs and write files
    double       meshing_time_limit   = 600.;  ///< [s]
    double       meshing_memory_limit = 8.;    ///< [GB]

    /// A numeric variable of a custom script, with its value from the parameter file, if given.
    struct Variable
    {
      GeometryVariable      declaration;
      std::optional<double> value;
    };

    std::string           directory; ///< folder of the parameter file, searched first for relative file names
    std::vector<Variable> variables; ///< variables of the script, except those set by the parameters above

    /// Sets file and directory, and the variables of the file if it is an existing script.
    void set_file(const std::string &name, const std::string &parameter_directory);

    /// Script variables that these parameters define, with their values as strings.
    std::map<std::string, std::string> script_variables() const;

    /// Names of the script_variables() that affect the geometry: names that occur in a Gmsh script, the dimensions, layers, rings and
    /// grading of an extruded plan, and the pairing tolerance. Reads the file without running it. Throws MeshError if it does not exist.
    std::set<std::string> used_variables() const;

    /// True if the file is a plan to be extruded, not a solid. Reads the file. Throws MeshError if it does not exist.
    bool is_plan() const;

    /// Path of the file. Throws MeshError if it does not exist.
    std::string path() const;

    void declare(Declarations &declarations);

    /// Throws ParameterError.
    void check() const;
  };

  /// Number of nodes of a pin face that is filled with three blocks of k × k elements: 3 k (k + 1) + 1.
  inline unsigned int nodes_of_pin_face(const unsigned int k)
  {
    return 3 * k * (k + 1) + 1;
  }

  /// Number k of elements along a block edge of a pin face with the given number of nodes, not rounded.
  inline double blocks_of_pin_face(const double nodes)
  {
    return (std::sqrt(12. * nodes - 3.) - 3.) / 6.;
  }

  /// Throws ParameterError unless the mesh of the geometry depends on the element size and the numbers of layers, and MeshError if the file
  /// does not exist.
  void check_follows(const GeometryParameters &geometry);

  /**
   * Geometry with a mesh refined by @p factor in every direction: the element size is divided by the factor, and the numbers of layers,
   * rings and elements k of the pin-face blocks (3 k (k + 1) + 1 nodes) are multiplied by the factor and rounded. Positive numbers remain
   * at least one. Grading ratios of layers and rings are adapted. Unchanged for a factor of 1.
   *
   * Throws the errors of check_follows().
   */
  GeometryParameters refined(const GeometryParameters &geometry, double factor);
} // namespace Squeal
