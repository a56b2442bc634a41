#include <squeal/base/exceptions.h>
#include <squeal/parameters/enum_parameter.h>
#include <squeal/parameters/parameters.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <sstream>

namespace Squeal
{
  namespace
  {
    /// One `set` or `subsection` line of a parameter file.
    struct Entry
    {
      std::string path; ///< "Section/Name"; a section ends in "/"
      std::string where;
    };

    /// Collapses runs of blanks, as ParameterHandler does.
    std::string normalize(const std::string &text)
    {
      std::istringstream stream(text);
      std::string        word, result;
      while (stream >> word)
        result += (result.empty() ? "" : " ") + word;
      return result;
    }

    /// Names that a parameter file sets or enters; values are left to ParameterHandler.
    std::vector<Entry> scan_names(std::istream &stream, const std::string &file)
    {
      std::vector<Entry>       entries;
      std::vector<std::string> sections;
      const auto path = [&](const std::string &name) {
        std::string result;
        for (const std::string &section : sections)
          result += section + "/";
        return result + name;
      };

      std::string line;
      for (unsigned int number = 1; std::getline(stream, line); ++number)
        {
          const std::string text  = normalize(line.substr(0, line.find('#')));
          const std::string where = "file " + file + ", line " + std::to_string(number);
          const std::string key   = text.substr(0, text.find(' '));
          const std::string rest  = text.size() > key.size() ? text.substr(key.size() + 1) : "";
          if (key == "subsection")
            {
              sections.push_back(rest);
              entries.push_back({path(""), where});
            }
          else if (key == "end" && !sections.empty())
            sections.pop_back();
          else if (key == "set")
            entries.push_back({path(normalize(rest.substr(0, rest.find('=')))), where});
        }
      return entries;
    }

    /// Levenshtein distance without regard to case.
    unsigned int edit_distance(const std::string &a, const std::string &b)
    {
      std::vector<unsigned int> row(b.size() + 1);
      std::iota(row.begin(), row.end(), 0);
      for (unsigned int i = 0; i < a.size(); ++i)
        {
          unsigned int diagonal = row[0];
          row[0]                = i + 1;
          for (unsigned int j = 0; j < b.size(); ++j)
            {
              const unsigned int substitution = diagonal + (std::tolower(a[i]) != std::tolower(b[j]));
              diagonal                        = row[j + 1];
              row[j + 1]                      = std::min({row[j] + 1, row[j + 1] + 1, substitution});
            }
        }
      return row[b.size()];
    }

    /// The words of a name.
    std::vector<std::string> words(const std::string &name)
    {
      std::istringstream       stream(name);
      std::vector<std::string> result;
      for (std::string word; stream >> word;)
        result.push_back(word);
      return result;
    }

    /**
     * Edits that lead from one name to another, words compared with their best counterparts: words may be left out,
     * exchanged or cut short, each at the price of one edit.
     */
    unsigned int word_distance(const std::string &written, const std::string &name)
    {
      const auto   written_words = words(written), name_words = words(name);
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

    /// Edits between two paths; a wrong section counts little, so that the right name in the wrong section is found.
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
      return wrong_section * distance(written_name, candidate_name) +
             std::min(distance(written_section, candidate_section), wrong_section);
    }

    /// Refuses a name that was not declared.
    void check_name(const Entry &entry, const std::vector<std::string> &known)
    {
      if (std::find(known.begin(), known.end(), entry.path) != known.end())
        return;
      const bool   is_section = entry.path.back() == '/';
      std::string  nearest;
      unsigned int smallest = -1;
      for (const std::string &candidate : known)
        if ((candidate.back() == '/') == is_section)
          if (const unsigned int distance = path_distance(entry.path, candidate); distance < smallest)
            {
              smallest = distance;
              nearest  = candidate;
            }
      throw ParameterError(std::string("unknown ") + (is_section ? "section `" : "parameter `") + entry.path + "`", entry.where,
                           "the nearest known name is `" + nearest + "`; squeal --print-parameters lists all");
    }

    void add_parameters(dealii::ParameterHandler &prm, Parameters &parameters)
    {
      add_enum_parameter(prm, "Study", parameters.study, "The question that the run answers.");
      parameters.geometry.add_parameters(prm);
      parameters.materials.add_parameters(prm);
      parameters.discretization.add_parameters(prm);
      parameters.operation.add_parameters(prm);
      parameters.sliding.add_parameters(prm);
      parameters.damping.add_parameters(prm);
      parameters.reduction.add_parameters(prm);
      parameters.sweep.add_parameters(prm);
      parameters.solvers.add_parameters(prm);
      parameters.output.add_parameters(prm);
    }

    std::vector<std::string> known_names(const dealii::ParameterHandler &prm)
    {
      std::stringstream text;
      prm.print_parameters(text, dealii::ParameterHandler::ShortPRM);
      std::vector<std::string> names;
      for (const Entry &entry : scan_names(text, ""))
        names.push_back(entry.path);
      return names;
    }

    /// What deal.II says of a refused value, without its banner.
    std::string short_message(const dealii::ExceptionBase &exception)
    {
      std::ostringstream text;
      exception.print_info(text);
      return normalize(text.str());
    }

    void apply_override(dealii::ParameterHandler &prm, const std::vector<std::string> &known, const std::string &text)
    {
      const auto        equal = text.find('=');
      const std::string where = "--set \"" + text + "\"";
      if (equal == std::string::npos)
        throw ParameterError("an override has no `=`", where, "write --set \"Section/Name=value\"");
      const std::string path = normalize(text.substr(0, equal));
      check_name({path, where}, known);
      auto parts = dealii::Utilities::split_string_list(path, '/');
      for (unsigned int i = 0; i + 1 < parts.size(); ++i)
        prm.enter_subsection(parts[i]);
      try
        {
          prm.set(parts.back(), dealii::Utilities::trim(text.substr(equal + 1)));
        }
      catch (const dealii::ExceptionBase &exception)
        {
          throw ParameterError(short_message(exception), where, "give a value of the kind that --print-parameters describes");
        }
      for (unsigned int i = 0; i + 1 < parts.size(); ++i)
        prm.leave_subsection();
    }
  } // namespace

  namespace
  {
    /// Geometry/File as file and overrides give it, read ahead because the variables of a geometry are parameters, too.
    std::string geometry_file(const std::string &file, const std::vector<std::string> &overrides)
    {
      GeometryParameters       geometry;
      dealii::ParameterHandler prm;
      geometry.add_parameters(prm);
      try
        {
          prm.parse_input(file, "", /* skip_undefined */ true);
        }
      catch (const dealii::ExceptionBase &)
        {} // what is wrong is said where all of the file is read
      for (const std::string &text : overrides)
        if (const auto equal = text.find('='); equal != std::string::npos && normalize(text.substr(0, equal)) == "Geometry/File")
          geometry.file = dealii::Utilities::trim(text.substr(equal + 1));
      return geometry.file;
    }
  } // namespace

  Parameters Parameters::read(const std::string &file, const std::vector<std::string> &overrides)
  {
    Parameters               parameters;
    parameters.geometry.set_file(geometry_file(file, overrides), std::filesystem::path(file).parent_path().string());
    dealii::ParameterHandler prm;
    add_parameters(prm, parameters);
    const std::vector<std::string> known = known_names(prm);

    std::ifstream stream(file);
    if (!stream)
      throw FileError("the parameter file cannot be read", "file " + file, "check its name and permissions");
    for (const Entry &entry : scan_names(stream, file))
      check_name(entry, known);
    try
      {
        prm.parse_input(file);
      }
    catch (const dealii::ExceptionBase &exception)
      {
        throw ParameterError(short_message(exception), "file " + file, "squeal --print-parameters lists every parameter with its kind");
      }
    for (const std::string &text : overrides)
      apply_override(prm, known, text);

    parameters.check();
    return parameters;
  }

  void Parameters::print(std::ostream &stream, const bool with_documentation) const
  {
    Parameters               copy = *this;
    dealii::ParameterHandler prm;
    add_parameters(prm, copy);
    const auto style = with_documentation ? dealii::ParameterHandler::PRM : dealii::ParameterHandler::ShortPRM;
    prm.print_parameters(stream, static_cast<dealii::ParameterHandler::OutputStyle>(style | dealii::ParameterHandler::KeepDeclarationOrder));
  }

  bool Parameters::needs_steady_sliding() const
  {
    return sliding.state == ContactState::steady_sliding || study == Study::dissipation;
  }

  void Parameters::check_contact_state() const
  {
    const bool is_steady = needs_steady_sliding();
    if (is_steady)
      sliding.check_steady();
    // The study of dissipation turns it on whatever the operation says
    const bool has_contact_damping =
      operation.radial_dissipation != RadialDissipation::none || operation.friction_slope != 0. || study == Study::dissipation;
    const bool uses_load = (!is_steady && has_contact_damping) || study == Study::dissipation ||
                           (is_steady && sliding.control == BackplateControl::load_per_side);
    if (uses_load && !(operation.load_per_side > 0.))
      throw ParameterError("contact damping and steady sliding need a contact force, but the load is zero", "parameter Operation/Load per side",
                           "give a positive load; or set Operation/Radial dissipation = none, Operation/Friction slope = 0 and "
                           "Steady sliding/Contact state = equal load");
    if ((is_steady || has_contact_damping) && !(operation.rotation_speed > 0.))
      throw ParameterError("the disc does not turn: nothing slides steadily, and contact damping has no sliding speed",
                           "parameter Operation/Rotation speed",
                           "give a positive speed; or set Operation/Radial dissipation = none, Operation/Friction slope = 0 and "
                           "Steady sliding/Contact state = equal load");
  }

  void Parameters::check_map() const
  {
    if (study != Study::sweep || sweep.map_parameter == MapParameter::none)
      return;
    const bool is_steady = needs_steady_sliding();
    if (operation.radial_dissipation == RadialDissipation::none && operation.friction_slope == 0. &&
        !(is_steady && sweep.map_parameter == MapParameter::load))
      throw ParameterError("without contact damping nothing depends on the " + to_string(sweep.map_parameter), "parameter Sweep/Map parameter",
                           "set Operation/Radial dissipation or Operation/Friction slope, or Sweep/Map parameter = none");
    if (is_steady && sweep.map_parameter == MapParameter::load && sliding.control != BackplateControl::load_per_side)
      throw ParameterError("a map over the load needs backplates that are pressed with it", "parameter Steady sliding/Control",
                           "set it to load per side, or Sweep/Map parameter = none");
  }

  void Parameters::check() const
  {
    geometry.check();
    materials.check();
    discretization.check();
    check_contact_state();
    damping.check();
    reduction.check();
    sweep.check();
    check_map();
    solvers.check();
  }
} // namespace Squeal
