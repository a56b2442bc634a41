// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/studies/sensitivity/sensitivity_results.h>
#include <squeal/tracking/mode_links.h>

#include <numeric>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Condition number κ above which an eigenvalue is differentiated together with the eigenvalue with which it nearly coalesces [-].
    constexpr double coalescing_condition = 1000.;

    /// Maximum number of extensions of the basis.
    constexpr int most_growths = 6;

    /// Eigenvalues that are differentiated together; the first one belongs to the requested mode.
    struct ModeGroup
    {
      std::vector<int> modes; ///< indices of modes of a point
      Differentiated   kind;
    };

    ModeGroup group_of(const ChartPoint &point, const int mode, const Complex &D)
    {
      const std::vector<int> clusters = mode_clusters(point.lambda);
      ModeGroup              result{{mode}, Differentiated::eigenvalue};
      for (int j = 0; j < static_cast<int>(clusters.size()); ++j)
        if (j != mode && clusters[j] == clusters[mode])
          {
            result.modes.push_back(j);
            result.kind = Differentiated::cluster;
          }
      // κ = 2 |λ| / |D|, because vectors have unit M-norms
      if (result.kind == Differentiated::cluster || 2. * std::abs(point.lambda[mode]) <= coalescing_condition * std::abs(D))
        return result;

      int    partner  = -1;
      double parallel = 0.;
      for (int j = 0; j < static_cast<int>(point.lambda.size()); ++j)
        if (const double overlap = std::abs(point.right.col(mode).dot(point.right.col(j))); j != mode && overlap > parallel)
          {
            partner  = j;
            parallel = overlap;
          }
      return partner < 0 ? result : ModeGroup{{mode, partner}, Differentiated::pair};
    }

    /// Growing modes of the band or, if no mode grows, all its modes, by descending divergence rate; at most @p most.
    std::vector<int> modes_of_interest(const SweepModel &model, const ChartPoint &point, const std::size_t most)
    {
      std::vector<int> result = model.in_band(point);
      if (model.n_of(point, Verdict::unstable) > 0)
        result.erase(std::remove_if(result.begin(), result.end(), [&](const int j) { return point.verdicts[j] != Verdict::unstable; }),
                     result.end());
      std::stable_sort(result.begin(), result.end(), [&](const int a, const int b) {
        return modal_quantities(point.lambda[a]).divergence_rate > modal_quantities(point.lambda[b]).divergence_rate;
      });
      result.resize(std::min(result.size(), most));
      return result;
    }

    /// Nearest mode of a point for each given mode, one to one.
    std::vector<int> nearest_modes(const ChartPoint &point, const std::vector<ModeSensitivity> &modes)
    {
      std::vector<int> result;
      for (const ModeSensitivity &mode : modes)
        {
          int nearest = -1;
          for (int j = 0; j < static_cast<int>(point.lambda.size()); ++j)
            if (std::find(result.begin(), result.end(), j) == result.end() &&
                (nearest < 0 || std::abs(point.lambda[j] - mode.lambda) < std::abs(point.lambda[nearest] - mode.lambda)))
              nearest = j;
          result.push_back(nearest);
        }
      return result;
    }

    ModeSensitivity sensitivity_of(const SensitivityModel &model, const ChartPoint &point, const int mode)
    {
      const SensitivityProducts own      = model.products(point, {mode});
      const ModeGroup           group    = group_of(point, mode, own.D(0, 0));
      const SensitivityProducts products = group.modes.size() == 1 ? own : model.products(point, group.modes);
      std::vector<int>          all(group.modes.size());
      std::iota(all.begin(), all.end(), 0);
      ModeSensitivity result{point.lambda[mode], {}, point.verdicts[mode] == Verdict::unstable, group.kind, {}, {}};
      for (const ComplexDenseMatrix &N : products.N)
        result.derivatives.push_back(mean_derivative(N, products.D, all));
      return result;
    }

    /// Largest modulus of the real or imaginary part of derivatives with respect to ln p.
    double largest(const std::vector<SensitivityParameter> &parameters,
                   const std::vector<Complex>              &derivatives,
                   double (*part)(const Complex &))
    {
      double result = 0.;
      for (std::size_t p = 0; p < parameters.size(); ++p)
        result = std::max(result, std::abs(parameters[p].value * part(derivatives[p])));
      return result;
    }

    const auto real_part      = [](const Complex &z) { return z.real(); };
    const auto imaginary_part = [](const Complex &z) { return z.imag(); };

    /// Stores the changes relative to an earlier basis; returns the largest change relative to the largest derivative of its mode.
    double compare(std::vector<ModeSensitivity>            &modes,
                   const std::vector<ModeSensitivity>      &before,
                   const std::vector<SensitivityParameter> &parameters)
    {
      double result = 0.;
      for (std::size_t m = 0; m < modes.size(); ++m)
        {
          ModeSensitivity &mode = modes[m];
          for (std::size_t p = 0; p < mode.derivatives.size(); ++p)
            mode.changes.push_back(mode.derivatives[p] - before[m].derivatives[p]);
          result =
            std::max(result, largest(parameters, mode.changes, imaginary_part) / largest(parameters, mode.derivatives, imaginary_part));
          // Skip growth rates of neutral modes, because they and their derivatives are rounding errors
          if (const double scale = largest(parameters, mode.derivatives, real_part); scale > negligible_divergence * std::abs(mode.lambda))
            result = std::max(result, largest(parameters, mode.changes, real_part) / scale);
        }
      return result;
    }
  } // namespace

  std::vector<ModeSensitivity> mode_sensitivities(SensitivityModel &model, Run &run)
  {
    SweepModel                  &sweep  = model.sweep;
    const SensitivityParameters &wanted = run.parameters.sensitivity;
    std::vector<ModeSensitivity> result;
    std::string                  why_stopped;
    int                          n_growths = 0;
    run.progress.begin("Derivatives of modes");
    sweep.known.clear();
    while (true)
      {
        const ChartPoint       point = sweep.evaluate(SensitivityModel::main_line, {run.parameters.operation.friction_coefficient}).front();
        const std::vector<int> modes = result.empty() ? modes_of_interest(sweep, point, wanted.modes) : nearest_modes(point, result);
        const std::vector<int> band  = sweep.in_band(point);
        const auto             labels = sweep.labels_in_band(point);
        std::vector<ModeSensitivity> now;
        for (const int mode : modes)
          {
            now.push_back(sensitivity_of(model, point, mode));
            now.back().label = labels[std::find(band.begin(), band.end(), mode) - band.begin()];
          }

        const double change = result.empty() ? std::numeric_limits<double>::infinity() : compare(now, result, model.parameters);
        result              = std::move(now);
        run.progress.update(text("change ", change));
        if (change <= wanted.tolerance)
          break;
        if (n_growths == most_growths)
          why_stopped = text("after ", most_growths, " extensions of the basis, they still change by ", change);
        else
          why_stopped = model.grow({{model.modes_at(point, modes)}}, run.parameters.sweep.maximum_basis);
        if (!why_stopped.empty())
          break;
        ++n_growths;
      }
    run.progress.finish(text(counted(result.size(), "mode"), ", ", counted(model.parameters.size(), "parameter"), "; ",
                             counted(sweep.reduced->size(), "vector"), " after ", counted(n_growths, "extension")));
    if (!why_stopped.empty())
      run.warn("derivatives of modes do not meet Sensitivity/Tolerance: " + why_stopped +
               "; raise Sensitivity/Tolerance, or Sweep/Maximum basis if it limits the basis");
    return result;
  }
} // namespace Squeal
