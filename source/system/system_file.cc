// SPDX-License-Identifier: GPL-3.0-or-later

#include "system_format.h"

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/matrix_market.h>
#include <squeal/system/expression.h>
#include <squeal/system/system_file.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>

namespace Squeal
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    /// Largest entry of (A − Aᵀ)/2 for a symmetric matrix, or of (A + Aᵀ)/2 for a skew matrix, relative to the largest entry of A [-].
    constexpr double symmetry_tolerance = 1e-12;

    /// Number of values in the range of each parameter at which the coefficients are checked.
    constexpr int n_samples = 65;

    /// A JSON value with its position in the file, for messages.
    class JsonEntry
    {
    public:
      JsonEntry(const Json &json, std::string file, std::string place)
        : json(json)
        , file(std::move(file))
        , place(std::move(place))
      {}

      [[noreturn]] void refuse(const std::string &what, const std::string &change) const
      {
        throw FileError(what, "file " + file + (place.empty() ? "" : ", entry " + place), change);
      }

      bool has(const char *key) const
      {
        return json.contains(key);
      }

      JsonEntry operator[](const std::string &key) const
      {
        if (!json.is_object() || !json.contains(key))
          refuse("`" + key + "` is missing", "add this key; doc/systems.md shows an example");
        return {json[key], file, place.empty() ? key : place + "." + key};
      }

      template <typename Value>
      Value as(const char *what) const
      {
        try
          {
            return json.get<Value>();
          }
        catch (const nlohmann::json::exception &)
          {
            refuse(text(in_quotes(json.dump()), " is not ", what), text("write ", what));
          }
      }

      int integer() const
      {
        if (!json.is_number_integer() || json.get<double>() < 0. || json.get<double>() > std::numeric_limits<int>::max())
          refuse(in_quotes(json.dump()) + " is not an integer from 0 to 2147483647", "write such an integer");
        return json.get<int>();
      }

      double number() const
      {
        const double value = json.is_number() ? json.get<double>() : NAN;
        if (!std::isfinite(value))
          refuse(in_quotes(json.dump()) + " is not a finite number", "write a number");
        return value;
      }

      std::string text_or(const char *key, const std::string &otherwise) const
      {
        return has(key) ? (*this)[key].as<std::string>("a string") : otherwise;
      }

      /// Elements of a list, or members of an object with their names.
      std::vector<std::pair<std::string, JsonEntry>> members(const bool named) const
      {
        if (named ? !json.is_object() : !json.is_array())
          refuse(named ? "the entry is not an object with named members" : "the entry is not a list",
                 named ? "write {\"name\": ...}" : "write [...]");
        std::vector<std::pair<std::string, JsonEntry>> result;
        std::size_t                                    i = 0;
        for (const auto &[key, value] : json.items())
          {
            const std::string name = named ? key : std::to_string(++i);
            result.emplace_back(name, JsonEntry(value, file, named ? place + "." + name : place + "[" + name + "]"));
          }
        return result;
      }

      /// Throws FileError for unknown keys, so that misspelt keys are not ignored.
      void check_keys(const std::set<std::string> &known) const
      {
        if (!json.is_object())
          refuse("the entry is not an object", "write {...}");
        for (const auto &[key, value] : json.items())
          if (known.count(key) == 0)
            {
              std::string names;
              for (const std::string &name : known)
                names += (names.empty() ? "" : ", ") + name;
              refuse(text("unknown key ", in_quotes(key)), "use one of the known keys: " + names);
            }
      }

    private:
      const Json &json;
      std::string file, place;
    };

    /// Parses JSON text, and rejects duplicate keys in an object because only one of them would be used.
    Json parsed(std::istream &stream, const std::string &file)
    {
      std::vector<std::set<std::string>> keys; // keys of the objects that are still open
      return Json::parse(stream, [&](int, const Json::parse_event_t event, const Json &value) {
        if (event == Json::parse_event_t::object_start)
          keys.emplace_back();
        else if (event == Json::parse_event_t::object_end)
          keys.pop_back();
        else if (event == Json::parse_event_t::key && !keys.back().insert(value.get<std::string>()).second)
          throw FileError(text("an object contains the key ", in_quotes(value.get<std::string>()), " twice"), "file " + file,
                          "remove one of the two entries");
        return true;
      });
    }

    std::vector<FileParameter> read_parameters(const JsonEntry &entries)
    {
      std::vector<FileParameter> result;
      for (const auto &[name, entry] : entries.members(true))
        {
          entry.check_keys({"value", "lower", "upper", "unit", "description"});
          if (!is_parameter_name(name))
            entry.refuse(in_quotes(name) + " cannot be the name of a parameter", "begin with a letter and use only letters, digits and _");
          FileParameter parameter{name, entry["value"].number()};
          parameter.lower       = entry.has("lower") ? entry["lower"].number() : parameter.value;
          parameter.upper       = entry.has("upper") ? entry["upper"].number() : parameter.value;
          parameter.unit        = entry.text_or("unit", "-");
          parameter.description = entry.text_or("description", "");
          if (!(parameter.lower <= parameter.value && parameter.value <= parameter.upper))
            entry.refuse(text("the value ", exact_text(parameter.value), " is not in the range from ", exact_text(parameter.lower), " to ",
                              exact_text(parameter.upper)),
                         "widen the range or change the value");
          result.push_back(parameter);
        }
      return result;
    }

    /// Reader of terms; matrices that several terms share are read once.
    class TermReader
    {
    public:
      TermReader(SystemFile &system, const MPI_Comm communicator)
        : system(system)
        , communicator(communicator)
        , folder(std::filesystem::path(system.path).parent_path())
      {
        for (const FileParameter &parameter : system.parameters)
          names.push_back(parameter.name);
      }

      void read(const JsonEntry &entry)
      {
        entry.check_keys({"name", "power", "coefficient", "matrix", "symmetry", "left", "right", "weights", "kind"});
        Term term;
        term.name  = entry.has("name") ? entry["name"].as<std::string>("a string") :
                                         entry[entry.has("matrix") ? "matrix" : "left"].as<std::string>("a string");
        term.power = entry["power"].integer();
        if (term.power < 0 || term.power > 2)
          entry["power"].refuse("the power of lambda is " + std::to_string(term.power) + ", not 0, 1 or 2", "write 0, 1 or 2");
        const std::string kind = entry.text_or("kind", "body");
        if (const auto kinds = enum_names<TermKind>(); std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
          entry["kind"].refuse("unknown kind " + in_quotes(kind), "remove this key");
        term.kind        = enum_value<TermKind>(kind);
        term.coefficient = coefficient(entry);
        if (entry.has("matrix"))
          for (const char *of_factors : {"left", "right", "weights"})
            if (entry.has(of_factors))
              entry[of_factors].refuse("the term has both a matrix and low-rank factors or weights",
                                       "remove either the matrix or left, right and weights");
        if (entry.has("matrix"))
          read_matrix(entry, term);
        else
          read_factors(entry, term);
      }

      /// `positions` of points and their `displacements`; by default, point i has the dofs 3i − 2, 3i − 1 and 3i.
      ShapePoints read_points(const JsonEntry &root) const
      {
        const JsonEntry  entry     = root["positions"];
        const SparseRows positions = read_matrix_file(entry);
        const int        n_points = static_cast<int>(positions.rows()), n = system.map.n();
        if (positions.cols() != 3 || n_points == 0)
          entry.refuse(text("the matrix of positions is ", n_points, " x ", positions.cols(), ", not n x 3 with n > 0"),
                       "give a row with x, y and z for each point");
        if (!root.has("displacements") && 3 * n_points != n)
          entry.refuse(
            text(counted(n_points, "point has ", "points have "), 3 * n_points, " displacements, but the system has ", counted(n, "dof")),
            "give `displacements`, the matrix from dofs to displacements of the points");
        ShapePoints  result{positions, nullptr};
        const RowMap rows = ShapePoints::rows_of(n_points, communicator);
        if (root.has("displacements"))
          {
            const JsonEntry  file = root["displacements"];
            const SparseRows T    = read_matrix_file(file);
            if (T.rows() != 3 * positions.rows() || T.cols() != n)
              file.refuse(text("the matrix is ", T.rows(), " x ", T.cols(), ", not ", 3 * n_points, " x ", n),
                          "give rows for x, y and z of each point, and a column for each dof");
            result.displacements = std::make_shared<SparseMatrix>(rows, system.map, SparseRows(T.middleRows(rows.first(), rows.n_local())));
            if (!(max_norm(*result.displacements) > 0.))
              file.refuse("all entries are zero, so that no dof moves a point",
                          "correct the matrix, or remove `positions` and `displacements`");
          }
        else
          result.displacements = std::make_shared<SparseMatrix>(
            rows, system.map, [&](const int i, SparseMatrix::Row &row) { row.emplace_back(rows.number(i), 1.); });
        return result;
      }

    private:
      Coefficient coefficient(const JsonEntry &entry) const
      {
        const std::string expression = entry.text_or("coefficient", "1");
        Coefficient       result;
        try
          {
            result = parsed_coefficient(expression, names);
          }
        catch (const ParameterError &error)
          {
            entry["coefficient"].refuse(error.reason, error.change);
          }
        // Vary each parameter over its range, with the other parameters at their values in the file
        const auto check = [&](const ParameterValues &values) {
          if (std::isfinite(result.at(values)))
            return;
          std::string at;
          for (const std::string &name : names)
            if (result.contains(name))
              at += text(at.empty() ? "" : ", ", name, " = ", values.at(name).front());
          entry["coefficient"].refuse(text(in_quotes(expression), " is not finite", at.empty() ? "" : " at ", at),
                                      "change the values or ranges of the parameters, or correct the expression");
        };
        const ParameterValues values = system.values();
        check(values);
        for (const FileParameter &parameter : system.parameters)
          {
            ParameterValues sample = values;
            double         &value  = sample.at(parameter.name).front();
            for (int i = 0; i < n_samples; ++i)
              {
                value = parameter.lower + (parameter.upper - parameter.lower) * i / (n_samples - 1.);
                check(sample);
              }
            if (parameter.lower < 0. && parameter.upper > 0.)
              {
                value = 0.;
                check(sample);
              }
          }
        return result;
      }

      SparseRows read_matrix_file(const JsonEntry &entry) const
      {
        const std::string           name = entry.as<std::string>("the name of a file");
        const std::filesystem::path path = folder / name;
        if (!std::filesystem::is_regular_file(path))
          entry.refuse("there is no file " + in_quotes(path.string()), "write the matrix to this file, or correct the name");
        return read_matrix_market(path.string());
      }

      /// All entries of a matrix or factor; each file is read once.
      const SparseRows &entries_of(const JsonEntry &file)
      {
        const std::string name = file.as<std::string>("the name of a file");
        if (const auto known = read_files.find(name); known != read_files.end())
          return known->second;
        const SparseRows &result = read_files.emplace(name, read_matrix_file(file)).first->second;
        if (system.map.n() == 0 && result.rows() > 0)
          {
            system.map = RowMap::even(static_cast<int>(result.rows()), communicator);
            size_from  = name;
          }
        if (result.rows() != system.map.n())
          file.refuse(text(in_quotes(name), " has ", result.rows(), " rows, but ", in_quotes(size_from), " has ", system.map.n()),
                      "give all matrices the same number of rows");
        return result;
      }

      void read_matrix(const JsonEntry &entry, Term term)
      {
        const JsonEntry   file = entry["matrix"];
        const SparseRows &A    = entries_of(file);
        if (A.cols() != A.rows())
          file.refuse(text("the matrix is ", A.rows(), " x ", A.cols(), ", not square"), "give a square matrix");
        term.matrix =
          std::make_shared<SparseMatrix>(system.map, system.map, SparseRows(A.middleRows(system.map.first(), system.map.n_local())));
        const double      size  = max_norm(*term.matrix);
        const std::string claim = entry.text_or("symmetry", "none");
        if (claim != "symmetric" && claim != "skew" && claim != "none")
          entry["symmetry"].refuse("unknown symmetry " + in_quotes(claim), "write symmetric, skew or none");
        std::vector<Term> parts = split_by_symmetry(term);
        for (Term &part : parts)
          {
            if (parts.size() == 2 && term.kind == TermKind::body)
              part.kind = TermKind::circulatory;
            const double defect = max_norm(*part.matrix);
            if (claim == "none" || claim == to_string(part.symmetry))
              system.terms.push_back(std::move(part));
            else if (defect > symmetry_tolerance * size)
              entry["symmetry"].refuse(text("the matrix is not ", claim, ": the entries of its ", to_string(part.symmetry), " part reach ",
                                            defect, ", and its largest entry is ", size),
                                       "correct the matrix, or set the symmetry to none");
          }
      }

      void read_factors(const JsonEntry &entry, Term term)
      {
        const JsonEntry left = entry["left"], right = entry["right"];
        const auto      factor = [&](const JsonEntry &file) {
          const std::string name = file.as<std::string>("the name of a file");
          if (const auto known = factors.find(name); known != factors.end())
            return known->second;
          const SparseRows transpose = entries_of(file).transpose();
          const RowMap     map       = RowMap::even(static_cast<int>(transpose.rows()), communicator);
          const auto       result    = std::make_shared<LowRankFactor>(
            std::make_shared<SparseMatrix>(map, system.map, SparseRows(transpose.middleRows(map.first(), map.n_local()))));
          factors.emplace(name, result);
          return std::shared_ptr<const LowRankFactor>(result);
        };
        term.left  = factor(left);
        term.right = factor(right);
        if (term.left->rank() != term.right->rank())
          right.refuse(
            text("the right factor has ", counted(term.right->rank(), "column"), ", but the left factor has ", term.left->rank()),
            "give both factors the same number of columns");
        if (entry.has("weights"))
          {
            const JsonEntry   file = entry["weights"];
            const std::string name = file.as<std::string>("the name of a file");
            const SparseRows  d    = read_matrix_file(file);
            if (d.rows() != term.left->rank() || d.cols() != 1)
              file.refuse(text("the weights are ", d.rows(), " x ", d.cols(), ", not ", term.left->rank(), " x 1"),
                          "give one weight for each column of the factors");
            term.weights  = "weights " + name;
            auto &weights = system.weights[term.weights];
            weights.assign(d.rows(), 0.);
            for (int i = 0; i < d.rows(); ++i)
              weights[i] = d.coeff(i, 0);
          }
        system.terms.push_back(term);
      }

      SystemFile                                                 &system;
      const MPI_Comm                                              communicator;
      const std::filesystem::path                                 folder;
      std::vector<std::string>                                    names;
      std::map<std::string, SparseRows>                           read_files;
      std::map<std::string, std::shared_ptr<const LowRankFactor>> factors;
      std::string                                                 size_from; ///< file that gave the number of dofs
    };

    std::vector<DofGroup> read_groups(const JsonEntry &entries, const int n)
    {
      std::vector<DofGroup> result;
      for (const auto &[name, entry] : entries.members(true))
        {
          result.push_back({name, {}});
          std::vector<bool> is_known(n, false);
          for (const auto &[number, range] : entry.members(false))
            {
              std::vector<int> ends;
              for (const auto &[place, end] : range.members(false))
                ends.push_back(end.integer());
              if (ends.size() != 2 || ends[0] < 1 || ends[0] > ends[1] || ends[1] > n)
                range.refuse(text("the entry is not a range of dofs from 1 to ", n), "write [first, last] with first <= last");
              for (int dof = ends[0] - 1; dof < ends[1]; ++dof)
                {
                  if (is_known[dof])
                    range.refuse(text("dof ", dof + 1, " is in the group twice"), "give ranges that do not overlap");
                  is_known[dof] = true;
                }
              result.back().ranges.emplace_back(ends[0] - 1, ends[1] - 1);
            }
          if (result.back().ranges.empty())
            entry.refuse("the group has no dofs", "give ranges of dofs, [[first, last], ...]");
        }
      return result;
    }

    /// Throws FileError if a dof has no nonzero entry in any matrix, or if there is no mass.
    void check_terms(const SystemFile &system, const JsonEntry &terms)
    {
      DenseMatrix sizes = DenseMatrix::Zero(system.map.n_local(), 1);
      double      mass  = 0.;
      for (const Term &term : system.terms)
        {
          SparseMatrix::Row row;
          double            largest = 0.;
          const auto        add     = [&](const SparseMatrix &A, const bool by_columns) {
            const MultiVector ones = [&] {
              MultiVector result(by_columns ? A.rows() : A.columns(), 1);
              result.local().setOnes();
              return result;
            }();
            const auto        abs  = moduli(A);
            const MultiVector sums = by_columns ? transpose_times(*abs, ones) : *abs * ones;
            sizes += sums.local();
            largest = std::max(largest, max_norm(A));
          };
          if (term.matrix)
            add(*term.matrix, false);
          else
            for (const auto &factor : {term.left, term.right})
              add(*factor->sparse_transpose(), true);
          if (term.power == 2)
            mass = std::max(mass, largest);
        }
      if (!(mass > 0.))
        terms.refuse("there is no mass: no term with power 2 has nonzero entries", "add the mass matrix as a term with power 2");
      int empty = system.map.n();
      for (int i = system.map.n_local() - 1; i >= 0; --i)
        if (sizes(i, 0) == 0.)
          empty = system.map.number(i);
      empty = -static_cast<int>(largest_of_processes(system.map.communicator(), -empty));
      if (empty < system.map.n())
        terms.refuse(text("dof ", empty + 1, " has no nonzero entry in any matrix: det Q(lambda) vanishes for all lambda"),
                     "remove its row and column from all matrices");
    }
  } // namespace

  const FileParameter *SystemFile::find(const std::string &parameter) const
  {
    const auto found =
      std::find_if(parameters.begin(), parameters.end(), [&](const FileParameter &known) { return known.name == parameter; });
    return found == parameters.end() ? nullptr : &*found;
  }

  std::string SystemFile::default_varied() const
  {
    return find("mu") != nullptr ? "mu" : parameters.empty() ? "" : parameters.front().name;
  }

  ParameterValues SystemFile::values(const std::map<std::string, double> &others) const
  {
    for (const auto &[name, value] : others)
      {
        const FileParameter *parameter = find(name);
        if (parameter == nullptr)
          {
            std::string known;
            for (const FileParameter &one : parameters)
              known += (known.empty() ? "" : ", ") + one.name;
            throw ParameterError("the system has no parameter " + in_quotes(name), "file " + path,
                                 known.empty() ? "remove this parameter; the system has no parameters" :
                                                 "use a parameter of the system: " + known);
          }
        if (!(parameter->lower <= value && value <= parameter->upper))
          throw ParameterError(text(name, " = ", exact_text(value), " is outside its range from ", exact_text(parameter->lower), " to ",
                                    exact_text(parameter->upper)),
                               "file " + path, "choose a value in the range, or widen the range in the file if the system is valid there");
      }
    ParameterValues result = weights;
    for (const FileParameter &parameter : parameters)
      {
        const auto other       = others.find(parameter.name);
        result[parameter.name] = {other == others.end() ? parameter.value : other->second};
      }
    for (const Term &term : terms)
      if (!std::isfinite(term.coefficient.at(result)))
        {
          std::string at;
          for (const FileParameter &parameter : parameters)
            at += (at.empty() ? "" : ", ") + parameter.name + " = " + exact_text(result.at(parameter.name).front());
          throw ParameterError("the coefficient " + in_quotes(term.coefficient.text()) + " of " + in_quotes(term.name) +
                                 " is not finite at " + at,
                               "file " + path, "narrow the ranges of the parameters, or correct the coefficient");
        }
    return result;
  }

  SystemFile read_system(const std::string &path, const MPI_Comm communicator)
  {
    const auto    file = std::filesystem::is_directory(path) ? std::filesystem::path(path) / "system.json" : std::filesystem::path(path);
    std::ifstream stream(file);
    if (!stream)
      throw FileError("the system file " + in_quotes(file.string()) + " cannot be opened", "parameter System",
                      "name a folder that contains system.json, or the path of this file");
    Json json;
    try
      {
        json = parsed(stream, file.string());
      }
    catch (const nlohmann::json::exception &error)
      {
        throw FileError(text("the file is not valid JSON: ", error.what()), "file " + file.string(), "correct the file at this position");
      }
    const JsonEntry root(json, file.string(), "");
    root.check_keys(
      {"format", "version", "description", "parameters", "terms", "groups", "positions", "displacements", "measured modes", "reduction"});
    if (root["format"].as<std::string>("a string") != system_format || root["version"].integer() != system_format_version)
      root.refuse("the file is not a system file of this version",
                  text("write \"format\": \"", system_format, "\", \"version\": ", system_format_version));

    SystemFile system;
    system.path        = file.string();
    system.description = root.text_or("description", "");
    if (root.has("parameters"))
      system.parameters = read_parameters(root["parameters"]);
    const JsonEntry terms = root["terms"];
    TermReader      reader(system, communicator);
    for (const auto &[number, entry] : terms.members(false))
      reader.read(entry);
    check_terms(system, terms);
    if (root.has("groups"))
      system.groups = read_groups(root["groups"], system.map.n());
    if (root.has("positions"))
      system.points = reader.read_points(root);
    else if (root.has("displacements"))
      root["displacements"].refuse("`displacements` are given without `positions`", "add `positions`, or remove `displacements`");
    if (root.has("measured modes"))
      system.measured_modes = (file.parent_path() / root["measured modes"].as<std::string>("a file name")).string();
    return system;
  }

  RowMap ShapePoints::rows_of(const int n_points, const MPI_Comm communicator)
  {
    return RowMap(3 * RowMap::even(n_points, communicator).n_local(), communicator);
  }
} // namespace Squeal
