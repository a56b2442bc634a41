// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/studies/sweep/sweep_charts.h>

#include <algorithm>
#include <cmath>

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
  } // namespace

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
    // First-order correction of λ by the residuals, since ψ is dual to φ
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
