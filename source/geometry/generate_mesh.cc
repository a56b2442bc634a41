// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/geometry/generate_mesh.h>
#include <squeal/geometry/mesh_check.h>
#include <squeal/geometry/mesh_file.h>
#include <squeal/geometry/mesh_topology.h>
#include <squeal/geometry/mesher.h>
#include <squeal/geometry/pin_grid.h>
#include <squeal/geometry/plan.h>
#include <squeal/geometry/plan_smoothing.h>
#include <squeal/geometry/scene_size.h>

#include <deal.II/base/mpi.h>

#include <boost/algorithm/string/join.hpp>
#include <boost/lexical_cast/try_lexical_convert.hpp>
#include <boost/serialization/utility.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>

namespace Squeal
{
  namespace
  {
    namespace fs = std::filesystem;

    constexpr const char *built_in_geometry = "disc_pins.geo";

    /// True if Gmsh's Include accepts the path, which must not contain quotes or special characters.
    bool can_be_included(const std::string &path)
    {
      return path.find_first_of("\"'\\%$~#\n") == std::string::npos;
    }

    /// Script that sets the parameters before Gmsh reads the geometry. Defaults in the geometry do not overwrite existing values.
    std::string driver(const GeometryParameters &parameters)
    {
      std::string script;
      for (const auto &[name, value] : parameters.script_variables())
        script += name + (value[0] == '{' ? "()" : "") + " = " + value + ";\n";
      for (const GeometryParameters::Variable &variable : parameters.variables)
        if (variable.value && variable.declaration.onelab_name.empty())
          script += variable.declaration.name + " = " + exact_text(*variable.value) + ";\n";
      return script;
    }

    /// Adds a note for each variable of the script that is overridden by the default value of section Geometry.
    void note_overridden_variables(const GeometryParameters &parameters, const std::string &where, Mesh &mesh)
    {
      const auto values = parameters.script_variables(), defaults = GeometryParameters().script_variables();
      double     own = 0.;
      if (is_script(where))
        for (const GeometryVariable &variable : GeometryScript(where).variables())
          if (const auto value = values.find(variable.name); value != values.end() && value->second == defaults.at(variable.name) &&
                                                             boost::conversion::try_lexical_convert(variable.value, own) &&
                                                             own != std::stod(value->second))
            mesh.notes.push_back(variable.name + " = " + variable.value + " in the script is overridden by " + value->second +
                                 ", the default of section Geometry; set the parameter there, or rename the variable");
    }

    // Gmsh statements with side effects outside the mesh
    const std::vector<std::string> shell_statements = {
      "SystemCall", "NonBlockingSystemCall", "OnelabRun", "CreateDir", "Save", "Print", "Printf", "Plugin"};

    MesherInput mesher_input(const GeometryParameters &parameters, const std::string &geometry)
    {
      if (!is_script(geometry))
        return {geometry, "", {}};
      MesherInput input{geometry, driver(parameters), {}};
      // Include the geometry if possible: Gmsh ignores the last line of an opened file if this line has no line break
      if (can_be_included(geometry))
        {
          input.script += "Include \"" + geometry + "\";\n";
          input.file.clear();
        }
      else if (std::ifstream stream(geometry, std::ios::binary | std::ios::ate);
               stream.tellg() > 0 && stream.seekg(-1, std::ios::cur).peek() != '\n')
        throw MeshError("The last line of the file has no line break, and Gmsh would ignore this line", geometry,
                        "add a line break, or choose a path without quotes, backslashes and $ % ~ #");
      for (const GeometryParameters::Variable &variable : parameters.variables)
        if (variable.value && !variable.declaration.onelab_name.empty())
          input.numbers[variable.declaration.onelab_name] = *variable.value;
      return input;
    }

    /// Runs Gmsh on the geometry. Gmsh is confined unless the geometry is supplied with the program or the parameters allow shell commands.
    GmshMesh run_gmsh(const GeometryParameters &parameters, const std::string &geometry)
    {
      const bool         is_trusted = parameters.allow_shell_commands || is_supplied(geometry);
      const MesherLimits limits{parameters.meshing_time_limit, 1e9 * parameters.meshing_memory_limit, !is_trusted};
      try
        {
          return run_mesher(mesher_input(parameters, geometry), geometry, limits);
        }
      catch (const ForbiddenAction &action)
        {
          throw MeshError(std::string("The geometry ") + action.what(), GeometryScript(geometry).find(shell_statements).value_or(geometry),
                          "remove the statement; if you trust every line of the file, set Geometry/Allow shell commands = true");
        }
    }

    /// Runs Gmsh on process 0; all processes receive the mesh or the error.
    GmshMesh run_gmsh_once(const GeometryParameters &parameters, const std::string &geometry, MPI_Comm communicator)
    {
      std::pair<std::string, GmshMesh> outcome; // error message and mesh
      std::exception_ptr               error;
      if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
        try
          {
            outcome.second = run_gmsh(parameters, geometry);
          }
        catch (const std::exception &exception)
          {
            outcome.first = exception.what();
            error         = std::current_exception();
          }
      if (dealii::Utilities::MPI::n_mpi_processes(communicator) > 1)
        outcome = dealii::Utilities::MPI::broadcast(communicator, outcome);
      if (error)
        std::rethrow_exception(error);
      if (!outcome.first.empty())
        throw std::runtime_error(outcome.first);
      return outcome.second;
    }

    // ---------------------------------------------------------- unit of length

    /// Decimal exponent of the unit of length in which the disc radius is between 0.1 and 1. The supplied plan is drawn and extruded in
    /// this unit, because tolerances of Gmsh are absolute lengths: a scaled plan would be meshed differently.
    int decimal_exponent(const double disc_outer_radius)
    {
      return 1 + static_cast<int>(std::floor(std::log10(disc_outer_radius)));
    }

    /// Divides all lengths by a power of ten by moving the decimal point, which is exact for up to 15 digits.
    GeometryParameters in_unit(GeometryParameters parameters, const int exponent)
    {
      const auto move_point = [exponent](double &length) {
        std::ostringstream text;
        text << std::setprecision(std::numeric_limits<double>::digits10) << length * std::pow(10., -exponent);
        if (exponent != 0)
          length = std::stod(text.str());
      };
      for (double *length : {&parameters.disc_inner_radius, &parameters.disc_outer_radius, &parameters.disc_thickness,
                             &parameters.pin_diameter, &parameters.pin_height, &parameters.element_size, &parameters.pairing_tolerance})
        move_point(*length);
      for (std::vector<double> *lengths : {&parameters.top.radii, &parameters.bottom.radii})
        std::for_each(lengths->begin(), lengths->end(), move_point);
      return parameters;
    }

    /// Checks the memory that every study needs.
    void check_least_memory(ProblemSize size, const std::string &where, const MPI_Comm communicator)
    {
      constexpr double no_modes = 0.;
      size.contact_nodes        = 0.; // attachment modes are not always needed
      check_memory(size, no_modes, where, communicator);
    }

    /// Rejects a mesh without volumes and surfaces, and unnamed groups that would be used.
    void check_groups(const GmshMesh &mesh, const std::string &where)
    {
      const std::string other_formats = "; for formats from which Gmsh reads no names (.unv, .inp, .bdf, ...), name the parts in a .geo "
                                        "after Merge, or convert the file to a .msh with physical names";
      if (mesh.dimension() < 2)
        throw MeshError(
          mesh.n_unnamed_volume_elements == 0 ?
            "The geometry has neither physical volumes nor physical surfaces" :
            text("The mesh has ", counted(mesh.n_unnamed_volume_elements, "volume element"), ", but no physical volumes or surfaces"),
          where, "name the volumes of a solid 'disc', 'pin_1', ..., or the surface of a plan 'disc'" + other_formats);
      constexpr const char *kinds[] = {"point", "curve", "surface", "volume"};
      for (const GmshMesh::Group &group : mesh.groups)
        if (group.name.empty() && (mesh.dimension() == 2 || group.dimension >= 2))
          throw MeshError(text("Physical ", kinds[group.dimension], ' ', group.number, " has no name"), where,
                          "name it, for example by Physical Volume(\"disc\") = {...} in a .geo or a line of $PhysicalNames in a .msh" +
                            other_formats);
    }

    /// Rejects names of missing surfaces; called before unused surfaces are rejected.
    void check_named(const GmshMesh                 &gmsh,
                     const std::vector<std::string> &mounted,
                     const ContactParameters        &contact,
                     const std::string              &where)
    {
      std::vector<std::string> present;
      for (const GmshMesh::Group &group : gmsh.groups)
        if (group.dimension == 2)
          present.push_back(group.name);
      const auto require = [&](const std::string &name, const char *parameter) {
        if (std::find(present.begin(), present.end(), name) == present.end())
          throw MeshError("There is no physical surface '" + name + "', which is named in " + parameter +
                            "; the surfaces are: " + (present.empty() ? "(none)" : boost::algorithm::join(present, ", ")),
                          where, text("rename a surface of the geometry, or correct the name in ", parameter));
      };
      for (const ContactPair &pair : contact.pairs)
        {
          require(pair.disc, "Contact/Pairs");
          require(pair.pin, "Contact/Pairs");
        }
      for (const TiedPair &pair : contact.tied)
        {
          require(pair.slave, "Contact/Tied");
          require(pair.master, "Contact/Tied");
        }
      for (const std::string &name : mounted)
        require(name, "Mounts/Elastic mounts, Mounts/Dashpots or Steady sliding/Pressed faces");
    }

    /// Adds the faces of contact surfaces to disc_contact and pin_contact.
    void name_contact(Mesh &mesh, const ContactParameters &contact, const std::string &where)
    {
      const std::vector<unsigned int> bodies = body_of_nodes(mesh);
      const auto                      number = [&mesh](const std::string &name) {
        return std::find(mesh.surface_names.begin(), mesh.surface_names.end(), name) - mesh.surface_names.begin();
      };
      const auto add = [&](const std::string &surface, const std::string &contact_name) {
        const std::size_t given = number(surface), n_faces = mesh.faces.size();
        for (const Mesh::Face &face : mesh.faces)
          if (const unsigned int body = bodies[face.nodes[0]];
              face.surface == given && (body == 0) != (contact_name == PhysicalNames::disc_contact))
            throw MeshError("Surface '" + surface + "' has a face on '" + mesh.body_names[body] + "'", where + ", parameter Contact/Pairs",
                            "in each pair, name a surface of the disc first, then a surface of another body; each surface must be on one "
                            "side of the contact only");
        if (surface == contact_name)
          return;
        const std::size_t named = number(contact_name);
        if (named == mesh.surface_names.size())
          mesh.surface_names.push_back(contact_name);
        std::set<std::array<unsigned int, 4>> known; // faces that are already on the surface
        for (const Mesh::Face &face : mesh.faces)
          if (face.surface == named)
            known.insert(face_key(face));
        for (std::size_t face = 0; face < n_faces; ++face)
          if (mesh.faces[face].surface == given && known.insert(face_key(mesh.faces[face])).second)
            {
              mesh.faces.push_back(mesh.faces[face]);
              mesh.faces.back().surface = named;
            }
      };
      for (const ContactPair &pair : contact.pairs)
        {
          add(pair.disc, PhysicalNames::disc_contact);
          add(pair.pin, PhysicalNames::pin_contact);
        }
    }

    Mesh mesh_once(const GeometryParameters       &parameters,
                   const double                    unit,
                   const std::string              &where,
                   const std::vector<std::string> &additional_surfaces,
                   const ContactParameters        &contact,
                   MPI_Comm                        communicator)
    {
      const GmshMesh gmsh = run_gmsh_once(parameters, where, communicator);
      check_groups(gmsh, where);
      const auto finished = [&](Mesh mesh) {
        if (mesh.tied = contact.tied; !mesh.tied.empty())
          find_bodies(mesh);
        if (!gmsh.why_not_confined.empty())
          mesh.notes.push_back("Gmsh was not confined: on this system, a geometry can run programs and write files (" +
                               gmsh.why_not_confined + ")");
        return mesh;
      };
      if (gmsh.dimension() == 3)
        {
          check_named(gmsh, additional_surfaces, contact, where);
          std::vector<std::string> surfaces = additional_surfaces;
          for (const ContactPair &pair : contact.pairs)
            surfaces.insert(surfaces.end(), {pair.disc, pair.pin});
          for (const TiedPair &pair : contact.tied)
            surfaces.insert(surfaces.end(), {pair.slave, pair.master});
          Mesh mesh = make_mesh(gmsh, surfaces, where);
          if (contact.pairs.size() > 1 || contact.pairs[0].disc != PhysicalNames::disc_contact ||
              contact.pairs[0].pin != PhysicalNames::pin_contact)
            name_contact(mesh, contact, where);
          check_unique(mesh, where);
          if (const unsigned int n = make_right_handed(mesh); n > 0)
            mesh.notes.push_back(text("left-handed cells: ", n, " of ", mesh.cells.size(), "; their nodes have been reordered"));
          return finished(std::move(mesh));
        }
      Plan plan = make_plan(gmsh, {parameters.pin_rings, parameters.pin_grading}, unit, where);
      check_least_memory(expected_size(plan, parameters), where, communicator);
      if (parameters.outlines == Outlines::true_area)
        enlarge_to_true_area(plan);
      smooth(plan);
      return finished(extrude(plan, parameters));
    }

    // If elements of the requested size do not fit between the pins of the supplied plan, repeat with smaller elements
    constexpr int    max_attempts      = 5;
    constexpr double smaller_next_time = 0.9;
  } // namespace

  Mesh generate_mesh(const GeometryParameters       &given,
                     const std::vector<std::string> &additional_surfaces,
                     MPI_Comm                        communicator,
                     const ContactParameters        &contact)
  {
    given.check();
    const std::string  where       = given.path();
    const bool         is_built_in = is_supplied(where) && fs::path(where).filename() == built_in_geometry;
    const int          exponent    = is_built_in ? decimal_exponent(given.disc_outer_radius) : 0;
    const double       unit        = std::pow(10., exponent); // [m]
    GeometryParameters parameters  = in_unit(given, exponent);
    if (is_built_in)
      check_least_memory(expected_size(parameters), where, communicator);
    Mesh                     mesh   = mesh_once(parameters, unit, where, additional_surfaces, contact, communicator);
    std::vector<std::string> needed = additional_surfaces;
    for (const TiedPair &pair : contact.tied)
      needed.insert(needed.end(), {pair.slave, pair.master});
    check_parts(mesh, needed, where);
    check_bodies(mesh, additional_surfaces, where);
    for (int attempt = 1; is_built_in && attempt < max_attempts && mesh_quality(mesh).worst_scaled_jacobian < smallest_scaled_jacobian;
         ++attempt)
      {
        parameters.element_size *= smaller_next_time;
        mesh = mesh_once(parameters, unit, where, additional_surfaces, contact, communicator);
      }
    for (Mesh::Point &point : mesh.points)
      point *= unit;
    check_mesh(mesh);
    if (!is_built_in) // the supplied plan is conforming by construction
      {
        // Tied faces may coincide without matching: check the topology with separate bodies
        mesh.tied.clear();
        find_bodies(mesh);
        check_topology(mesh, given.pairing_tolerance, where);
        mesh.tied = contact.tied;
        find_bodies(mesh);
        note_overridden_variables(given, where, mesh);
      }
    return mesh;
  }
} // namespace Squeal
