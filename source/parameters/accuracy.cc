#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/accuracy.h>

#include <deal.II/base/utilities.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <set>

namespace Squeal
{
  namespace
  {
    std::vector<std::string> split(const std::string &text)
    {
      std::vector<std::string> names = dealii::Utilities::split_string_list(text, ',');
      names.erase(std::remove(names.begin(), names.end(), ""), names.end());
      return names;
    }

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
                throw ParameterError("Accuracy study/" + name + " names " + in_quotes(entry) + ", which is none of " +
                                       boost::algorithm::join(known, ", "),
                                     "", "choose among these, separated by commas");
              read.push_back(enum_value<Enum>(entry));
            }
          values = read;
        });
    }

    template <typename Value>
    void check_list(const std::vector<Value> &values, const char *name)
    {
      if (values.empty())
        throw ParameterError(text("Accuracy study/", name, " is empty"), text("parameter Accuracy study/", name), "give at least one");
      if (std::set<Value>(values.begin(), values.end()).size() < values.size())
        throw ParameterError(text("Accuracy study/", name, " has an entry twice"), text("parameter Accuracy study/", name),
                             "give each once");
    }
  } // namespace

  void AccuracyStudyParameters::declare(Declarations &declarations)
  {
    declarations.enter("Accuracy study");
    declarations.add("Mesh factors", factors,
                     "How many times as fine as the mesh of the section Geometry the meshes are, in every direction, separated by commas: "
                     "element size, layers and nodes per pin face follow. Two or more; three give an order of convergence. Units: none.",
                     {0.1, 10.}, 20);
    add_list(declarations, "Elements", elements, "Elements that are compared.");
    add_list(declarations, "Outlines", outlines, "Outlines of meshes with straight edges; quadratic elements follow the circles.");
    declarations.add_text(
      "Bases", "Names of reduced bases that are measured beside full order, separated by commas, as in the section Reduction; empty: none.",
      [this] { return boost::algorithm::join(bases, ", "); }, [this](const std::string &text) { bases = split(text); });
    declarations.add("Grown tolerance", grown_tolerance,
                     "Bases `residual-grown`: estimated relative error of lambda at which they stop to grow. Units: none.", {1e-11, 1e-1});
    declarations.add("Largest number of dofs", largest_dofs, "Meshes with more dofs are left out. Units: none.", {1.});
    declarations.add(
      "Band margin", margin,
      "Part of the band by which all modes are found beyond its end, so that modes of coarse meshes, whose frequencies are too "
      "high, do not lack partners. Units: none.",
      {0., 1.});
  }

  void AccuracyStudyParameters::check() const
  {
    check_list(factors, "Mesh factors");
    check_list(elements, "Elements");
    check_list(outlines, "Outlines");
    if (factors.size() < 2)
      throw ParameterError("Accuracy study/Mesh factors has one entry: without a second mesh no error is known",
                           "parameter Accuracy study/Mesh factors", "give two or more; three show the order of convergence");
  }
} // namespace Squeal
