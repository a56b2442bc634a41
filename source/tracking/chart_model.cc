#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/tracking/chart_model.h>
#include <squeal/tracking/mode_links.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace Squeal
{
  ChartModel::ChartModel(const CoupledSystem  &system,
                         const UpdatedInverse &inverse,
                         const double          shift,
                         const MultiVector    &real_modes,
                         const double          largest_circular_frequency,
                         const double          margin)
    : system(system)
    , inverse(inverse)
    , real_modes(real_modes)
    , shift(shift)
    , largest_circular_frequency(largest_circular_frequency)
    , margin(margin)
    , model(starting_model(system, inverse, real_modes, true))
    , residuals(system, inverse, shift, system.values)
  {
    residuals.extend(model);
  }

  int ChartModel::size() const
  {
    return model.size();
  }

  const ReducedModel &ChartModel::reduced() const
  {
    return model;
  }

  ChartPoint ChartModel::evaluate(const OperatingPoint &point) const
  {
    const ParameterValues values    = system.at(point.friction_coefficient, point.values);
    const ReducedModes    modes     = local_reduced_modes(model, values, (1. + margin) * largest_circular_frequency);
    const auto            estimates = estimate_eigenvalues(modes, residuals.products(values, modes.lambda, modes.right, modes.left));

    ChartPoint result{point.friction_coefficient,
                      modes.lambda,
                      modes.right,
                      modes.left,
                      estimates.energy_residuals,
                      estimates.left_residuals,
                      estimates.errors,
                      estimates.uncertainties,
                      estimates.verdicts,
                      estimates.couplings,
                      modes.real_values,
                      modes.n_zeros};
    for (std::size_t j = 0; j < modes.lambda.size(); ++j)
      if (!estimates.claimed[j])
        result.errors[j] = estimates.uncertainties[j] / std::abs(modes.lambda[j]);
    return result;
  }

  double ChartModel::largest_error(const ChartPoint &point) const
  {
    double result = 0.;
    for (const int j : inaccurate_modes(point, 0.))
      result = std::max(result, point.errors[j]);
    return result;
  }

  std::vector<int> ChartModel::inaccurate_modes(const ChartPoint &chart, const double tolerance) const
  {
    std::vector<int> result;
    for (std::size_t j = 0; j < chart.lambda.size(); ++j)
      if (chart.lambda[j].imag() <= largest_circular_frequency && !(chart.errors[j] <= tolerance))
        result.push_back(static_cast<int>(j));
    return result;
  }

  std::optional<MultiVector> ChartModel::new_vectors(const std::vector<ModesAt> &sets) const
  {
    std::vector<MultiVector> directions;
    for (const ModesAt &set : sets)
      {
        if (set.modes.empty())
          continue;
        ReducedModes modes;
        modes.values = system.at(set.point.friction_coefficient, set.point.values);
        for (const int j : set.modes)
          modes.lambda.push_back(set.chart->lambda[j]);
        modes.right = with_rows(orthonormal_in_clusters(set.chart->right(Eigen::all, set.modes), modes.lambda), model.size());
        modes.left  = with_rows(orthonormal_in_clusters(set.chart->left(Eigen::all, set.modes), modes.lambda), model.size());
        std::vector<int> all(set.modes.size());
        std::iota(all.begin(), all.end(), 0);
        directions.push_back(residual_directions(residual_vectors(system, inverse, model, modes), modes, all));
      }
    return Squeal::new_vectors(system, model, directions);
  }

  void ChartModel::extend(const MultiVector &vectors)
  {
    model.extend(vectors);
    residuals.extend(model);
  }

  MultiVector ChartModel::compressed_basis(const std::vector<ChartPoint> &charts, const double tolerance, const int maximum) const
  {
    const SparseMatrix &M = *system.mass;
    const MultiVector  &T = model.basis();
    DenseMatrix         Y;
    for (const ChartPoint &chart : charts)
      for (const ComplexDenseMatrix *X : {&chart.right, &chart.left})
        {
          // Of unit strain energy
          const Eigen::VectorXcd scales = as_column(chart.lambda).cwiseAbs().cwiseInverse().cast<std::complex<double>>();
          Y                             = append_columns(Y, halves(orthonormal_in_clusters(*X, chart.lambda) * scales.asDiagonal()));
        }
    const DenseMatrix R = gram(T, M * real_modes);
    Y -= R * (R.transpose() * Y);

    // Strain energy: K_r = V diag(w) Vᵀ, the squares of Y are those of √w VᵀY
    const auto [w, V]          = agreed(T.communicator(), symmetric_eigenpairs(model.stiffness() + shift * shift * model.mass()));
    const DenseMatrix Y_w      = as_column(w).cwiseSqrt().asDiagonal() * (V.transpose() * Y);
    const auto [squares, axes] = agreed(T.communicator(), symmetric_eigenpairs(Y_w * Y_w.transpose())); // ascending
    const int r = model.size(), first = std::lower_bound(squares.begin(), squares.end(), tolerance) - squares.begin();
    if (first == r)
      return real_modes;
    const DenseMatrix Z                    = as_column(w).cwiseSqrt().cwiseInverse().asDiagonal() * axes.rightCols(r - first);
    constexpr double  dependence_tolerance = 1e-10;
    const auto        rest                 = orthonormalize_if_any(M, &real_modes, T * DenseMatrix(V * Z), dependence_tolerance);
    const int         n_rest               = rest ? std::min(rest->n_columns(), maximum - real_modes.n_columns()) : 0;
    if (n_rest <= 0)
      return real_modes;
    const MultiVector largest = view(*rest, 0, n_rest);
    return join({&real_modes, &largest});
  }

  void ChartModel::restart(const MultiVector &vectors)
  {
    model = ReducedModel(system);
    residuals.clear();
    extend(vectors);
  }
} // namespace Squeal
