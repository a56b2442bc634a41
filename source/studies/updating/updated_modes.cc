// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/groups.h>
#include <squeal/studies/sensitivity/sensitivity_results.h>
#include <squeal/studies/updating/updating.h>
#include <squeal/tracking/mode_links.h>

#include <cmath>

namespace Squeal
{
  namespace
  {
    using Derivatives = std::vector<std::vector<std::complex<double>>>;

    /// Indices of the modes with Im λ > 0, in clusters of equal λ.
    std::vector<std::vector<int>> clusters_of(const std::vector<std::complex<double>> &lambda)
    {
      std::vector<int>                  numbers;
      std::vector<std::complex<double>> oscillating;
      for (int j = 0; j < static_cast<int>(lambda.size()); ++j)
        if (lambda[j].imag() > 0.)
          {
            numbers.push_back(j);
            oscillating.push_back(lambda[j]);
          }
      std::vector<std::vector<int>> result = members_of(mode_clusters(oscillating));
      for (std::vector<int> &cluster : result)
        for (int &j : cluster)
          j = numbers[j];
      return result;
    }

    /// Σ c φ_jᵀ A φ_j over the factors c and matrices A of the sum, for each mode j.
    Eigen::VectorXd diagonal_of(const BodyRates::Sum &sum, const MultiVector &shapes)
    {
      Eigen::VectorXd result = Eigen::VectorXd::Zero(shapes.n_columns());
      for (const auto &[factor, matrix] : sum)
        result += factor * weighted_gram(shapes, *matrix).diagonal();
      return result;
    }
  } // namespace

  Derivatives real_mode_derivatives(const std::vector<double> &squares, const MultiVector &shapes, const std::vector<BodyRates> &rates)
  {
    Derivatives                       result(squares.size(), std::vector<std::complex<double>>(rates.size()));
    std::vector<std::complex<double>> lambda;
    for (const double square : squares)
      lambda.emplace_back(0., std::sqrt(std::max(square, 0.)));
    const std::vector<std::vector<int>> clusters = clusters_of(lambda);
    for (std::size_t p = 0; p < rates.size(); ++p)
      {
        const Eigen::VectorXd of_squares =
          diagonal_of(rates[p].stiffness, shapes) - as_column(squares).cwiseProduct(diagonal_of(rates[p].mass, shapes));
        for (const std::vector<int> &cluster : clusters)
          for (const int j : cluster)
            result[j][p] = {0., of_squares(cluster).mean() / (2. * lambda[j].imag())};
      }
    return result;
  }

  Derivatives complex_mode_derivatives(const std::vector<std::complex<double>> &lambda,
                                       const std::vector<ComplexDenseMatrix>   &N,
                                       const ComplexDenseMatrix                &D)
  {
    Derivatives result(lambda.size(), std::vector<std::complex<double>>(N.size()));
    for (const std::vector<int> &cluster : clusters_of(lambda))
      for (const int j : cluster)
        for (std::size_t p = 0; p < N.size(); ++p)
          result[j][p] = cluster.size() == 1 ? eigenvalue_derivative(N[p], D, j) : mean_derivative(N[p], D, cluster);
    return result;
  }

  ComplexDenseMatrix at_sensors(const std::shared_ptr<const SparseMatrix> &rows, const MultiVector &re, const MultiVector *im)
  {
    if (rows == nullptr)
      return ComplexDenseMatrix(0, re.n_columns());
    ComplexDenseMatrix result = replicate(*rows * re).cast<std::complex<double>>();
    if (im != nullptr)
      result += std::complex<double>(0., 1.) * replicate(*rows * *im);
    return result;
  }

  // ----------------------------------------------------------------------- of a system file

  ModesAtValues modes_of_file(const SystemFile                   &file,
                              const std::vector<FittedParameter> &parameters,
                              const MeasuredModes                &measured,
                              Run                                &run)
  {
    if (measured.has(MeasuredState::component))
      throw ParameterError("component modes are measured, but a system file has none", "column `state` of the measured modes",
                           "give coupled and complex modes only");
    std::shared_ptr<const SparseMatrix> sensors; // matrix from dofs to responses of the sensors
    if (!measured.sensors.shapes.empty())
      {
        if (!file.points)
          throw ParameterError("the system file has no points to which sensors can be assigned", "file " + file.path,
                               "add `positions` and `displacements` to the file, or clear Updating/Sensors");
        sensors = measured.sensors.rows(*file.points);
      }
    return [&, sensors](const std::vector<double> &values) {
      GivenSystem given{file, {}, {}, 0.};
      auto        others = run.parameters.system.values;
      for (std::size_t p = 0; p < parameters.size(); ++p)
        others[parameters[p].name] = values[p];
      given.values             = file.values(others);
      const std::string varied = file.default_varied();
      given.coupled = imported_system(file, given.values, varied, circular_frequency(run.parameters.discretization.maximum_frequency));
      given.value   = given.values.at(varied).front();
      const CoupledSystem &system = given.coupled;

      Progress                         silent;
      Run                              part(run.parameters, run, silent);
      std::optional<FrictionlessModes> frictionless;
      if (system.stiffness || measured.has(MeasuredState::coupled))
        frictionless = imported_modes(system, system, part);
      std::vector<ComputedMode> result;
      if (measured.has(MeasuredState::coupled))
        {
          std::vector<Term> terms;
          for (const Term &term : system.terms)
            if (term.matrix && term.is_frictionless())
              terms.push_back(term);
          std::vector<BodyRates> rates(parameters.size());
          for (std::size_t p = 0; p < parameters.size(); ++p)
            rates[p].add_along(terms, system.at(given.value), {{parameters[p].name, {1.}}});
          const SymmetricModes    &real        = frictionless->real;
          const Derivatives        derivatives = real_mode_derivatives(real.eigenvalues, *real.vectors, rates);
          const ComplexDenseMatrix responses   = at_sensors(sensors, *real.vectors);
          for (std::size_t j = 0; j < real.eigenvalues.size(); ++j)
            result.push_back({MeasuredState::coupled,
                              to_string(frictionless->labels[j]),
                              {0., std::sqrt(real.eigenvalues[j])},
                              derivatives[j],
                              responses.col(static_cast<Eigen::Index>(j))});
        }
      if (measured.has(MeasuredState::complex))
        {
          const FrictionModes friction =
            frictionless ? left_and_right_modes(*frictionless, given.value, part) : direct_solution(given, part);
          const TermProducts              products(system.terms, eigentriples(friction.modes));
          const ParameterValues           at = system.at(given.value);
          std::vector<ComplexDenseMatrix> N;
          for (const FittedParameter &parameter : parameters)
            N.push_back(products.along(at, {{parameter.name, {1.}}}));
          const auto              &lambda      = friction.modes.lambda;
          const Derivatives        derivatives = complex_mode_derivatives(lambda, N, products.by_lambda(at));
          const ComplexDenseMatrix responses   = at_sensors(sensors, *friction.modes.real_part, friction.modes.imaginary_part.get());
          for (std::size_t j = 0; j < lambda.size(); ++j)
            result.push_back({MeasuredState::complex, to_string(friction.labels[j]), lambda[j], derivatives[j],
                              responses.col(static_cast<Eigen::Index>(j))});
        }
      return result;
    };
  }
} // namespace Squeal
