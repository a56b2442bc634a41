// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/groups.h>
#include <squeal/studies/updating/least_squares.h>

#define GLOG_USE_GLOG_EXPORT // the headers of glog 0.7 require this macro
#include <ceres/cost_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace Squeal
{
  namespace
  {
    /// A parameter within this distance of an end of the unit interval is at its limit.
    constexpr double at_limit = 1e-6;

    /// Largest Gauss-Newton step that rounding errors and curvature of the residuals may cause at a minimum [-].
    constexpr double step_at_minimum = 1e-3;

    /// Parameters at a limit beyond which |r| would decrease.
    std::vector<int> held_by_limits(const std::vector<double> &x, const Residuals &residuals)
    {
      const Eigen::VectorXd gradient = residuals.J.transpose() * residuals.r;
      std::vector<int>      result;
      for (int i = 0; i < static_cast<int>(x.size()); ++i)
        if ((x[i] <= at_limit && gradient[i] > 0.) || (x[i] >= 1. - at_limit && gradient[i] < 0.))
          result.push_back(i);
      return result;
    }

    /// Parameters that are not held by a limit.
    std::vector<Eigen::Index> free_parameters(const std::vector<double> &x, const Residuals &residuals)
    {
      const std::vector<int>    held = held_by_limits(x, residuals);
      std::vector<Eigen::Index> result;
      for (int i = 0; i < static_cast<int>(x.size()); ++i)
        if (std::find(held.begin(), held.end(), i) == held.end())
          result.push_back(i);
      return result;
    }

    /// Singular values below this fraction of the largest one are attributed to errors of the derivatives.
    constexpr double smallest_singular_value = 1e-7;

    /// Largest component of the Gauss-Newton step of the free parameters, in the directions that the data determine.
    double remaining_step(const std::vector<double> &x, const Residuals &residuals)
    {
      const std::vector<Eigen::Index> free = free_parameters(x, residuals);
      if (free.empty())
        return 0.;
      Eigen::JacobiSVD<DenseMatrix> svd(DenseMatrix(residuals.J(Eigen::placeholders::all, free)),
                                        Eigen::ComputeThinU | Eigen::ComputeThinV);
      svd.setThreshold(smallest_singular_value);
      return svd.solve(residuals.r).cwiseAbs().maxCoeff();
    }

    /// Largest relative offset of a minimum: remaining steps are small compared with the standard deviations of the parameters [-].
    constexpr double offset_at_minimum = 0.01;

    /// √(‖P r‖²/n) / √(‖r − P r‖²/(m − n)) with the projection P onto the columns of J, m numbers and n free parameters (D. M. Bates,
    /// D. G. Watts, Technometrics 23 (1981) 179); infinite for m <= n.
    double relative_offset(const std::vector<double> &x, const Residuals &residuals)
    {
      const std::vector<Eigen::Index> free = free_parameters(x, residuals);
      const auto                      m = residuals.r.size(), n = static_cast<Eigen::Index>(free.size());
      if (m <= n)
        return std::numeric_limits<double>::infinity();
      const DenseMatrix     J         = residuals.J(Eigen::placeholders::all, free);
      const Eigen::VectorXd projected = J * J.colPivHouseholderQr().solve(residuals.r);
      return std::sqrt(projected.squaredNorm() / n / ((residuals.r - projected).squaredNorm() / (m - n)));
    }

    /// A parameter is undetermined if the squared norm of its component in undetermined directions exceeds this value.
    constexpr double undetermined_square = 1e-4;

    /// Undetermined parameters form a group if the cosine between their components in undetermined directions exceeds this value.
    constexpr double act_alike = 0.1;

    /// Residuals for Ceres, cached so that each point is computed once.
    class RememberedResiduals : public ceres::CostFunction
    {
    public:
      RememberedResiduals(const ResidualsAt &residuals_at, const std::vector<double> &start)
        : residuals_at(residuals_at)
        , n(start.size())
      {
        set_num_residuals(static_cast<int>(at(start)->r.size()));
        mutable_parameter_block_sizes()->push_back(static_cast<int>(n));
      }

      const std::optional<Residuals> &at(const std::vector<double> &x) const
      {
        const auto known = points.find(x);
        return known != points.end() ? known->second : points.emplace(x, residuals_at(x)).first->second;
      }

      bool Evaluate(const double *const *parameters, double *residuals, double **jacobians) const override
      {
        const std::optional<Residuals> &found = at({parameters[0], parameters[0] + n});
        if (!found)
          return false;
        std::copy_n(found->r.data(), found->r.size(), residuals);
        if (jacobians != nullptr && jacobians[0] != nullptr)
          Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(jacobians[0], found->J.rows(),
                                                                                             found->J.cols()) = found->J;
        return true;
      }

    private:
      const ResidualsAt                                              &residuals_at;
      const std::size_t                                               n;
      mutable std::map<std::vector<double>, std::optional<Residuals>> points;
    };
  } // namespace

  Fit least_squares(const ResidualsAt &residuals_at, const std::vector<double> &start, const double tolerance, const int maximum_iterations)
  {
    Fit                       result{start, {}, false, 0, {}};
    const RememberedResiduals residuals(residuals_at, start);

    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(ownership);
    problem.AddResidualBlock(const_cast<RememberedResiduals *>(&residuals), nullptr, result.x.data());
    for (int i = 0; i < static_cast<int>(start.size()); ++i)
      {
        problem.SetParameterLowerBound(result.x.data(), i, 0.);
        problem.SetParameterUpperBound(result.x.data(), i, 1.);
      }

    ceres::Solver::Options options;
    options.linear_solver_type                = ceres::DENSE_QR;
    options.logging_type                      = ceres::SILENT;
    options.num_threads                       = 1;
    options.max_num_iterations                = maximum_iterations;
    options.parameter_tolerance               = tolerance;
    options.function_tolerance                = tolerance * tolerance;
    options.gradient_tolerance                = 1e-16;
    options.min_trust_region_radius           = tolerance * tolerance;
    options.max_num_consecutive_invalid_steps = maximum_iterations;
    // Fix the parameters at limits and continue with the others, because steps truncated at a limit end the search too early
    std::vector<int>  held;
    const std::size_t most_changes = 4 * start.size();
    for (std::size_t change = 0;; ++change)
      {
        ceres::Solver::Summary summary;
        ceres::Solve(options, &problem, &summary);
        result.has_converged = summary.termination_type == ceres::CONVERGENCE;
        result.n_iterations += summary.num_successful_steps + summary.num_unsuccessful_steps;
        result.message                 = summary.message;
        result.residuals               = *residuals.at(result.x);
        const std::vector<int> reached = held_by_limits(result.x, result.residuals);
        if (!result.has_converged || reached.size() == start.size())
          break;
        if (reached == held || change == most_changes)
          {
            result.has_converged = reached == held && (remaining_step(result.x, result.residuals) <= std::max(step_at_minimum, tolerance) ||
                                                       relative_offset(result.x, result.residuals) <= offset_at_minimum);
            break;
          }
        held = reached;
        problem.SetManifold(result.x.data(), new ceres::SubsetManifold(static_cast<int>(start.size()), held));
      }
    return result;
  }

  FitStatistics fit_statistics(const Residuals &residuals, const std::vector<double> &x, const bool is_relative)
  {
    const std::size_t               n = x.size();
    FitStatistics                   result{{}, std::vector<std::optional<double>>(n), DenseMatrix::Zero(n, n), {}};
    const std::vector<Eigen::Index> free = free_parameters(x, residuals);
    result.is_at_limit.assign(n, true);
    for (const Eigen::Index i : free)
      result.is_at_limit[i] = false;
    if (free.empty())
      return result;

    const auto                          n_free = static_cast<Eigen::Index>(free.size()), m = residuals.r.size();
    const Eigen::JacobiSVD<DenseMatrix> svd(DenseMatrix(residuals.J(Eigen::placeholders::all, free)), Eigen::ComputeFullV);
    Eigen::VectorXd                     S = Eigen::VectorXd::Zero(n_free); // padded with zeros if there are fewer data than parameters
    S.head(svd.singularValues().size())   = svd.singularValues();
    const DenseMatrix &V                  = svd.matrixV();
    const bool         has_scale          = !is_relative || m > n_free;
    const double       s = !is_relative ? 1. : m > n_free ? std::sqrt(residuals.r.squaredNorm() / static_cast<double>(m - n_free)) : 0.;

    DenseMatrix covariance = DenseMatrix::Zero(n_free, n_free), undetermined = covariance;
    for (Eigen::Index k = 0; k < n_free; ++k)
      if (S[k] <= smallest_singular_value * S[0] || S[k] <= s)
        undetermined += V.col(k) * V.col(k).transpose();
      else
        covariance += std::pow(s / S[k], 2) * V.col(k) * V.col(k).transpose();

    std::vector<Eigen::Index> concerned;
    for (Eigen::Index i = 0; i < n_free; ++i)
      if (undetermined(i, i) > undetermined_square)
        concerned.push_back(i);
      else if (has_scale)
        result.deviations[free[i]] = std::sqrt(covariance(i, i));
    for (const std::vector<int> &group : members_of(connected_groups(static_cast<int>(concerned.size()), [&](const int i, const int j) {
           const Eigen::Index a = concerned[i], b = concerned[j];
           return std::abs(undetermined(a, b)) > act_alike * std::sqrt(undetermined(a, a) * undetermined(b, b));
         })))
      {
        result.undetermined.emplace_back();
        for (const int i : group)
          result.undetermined.back().push_back(free[concerned[i]]);
      }
    for (Eigen::Index i = 0; i < n_free; ++i)
      for (Eigen::Index j = 0; j < n_free; ++j)
        if (result.deviations[free[i]] && result.deviations[free[j]] && covariance(i, i) > 0. && covariance(j, j) > 0.)
          result.correlations(free[i], free[j]) = covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
    return result;
  }
} // namespace Squeal
