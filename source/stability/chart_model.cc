#include <squeal/stability/chart_model.h>
#include <squeal/stability/mode_links.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace Squeal
{
  namespace
  {
    /// Columns of X in the band and its margin, each half scaled by a factor of its own, side by side.
    void append_scaled(DenseMatrix &target, const ComplexDenseMatrix &X, const std::vector<std::complex<double>> &lambda)
    {
      for (DenseMatrix part : {real_part(X), imaginary_part(X)})
        {
          for (int j = 0; j < part.n_columns(); ++j)
            std::for_each(part.column(j), part.column(j) + part.n_rows(), [&](double &x) { x /= std::abs(lambda[j]); });
          target = append_columns(target, part);
        }
    }
  } // namespace

  ChartModel::ChartModel(const CoupledSystem  &system,
                         const UpdatedInverse &inverse,
                         const double          shift,
                         const MultiVector    &real_modes,
                         const double          largest_frequency,
                         const double          margin)
    : system(system)
    , inverse(inverse)
    , real_modes(real_modes)
    , shift(shift)
    , largest_frequency(largest_frequency)
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

  int ChartModel::n_real_modes() const
  {
    return real_modes.NumVectors();
  }

  const ReducedModel &ChartModel::reduced() const
  {
    return model;
  }

  ChartPoint ChartModel::evaluate(const OperatingPoint &point) const
  {
    const ParameterValues values    = system.at(point.friction_coefficient, point.values);
    const ReducedModes    modes     = local_reduced_modes(model, values, (1. + margin) * largest_frequency);
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
    for (std::size_t j = 0; j < point.lambda.size(); ++j)
      if (point.lambda[j].imag() <= largest_frequency)
        result = std::max(result, point.errors[j]);
    return result;
  }

  std::vector<int> ChartModel::inaccurate_modes(const ChartPoint &chart, const double tolerance) const
  {
    std::vector<int> result;
    for (std::size_t j = 0; j < chart.lambda.size(); ++j)
      if (chart.lambda[j].imag() <= largest_frequency && !(chart.errors[j] <= tolerance))
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
        modes.right = padded(orthonormal_in_clusters(selected_columns(set.chart->right, set.modes), modes.lambda), model.size());
        modes.left  = padded(orthonormal_in_clusters(selected_columns(set.chart->left, set.modes), modes.lambda), model.size());
        std::vector<int> all(set.modes.size());
        std::iota(all.begin(), all.end(), 0);
        directions.push_back(residual_directions(residual_vectors(system, inverse, model, modes), modes, all));
      }
    if (directions.empty())
      return {};
    std::vector<const MultiVector *> parts;
    for (const MultiVector &part : directions)
      parts.push_back(&part);
    return Squeal::new_vectors(system, model, join(parts));
  }

  void ChartModel::extend(const MultiVector &vectors)
  {
    model.extend(vectors);
    residuals.extend(model);
  }

  MultiVector ChartModel::compressed_basis(const std::vector<ChartPoint> &charts, const double tolerance) const
  {
    const SparseMatrix &M = *system.mass;
    const MultiVector  &T = model.basis();
    DenseMatrix         Y;
    for (const ChartPoint &chart : charts)
      for (const ComplexDenseMatrix *X : {&chart.right, &chart.left})
        append_scaled(Y, orthonormal_in_clusters(*X, chart.lambda), chart.lambda);
    const DenseMatrix R = gram(T, M * real_modes);
    Y                   = add(Y, multiply(R, multiply(R, Y, true)), -1.);

    // Strain energy: K_r = V diag(w) Vᵀ, the squares of Y are those of √w VᵀY
    DenseMatrix V = add(model.stiffness(), model.mass(), shift * shift);
    auto        w = symmetric_eigenvalues(V);
    agree(T.Comm(), V, w);
    DenseMatrix Y_w = multiply(V, Y, true);
    for (int j = 0; j < Y_w.n_columns(); ++j)
      for (int i = 0; i < Y_w.n_rows(); ++i)
        Y_w(i, j) *= std::sqrt(w[i]);
    DenseMatrix axes    = multiply(Y_w, Y_w, false, true);
    auto        squares = symmetric_eigenvalues(axes); // ascending
    agree(T.Comm(), axes, squares);
    const int r = model.size(), first = std::lower_bound(squares.begin(), squares.end(), tolerance) - squares.begin();
    if (first == r)
      return real_modes;
    DenseMatrix Z = columns(axes, first, r - first);
    for (int j = 0; j < Z.n_columns(); ++j)
      for (int i = 0; i < r; ++i)
        Z(i, j) /= std::sqrt(w[i]);
    constexpr double dependence_tolerance = 1e-10;
    const auto       rest                 = orthonormalize_if_any(M, &real_modes, T * multiply(V, Z), dependence_tolerance);
    return rest ? join({&real_modes, &*rest}) : real_modes;
  }

  void ChartModel::restart(const MultiVector &vectors)
  {
    model = ReducedModel(system);
    residuals.clear();
    extend(vectors);
  }
} // namespace Squeal
