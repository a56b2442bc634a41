// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/linear_algebra/multivector.h>
#include <squeal/studies/steps/friction_modes.h>
#include <squeal/studies/steps/material_numbers.h>
#include <squeal/studies/steps/written_system.h>
#include <squeal/system/expression.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <ostream>

namespace Squeal
{
  namespace
  {
    constexpr double largest_friction_coefficient = 10.;

    /// Parameter ranges extend by this factor below and above the value.
    constexpr double range_factor = 100.;

    /// Converts to lower case, replaces each run of non-alphanumeric characters by _, and adds a prefix if the first character requires it.
    std::string identifier(const std::string &text)
    {
      std::string result = is_parameter_name(text.substr(0, 1)) ? "" : "of_";
      for (const unsigned char c : text)
        if (std::isalnum(c) != 0)
          result += static_cast<char>(std::tolower(c));
        else if (result.back() != '_')
          result += '_';
      return result;
    }

    FileParameter scaled_parameter(const std::string &name, const double value, const std::string &unit, const std::string &description)
    {
      const auto [lower, upper] = std::minmax({value / range_factor, value * range_factor});
      return {identifier(name), value, lower, upper, unit, description};
    }

    /// Names the material constants; volumes that use the common material of the disc or the pins share its parameters.
    void name_materials(NamedParameters &named, const std::vector<std::string> &volumes, const MaterialParameters &materials)
    {
      for (const std::string &volume : volumes)
        {
          const bool        has_own  = materials.has_own(volume);
          const std::string owner    = has_own ? volume : is_of_disc(volume) ? "disc" : "pin";
          const Material    material = materials.of(volume);
          for (const MaterialNumber &number : material_numbers)
            if (const double value = material.*number.value; value != 0.)
              named.name(number.parameter(volume),
                         scaled_parameter(owner + " " + number.name, value, number.unit,
                                          materials.section_of(volume) + (has_own ? ": " + volume + ", " : "/") + number.name));
        }
    }

    /// Terms of the bodies in the parameters of the file; terms with the same coefficient are summed.
    std::vector<Term> summed_terms(const BodyTerms &bodies, const std::map<std::string, std::string> &names)
    {
      std::vector<Term>                                                                result;
      std::vector<std::vector<std::pair<double, std::shared_ptr<const SparseMatrix>>>> summands;
      for (const Term &term : bodies.terms)
        {
          if (term.vanishes(bodies.values))
            continue;
          const Coefficient coefficient = in_names(term.coefficient, names);
          const auto        known       = std::find_if(result.begin(), result.end(), [&](const Term &other) {
            return other.power == term.power && other.symmetry == term.symmetry && other.coefficient.text() == coefficient.text();
          });
          const auto        place       = static_cast<std::size_t>(known - result.begin());
          if (known == result.end())
            {
              result.push_back(term);
              result.back().coefficient = coefficient;
              summands.emplace_back();
            }
          summands[place].emplace_back(1., term.matrix);
        }
      for (std::size_t k = 0; k < result.size(); ++k)
        {
          result[k].matrix = sum(summands[k]);
          if (summands[k].size() > 1)
            result[k].name += text(" and ", summands[k].size() - 1, " more");
        }
      return result;
    }

    /// The coupled system as a function of the parameters of the file.
    CoupledSystem system_with_parameters(const Linearisation &linearisation, const NamedParameters &named, const Parameters &parameters)
    {
      const Model &model  = *linearisation.scene->model;
      BodyTerms    bodies = body_terms(model, parameters.materials);
      if (parameters.operation.rotating_disc)
        add_rotation(bodies, model, parameters.operation.angular_velocity());
      ParameterValues values;
      for (const FileParameter &parameter : named.parameters)
        values[parameter.name] = {parameter.value};
      ContactOperators contact = linearisation.contact;
      auto             names   = named.names;
      for (ContactSpring &spring : contact.springs)
        spring.name = names.at(spring.name);
      CoupledSystem result = couple(summed_terms(bodies, names), contact, linearisation.damping, values);
      names.clear();
      for (const FileParameter &parameter : named.parameters)
        names[parameter.name] = parameter.name;
      for (Term &term : result.terms)
        term.coefficient = in_names(term.coefficient, names);
      return result;
    }

    /// Coupled dofs of each body, on process 0.
    std::vector<DofGroup> groups_of_bodies(const Model &model, const SparseMatrix &kernel)
    {
      MultiVector component(model.free_map(), 1);
      for (const Node &node : model.nodes())
        for (const int dof : node.dofs)
          if (const int place = model.free_map().place(dof); place >= 0)
            component(place, 0) = node.component;
      const DenseMatrix     of_dofs = gather(coordinates(kernel, component));
      std::vector<DofGroup> result;
      for (const std::string &name : model.component_names())
        result.push_back({name, {}});
      for (int dof = 0; dof < of_dofs.rows(); ++dof)
        {
          auto &ranges = result[std::lround(of_dofs(dof, 0))].ranges;
          if (ranges.empty() || ranges.back().second != dof - 1)
            ranges.emplace_back(dof, dof);
          ranges.back().second = dof;
        }
      return result;
    }
  } // namespace

  void NamedParameters::name(const std::string &of_terms, FileParameter parameter)
  {
    const auto find = [&](std::string FileParameter::*text, const std::string &wanted) {
      return std::find_if(parameters.begin(), parameters.end(), [&](const FileParameter &known) { return known.*text == wanted; });
    };
    if (const auto known = find(&FileParameter::description, parameter.description); known != parameters.end())
      {
        names[of_terms] = known->name;
        return;
      }
    const std::string name = parameter.name;
    for (int n = 2; find(&FileParameter::name, parameter.name) != parameters.end(); ++n)
      parameter.name = Squeal::text(name, "_", n);
    names[of_terms] = parameter.name;
    parameters.push_back(parameter);
  }

  NamedParameters named_parameters(const Linearisation &linearisation, const FileParameter &friction, const Parameters &parameters)
  {
    NamedParameters result;
    result.name(SystemParameter::friction, friction);
    if (parameters.needs_steady_sliding() || !parameters.damping.modal_ratios.empty())
      return result;
    name_materials(result, linearisation.scene->model->volume_names(), parameters.materials);
    for (const MountParameter &mount : mount_parameters(parameters.materials))
      result.name(mount.name, scaled_parameter(mount.name, mount.value, mount.unit, mount.path));
    for (const ContactSpring &spring : linearisation.contact.springs)
      result.name(spring.name, scaled_parameter(spring.name, spring.stiffness, "N/m^3", "Contact/Pairs: " + spring.name));
    if (parameters.operation.rotating_disc)
      {
        FileParameter speed = scaled_parameter(BodyParameter::angular_velocity, parameters.operation.angular_velocity(), "rad/s",
                                               "Operation/Rotation speed, positive about z");
        if (parameters.has_contact_damping()) // contact damping depends on the speed as well
          speed.lower = speed.upper = speed.value;
        result.name(BodyParameter::angular_velocity, speed);
      }
    return result;
  }

  Coefficient in_names(const Coefficient &monomial, const std::map<std::string, std::string> &names)
  {
    ParameterValues ones;
    for (const auto &[of_terms, of_file] : names)
      ones[of_terms] = {1.};
    // With all p = 1, a monomial equals its factor, and its derivatives are the factor times the exponents
    const double               factor = monomial.at(ones);
    std::map<std::string, int> powers;
    for (const auto &[of_terms, of_file] : names)
      if (!of_file.empty() && monomial.contains(of_terms))
        powers[of_file] += static_cast<int>(std::lround(monomial.derivative(of_terms, ones) / factor));
    return {factor, powers};
  }

  std::vector<FileParameter> fixed(std::vector<FileParameter> parameters, const ParameterValues &values)
  {
    for (FileParameter &parameter : parameters)
      parameter.value = parameter.lower = parameter.upper = values.at(parameter.name).front();
    return parameters;
  }

  ShapePoints displacements_of_nodes(const Model &model)
  {
    std::vector<Node>   own;
    std::vector<double> places;
    for (const Node &node : model.nodes())
      if (node.is_own && !node.is_clamped())
        {
          own.push_back(node);
          places.insert(places.end(), node.position.begin(), node.position.end());
        }
    const RowMap rows(3 * static_cast<int>(own.size()), model.communicator());
    ShapePoints  result{DenseMatrix(rows.n() / 3, 3),
                       std::make_shared<SparseMatrix>(rows, model.free_map(), [&](const int i, SparseMatrix::Row &row) {
                         own[i / 3].for_each_dof(i % 3, [&](const int dof, const double weight) { row.emplace_back(dof, weight); });
                       })};
    Eigen::Index point = 0;
    for (const std::vector<double> &part : dealii::Utilities::MPI::all_gather(model.communicator(), places))
      for (std::size_t i = 0; i < part.size(); i += 3)
        result.positions.row(point++) << part[i], part[i + 1], part[i + 2];
    return result;
  }

  FileParameter friction_parameter(const Parameters &parameters)
  {
    const double  mu      = parameters.operation.friction_coefficient;
    const bool    depends = parameters.needs_steady_sliding() || parameters.has_contact_damping();
    FileParameter result{SystemParameter::friction, mu};
    result.lower       = depends ? mu : 0.;
    result.upper       = depends ? mu : largest_friction_coefficient;
    result.description = depends ? "friction coefficient; contact state and damping are valid at this value only" : "friction coefficient";
    return result;
  }

  /// Writes a system file to a folder of the results, as a step of the run.
  static void write_system(const std::vector<Term> &terms,
                           const ParameterValues   &weights,
                           const SystemNotes       &notes,
                           const std::string       &folder,
                           Run                     &run)
  {
    run.progress.begin("System file");
    write_system(terms, weights, notes, [&](const std::string &name, const std::function<void(std::ostream &)> &content) {
      run.folder().write(folder + name, content);
    });
    run.progress.finish(text(counted(terms.size(), "term"), ", ", counted(notes.parameters.size(), "parameter")));
  }

  void write_scene_system(const Linearisation &linearisation, const FileParameter &friction, const std::string &folder, Run &run)
  {
    if (run.parameters.output.write_system != SystemOutput::full)
      return;
    const Parameters     &parameters = run.parameters;
    const NamedParameters named      = named_parameters(linearisation, friction, parameters);
    const CoupledSystem   system =
      named.parameters.size() > 1 ? system_with_parameters(linearisation, named, parameters) : linearisation.coupled;
    const Model        &model  = *linearisation.scene->model;
    const SparseMatrix &kernel = *linearisation.coupled.kernel;
    ShapePoints         points = displacements_of_nodes(model);
    points.displacements       = multiply(*points.displacements, kernel);
    write_system(system.terms, system.values,
                 {named.parameters,
                  "coupled system, displacements in m, forces in N; groups exclude dofs eliminated by contact constraints",
                  groups_of_bodies(model, kernel), points},
                 folder, run);
  }

  void write_reduced_system(const ReducedModel                                    &model,
                            const ReductionNotes                                  &notes,
                            const std::function<Coefficient(const Coefficient &)> &rename,
                            const std::string                                     &folder,
                            Run                                                   &run)
  {
    std::vector<Term> terms = model.system().terms;
    if (rename)
      for (Term &term : terms)
        term.coefficient = rename(term.coefficient);
    write_system(terms, model.full_order().values,
                 {notes.parameters, notes.description, {}, {}, Reduction{"basis.mtx", "points.csv", notes.tolerance}}, folder, run);
    run.folder().write(folder + "basis.mtx", [&](std::ostream &stream) {
      const MultiVector  &T      = model.basis();
      const SparseMatrix &kernel = *model.full_order().kernel;
      stream << "%%MatrixMarket matrix array real general\n" << kernel.n_rows() << ' ' << T.n_columns() << '\n';
      stream.precision(17);
      for (int j = 0; j < T.n_columns(); ++j)
        stream << replicate(kernel * view(T, j, 1)) << '\n';
    });
    run.folder().write(folder + "points.csv", [&](std::ostream &stream) { notes.points.write_csv(stream); });
  }

  void write_scene_system(Scene &scene, Run &run)
  {
    if (run.parameters.output.write_system != SystemOutput::full)
      return;
    // Modal damping requires modes
    const bool is_modal = !run.parameters.damping.modal_ratios.empty();
    write_scene_system(is_modal ? damped_modes(scene, run).linearisation : linearised_scene(scene, run), friction_parameter(run.parameters),
                       "system/", run);
  }

  void write_system_again(const SystemFile &file, const std::string &folder, Run &run)
  {
    if (run.parameters.output.write_system == SystemOutput::full)
      write_system(file.terms, file.weights, {file.parameters, file.description, file.groups, file.points}, folder, run);
  }
} // namespace Squeal
