// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/communication.h>
#include <squeal/studies/steps/imported_modes.h>
#include <squeal/tracking/chart_model.h>

#include <cmath>

namespace Squeal
{
  namespace
  {
    /// Block size of the eigensolver.
    constexpr int block_size_of_modes = 8;
  } // namespace

  ModeLabel numbered_label(const int number)
  {
    ModeLabel label;
    label.family        = ModeFamily::body;
    label.body          = "mode";
    label.rank          = number;
    label.participation = 1.;
    return label;
  }

  SystemFile read_system(Run &run)
  {
    run.progress.begin("System");
    SystemFile  result = read_system(run.parameters.system.path(), run.communicator);
    std::string names;
    for (const FileParameter &parameter : result.parameters)
      names += (names.empty() ? "" : ", ") + parameter.name;
    run.progress.finish(text(counted(result.map.n(), "dof"), ", ", counted(result.terms.size(), "term"), ", ",
                             names.empty() ? "no parameters" : "parameters " + names));
    run.count("dofs", result.map.n());
    return result;
  }

  GivenSystem given_system(Run &run)
  {
    SystemFile            file   = read_system(run);
    const ParameterValues values = file.values(run.parameters.system.values);
    const std::string     varied = file.default_varied();
    CoupledSystem coupled = imported_system(file, values, varied, circular_frequency(run.parameters.discretization.maximum_frequency));
    return {std::move(file), values, std::move(coupled), varied.empty() ? 0. : values.at(varied).front()};
  }

  FrictionlessModes imported_modes(const CoupledSystem &system, const CoupledSystem &whole, Run &run, const double margin)
  {
    const double omega_max = circular_frequency(run.parameters.discretization.maximum_frequency);
    const auto  &solvers   = run.parameters.solvers;
    const auto   shift     = system.stiffness ? definite_shift(system, omega_max) : std::nullopt;
    if (!shift)
      throw SolverError(
        "stiffness or mass has no symmetric terms, the symmetric stiffness has negative eigenvalues, or both are singular for the same motion",
        "file " + run.parameters.system.path(),
        "mark destabilising terms with \"kind\": \"friction\", eliminate constraints, correct the signs of terms, "
        "or, for Study = updating, give complex modes only");
    const auto count = number_of_modes(system, (1. + margin) * omega_max, solvers, run.progress);

    FrictionlessModes result;
    static_cast<SystemModes &>(result) = system_modes(system, *shift, omega_max, count, block_size_of_modes, solvers, run.progress);
    result.linearisation.coupled       = whole;
    run.measure("entries of the Cholesky factor", result.inverse->frictionless().n_factor_entries());
    run.count("real modes", n_in_band(result.real.eigenvalues, omega_max * omega_max));
    for (int j = 0; j < result.real.vectors->n_columns(); ++j)
      result.labels.push_back(numbered_label(j + 1));
    result.disc = {result.labels, result.real.eigenvalues, result.real.residuals, result.real.vectors};
    return result;
  }

  FrictionlessModes starting_modes(const CoupledSystem &whole, Run &run)
  {
    if (whole.stiffness)
      return imported_modes(undamped(whole), whole, run, band_margin);
    FrictionlessModes result;
    result.linearisation.coupled = whole;
    return result;
  }

  FrictionModes direct_solution(const GivenSystem &given, Run &run)
  {
    run.progress.begin("Complex modes");
    run.progress.note("  no definite part: Q itself is factorised, and modes are labelled by number");
    FrictionModes result;
    static_cast<JudgedModes &>(result) = direct_modes(given.coupled, given.value, run.parameters.discretization.band(),
                                                      run.parameters.solvers, "file " + given.file.path, run.progress);
    if (result.modes.lambda.empty())
      throw SolverError("there are no oscillating modes in the band", "complex modes", "raise Band/Maximum frequency");
    for (std::size_t j = 0; j < result.modes.lambda.size(); ++j)
      result.labels.push_back(numbered_label(static_cast<int>(j) + 1));
    if (!given.coupled.varied.empty())
      result.at = text(" at ", given.coupled.varied, " = ", exact_text(given.value));
    result.cost = run.progress.finish(
      text(result.modes.lambda.size(), " found, ", result.n_unstable(), " unstable", result.at, "; ", result.modes.summary));
    count_modes(given, {}, result, run);
    return result;
  }

  CountedModes counted_modes(const CoupledSystem &system, const double value, const FrictionlessModes &frictionless, Run &run)
  {
    const Band band = run.parameters.discretization.band();
    if (!system.stiffness)
      {
        const ContourOptions contour = contour_of_band(band);
        return {contour, count_by_sparse_lu(sparse_matrices(system.terms, system.at(value)), contour, run.progress)};
      }
    const ContourOptions contour = contour_of_band(system, frictionless, band, run.parameters.solvers);
    return {contour, count_by_contour(system, {value}, contour, run.progress).front()};
  }

  void count_modes(const GivenSystem &given, const FrictionlessModes &frictionless, const FrictionModes &friction, Run &run)
  {
    run.progress.begin("Argument principle");
    if (!is_countable(given.coupled))
      {
        run.progress.finish("modes are not counted, because this requires a single process");
        return;
      }
    const auto [contour, count] = counted_modes(given.coupled, given.value, frictionless, run);
    check_count(count.n_modes, friction.modes.lambda, contour);
    run.count("complex modes counted by the argument principle", count.n_modes);
    run.progress.finish(text(counted(count.n_modes, "mode"), " counted and found up to |Re lambda| = ", contour.largest_growth, " 1/s, ",
                             counted(count.n_points, "point")));
  }

  Columns<int> accuracy_columns(const GivenSystem &given, const JudgedModes &modes)
  {
    const auto column = [](const std::string &name, const std::vector<double> &values) {
      return Column<int>{name, "-", [values](const int j) { return values[j]; }, 1, true};
    };
    return {column("backward error", backward_errors(given.coupled, given.coupled.at(given.value), modes.modes)),
            column("condition number", modes.conditioning.modes), column("error of lambda", modes.conditioning.errors)};
  }

  Columns<int> group_columns(const GivenSystem &given, const ComplexModes &modes)
  {
    const SystemFile  &file = given.file;
    const MultiVector &re = *modes.real_part, &im = *modes.imaginary_part;
    const auto mass = given.coupled.mass ? given.coupled.mass : sparse_matrices(given.coupled.terms, given.coupled.at(given.value)).mass;
    const MultiVector M_re = *mass * re, M_im = *mass * im;
    const DenseMatrix energies = re.local().cwiseProduct(M_re.local()) + im.local().cwiseProduct(M_im.local()); // at each dof
    DenseMatrix       shares   = DenseMatrix::Zero(static_cast<Eigen::Index>(file.groups.size()), energies.cols());
    for (std::size_t g = 0; g < file.groups.size(); ++g)
      for (const auto &[first, last] : file.groups[g].ranges)
        for (int dof = first; dof <= last; ++dof)
          if (const int place = re.map().place(dof); place >= 0)
            shares.row(static_cast<Eigen::Index>(g)) += energies.row(place);
    sum_over_processes(re.map().communicator(), shares.data(), static_cast<std::size_t>(shares.size()));
    Eigen::RowVectorXd all = energies.colwise().sum();
    sum_over_processes(re.map().communicator(), all.data(), static_cast<std::size_t>(all.size()));
    shares = shares * all.cwiseInverse().asDiagonal();
    Columns<int> result;
    for (std::size_t g = 0; g < file.groups.size(); ++g)
      result.push_back({"kinetic energy of " + file.groups[g].name, "%",
                        [shares, g](const int j) { return 100. * shares(static_cast<Eigen::Index>(g), j); }, 1});
    return result;
  }
} // namespace Squeal
