// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/orthonormal_basis.h>
#include <squeal/studies/designs/design_solution.h>

#include <cmath>
#include <numeric>

namespace Squeal
{
  namespace
  {
    /// Part of the tolerance that the whole basis keeps, so that what is left out of it for a design has the rest.
    constexpr double part_of_family = 0.5;

    /// Squares of principal axes below this times the tolerance are left out of the basis of a design: at first, and for points
    /// that missed the tolerance.
    constexpr double first_compression = 10., later_compression = 0.3;

    /// Growths for one point, beyond which a design is taken for too far from the others.
    constexpr int most_growths_for_point = 6;

    /// Vectors beyond which small matrices are no longer small.
    constexpr int most_vectors = 900;
  } // namespace

  std::string family_key(const Parameters &design)
  {
    if (design.needs_steady_sliding() || design.operation.rotating_disc || !design.damping.modal_ratios.empty())
      return "";
    return text_without_coefficients(design);
  }

  DesignFamily::DesignFamily(const std::vector<Parameters> &designs, Run &run)
    : scene(mesh_scene(run))
    , designs(designs)
    , run(run)
    , largest_circular_frequency(circular_frequency(run.parameters.discretization.maximum_frequency))
  {
    const BodyTerms              bodies = assemble_scene(scene, run);
    std::vector<ParameterValues> values;
    for (const Parameters &design : designs)
      values.push_back(body_values(*scene.model, design.materials));

    // Which kinds of damping of the contact there are, is the same for all
    const SweepPlan       plan = sweep_plan(scene, run);
    const OperatingPoint &most = most_damped(plan.regimes.front());
    SystemFamily          family =
      system_family(bodies, values, linearise(scene, {}, plan.lines[most.line].at(most.friction_coefficient)), band_margin, run);
    terms  = std::move(family.terms);
    middle = std::move(family.middle);

    run.progress.begin("Reduced model");
    const CoupledSystem &system = middle.linearisation.coupled;
    model                       = std::make_unique<ReducedModel>(starting_model(system, *middle.inverse, *middle.real.vectors, true));
    residuals                   = std::make_unique<ProjectedResiduals>(system, *middle.inverse, middle.shift, system.values);
    residuals->extend(*model);
    run.progress.finish(text(model->size(), " vectors to start from, ", system.terms.size(), " terms"));
  }

  std::unique_ptr<ChartModel> DesignFamily::restricted(const SystemMember &member, const DenseMatrix &Z) const
  {
    return std::make_unique<ChartModel>(member.system, *middle.inverse, middle.shift, model->restricted(member, Z),
                                        residuals->restricted(member, Z), largest_circular_frequency);
  }

  void DesignFamily::find_whole_model(Member &member) const
  {
    const ReducedPencil pencil = model->at(middle.linearisation.coupled.at(0., terms.members[member.design]));
    const Eigen::Index  n = model->size(), old = member.Z.cols();
    if (old == 0)
      member.Z = agreed(run.communicator, symmetric_eigenpairs(pencil.stiffness, pencil.mass)).vectors;
    else
      {
        // Coordinates that are known stay what they are
        DenseMatrix Z(n, n);
        Z.leftCols(old)      = with_rows(member.Z, n);
        DenseMatrix rest     = DenseMatrix::Identity(n, n).rightCols(n - old);
        const auto  old_part = Z.leftCols(old);
        for (unsigned int pass = 0; pass < 2; ++pass)
          rest -= old_part * (old_part.transpose() * (pencil.mass * rest));
        const auto [squares, axes] = agreed(run.communicator, symmetric_eigenpairs(rest.transpose() * (pencil.mass * rest)));
        Z.rightCols(n - old)       = rest * axes * as_column(squares).cwiseSqrt().cwiseInverse().asDiagonal();
        member.Z                   = std::move(Z);
      }
    member.whole = restricted(member.system, member.Z);
  }

  ChartPoint DesignFamily::accurate_point(const OperatingPoint &point, Member &member)
  {
    const double tolerance = part_of_family * run.parameters.sweep.tolerance;
    for (int growth = 0;; ++growth)
      {
        const ChartPoint result = evaluate(*member.whole, {point}, run.communicator).front();
        const double     error  = member.whole->largest_error(result);
        run.progress.update(text("mu = ", point.friction_coefficient, ", ", model->size(), " vectors, estimated error ", error));
        if (error <= tolerance)
          return result;
        const auto vectors = growth < most_growths_for_point ?
                               member.whole->new_vectors({{point, &result, member.whole->inaccurate_modes(result, tolerance)}}) :
                               std::nullopt;
        if (!vectors || model->size() + vectors->n_columns() > most_vectors)
          throw SolverError(
            text("one basis does not serve this design and those before it: estimated error ", error, " with ", model->size(), " vectors"),
            "designs on one mesh", "solve it alone");
        model->extend(*vectors);
        residuals->extend(*model);
        find_whole_model(member);
      }
  }

  void DesignFamily::learn(const std::vector<ChartPoint> &charts, const double compression, DenseMatrix &basis, const Member &member) const
  {
    std::vector<ChartPoint> padded = charts;
    for (ChartPoint &chart : padded)
      for (ComplexDenseMatrix *vectors : {&chart.right, &chart.left})
        *vectors = with_rows(*vectors, member.Z.cols());
    basis                   = with_rows(basis, member.Z.cols());
    const DenseMatrix parts = member.whole->principal_parts(basis, padded, compression * run.parameters.sweep.tolerance);
    if (parts.cols() > 0)
      basis = append_columns(basis, orthonormal_columns(parts - basis * (basis.transpose() * parts)));
  }

  DesignFamily::Member DesignFamily::solve(const std::size_t design)
  {
    Member result;
    result.design                            = design;
    result.run                               = std::make_unique<Run>(designs[design], run, run.progress);
    result.plan                              = std::make_unique<SweepPlan>(sweep_plan(scene, *result.run));
    result.system                            = member_of(middle.linearisation.coupled, terms.members[design]);
    const ContactRegime              &regime = result.plan->regimes.front();
    const std::vector<OperatingPoint> points = regime.points;

    run.progress.begin("Family");
    find_whole_model(result);
    const double            margin = (1. + band_margin) * largest_circular_frequency;
    std::vector<double>     eigenvalues; // of real modes
    std::vector<ChartPoint> charts;
    for (const int i : ends_and_quarters(static_cast<int>(points.size())))
      charts.push_back(accurate_point(points[i], result));
    {
      const ReducedPencil pencil = model->at(middle.linearisation.coupled.at(0., terms.members[design]));
      eigenvalues                = symmetric_eigenpairs(pencil.stiffness, pencil.mass).values;
      eigenvalues.resize(n_in_band(eigenvalues, margin * margin));
    }
    run.progress.finish(text(model->size(), " vectors"));

    // Without friction the modes are the first columns of Z
    run.progress.begin("Sweep");
    const double tolerance = run.parameters.sweep.tolerance;
    DenseMatrix  basis     = DenseMatrix::Identity(result.Z.cols(), static_cast<Eigen::Index>(eigenvalues.size()));
    learn(charts, first_compression, basis, result);
    FrictionlessModes frictionless     = middle;
    frictionless.linearisation.coupled = result.system.system;
    frictionless.real.eigenvalues      = eigenvalues;
    result.model =
      std::make_unique<SweepModel>(*result.plan, regime, *result.run, std::move(frictionless), restricted(result.system, result.Z * basis));
    std::vector<std::size_t> left(points.size());
    std::iota(left.begin(), left.end(), 0);
    std::vector<bool> is_learnt(points.size(), false);
    for (;;)
      {
        std::vector<OperatingPoint> asked;
        for (const std::size_t i : left)
          asked.push_back(points[i]);
        const auto               found = evaluate(*result.model->reduced, asked, run.communicator);
        std::vector<std::size_t> missed;
        double                   worst = 0.;
        std::size_t              at    = 0;
        for (std::size_t k = 0; k < left.size(); ++k)
          if (const double error = result.model->reduced->largest_error(found[k]); error <= tolerance)
            result.model->known.emplace(std::make_pair(asked[k].line, asked[k].friction_coefficient), found[k]);
          else
            {
              missed.push_back(left[k]);
              if (!(error <= worst))
                {
                  worst = error;
                  at    = left[k];
                }
            }
        left = missed;
        if (left.empty())
          break;
        if (is_learnt[at])
          throw SolverError(text("the basis of a design cannot be compressed: estimated error ", worst), "designs on one mesh",
                            "solve it alone");
        is_learnt[at] = true;
        learn({accurate_point(points[at], result)}, later_compression, basis, result);
        result.model->reduced = restricted(result.system, result.Z * basis);
      }
    run.progress.finish(text(points.size(), " operating points, ", result.model->reduced->size(), " of ", model->size(), " vectors"));

    run.progress.begin("Mode count");
    const double limit = largest_circular_frequency * largest_circular_frequency;
    result.n_counted   = count_below(*result.system.system.stiffness, *result.system.system.mass, limit, "real modes of a design").n_modes;
    run.progress.finish(text(result.n_counted, " by inertia"));

    std::vector<double> friction_coefficients;
    for (const OperatingPoint &point : points)
      friction_coefficients.push_back(point.friction_coefficient);
    result.chart = follow_branches(*result.model, points.front().line, friction_coefficients);
    return result;
  }
} // namespace Squeal
