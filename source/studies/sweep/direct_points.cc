// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/studies/sweep/sweep_charts.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace Squeal
{
  namespace
  {
    /// Selected columns of X + iY, with the rows of all processes.
    ComplexDenseMatrix gathered(const MultiVector &X, const MultiVector &Y, const std::vector<int> &columns)
    {
      const std::complex<double> i(0., 1.);
      return (replicate(X).cast<std::complex<double>>() + i * replicate(Y))(Eigen::placeholders::all, columns);
    }

    /// Backward errors ‖ψᵀQ(λ)‖ / (w ‖ψ‖) of left vectors, see backward_errors().
    std::vector<double> left_backward_errors(const CoupledSystem &system, const ParameterValues &values, const ComplexModes &modes)
    {
      const MultiVector        &X = *modes.left_real_part, &Y = *modes.left_imaginary_part;
      const int                 n         = X.n_columns();
      const MultiVector         residuals = force_residuals(system, values, modes.lambda, X, Y, true);
      std::vector<double>       result    = complex_norms(view(residuals, 0, n), view(residuals, n, n));
      const std::vector<double> w = pencil_norms(system, values, modes.lambda), norms = complex_norms(X, Y);
      for (int j = 0; j < n; ++j)
        result[j] /= w[j] * norms[j];
      return result;
    }

    template <typename Value>
    std::vector<Value> chosen(const std::vector<Value> &values, const std::vector<int> &numbers)
    {
      std::vector<Value> result;
      for (const int number : numbers)
        result.push_back(values[number]);
      return result;
    }

    /// Differences between reduced and full-order modes.
    struct Differences
    {
      double largest_error = 0.; ///< |λ̂ − λ| / |λ|
      int    n_other       = 0;  ///< number of reduced modes in the band without a full-order counterpart
    };

    /// Errors of the reduced modes: each full-order mode is paired with the nearest reduced mode that is not yet paired.
    Differences differences(const SweepModel &model, const ChartPoint &point, std::vector<std::complex<double>> reduced)
    {
      Differences result;
      for (std::size_t i = 0; i < point.lambda.size(); ++i)
        {
          const std::complex<double> lambda  = point.lambda[i];
          const auto                 nearest = std::min_element(reduced.begin(), reduced.end(),
                                                                [&](const auto &a, const auto &b) { return std::abs(a - lambda) < std::abs(b - lambda); });
          if (nearest != reduced.end())
            {
              if (model.is_in_band(lambda))
                result.largest_error = std::max(result.largest_error, std::abs(*nearest - lambda) / std::abs(lambda));
              reduced.erase(nearest);
            }
          else if (model.is_in_band(lambda))
            result.largest_error = std::numeric_limits<double>::infinity();
        }
      const double rate = model.run.parameters.discretization.band().rate;
      result.n_other    = static_cast<int>(std::count_if(reduced.begin(), reduced.end(), [&](const std::complex<double> &lambda) {
        return model.is_in_band(lambda) && lambda.real() >= -rate;
      }));
      return result;
    }

    /// Real and imaginary parts of right and left vectors of a point.
    MultiVector snapshot(const ChartPoint &point, const RowMap &map)
    {
      const MultiVector parts[] = {distribute(point.right.real(), map), distribute(point.right.imag(), map),
                                   distribute(point.left.real(), map), distribute(point.left.imag(), map)};
      return join({&parts[0], &parts[1], &parts[2], &parts[3]});
    }
  } // namespace

  ReducedModel snapshot_model(SweepModel &model, std::map<SweepModel::Place, double> &errors)
  {
    constexpr double     first_cut = 1e-3, last_cut = 1e-11;
    Run                 &run  = model.run;
    const CoupledSystem &full = model.frictionless.linearisation.coupled;
    const Band           band((1. + band_margin) * model.largest_circular_frequency, run.parameters.discretization.maximum_rate);

    run.progress.begin("Reduced model");
    // Train the basis at values of the sweep and verify it at points from the search for thresholds
    std::vector<SweepModel::Place> places;
    for (const OperatingPoint &point : model.regime.points)
      places.emplace_back(point.line, point.friction_coefficient);
    auto worst = std::find_if(places.begin(), places.end(), [&](const auto &place) { return !model.known.at(place).lambda.empty(); });
    if (worst == places.end())
      throw SolverError("a reduced system requires modes, but the sweep has no modes in the band", "parameter Output/Write system",
                        "raise Band/Maximum frequency, or set Output/Write system = full");
    std::set<SweepModel::Place> chosen  = {*worst};
    MultiVector                 set     = snapshot(model.known.at(*worst), full.map());
    const auto                  inertia = inertia_square(full, worst->second, model.largest_circular_frequency);
    for (double cut = first_cut;;)
      {
        ReducedModel result(full);
        result.extend(principal_axes(*inertia, set, cut, set.n_columns()));
        const CoupledSystem system  = result.system();
        double              largest = -1.;
        for (auto place = places.begin(); place != places.end(); ++place)
          {
            const OperatingPoint point = model.plan.point(place->first, place->second, model.regime.closed);
            const JudgedModes    modes =
              direct_modes(with_values(system, point.values), place->second, band, run.parameters.solvers, "reduced model", run.progress);
            const Differences found = differences(model, model.known.at(*place), modes.modes.lambda);
            const double      size  = found.n_other > 0 ? std::numeric_limits<double>::infinity() : found.largest_error;
            errors[*place]          = found.largest_error;
            if (size > largest)
              {
                largest = size;
                worst   = place;
              }
          }
        if (largest > run.parameters.sweep.tolerance)
          {
            if (chosen.insert(*worst).second)
              set.append(snapshot(model.known.at(*worst), full.map()));
            else if (cut > last_cut)
              cut /= 10.;
            else
              throw SolverError("the reduced model does not reproduce the modes of the sweep within Sweep/Tolerance",
                                "parameter Output/Write system",
                                "narrow the range of the sweep, raise Sweep/Tolerance, or set Output/Write system = full");
          }
        else if (places.size() < model.known.size())
          {
            places.clear();
            for (const auto &[place, point] : model.known)
              places.push_back(place);
          }
        else
          {
            run.progress.finish(text(result.size(), " vectors from ", chosen.size(), " of ", places.size(),
                                     " operating points, largest error of lambda ", largest));
            return result;
          }
      }
  }

  ChartPoint SweepModel::evaluate_directly(const OperatingPoint &point) const
  {
    const auto         &discretization = run.parameters.discretization;
    const CoupledSystem system         = with_values(frictionless.linearisation.coupled, point.values);
    const JudgedModes   found =
      direct_modes(system, point.friction_coefficient, Band((1. + band_margin) * largest_circular_frequency, discretization.maximum_rate),
                   run.parameters.solvers, "file " + plan.file->path, run.progress);
    const ComplexModes &modes = found.modes;
    ChartPoint          result;
    result.friction_coefficient = point.friction_coefficient;
    result.real_values          = modes.real_values;
    result.n_zeros              = 2 * modes.n_rigid_body;
    std::vector<int> listed;
    for (std::size_t j = 0; j < modes.lambda.size(); ++j)
      if (modes.lambda[j].real() >= -discretization.band().rate)
        listed.push_back(static_cast<int>(j));
    if (listed.empty())
      return result;
    std::sort(listed.begin(), listed.end(), [&](const int a, const int b) {
      const auto &x = modes.lambda[a], &y = modes.lambda[b];
      return std::make_pair(x.imag(), x.real()) < std::make_pair(y.imag(), y.real());
    });

    const ParameterValues values = system.at(point.friction_coefficient);
    result.lambda                = chosen(modes.lambda, listed);
    result.verdicts              = chosen(found.verdicts, listed);
    result.errors                = chosen(found.conditioning.errors, listed);
    result.right_residuals       = chosen(backward_errors(system, values, modes), listed);
    result.left_residuals        = chosen(left_backward_errors(system, values, modes), listed);
    for (std::size_t j = 0; j < listed.size(); ++j)
      result.uncertainties.push_back(result.errors[j] * std::abs(result.lambda[j]));
    result.right = gathered(*modes.real_part, *modes.imaginary_part, listed);
    result.left  = gathered(*modes.left_real_part, *modes.left_imaginary_part, listed);
    // First-order corrections of λ from the residuals of φ, with the left vectors ψ
    const int         n         = static_cast<int>(modes.lambda.size());
    const MultiVector residuals = force_residuals(system, values, modes.lambda, *modes.real_part, *modes.imaginary_part);
    result.corrections          = -result.left.transpose() * gathered(view(residuals, 0, n), view(residuals, n, n), listed);
    result.left.colwise().normalize();
    return result;
  }

  std::vector<ModeLabel> SweepModel::labels_by_number(const ChartPoint &point, const std::vector<int> &modes) const
  {
    if (!first_point)
      first_point = point;
    const DenseMatrix      overlaps = 0.5 * ((first_point->right.adjoint() * point.right(Eigen::placeholders::all, modes)).cwiseAbs2() +
                                        (first_point->left.adjoint() * point.left(Eigen::placeholders::all, modes)).cwiseAbs2());
    std::vector<ModeLabel> result;
    for (Eigen::Index j = 0; j < overlaps.cols(); ++j)
      {
        Eigen::Index nearest = 0;
        const double overlap = overlaps.rows() > 0 ? overlaps.col(j).maxCoeff(&nearest) : 0.;
        result.push_back(numbered_label(static_cast<int>(nearest) + 1));
        result.back().participation = overlap;
      }
    return result;
  }
} // namespace Squeal
