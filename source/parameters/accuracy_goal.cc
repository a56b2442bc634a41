// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/accuracy_goal.h>
#include <squeal/parameters/parameters.h>

#include <boost/algorithm/string/join.hpp>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace Squeal
{
  namespace
  {
    /// Mesh density for any size of disc and pins.
    struct MeshDensity
    {
      Element      element;
      unsigned int blocks; ///< k, elements along a block edge of a pin face
      unsigned int rings;
      double       grading;
      unsigned int pin_layers; ///< layers of pins with a height of up to squat_pin diameters
      unsigned int disc_layers;
      double       elements_per_wave; ///< elements per wavelength in the disc
    };

    struct Level
    {
      AccuracyLimits limits;
      MeshDensity    mesh, coarser;
      double         tolerance; ///< tolerance of reduced models and solvers: estimated |δλ| / |λ| [-]
    };

    /// Settings of a goal other than as_given, based on errors of the default model (doc/accuracy.md).
    const Level &level(const AccuracyGoal goal)
    {
      static const MeshDensity                   fine   = {Element::quadratic, 2, 3, 1.5, 5, 3, 10.};
      static const std::map<AccuracyGoal, Level> levels = {
        {AccuracyGoal::five_percent,
         {{5e-2, 5e-3}, {Element::incompatible_modes, 2, 0, 1., 4, 2, 13.}, {Element::incompatible_modes, 1, 0, 1., 2, 1, 6.5}, 1e-5}},
        {AccuracyGoal::one_percent,
         {{1e-2, 1e-3}, {Element::quadratic, 2, 0, 1., 2, 2, 10.}, {Element::quadratic, 2, 0, 1., 1, 1, 6.5}, 1e-5}},
        {AccuracyGoal::a_tenth_percent, {{1e-3, 1e-4}, fine, {Element::quadratic, 2, 2, 1.5, 3, 2, 7.5}, 1e-5}},
        {AccuracyGoal::a_hundredth_percent, {{1e-4, 1e-5}, {Element::quadratic, 2, 4, 1.5, 7, 4, 13.}, fine, 1e-6}}};
      return levels.at(goal);
    }

    /// Largest ratio of pin height to diameter for which the layers of a level are sufficient [-].
    constexpr double squat_pin = 0.62;

    /// Relative extension of the band on the coarser mesh as a multiple of the requested accuracy, and minimum extension [-].
    constexpr double margin_of_coarser_band = 2., least_band_margin = 0.02;

    /// Relative extension of the band on a given coarser mesh, whose accuracy is unknown [-].
    constexpr double margin_of_given_mesh = 0.05;

    /// Shortest wavelength at the end of the band [m]: thin-plate bending, 2π (D / ρhω²)^¼, or Rayleigh waves on the faces.
    double shortest_wave(const Parameters &parameters)
    {
      constexpr double rayleigh  = 0.9; // Rayleigh wave speed relative to the shear wave speed
      const Material   disc      = parameters.materials.of("disc");
      const double     frequency = parameters.discretization.maximum_frequency, omega = circular_frequency(frequency);
      const double     nu = disc.mean_poisson_ratio(), h = parameters.geometry.disc_thickness;
      const double     plate_speed = std::sqrt(disc.young_modulus / (12. * (1. - nu * nu) * disc.density)); // √(D / ρh) / h
      const double     shear_speed = std::sqrt(disc.least_wave_modulus() / disc.density);
      return std::min(2. * M_PI * std::sqrt(plate_speed * h / omega), rayleigh * shear_speed / frequency);
    }

    GeometryParameters meshed(const Parameters &parameters, const MeshDensity &mesh)
    {
      GeometryParameters geometry = parameters.geometry;
      check_follows(geometry);
      const double width          = (geometry.disc_outer_radius - geometry.disc_inner_radius) / 2.;
      const double slenderness    = geometry.pin_height / geometry.pin_diameter / squat_pin;
      geometry.element_size       = std::min({shortest_wave(parameters) / mesh.elements_per_wave, width, geometry.disc_inner_radius});
      geometry.nodes_per_pin_face = nodes_of_pin_face(mesh.blocks);
      geometry.pin_rings          = mesh.rings;
      geometry.pin_grading        = mesh.grading;
      geometry.pin_layers         = std::lround(std::ceil(mesh.pin_layers * std::max(1., slenderness)));
      const double layers         = geometry.disc_thickness / geometry.element_size;
      geometry.disc_layers        = std::max(mesh.disc_layers, static_cast<unsigned int>(std::lround(layers)));
      return geometry;
    }

    Parameters with(const Parameters &given, const MeshDensity &mesh, const double tolerance)
    {
      Parameters result                  = given;
      result.discretization.element      = mesh.element;
      result.discretization.coarser_mesh = "";
      result.geometry                    = meshed(given, mesh);
      result.solvers.complex_solver      = ComplexSolver::residual_iteration;
      result.solvers.iteration_tolerance = tolerance;
      return result;
    }
  } // namespace

  AccuracyLimits limits_of(const AccuracyGoal goal)
  {
    return level(goal).limits;
  }

  double error_by_difference(const AccuracyGoal goal)
  {
    if (goal == AccuracyGoal::as_given)
      return 1.;
    return level(goal).mesh.element == Element::quadratic ? 1. / 3. : 2. / 3.;
  }

  Parameters with_goal(const Parameters &given)
  {
    if (given.goal == AccuracyGoal::as_given)
      return given;
    const Level &asked = level(given.goal);
    return with(given, asked.mesh, asked.tolerance);
  }

  namespace
  {
    std::vector<std::string> split(const std::string &text, const char separator = ',')
    {
      std::vector<std::string> names = dealii::Utilities::split_string_list(text, separator);
      names.erase(std::remove(names.begin(), names.end(), ""), names.end());
      return names;
    }

    Parameters with_given_coarser_mesh(const Parameters &given)
    {
      const std::string where = "parameter Discretization/Coarser mesh", &mesh = given.discretization.coarser_mesh;
      Parameters        result = given;
      const auto        set    = [&](const std::string &name, const std::string &value) {
        result.set("Geometry/" + name, where, [&](const std::string &) { return value; });
      };
      result.discretization.coarser_mesh = "";
      result.discretization.maximum_frequency *= 1. + margin_of_given_mesh;
      if (given.discretization.coarser_mesh_is_file())
        set("File", mesh);
      else
        for (const std::string &entry : split(mesh))
          {
            const std::vector<std::string> words = split(entry, '=');
            if (words.size() != 2)
              throw ParameterError("`" + entry + "` is not of the form NAME = VALUE", where,
                                   "give parameters of the section Geometry with their values, separated by commas, or the name of a file");
            set(words[0], words[1]);
          }
      return result;
    }
  } // namespace

  Parameters with_coarser_mesh(const Parameters &given)
  {
    if (given.goal == AccuracyGoal::as_given)
      return with_given_coarser_mesh(given);
    const Level &asked  = level(given.goal);
    Parameters   result = with(given, asked.coarser, asked.tolerance);
    result.discretization.maximum_frequency *= 1. + std::max(margin_of_coarser_band * asked.limits.frequency, least_band_margin);
    return result;
  }

  namespace
  {
    /// Names of an enumeration, separated by commas.
    template <typename Enum>
    void add_list(Declarations &declarations, const std::string &name, std::vector<Enum> &values, const std::string &documentation)
    {
      const std::vector<std::string> known = enum_names<Enum>();
      declarations.add_text(
        name, documentation + " One or more of " + boost::algorithm::join(known, ", ") + ", separated by commas.",
        [&values] {
          std::vector<std::string> names;
          for (const Enum value : values)
            names.push_back(to_string(value));
          return boost::algorithm::join(names, ", ");
        },
        [&values, known, name](const std::string &text) {
          std::vector<Enum> read;
          for (const std::string &entry : split(text))
            {
              if (std::find(known.begin(), known.end(), entry) == known.end())
                throw ParameterError("Accuracy study/" + name + " contains " + in_quotes(entry) + ", which is not one of " +
                                       boost::algorithm::join(known, ", "),
                                     "", "give one or more of these names, separated by commas");
              read.push_back(enum_value<Enum>(entry));
            }
          values = read;
        });
    }

    template <typename Value>
    void check_list(const std::vector<Value> &values, const char *name)
    {
      if (values.empty())
        throw ParameterError(text("Accuracy study/", name, " is empty"), text("parameter Accuracy study/", name),
                             "give at least one value");
      if (std::set<Value>(values.begin(), values.end()).size() < values.size())
        throw ParameterError(text("Accuracy study/", name, " contains a value twice"), text("parameter Accuracy study/", name),
                             "give each value once");
    }
  } // namespace

  void AccuracyStudyParameters::declare(Declarations &declarations)
  {
    declarations.enter("Accuracy study");
    declarations.add(
      "Mesh factors", factors, "none",
      "Mesh refinement factors relative to the section Geometry, in every direction, separated by commas. They scale the element size and "
      "the numbers of layers, pin rings and nodes per pin face. At least two factors are required; three factors also yield an order of "
      "convergence.",
      {0.1, 10.}, 20);
    add_list(declarations, "Elements", elements, "Elements to be compared.");
    add_list(declarations, "Outlines", outlines,
             "Outlines to be compared for elements with straight edges; quadratic elements follow the circle.");
    declarations.add_text(
      "Bases", "Names of the reduced bases to be compared with full order, as in the section Reduction, separated by commas; empty: none.",
      [this] { return boost::algorithm::join(bases, ", "); }, [this](const std::string &text) { bases = split(text); });
    declarations.add("Grown tolerance", grown_tolerance, "none",
                     "A `residual-grown` basis is complete when the estimated relative error of every lambda is below this tolerance.",
                     {1e-11, 1e-1});
    declarations.add("Largest number of dofs", largest_dofs, "none", "Meshes with more dofs are skipped.", {1.});
    declarations.add(
      "Band margin", margin, "none",
      "Relative extension of the band on all meshes, so that modes of coarse meshes, whose frequencies are too high, have counterparts.",
      {0., 1.});
  }

  void AccuracyStudyParameters::check() const
  {
    check_list(factors, "Mesh factors");
    check_list(elements, "Elements");
    check_list(outlines, "Outlines");
    if (factors.size() < 2)
      throw ParameterError("Accuracy study/Mesh factors has only one value, but error estimates require two meshes",
                           "parameter Accuracy study/Mesh factors", "give two or more values; three also yield the order of convergence");
  }
} // namespace Squeal
