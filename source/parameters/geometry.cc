// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/geometry.h>
#include <squeal/parameters/number_list.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <type_traits>

namespace Squeal
{
  namespace
  {
    [[noreturn]] void refuse(const std::string &what, const std::string &name, const std::string &change)
    {
      throw ParameterError(what, "Geometry/" + name, change);
    }

    /// Minimum memory limit, more than twice the memory that Gmsh needs before meshing [GB].
    constexpr double least_memory_limit = 1.;

    void check_format(const std::string &file)
    {
      const std::string format = std::filesystem::path(file).extension().string();
      if (!is_script(file) && format != ".msh")
        refuse("the format of Geometry/File = " + legible(file) +
                 (format.empty() ? " is unknown" : ", " + legible(format) + ", is not supported"),
               "File", "give a Gmsh geometry (.geo) or a Gmsh mesh (.msh) with named parts; Gmsh converts other mesh formats to .msh");
    }

    void check_positive(const double value, const std::string &name)
    {
      if (!(value > 0.) || !std::isfinite(value))
        refuse(text("Geometry/", name, " is ", exact_text(value), ", but must be positive"), name, "set a positive value");
    }

    void check_nodes_per_pin_face(const unsigned int nodes_per_pin_face)
    {
      const unsigned int k     = std::max(1., std::floor(blocks_of_pin_face(nodes_per_pin_face) + 1e-9));
      const unsigned int below = nodes_of_pin_face(k), above = nodes_of_pin_face(k + 1);
      if (nodes_per_pin_face == below)
        return;
      const bool is_below_nearest = nodes_per_pin_face < below || nodes_per_pin_face - below <= above - nodes_per_pin_face;
      refuse(text("Geometry/Nodes per pin face is ", nodes_per_pin_face,
                  ", but three blocks of k x k elements give 3 k (k + 1) + 1 nodes: 7, 19, 37, 61, ..."),
             "Nodes per pin face", text("set it to the nearest allowed value, ", is_below_nearest ? below : above));
    }

    /// Checks the pin positions of one side; @p side is "Top" or "Bottom".
    void check_layout(const PinLayout &layout, const std::string &side, const GeometryParameters &parameters)
    {
      const std::string radii_name = side + " pin radii", angles_name = side + " pin angles";
      const double      pin_radius = parameters.pin_diameter / 2.;

      for (std::size_t i = 0; i < layout.radii.size(); ++i)
        {
          const double inside  = parameters.disc_inner_radius - (layout.radii[i] - pin_radius);
          const double outside = layout.radii[i] + pin_radius - parameters.disc_outer_radius;
          if (inside >= 0. || outside >= 0.)
            refuse(text("Geometry/", radii_name, ": pin ", i + 1, ", at radius ", exact_text(layout.radii[i]), " m with diameter ",
                        exact_text(parameters.pin_diameter), " m, is not inside the disc: it extends ", std::max(inside, outside),
                        " m beyond the ", inside >= outside ? "inner" : "outer", " radius of the disc (",
                        inside >= outside ? parameters.disc_inner_radius : parameters.disc_outer_radius, " m)"),
                   radii_name,
                   text("give a radius between ", parameters.disc_inner_radius + pin_radius, " m and ",
                        parameters.disc_outer_radius - pin_radius, " m, both excluded, or make the pin smaller"));
        }

      const double to_radians = std::acos(-1.) / 180.;
      for (std::size_t i = 0; i < layout.radii.size(); ++i)
        for (std::size_t j = i + 1; j < layout.radii.size(); ++j)
          {
            const double angle    = (layout.angles[i] - layout.angles[j]) * to_radians;
            const double distance = std::sqrt(std::pow(layout.radii[i] - layout.radii[j], 2) +
                                              4. * layout.radii[i] * layout.radii[j] * std::pow(std::sin(angle / 2.), 2));
            if (distance <= parameters.pin_diameter)
              refuse(text("Geometry/", angles_name, ": pins ", i + 1, " and ", j + 1, " of this side overlap by ",
                          parameters.pin_diameter - distance, " m: their axes are ", distance, " m apart, and their diameter is ",
                          exact_text(parameters.pin_diameter), " m"),
                     angles_name, text("move one of them in angle or radius (", radii_name, "), or make the pins smaller"));
          }
    }

    void declare_variable(Declarations &declarations, GeometryParameters::Variable &variable)
    {
      const std::string &name = variable.declaration.name;
      declarations.add_text(
        name, "Variable of the geometry file; empty: the value in the file, " + variable.declaration.value + ". Units: as in the geometry.",
        [&variable] { return variable.value ? exact_text(*variable.value) : ""; },
        [&variable, name](const std::string &text) {
          variable.value = parse_number(text);
          if (!variable.value && !text.empty())
            refuse("Geometry/" + name + " is " + in_quotes(text) + ", which is not a finite number", name,
                   "give a number, or leave it empty for the value in the geometry file" + decimal_point_hint(text));
        });
    }

    /// True if a Gmsh mesh has physical volumes, whose names are stored in plain text even in binary files.
    bool has_volumes(const std::string &mesh)
    {
      std::ifstream stream(mesh, std::ios::binary);
      std::string   line;
      while (std::getline(stream, line) && line.rfind("$PhysicalNames", 0) != 0)
        ;
      std::getline(stream, line); // skip the number of names
      while (std::getline(stream, line) && line.rfind("$End", 0) != 0)
        if (int dimension; std::istringstream(line) >> dimension && dimension == 3)
          return true;
      return false;
    }
  } // namespace

  void GeometryParameters::set_file(const std::string &name, const std::string &parameter_directory)
  {
    file      = name;
    directory = parameter_directory;
    variables.clear();
    std::string geometry;
    try
      {
        geometry = path();
      }
    catch (const MeshError &)
      {
        return; // the missing file is reported when it is opened
      }
    if (is_script(geometry))
      for (const GeometryVariable &variable : GeometryScript(geometry).variables())
        if (script_variables().count(variable.name) == 0)
          variables.push_back({variable, {}});
  }

  std::map<std::string, std::string> GeometryParameters::script_variables() const
  {
    const auto list = [](const std::vector<double> &values) { return "{" + exact_text(values) + "}"; };
    return {{"disc_inner_radius", exact_text(disc_inner_radius)},
            {"disc_outer_radius", exact_text(disc_outer_radius)},
            {"disc_thickness", exact_text(disc_thickness)},
            {"pin_diameter", exact_text(pin_diameter)},
            {"pin_height", exact_text(pin_height)},
            {"top_pin_radii", list(top.radii)},
            {"top_pin_angles", list(top.angles)},
            {"bottom_pin_radii", list(bottom.radii)},
            {"bottom_pin_angles", list(bottom.angles)},
            {"nodes_per_pin_face", std::to_string(nodes_per_pin_face)},
            {"pin_layers", std::to_string(pin_layers)},
            {"pin_rings", std::to_string(pin_rings)},
            {"pin_grading", exact_text(pin_grading)},
            {"disc_layers", std::to_string(disc_layers)},
            {"element_size", exact_text(element_size)},
            {"pairing_tolerance", exact_text(pairing_tolerance)}};
  }

  std::set<std::string> GeometryParameters::used_variables() const
  {
    const std::string             geometry = path();
    std::optional<GeometryScript> script;
    if (is_script(geometry))
      script.emplace(geometry);
    std::set<std::string> used = {"pairing_tolerance"};
    if (is_plan())
      used.insert({"disc_thickness", "pin_height", "disc_layers", "pin_layers", "pin_rings", "pin_grading"});
    for (const auto &[name, value] : script_variables())
      if (script && script->find({name}))
        used.insert(name);
    return used;
  }

  bool GeometryParameters::is_plan() const
  {
    const std::string geometry = path();
    return is_script(geometry) ? !GeometryScript(geometry).find({"Physical Volume"}) : !has_volumes(geometry);
  }

  std::string GeometryParameters::path() const
  {
    return find_geometry(file, directory);
  }

  void GeometryParameters::declare(Declarations &declarations)
  {
    declarations.enter("Geometry");
    declarations.add(
      "File", file,
      "Geometry or mesh of disc and pins: a Gmsh script (.geo) or a Gmsh mesh (.msh). The file is searched for in the folder of the "
      "parameter file, in the current directory, then among the supplied geometries. A file with physical volumes is a solid model. A file "
      "with only physical surfaces and curves is a plan: a planar geometry that is meshed and extruded. A .geo can use the dimensions, "
      "positions and mesh parameters below as variables, and its own numeric variables (DefineConstant, DefineNumber) become parameters of "
      "this section.");
    declarations.add("Disc inner radius", disc_inner_radius, "m", "Radius of the bore of the disc.", {0.});
    declarations.add("Disc outer radius", disc_outer_radius, "m", "Radius of the rim of the disc.", {0.});
    declarations.add("Disc thickness", disc_thickness, "m", "Thickness of the disc, which is symmetric about z = 0.", {0.});
    declarations.add("Pin diameter", pin_diameter, "m", "Diameter of every pin.", {0.});
    declarations.add("Pin height", pin_height, "m", "Height of every pin above the disc's face.", {0.});
    declarations.add("Top pin radii", top.radii, "m",
                     "Distances between the axis of the disc and the axes of the pins on the upper face (z > 0), separated by commas; "
                     "empty: no pins on this face.",
                     {0.});
    declarations.add("Top pin angles", top.angles, "degree", "Angular positions of the pins on the upper face, one for each radius.");
    declarations.add("Bottom pin radii", bottom.radii, "m",
                     "Distances between the axis of the disc and the axes of the pins on the lower face (z < 0), separated by commas; "
                     "empty: no pins on this face.",
                     {0.});
    declarations.add("Bottom pin angles", bottom.angles, "degree", "Angular positions of the pins on the lower face, one for each radius.");
    declarations.add("Nodes per pin face", nodes_per_pin_face, "none",
                     "Number of nodes on the contact face of a pin, 3 k (k + 1) + 1: 7, 19, 37, 61, ...", {1});
    declarations.add("Pin layers", pin_layers, "none", "Number of element layers along the height of a pin.", {1});
    declarations.add("Disc layers", disc_layers, "none", "Number of element layers through the thickness of the disc.", {1});
    declarations.add(
      "Element size", element_size, "m",
      "Edge length of disc elements, in the plane of the disc and away from the pins; disc_pins.geo uses smaller elements where this size "
      "does not fit between the pins.",
      {0.});
    declarations.add(
      "Outlines", outlines,
      "Approximation of round pins, bore and rim of a plan by straight edges. `inscribed`: nodes on the circle, so that the area is too "
      "small. `true area`: nodes moved outwards, so that the area is the same as for the circle. Quadratic elements "
      "follow the circle.");
    declarations.add(
      "Pin rings", pin_rings, "none",
      "Number of rings of elements along the outline of every pin of a plan, around the inner blocks of elements. Each ring adds 6 k nodes "
      "to the face, with k from Nodes per pin face = 3 k (k + 1) + 1.",
      {0, 20});
    declarations.add(
      "Pin grading", pin_grading, "none",
      "Size ratio of successive layers and rings of a pin towards the edge of its clamped end, where stresses are singular; 1: uniform.",
      {1., 4.});
    declarations.add("Pairing tolerance", pairing_tolerance, "m",
                     "Maximum distance between a node of the disc and a node of a pin that form a contact pair.", {0.});
    declarations.add(
      "Allow shell commands", allow_shell_commands,
      "Allows a .geo to start programs, to create, write and remove files, and to use the network. If the operating system cannot forbid "
      "these actions, a note is printed. Set this parameter to true only if you trust every line of the file.");
    declarations.add("Meshing time limit", meshing_time_limit, "s", "Time limit for Gmsh.", {0.});
    declarations.add("Meshing memory limit", meshing_memory_limit, "GB", "Memory limit for Gmsh.", {0.});
    for (Variable &variable : variables)
      declare_variable(declarations, variable);
  }

  void GeometryParameters::check() const
  {
    if (file.empty())
      refuse("Geometry/File is empty", "File", "name a .geo or .msh file, or remove the line to use disc_pins.geo");
    check_format(file);
    check_positive(disc_inner_radius, "Disc inner radius");
    check_positive(disc_outer_radius, "Disc outer radius");
    check_positive(disc_thickness, "Disc thickness");
    check_positive(pin_diameter, "Pin diameter");
    check_positive(pin_height, "Pin height");
    check_positive(element_size, "Element size");
    check_positive(pairing_tolerance, "Pairing tolerance");
    check_positive(meshing_time_limit, "Meshing time limit");
    if (!(meshing_memory_limit >= least_memory_limit))
      refuse(text("Geometry/Meshing memory limit is ", exact_text(meshing_memory_limit), " GB, which is below the minimum"),
             "Meshing memory limit", text("set it to at least ", exact_text(least_memory_limit), " GB"));
    check_positive(pin_layers, "Pin layers");
    check_positive(disc_layers, "Disc layers");
    check_nodes_per_pin_face(nodes_per_pin_face);

    const auto check_lengths = [](const PinLayout &layout, const char *side) {
      if (layout.radii.size() != layout.angles.size())
        refuse(text("Geometry/", side, " pin radii has ", counted(layout.radii.size(), "value"), ", but Geometry/", side,
                    " pin angles has ", layout.angles.size()),
               text(side, " pin angles"), "give every pin one radius and one angle");
    };
    check_lengths(top, "Top");
    check_lengths(bottom, "Bottom");

    // Keep pairs unambiguous: the tolerance must be less than half the distance between neighbouring nodes
    if (pairing_tolerance >= element_size / 2.)
      refuse(text("Geometry/Pairing tolerance is ", exact_text(pairing_tolerance), " m, not less than half the element size, ",
                  exact_text(element_size / 2.), " m"),
             "Pairing tolerance", "set it to a small fraction of the element size; 1e-6 m suits most geometries");

    // Check the built-in plan only: custom geometries need not use these parameters
    if (std::filesystem::path(file).filename() != "disc_pins.geo")
      return;
    if (disc_inner_radius >= disc_outer_radius)
      refuse(text("Geometry/Disc inner radius is ", exact_text(disc_inner_radius), " m, not smaller than Geometry/Disc outer radius, ",
                  exact_text(disc_outer_radius), " m"),
             "Disc inner radius", "set it below the outer radius");
    const double width = disc_outer_radius - disc_inner_radius;
    if (element_size > width / 2.)
      refuse(text("Geometry/Element size is ", exact_text(element_size), " m, but the annulus of the disc is only ", width, " m wide"),
             "Element size", text("set it to at most ", width / 2., " m, preferably much less"));
    if (element_size > disc_inner_radius)
      refuse(text("Geometry/Element size is ", exact_text(element_size), " m, but the bore has a radius of only ",
                  exact_text(disc_inner_radius), " m"),
             "Element size", text("set it to at most ", exact_text(disc_inner_radius), " m, preferably much less"));
    if (top.radii.empty() && bottom.radii.empty())
      refuse("Geometry/Top pin radii and Geometry/Bottom pin radii are both empty", "Top pin radii",
             "give the radius and the angle of at least one pin");
    check_layout(top, "Top", *this);
    check_layout(bottom, "Bottom", *this);
  }

  namespace
  {
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
          text("the mesh density of Geometry/File = ", in_quotes(geometry.file), " cannot be changed: the file does not use Geometry/",
               parameter),
          "parameter Geometry/File",
          text("give a script (.geo) that uses element_size, disc_layers and pin_layers (in a plan, only element_size); or set Accuracy = "
               "as given and a Study other than accuracy"));
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
