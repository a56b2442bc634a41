#include <squeal/base/conventions.h>
#include <squeal/estimates/mode_pairing.h>
#include <squeal/studies/accuracy/accuracy.h>

#include <algorithm>
#include <cmath>

namespace Squeal
{
  namespace
  {
    constexpr double percent = 100.;

    template <typename Row>
    using Getter = std::function<const ErrorKinds &(const Row &)>;

    /// Columns of the kinds of an error, in per cent.
    template <typename Row>
    Columns<Row> kinds(const std::string &what, const std::string &unit, const std::function<std::optional<ErrorKinds>(const Row &)> &get)
    {
      Columns<Row> columns;
      for (const auto &[name, kind] :
           {std::make_pair("", &ErrorKinds::total), std::make_pair("discretisation ", &ErrorKinds::discretisation),
            std::make_pair("reduction ", &ErrorKinds::reduction), std::make_pair("algebraic ", &ErrorKinds::algebraic)})
        columns.push_back({name + what, unit,
                           [get, kind = kind](const Row &row) -> Cell {
                             const std::optional<ErrorKinds> error = get(row);
                             return error ? Cell(percent * (*error).*kind) : Cell();
                           },
                           2, true});
      return columns;
    }

    template <typename Row>
    Columns<Row> operator+(Columns<Row> a, const Columns<Row> &b)
    {
      a.insert(a.end(), b.begin(), b.end());
      return a;
    }

    /// Which mesh and element.
    template <typename Row>
    Columns<Row> mesh_columns(const std::function<const MeshAndElement &(const Row &)> &of)
    {
      return {
        {"element", "", [of](const Row &row) { return of(row).element; }},
        {"outlines", "",
         [of](const Row &row) { return of(row).element == Element::quadratic ? std::string("curved") : to_string(of(row).outlines); }},
        {"mesh factor", "-", [of](const Row &row) { return of(row).factor; }, 2}};
    }

    /// Which mesh, element and method.
    template <typename Row>
    Columns<Row> identity(const std::function<const ComparedMethod &(const Row &)> &of)
    {
      return mesh_columns<Row>([of](const Row &row) -> const MeshAndElement & { return of(row).mesh->mesh; }) +
             Columns<Row>{{"method", "", [of](const Row &row) { return of(row).method->method; }}};
    }

    const ComparedMethod &itself(const ComparedMethod &method)
    {
      return method;
    }

    struct ModeRow
    {
      const ComparedMethod *method;
      const ModeErrors     *mode;
    };

    /// Nothing where a mode has no counterpart.
    template <typename Function>
    auto if_found(const Function &value)
    {
      return [value](const ModeRow &row) { return row.mode->number >= 0 ? Cell(value(*row.mode)) : Cell(); };
    }

    std::string counterpart(const ModeRow &row)
    {
      return row.mode->number < 0 ? "none" : row.mode->in_cluster ? "in a cluster" : "by shape";
    }
  } // namespace

  Table accuracy_table(const std::vector<ComparedMethod> &methods)
  {
    using Row                 = ComparedMethod;
    const Columns<Row> sizes  = {{"dofs", "-", [](const Row &row) { return row.mesh->n_dofs; }},
                                 {"contact nodes", "-", [](const Row &row) { return row.mesh->n_contact_nodes; }},
                                 {"unknowns", "-", [](const Row &row) { return row.method->size; }},
                                 {"wall time", "s", [](const Row &row) { return row.method->cost.seconds; }, 2},
                                 {"CPU time", "s", [](const Row &row) { return row.method->cost.cpu_seconds; }, 2},
                                 {"memory", "GB", [](const Row &row) { return row.method->cost.peak_memory / 1e9; }, 2},
                                 {"Pareto front", "", [](const Row &row) { return row.on_front ? "yes" : "no"; }},
                                 {"rms frequency error", "%", [](const Row &row) { return percent * row.rms_frequency; }, 2, true}};
    const Columns<Row> counts = {{"modes", "-", [](const Row &row) { return row.modes.size(); }},
                                 {"modes in clusters", "-", &Row::n_in_cluster},
                                 {"modes without counterpart", "-", &Row::n_lost}};
    return Table(identity<Row>(itself) + sizes + kinds<Row>("frequency error", "%", [](const Row &row) { return row.largest_frequency; }) +
                   kinds<Row>("divergence error", "percentage points", [](const Row &row) { return row.largest_divergence; }) + counts,
                 methods);
  }

  Table pareto_table(const std::vector<ComparedMethod> &methods)
  {
    using Row = ComparedMethod;
    std::vector<Row> front;
    std::copy_if(methods.begin(), methods.end(), std::back_inserter(front), [](const Row &row) { return row.on_front; });
    std::sort(front.begin(), front.end(),
              [](const Row &a, const Row &b) { return a.method->cost.cpu_seconds < b.method->cost.cpu_seconds; });
    return Table(
      identity<Row>(itself) +
        Columns<Row>{{"dofs", "-", [](const Row &row) { return row.mesh->n_dofs; }},
                     {"CPU time", "s", [](const Row &row) { return row.method->cost.cpu_seconds; }, 1},
                     {"memory", "GB", [](const Row &row) { return row.method->cost.peak_memory / 1e9; }, 2},
                     {"frequency error", "%", [](const Row &row) { return percent * row.largest_frequency.total; }, 3},
                     {"divergence error", "percentage points", [](const Row &row) { return percent * row.largest_divergence.total; }, 4}},
      front);
  }

  Table accuracy_mode_table(const std::vector<ComparedMethod> &methods)
  {
    std::vector<ModeRow> rows;
    for (const ComparedMethod &method : methods)
      for (const ModeErrors &mode : method.modes)
        rows.push_back({&method, &mode});
    using Row        = ModeRow;
    const auto found = [](ErrorKinds ModeErrors::*error) {
      return [error](const Row &row) { return row.mode->number >= 0 ? std::make_optional(row.mode->*error) : std::nullopt; };
    };
    const Columns<Row> values = {
      {"label", "", [](const Row &row) { return to_string(row.mode->reference->label); }},
      {"counterpart", "", counterpart},
      {"overlap", "-", if_found([](const ModeErrors &mode) { return mode.overlap; }), 4},
      {"extrapolated frequency", "Hz", [](const Row &row) { return row.mode->reference->frequency; }, 2},
      {"frequency", "Hz", if_found([](const ModeErrors &mode) { return mode.frequency; }), 2},
      {"extrapolated divergence rate", "%", [](const Row &row) { return percent * row.mode->reference->divergence; }, 4},
      {"divergence rate", "%", if_found([](const ModeErrors &mode) { return percent * mode.divergence; }), 4}};
    return Table(identity<Row>([](const Row &row) -> const ComparedMethod & { return *row.method; }) + values +
                   kinds<Row>("frequency error", "%", found(&ModeErrors::frequency_error)) +
                   kinds<Row>("divergence error", "percentage points", found(&ModeErrors::divergence_error)),
                 rows);
  }

  // --------------------------------------------------------------------- orders

  Table accuracy_order_table(const std::vector<ConvergedFamily> &families, const ConvergedFamily &reference, const double maximum_frequency)
  {
    struct Row
    {
      const ConvergedFamily *family;
      const ConvergedMode   *mode;
      const ConvergedMode   *counterpart; ///< in the reference; null if there is none
    };
    std::vector<Row> rows;
    for (const ConvergedFamily &family : families)
      {
        const ModePairing pairing = pair_modes(family.members.back()->modes, reference.members.back()->modes);
        for (std::size_t j = 0; j < family.modes.size(); ++j)
          if (family.modes[j].frequency <= maximum_frequency)
            {
              const int partner = pairing.coarse[j].partner;
              rows.push_back({&family, &family.modes[j], partner >= 0 ? &reference.modes[partner] : nullptr});
            }
      }
    // Of sequences of three meshes or more; an order that was not observed is none
    const auto order = [](const std::optional<Extrapolation> &sequence) {
      return sequence && !sequence->observed_orders.empty() ? Cell(sequence->observed_orders.back()) : Cell();
    };
    return Table(
      Columns<Row>{
        {"family", "", [](const Row &row) { return row.family->name; }},
        {"reference", "", [&](const Row &row) { return row.family == &reference ? "yes" : "no"; }},
        {"label", "", [](const Row &row) { return to_string(row.mode->label); }},
        {"meshes", "-", [](const Row &row) { return row.family->members.size(); }},
        {"cluster", "", [](const Row &row) { return row.mode->in_cluster ? "yes" : "no"; }},
        {"order of frequency", "-", [&](const Row &row) { return order(row.mode->frequencies); }, 2},
        {"frequency", "Hz", [](const Row &row) { return row.mode->frequency; }, 3},
        {"uncertainty of frequency", "Hz", [](const Row &row) { return row.mode->frequency_uncertainty; }, 3},
        {"frequency beside reference", "%",
         [](const Row &row) { return row.counterpart ? Cell(percent * (row.mode->frequency / row.counterpart->frequency - 1.)) : Cell(); },
         3},
        {"order of divergence rate", "-", [&](const Row &row) { return order(row.mode->divergences); }, 2},
        {"divergence rate", "%", [](const Row &row) { return percent * row.mode->divergence; }, 4},
        {"uncertainty of divergence rate", "percentage points", [](const Row &row) { return percent * row.mode->divergence_uncertainty; },
         4},
        {"divergence rate beside reference", "percentage points",
         [](const Row &row) { return row.counterpart ? Cell(percent * (row.mode->divergence - row.counterpart->divergence)) : Cell(); },
         4}},
      rows);
  }

  Table left_out_table(const std::vector<LeftOut> &meshes)
  {
    return Table(mesh_columns<LeftOut>([](const LeftOut &row) -> const MeshAndElement & { return row.mesh; }) +
                   Columns<LeftOut>{{"reason", "", &LeftOut::reason}},
                 meshes);
  }
} // namespace Squeal
