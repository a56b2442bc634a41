// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/parameter_file.h>
#include <squeal/parameters/parameters.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <numeric>
#include <sstream>

namespace Squeal
{
  namespace
  {
    /// Smallest 1/β, relative to the radius of the band, at which the eigenvalues that accumulate near −1/β do not affect the search [-].
    constexpr double clear_of_accumulation = 1.2;

    /// Maximum number of compared characters of an unknown name; all known names are shorter.
    constexpr std::size_t longest_name = 200;

    /// Largest α, relative to the radius of the band, at which overdamped waves above the band have no eigenvalue in the band [-].
    constexpr double most_damping_by_mass = 4.;

    /// Case-insensitive Levenshtein distance.
    unsigned int edit_distance(const std::string &a, const std::string &b)
    {
      const auto                small = [](const char c) { return std::tolower(static_cast<unsigned char>(c)); };
      std::vector<unsigned int> row(b.size() + 1);
      std::iota(row.begin(), row.end(), 0);
      for (unsigned int i = 0; i < a.size(); ++i)
        {
          unsigned int diagonal = row[0];
          row[0]                = i + 1;
          for (unsigned int j = 0; j < b.size(); ++j)
            {
              const unsigned int substitution = diagonal + (small(a[i]) != small(b[j]));
              diagonal                        = row[j + 1];
              row[j + 1]                      = std::min({row[j] + 1, row[j + 1] + 1, substitution});
            }
        }
      return row[b.size()];
    }

    /// Edit distance between two names, compared word by word in any order; an omitted or abbreviated word counts as one edit.
    unsigned int word_distance(const std::string &written, const std::string &name)
    {
      using dealii::Utilities::split_string_list;
      const auto   written_words = split_string_list(written, ' '), name_words = split_string_list(name, ' ');
      unsigned int sum = std::max(written_words.size(), name_words.size()) - written_words.size();
      for (const std::string &word : written_words)
        {
          unsigned int smallest = word.size();
          for (const std::string &counterpart : name_words)
            {
              smallest = std::min(smallest, edit_distance(word, counterpart));
              if (word.size() > 1 && word.size() < counterpart.size())
                smallest = std::min(smallest, edit_distance(word, counterpart.substr(0, word.size())) + 1);
            }
          sum += smallest;
        }
      return sum;
    }

    /// Edit distance between two paths; the section has little weight, so that a correct name in a wrong section is found.
    unsigned int path_distance(const std::string &written, const std::string &candidate)
    {
      const auto split = [](const std::string &path) {
        const auto slash = path.rfind('/', path.size() - 2);
        return slash == std::string::npos ? std::make_pair(std::string(), path) :
                                            std::make_pair(path.substr(0, slash), path.substr(slash + 1));
      };
      const auto [written_section, written_name]     = split(written);
      const auto [candidate_section, candidate_name] = split(candidate);
      const auto distance = [](const std::string &a, const std::string &b) { return std::min(edit_distance(a, b), word_distance(a, b)); };
      constexpr unsigned int wrong_section = 4;
      return wrong_section * distance(written_name, candidate_name) + std::min(distance(written_section, candidate_section), wrong_section);
    }

    void check_name(const ParameterStatement &statement, const std::vector<std::string> &known)
    {
      if (std::find(known.begin(), known.end(), statement.path) != known.end())
        return;
      const bool        is_section = statement.is_section();
      const std::string written =
        statement.path.size() <= longest_name ? statement.path : statement.path.substr(0, longest_name) + (is_section ? "/" : "");
      std::string  nearest;
      unsigned int smallest = -1;
      for (const std::string &candidate : known)
        if ((candidate.back() == '/') == is_section)
          if (const unsigned int distance = path_distance(written, candidate); distance < smallest)
            {
              smallest = distance;
              nearest  = candidate;
            }
      throw ParameterError(std::string("unknown ") + (is_section ? "section " : "parameter ") + in_quotes(statement.path), statement.where,
                           "the nearest known name is `" + nearest + "`; squeal --print-parameters lists all names");
    }

    /// Paths of all parameters and of their sections.
    std::vector<std::string> known_names(const Declarations &declarations)
    {
      std::vector<std::string> names;
      for (const DeclaredParameter &parameter : declarations.parameters())
        {
          const std::string section = parameter.path.substr(0, parameter.path.find('/') + 1);
          if (!section.empty() && std::find(names.begin(), names.end(), section) == names.end())
            names.push_back(section);
          names.push_back(parameter.path);
        }
      return names;
    }

    /// Sets a parameter from a statement; errors name the file and line of the statement.
    void assign(const DeclaredParameter &parameter, const ParameterStatement &statement)
    {
      try
        {
          parameter.parse(statement.value);
        }
      catch (const ParameterError &error)
        {
          throw ParameterError(error.reason, statement.where + (error.where.empty() ? "" : ", ") + error.where, error.change);
        }
    }

    /// Statement of an override "Section/Name=value".
    ParameterStatement parse_override(const std::string &text)
    {
      const auto        equal = text.find('=');
      const std::string where = "--set \"" + legible(text) + "\"";
      if (equal == std::string::npos)
        throw ParameterError("the override has no `=`", where, "write --set \"Section/Name=value\"");
      return {single_spaced(text.substr(0, equal)), read_value(text.substr(equal + 1), where), where};
    }

    void declare_study(Declarations &declarations, const Study *&study)
    {
      std::vector<std::string> names;
      for (const Study *known : studies())
        names.emplace_back(known->name);
      declarations.add_choice(
        "Study", names, "Study to be run.", [&study] { return study->name; },
        [&study](const std::string &name) {
          study = *std::find_if(studies().begin(), studies().end(), [&](const Study *known) { return known->name == name; });
        });
    }

    /// Geometry/File from the last statement that sets it.
    std::string geometry_file(const std::vector<ParameterStatement> &statements)
    {
      std::string result = GeometryParameters().file;
      for (const ParameterStatement &statement : statements)
        if (statement.path == "Geometry/File")
          result = statement.value;
      return result;
    }
  } // namespace

  void Parameters::declare(Declarations &declarations)
  {
    declare_study(declarations, study);
    declarations.add(
      "Accuracy", goal,
      "Required accuracy of frequencies; the required accuracy of divergence rates is a tenth of this number, in percentage points. The "
      "program chooses elements, mesh, solver and tolerances, and ignores the corresponding parameters below. Study = stability estimates "
      "the achieved accuracy of each mode with a second, coarser mesh. `as given`: the parameters below are used, and the discretisation "
      "error is estimated only with Discretization/Coarser mesh.");
    system.declare(declarations);
    geometry.declare(declarations);
    materials.declare(declarations);
    discretization.declare(declarations);
    contact.declare(declarations);
    operation.declare(declarations);
    sliding.declare(declarations);
    damping.declare(declarations);
    reduction.declare(declarations);
    sweep.declare(declarations);
    sensitivity.declare(declarations);
    ingredients.declare(declarations);
    accuracy.declare(declarations);
    designs.declare(declarations);
    search.declare(declarations);
    robustness.declare(declarations);
    updating.declare(declarations);
    solvers.declare(declarations);
    output.declare(declarations);
  }

  Parameters Parameters::read(const std::string &file, const std::vector<std::string> &overrides)
  {
    std::vector<ParameterStatement> statements = read_parameter_file(file);
    for (const std::string &text : overrides)
      statements.push_back(parse_override(text));

    // The variables of the geometry are also parameters
    Parameters parameters;
    parameters.system.directory = std::filesystem::path(file).parent_path().string();
    parameters.geometry.set_file(geometry_file(statements), std::filesystem::path(file).parent_path().string());
    Declarations declarations;
    parameters.declare(declarations);
    const std::vector<std::string> known = known_names(declarations);

    for (const ParameterStatement &statement : statements)
      check_name(statement, known);
    for (const ParameterStatement &statement : statements)
      if (const DeclaredParameter *parameter = declarations.find(statement.path))
        assign(*parameter, statement);

    parameters.check();
    if (parameters.goal == AccuracyGoal::as_given)
      return parameters;
    std::map<std::string, std::string> given;
    for (const ParameterStatement &statement : statements)
      if (const DeclaredParameter *parameter = declarations.find(statement.path))
        given[statement.path] = parameter->print();
    parameters = with_goal(parameters);
    for (const auto &[path, value] : given)
      if (declarations.find(path)->print() != value)
        parameters.replaced.push_back(path);
    parameters.check();
    return parameters;
  }

  void Parameters::set(const std::string &path, const std::string &where, const std::function<std::string(const std::string &)> &new_value)
  {
    Declarations declarations;
    declare(declarations);
    check_name({path, "", where}, known_names(declarations));
    const DeclaredParameter *parameter = declarations.find(path);
    if (parameter == nullptr)
      throw ParameterError(in_quotes(path) + " is a section", where, "name a parameter of this section");
    const std::string value = new_value(parameter->print());
    if (path == "Geometry/File")
      geometry.set_file(value, geometry.directory);
    assign(*parameter, {path, value, where});
  }

  void Parameters::print(std::ostream &stream, const bool with_documentation) const
  {
    Parameters   copy = *this;
    Declarations declarations;
    copy.declare(declarations);

    using dealii::ParameterHandler;
    ParameterHandler prm;
    for (const auto &[path, documentation, accepted, value, parse] : declarations.parameters())
      {
        const auto slash = path.find('/');
        if (slash != std::string::npos)
          prm.enter_subsection(path.substr(0, slash));
        prm.declare_entry(path.substr(slash + 1), written_value(value()), dealii::Patterns::Anything(),
                          documentation + (accepted.empty() ? "" : " Accepts " + accepted + "."));
        if (slash != std::string::npos)
          prm.leave_subsection();
      }
    prm.print_parameters(
      stream, static_cast<ParameterHandler::OutputStyle>((with_documentation ? ParameterHandler::PRM : ParameterHandler::ShortPRM) |
                                                         ParameterHandler::KeepDeclarationOrder));
  }

  bool Parameters::needs_steady_sliding() const
  {
    return sliding.state == ContactState::steady_sliding;
  }

  bool Parameters::has_contact_damping() const
  {
    return operation.has_contact_damping();
  }

  bool Parameters::has_friction() const
  {
    return reduction.problem == ReductionProblem::friction || system || !study->has("Reduction/Problem");
  }

  bool Parameters::maps_rotation() const
  {
    return operation.rotating_disc && sweep.map_parameter == MapParameter::speed && study->has("Sweep/Map parameter");
  }

  bool Parameters::solves_by(const ComplexSolver solver) const
  {
    return has_friction() && solvers.complex_solver == solver;
  }

  bool Parameters::uses_load_per_side() const
  {
    const bool by_side = sliding.control == BackplateControl::load_per_side || sliding.control == BackplateControl::pressure;
    return needs_steady_sliding() ? by_side : has_contact_damping();
  }

  void Parameters::check_contact_state() const
  {
    const bool is_steady = needs_steady_sliding();
    if (is_steady)
      sliding.check_steady();
    if (uses_load_per_side() && !(operation.load_per_side > 0.))
      throw ParameterError("contact damping and steady sliding require a positive load, but the load is zero",
                           "parameter Operation/Load per side",
                           "give a positive load, or set Operation/Radial dissipation = none, Operation/Friction slope = 0 and Steady "
                           "sliding/Contact state = equal load");
    if ((is_steady || has_contact_damping()) && !(operation.rotation_speed > 0.))
      throw ParameterError("contact damping and steady sliding require a sliding speed, but the disc does not turn",
                           "parameter Operation/Rotation speed",
                           "give a positive speed, or set Operation/Radial dissipation = none, Operation/Friction slope = 0 and Steady "
                           "sliding/Contact state = equal load");
  }

  void Parameters::check_damping_in_band() const
  {
    // Keep −1/β outside the search radius: one real λ of each overdamped wave (β ω > 2) approaches −1/β as ω increases
    const double radius = clear_of_accumulation * discretization.band().radius();
    for (const auto &[section, material] : materials.all())
      if (const double beta = material.rayleigh_beta; beta * radius >= 1.)
        throw ParameterError("stiffness-proportional damping of " + exact_text(beta) +
                               " s makes real eigenvalues of overdamped waves accumulate at -1/beta = " + exact_text(-1. / beta) +
                               " 1/s, too close to the band",
                             "parameter " + section + "/Rayleigh beta",
                             text("give less than ", 1. / radius, " s; or lower Band/Maximum frequency below ",
                                  hertz(circular_frequency(discretization.maximum_frequency) / (beta * radius)),
                                  " Hz, and Band/Maximum rate by the same factor; or set Damping/Modal damping ratio instead"));

    // Keep real λ of overdamped waves (α > 2 ω), about −ω²/α, out of the band if the mesh does not resolve these waves
    for (const auto &[section, material] : materials.all())
      if (const double alpha = material.rayleigh_alpha; alpha > most_damping_by_mass * radius)
        throw ParameterError("mass-proportional damping of " + exact_text(alpha) +
                               " 1/s moves real eigenvalues -omega^2/alpha of waves above the band into the band",
                             "parameter " + section + "/Rayleigh alpha",
                             text("give at most ", most_damping_by_mass * radius, " 1/s, or set Damping/Modal damping ratio instead"));
  }

  void Parameters::check() const
  {
    if (output.write_system != SystemOutput::none && !study->has("Output/Write system"))
      throw ParameterError(text("Study = ", study->name, " does not write a system"), "parameter Output/Write system",
                           "set Output/Write system = none; to write the system of one model, run this model with Study = stability");
    if (output.write_system == SystemOutput::reduced && !study->has_reduced_model)
      throw ParameterError(text("Study = ", study->name, " has no reduced model to write"), "parameter Output/Write system",
                           "set Output/Write system = full, or set Study = sweep, robustness or reduction");
    if (system)
      {
        if (study->run_of_system == nullptr)
          throw ParameterError(
            text("Study = ", study->name, " requires a mesh"), "parameter System",
            "set Study = stability, reduction, sweep, sensitivity, geometry, search, robustness or updating, or leave System empty");
        if (goal != AccuracyGoal::as_given)
          throw ParameterError("Accuracy selects a mesh, but the parameter System replaces the mesh", "parameter Accuracy",
                               "set Accuracy = as given, or leave System empty");
        discretization.check();
        reduction.check_of_system();
        sweep.check_of_system();
        search.check();
        return;
      }
    geometry.check();
    contact.check();
    materials.check();
    discretization.check();
    operation.check();
    check_contact_state();
    damping.check();
    reduction.check();
    sweep.check();
    ingredients.check();
    accuracy.check();
    search.check();
    if (study->check != nullptr)
      study->check(*this);
    if (goal == AccuracyGoal::as_given && !discretization.coarser_mesh.empty())
      with_coarser_mesh(*this).check();
    check_damping_in_band();
  }
} // namespace Squeal
