// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/linear_algebra/multivector.h>
#include <squeal/studies/steps/written_system.h>
#include <squeal/studies/sweep/sweep_charts.h>

#include <ostream>

namespace Squeal
{
  namespace
  {
    std::shared_ptr<const SparseMatrix> as_sparse(const DenseMatrix &A, const RowMap &rows, const RowMap &columns)
    {
      return std::make_shared<SparseMatrix>(rows, columns, [&](const int i, SparseMatrix::Row &row) {
        for (Eigen::Index j = 0; j < A.cols(); ++j)
          row.emplace_back(static_cast<int>(j), A(rows.number(i), j));
      });
    }

    /// Terms of the reduced model; low-rank terms without weights are multiplied out.
    std::vector<Term> reduced_terms(const ReducedModel &model)
    {
      const CoupledSystem                                                  &system = model.full_order();
      const RowMap                                                          map = RowMap::even(model.size(), system.map().communicator());
      std::vector<Term>                                                     result;
      std::map<const LowRankFactor *, std::shared_ptr<const LowRankFactor>> factors;
      const auto reduced_factor = [&](const std::shared_ptr<const LowRankFactor> &factor) {
        auto &entry = factors[factor.get()];
        if (!entry)
          entry = std::make_shared<LowRankFactor>(
            as_sparse(model.motions(*factor), RowMap::even(factor->rank(), system.map().communicator()), map));
        return entry;
      };
      for (std::size_t k = 0; k < system.terms.size(); ++k)
        {
          Term term = system.terms[k];
          if (!term.weights.empty())
            {
              term.left  = reduced_factor(term.left);
              term.right = reduced_factor(term.right);
              result.push_back(term);
              continue;
            }
          term.left = term.right = nullptr;
          term.matrix            = as_sparse(model.projected(k), map, map);
          for (Term &part : split_by_symmetry(term))
            result.push_back(std::move(part));
        }
      return result;
    }

    /// Range of each parameter covered by the plan.
    std::vector<FileParameter> covered_parameters(const SweepModel &model)
    {
      const SweepPlan &plan  = model.plan;
      double           first = plan.lines.front().friction_coefficients.front(), last = plan.lines.front().friction_coefficients.back();
      if (plan.scene != nullptr)
        {
          FileParameter mu = friction_parameter(model.run.parameters);
          if (mu.lower == mu.upper) // the contact state depends on the value
            first = last = most_damped(model.regime).friction_coefficient;
          mu.value = mu.upper = last;
          mu.lower            = first;
          return {mu};
        }
      std::vector<FileParameter> result = plan.file->parameters;
      for (FileParameter &parameter : result)
        {
          parameter.value = parameter.lower = parameter.upper = plan.values.at(parameter.name).front();
          if (parameter.name == plan.axis.name)
            parameter.lower = first;
          for (const SweepLine &line : plan.lines)
            if (line.kind == SweepLine::Kind::map && parameter.name == plan.second_axis.name)
              {
                parameter.lower = std::min(parameter.lower, line.value);
                parameter.upper = std::max(parameter.upper, line.value);
              }
        }
      return result;
    }

    /// T on the dofs of the bodies or of the file, as a dense Matrix Market file. Collective.
    void write_basis(const SweepModel &model, std::ostream &stream)
    {
      const MultiVector  &T      = model.reduced->reduced().basis();
      const SparseMatrix &kernel = *model.frictionless.linearisation.coupled.kernel;
      stream << "%%MatrixMarket matrix array real general\n" << kernel.n_rows() << ' ' << T.n_columns() << '\n';
      stream.precision(17);
      for (int j = 0; j < T.n_columns(); ++j)
        stream << replicate(kernel * view(T, j, 1)) << '\n';
    }
    /// Largest estimated error of λ at every point.
    Table point_table(const SweepModel &model)
    {
      using Row             = const std::pair<const std::pair<int, double>, ChartPoint>;
      const SweepPlan &plan = model.plan;
      Columns<Row>     columns{{plan.axis.name, plan.axis.unit, [](const Row &row) { return row.first.second; }}};
      if (!plan.second_axis.name.empty())
        columns.push_back({plan.second_axis.name, plan.second_axis.unit, [&](const Row &row) {
                             const SweepLine &line = plan.lines[row.first.first];
                             return line.kind == SweepLine::Kind::map ? Entry(line.value) : Entry();
                           }});
      columns.push_back(
        {"largest estimated error of lambda", "-", [&](const Row &row) { return model.largest_error(row.second); }, 1, true});
      return Table(columns, model.known);
    }
  } // namespace

  void write_system_of(const SweepModel &model)
  {
    Run                             &run           = model.run;
    const std::string                folder        = model.plan.regimes.size() > 1 ? text("system_", model.regime.number, "/") : "system/";
    const Linearisation             &linearisation = model.frictionless.linearisation;
    const std::vector<FileParameter> parameters    = covered_parameters(model);
    switch (run.parameters.output.write_system)
      {
        case SystemOutput::none:
          return;
        case SystemOutput::full:
          if (model.plan.file)
            write_system_again(*model.plan.file, folder, run);
          else
            write_scene_system(linearisation, parameters.front(), folder, run);
          return;
        case SystemOutput::reduced:
          write_system(reduced_terms(model.reduced->reduced()), linearisation.coupled.values,
                       {parameters, "reduced model", {}, {}, Reduction{"basis.mtx", "points.csv", run.parameters.sweep.tolerance}}, folder,
                       run);
          run.folder().write(folder + "basis.mtx", [&](std::ostream &stream) { write_basis(model, stream); });
          run.folder().write(folder + "points.csv", [&](std::ostream &stream) { point_table(model).write_csv(stream); });
      }
  }
} // namespace Squeal
