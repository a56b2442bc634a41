// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/tasks.h>
#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/linear_algebra/orthonormal_basis.h>
#include <squeal/tracking/chart_model.h>
#include <squeal/tracking/mode_links.h>

#include <boost/math/tools/roots.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace Squeal
{
  namespace
  {
    /// Directions with M-norms below this fraction of the largest are rounding errors [-].
    constexpr double dependence_tolerance = 1e-8;
    /// Principal axes of residuals below this fraction of the largest are postponed to the next extension [-].
    constexpr double compression_tolerance = 0.02;

    /// Factor between the tolerance of λ and the squared length of the principal axes that are dropped from a basis [-].
    constexpr double compression_factor = 10.;

    /// Principal axes of vectors below this fraction of the largest are dropped [-].
    constexpr double least_axis = 1e-6;

    /// Orthonormal basis of the span of X, which has few columns; negligible directions are dropped.
    DenseMatrix principal_columns(const DenseMatrix &X)
    {
      const auto [sizes, axes] = singular_values(X); // descending
      const auto n             = std::upper_bound(sizes.begin(), sizes.end(), least_axis * sizes.front(), std::greater<>()) - sizes.begin();
      // Orthonormalise again: small principal axes have lost their orthogonality
      return orthonormal_columns(X * axes.leftCols(n));
    }

    /// λ of a mode, or the mean and (λ_1 − λ_2)² of two modes, which are smooth functions of μ at a coalescence.
    struct LambdaPair
    {
      std::complex<double> mean, square;

      LambdaPair(const std::complex<double> &mean, const std::complex<double> &square)
        : mean(mean)
        , square(square)
      {}

      explicit LambdaPair(const ModesAtPoint &at)
        : LambdaPair(as_column(at.point->lambda)(at.modes).mean(),
                     std::pow(at.point->lambda[at.modes.front()] - at.point->lambda[at.modes.back()], 2))
      {}

      LambdaPair towards(const LambdaPair &other, const double t) const
      {
        return {(1. - t) * mean + t * other.mean, (1. - t) * square + t * other.square};
      }

      /// Moves the values closest to the expected values to the front, because a small basis has additional eigenvalues, which may be close
      /// to the mean.
      void bring_to_front(std::vector<std::complex<double>> &values) const
      {
        auto place = values.begin();
        for (const double sign : {1., -1.})
          if (place != values.end())
            {
              const auto expected = mean + 0.5 * sign * std::sqrt(square);
              std::iter_swap(place, std::min_element(place, values.end(), [&](const auto &x, const auto &y) {
                               return std::abs(x - expected) < std::abs(y - expected);
                             }));
              ++place;
            }
      }
    };
  } // namespace

  ChartModel::ChartModel(const CoupledSystem  &system,
                         const UpdatedInverse &inverse,
                         const double          shift,
                         const MultiVector    &real_modes,
                         const double          largest_circular_frequency)
    : system(system)
    , inverse(inverse)
    , real_modes(&real_modes)
    , shift(shift)
    , largest_circular_frequency(largest_circular_frequency)
    , model(starting_model(system, inverse, real_modes, system.n_contact() > 0))
    , residuals(system, inverse, shift, system.values)
  {}

  void ChartModel::prepare() const
  {
    if (model.size() == 0)
      return;
    residuals.extend(model);
    run_tasks(2, [this](const int part) { part == 0 ? residuals.prepare() : static_cast<void>(model.modal()); });
  }

  ChartPoint ChartModel::evaluate(const OperatingPoint &point) const
  {
    const ParameterValues values = system.at(point.friction_coefficient, point.values);
    // Compute modes in modal coordinates, in which most matrices are diagonal; inner products do not change
    const double     end   = (1. + band_margin) * largest_circular_frequency;
    auto             modal = modal_modes_of_band(model, values, end);
    ReducedModes     modes = modal ? std::move(*modal) : local_reduced_modes_by_qr(model, values, end);
    std::vector<int> slow;
    for (std::size_t j = 0; j < modes.lambda.size(); ++j)
      if (modes.lambda[j].real() >= -largest_decay)
        slow.push_back(static_cast<int>(j));
    if (slow.size() < modes.lambda.size())
      modes = selected(modes, slow);
    ComplexDenseMatrix right = modes.right, left = modes.left;
    const auto         transform_from_modal = [&](ComplexDenseMatrix &X, ComplexDenseMatrix &X_modal) {
      X = multiply(model.modal().vectors, X);
      for (Eigen::Index j = 0; j < X.cols(); ++j)
        {
          const double norm = X.col(j).norm();
          X.col(j) /= norm;
          X_modal.col(j) /= norm;
        }
    };
    if (modal)
      {
        transform_from_modal(right, modes.right);
        transform_from_modal(left, modes.left);
      }
    const auto estimates = estimate_eigenvalues(modes, residuals.products(values, modes.lambda, right, left));

    ChartPoint result{point.friction_coefficient, modes.lambda,     std::move(right),        std::move(left),    estimates.energy_residuals,
                      estimates.left_residuals,   estimates.errors, estimates.uncertainties, estimates.verdicts, estimates.couplings,
                      modes.real_values,          modes.n_zeros};
    for (std::size_t j = 0; j < modes.lambda.size(); ++j)
      {
        if (!estimates.claimed[j])
          result.errors[j] = estimates.uncertainties[j] / std::abs(modes.lambda[j]);
        if (!allows_cancellation)
          result.errors[j] = std::max(result.errors[j], 0.5 * estimates.conditions[j] *
                                                          std::sqrt(estimates.energy_residuals[j] * estimates.left_residuals[j]));
      }
    return result;
  }

  std::optional<double> ChartModel::predicted_zero(const ZeroSearch     &search,
                                                   const OperatingPoint &first,
                                                   const OperatingPoint &second) const
  {
    DenseMatrix               X;
    std::vector<ModesAtPoint> known = search.beyond;
    known.push_back(search.first);
    known.push_back(search.second);
    for (const auto &[point, modes] : known)
      for (const ComplexDenseMatrix *vectors : {&point->right, &point->left})
        X = append_columns(X, halves(with_rows((*vectors)(Eigen::placeholders::all, modes), model.size())));
    const ReducedModel small = model.restricted(principal_columns(X));

    const double     a = first.friction_coefficient, b = second.friction_coefficient;
    const LambdaPair before(search.first), after(search.second);
    const auto       value = [&](const double mu) {
      const double    t = (mu - a) / (b - a);
      ParameterValues others;
      for (const auto &[name, numbers] : first.values)
        {
          std::vector<double> &between = others[name]; // keeps empty lists, which mean zeros
          for (std::size_t i = 0; i < numbers.size(); ++i)
            between.push_back((1. - t) * numbers[i] + t * second.values.at(name)[i]);
        }
      std::vector<std::complex<double>> lambda =
        local_reduced_modes(small, system.at(mu, others), (1. + band_margin) * largest_circular_frequency).lambda;
      if (lambda.size() < search.first.modes.size())
        return std::numeric_limits<double>::quiet_NaN();
      before.towards(after, t).bring_to_front(lambda);
      switch (search.function)
        {
          case ModeFunction::growth:
            return lambda[0].real();
          case ModeFunction::discriminant:
            return ((lambda[0] - lambda[1]) * (lambda[0] - lambda[1])).real();
          case ModeFunction::frequency:
            return lambda[0].imag() - search.bound;
        }
      return std::numeric_limits<double>::quiet_NaN();
    };
    const double at_a = value(a), at_b = value(b);
    if (!(at_a * at_b < 0.))
      return {};
    constexpr double resolution = 1e-10;
    std::uintmax_t   n_steps    = 50;
    const auto       bracket    = boost::math::tools::toms748_solve(
               value, a, b, at_a, at_b, [](const double x, const double y) { return std::abs(x - y) <= resolution; }, n_steps);
    const double result = 0.5 * (bracket.first + bracket.second);
    return result > a && result < b ? std::optional(result) : std::nullopt;
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
    const int n_missing = system.map().n() - model.size(); // number of vectors missing for a complete basis
    if (n_missing <= 0)
      return {};
    std::vector<ProjectedResiduals::ModesAt> modes;
    for (const ModesAt &set : sets)
      {
        if (set.modes.empty())
          continue;
        std::vector<std::complex<double>> lambda;
        for (const int j : set.modes)
          lambda.push_back(set.chart->lambda[j]);
        modes.push_back({system.at(set.point.friction_coefficient, set.point.values), lambda,
                         with_rows(orthonormal_in_clusters(set.chart->right(Eigen::placeholders::all, set.modes), lambda), model.size()),
                         with_rows(orthonormal_in_clusters(set.chart->left(Eigen::placeholders::all, set.modes), lambda), model.size())});
      }
    residuals.extend(model);
    std::optional<MultiVector> responses = residuals.principal_responses(model, modes, compression_tolerance);
    if (!responses)
      return {};
    // Remove components within the span of the basis first, so that the tolerance is relative to the remainder
    remove_basis(*system.mass, model, *responses);
    auto result =
      orthonormalize_if_any(*system.mass, &model.basis(), std::move(*responses), dependence_tolerance, nullptr, FirstProjection::done);
    if (result && result->n_columns() > n_missing)
      return MultiVector(view(*result, 0, n_missing));
    return result;
  }

  void ChartModel::extend(MultiVector vectors)
  {
    model.extend(std::move(vectors));
  }

  DenseMatrix ChartModel::principal_parts(const DenseMatrix             &real_modes,
                                          const std::vector<ChartPoint> &charts,
                                          const double                   tolerance) const
  {
    DenseMatrix Y;
    for (const ChartPoint &chart : charts)
      for (const ComplexDenseMatrix *X : {&chart.right, &chart.left})
        {
          // Scale to unit strain energy
          const Eigen::VectorXcd scales = as_column(chart.lambda).cwiseAbs().cwiseInverse().cast<std::complex<double>>();
          Y = append_columns(Y, halves(orthonormal_in_clusters(with_rows(*X, model.size()), chart.lambda) * scales.asDiagonal()));
        }
    Y -= real_modes * (real_modes.transpose() * Y);

    // Strain energy: with K_r = V diag(w) Vᵀ, the squared norms of Y are the squared norms of √w VᵀY
    const MPI_Comm communicator = inverse.map().communicator();
    const auto [w, V]           = agreed(communicator, symmetric_eigenpairs(model.stiffness() + shift * shift * model.mass()));
    const DenseMatrix Y_w       = as_column(w).cwiseSqrt().asDiagonal() * (V.transpose() * Y);
    const auto [squares, axes]  = agreed(communicator, symmetric_eigenpairs(Y_w * Y_w.transpose())); // ascending
    const Eigen::Index r        = model.size(),
                       first    = std::lower_bound(squares.begin(), squares.end(), compression_factor * tolerance) - squares.begin();
    const DenseMatrix Z         = as_column(w).cwiseSqrt().cwiseInverse().asDiagonal() * axes.rightCols(r - first);
    return V * Z;
  }

  DenseMatrix ChartModel::real_coordinates() const
  {
    return gram(model.basis(), *system.mass * *real_modes);
  }

  MultiVector ChartModel::compressed_basis(const std::vector<ChartPoint> &charts, const double tolerance, const int maximum) const
  {
    const SparseMatrix &M     = *system.mass;
    const MultiVector  &T     = model.basis();
    const DenseMatrix   parts = principal_parts(real_coordinates(), charts, tolerance);
    if (parts.cols() == 0)
      return *real_modes;
    constexpr double independent = 1e-10;
    const auto       rest        = orthonormalize_if_any(M, real_modes, T * parts, independent);
    const int        n_rest      = rest ? std::min(rest->n_columns(), maximum - real_modes->n_columns()) : 0;
    if (n_rest <= 0)
      return *real_modes;
    const MultiVector largest = view(*rest, 0, n_rest);
    return join({real_modes, &largest});
  }

  std::unique_ptr<ChartModel> ChartModel::restricted(const std::vector<ChartPoint> &charts, const double tolerance) const
  {
    residuals.extend(model);
    DenseMatrix       Z     = orthonormal_columns(real_coordinates());
    const DenseMatrix parts = principal_parts(Z, charts, tolerance);
    Z                       = append_columns(Z, orthonormal_columns(parts - Z * (Z.transpose() * parts)));
    auto result             = std::make_unique<ChartModel>(*this);
    result->model           = model.restricted(Z, true);
    result->residuals.restrict(result->model, Z);
    return result;
  }

  void ChartModel::restart(MultiVector vectors)
  {
    model = ReducedModel(system);
    residuals.clear();
    extend(std::move(vectors));
  }
} // namespace Squeal
