// SPDX-License-Identifier: GPL-3.0-or-later

#include "shift_invert.h"
#include "symmetric_solver.h"

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/linear_algebra/mass_orthonormal.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace Squeal
{
  namespace
  {
    /// Largest accepted residual of a rigid-body mode, relative to the largest requested eigenvalue [-].
    constexpr double largest_rigid_residual = 1e-8;

    /// If the lowest eigenvalue is below this fraction of the end of the band, K⁻¹ amplifies its mode so much that other modes lose digits
    /// [-].
    constexpr double almost_rigid = 1e-6;

    /// Shift s, relative to the end of the band, for bodies with rigid-body or nearly rigid motions [-].
    constexpr double shift_of_free_bodies = 0.01;

    constexpr int most_refinements = 3;

    /// Number of starts without new modes after which the solver gives up; the last one uses the other solver.
    constexpr int most_fruitless_starts = 4;

  } // namespace

  SymmetricSolver::SymmetricSolver(const SparseMatrix &K, const SparseMatrix &M, const double limit, const SymmetricModesOptions &options)
    : K(K)
    , M(M)
    , options(options)
    , shift(options.shift)
    , count(options.count ? *options.count : count_below(K, M, limit, options.what))
    , hidden_square(unresolved_square(K, M))
  {}

  bool SymmetricSolver::is_dense() const
  {
    return count.n_modes > 0 && (K.n_rows() <= largest_dense_system || 4 * count.n_modes + 50 > K.n_rows());
  }

  void SymmetricSolver::solve_densely()
  {
    const DenseMatrix stiffness = to_dense(K), mass = to_dense(M);
    if (mass.llt().info() == Eigen::Success)
      {
        dense_pairs = symmetric_eigenpairs(stiffness, mass);
        return;
      }
    // M is singular because of massless dofs: solve M x = ν (K + s M) x with ν = 1 / (ω² + s) and omit ν = 0
    const double     s       = count.limit;
    const RealPairs  inverse = symmetric_eigenpairs(mass, stiffness + s * mass); // ascending
    constexpr double zero    = 1e-12;
    const auto finite = inverse.values.end() - std::upper_bound(inverse.values.begin(), inverse.values.end(), zero * inverse.values.back());
    RealPairs  pairs{{}, DenseMatrix(mass.rows(), finite)};
    for (Eigen::Index j = 0; j < finite; ++j)
      {
        const Eigen::Index from = mass.rows() - 1 - j;
        const double       nu   = inverse.values[from];
        pairs.values.push_back(1. / nu - s);
        pairs.vectors.col(j) = inverse.vectors.col(from) / std::sqrt(nu);
      }
    dense_pairs = std::move(pairs);
  }

  SymmetricSolver::RitzPairs SymmetricSolver::rayleigh_ritz(const MultiVector &V) const
  {
    const RealPairs reduced = agreed(V.communicator(), symmetric_eigenpairs(gram(V, K * V), gram(V, M * V)));
    return {reduced.values, V * reduced.vectors};
  }

  SymmetricModes SymmetricSolver::modes()
  {
    SymmetricModes modes;
    if (count.n_modes > 0)
      {
        RitzPairs pairs = find_all();
        if (!is_dense() && options.inverse == nullptr && shift == 0. && pairs.values.front() < almost_rigid * count.limit)
          {
            factorization.reset();
            shift = shift_of_free_bodies * count.limit;
            pairs = find_all();
          }
        Residuals result = refine(pairs);
        if (!(result.excess <= 1.) && options.solver != RealSolver::lanczos && !is_dense())
          {
            // Use block Lanczos: for multiple eigenvalues, Anasazi and ARPACK may return mixtures with other modes, which refinement does
            // not separate
            options.solver = RealSolver::lanczos;
            pairs          = find_all();
            result         = refine(pairs);
          }
        modes = accept(pairs, result);
      }
    modes.n_counted = count.n_modes;
    return modes;
  }

  const LinearOperator &SymmetricSolver::inverse()
  {
    if (options.inverse != nullptr)
      return *options.inverse;
    if (factorization)
      return *factorization;
    if (shift == 0.)
      try
        {
          factorization = factorize_positive_definite(K, options.library, options.what);
          return *factorization;
        }
      catch (const SolverError &)
        {
          // K is probably singular because of rigid-body motions: try a shift; the factorisation then throws if there is another reason
        }
    if (shift == 0.)
      shift = shift_of_free_bodies * count.limit;
    factorization = factorize_positive_definite(*add(1., K, shift, M), options.library, options.what);
    return *factorization;
  }

  SymmetricSolver::RitzPairs SymmetricSolver::find_all()
  {
    if (is_dense())
      return dense();

    RitzPairs pairs;
    int       n_found = 0, n_fruitless = 0;
    // Start again while modes are missing: a start may miss members of multiple eigenvalues, which further starts can find
    for (unsigned int attempt = 0; n_found < count.n_modes; ++attempt)
      {
        const std::optional<MultiVector> fresh = krylov(count.n_modes - n_found, attempt, n_fruitless, pairs.vectors);
        if (const int n_all = fresh ? merge(*fresh, pairs) : 0; n_all > n_found)
          {
            n_found = n_all;
            continue;
          }
        if (lift_limit() || ++n_fruitless < most_fruitless_starts)
          continue;
        fail_incomplete(n_found);
      }
    return pairs;
  }

  int SymmetricSolver::merge(const MultiVector &fresh, RitzPairs &pairs) const
  {
    const MultiVector space = pairs.vectors ? join({&*pairs.vectors, &fresh}) : fresh;
    RitzPairs         all   = rayleigh_ritz(space);
    const int         n_all = std::upper_bound(all.values.begin(), all.values.end(), count.limit) - all.values.begin();
    if (n_all > static_cast<int>(pairs.values.size()))
      {
        // Keep only vectors below the limit for deflation: the others may be poor approximations of modes
        pairs.values.assign(all.values.begin(), all.values.begin() + n_all);
        pairs.vectors.emplace(view(*all.vectors, 0, n_all));
      }
    return n_all;
  }

  SymmetricSolver::RitzPairs SymmetricSolver::dense()
  {
    if (!dense_pairs)
      solve_densely();
    const RealPairs all = agreed(K.communicator(), std::move(*dense_pairs));
    dense_pairs.reset();
    const int   n_kept = std::min<int>(std::max(1, count.n_modes), all.values.size());
    MultiVector vectors(K.columns(), n_kept, false);
    vectors.local() = all.vectors.block(K.rows().first(), 0, vectors.n_local_rows(), n_kept);
    return {{all.values.begin(), all.values.begin() + n_kept}, vectors};
  }

  std::optional<MultiVector> SymmetricSolver::krylov(const int                         n_wanted,
                                                     const unsigned int                attempt,
                                                     const int                         n_fruitless,
                                                     const std::optional<MultiVector> &deflated)
  {
    const ShiftInvert A(inverse(), M, deflated ? &*deflated : nullptr);
    KrylovRequest     request;
    request.n_wanted   = n_wanted;
    request.tolerance  = 0.1 * options.tolerance;
    request.block_size = options.block_size > 0 ? options.block_size : 8;
    request.seed       = options.seed + 7919 * attempt;
    request.attempt    = n_fruitless;
    request.what       = options.what;
    // If the chosen solver finds no more modes, try another one
    const RealSolver other = options.solver == RealSolver::anasazi ? RealSolver::arpack : RealSolver::anasazi;
    switch (n_fruitless < most_fruitless_starts - 1 ? options.solver : other)
      {
        case RealSolver::lanczos:
          return lanczos_vectors(A, request);
        case RealSolver::anasazi:
          return anasazi_vectors(A, request);
        case RealSolver::arpack:
          break;
      }
    return arpack_vectors(A, request);
  }

  bool SymmetricSolver::lift_limit()
  {
    if (lifted)
      return false;
    lifted                = true;
    const ModeCount below = count_below(K, M, count.limit * (1. - 1e-8), options.what);
    const ModeCount above = count_below(K, M, count.limit * (1. + 1e-8), options.what);
    if (below.n_modes == above.n_modes)
      return false;
    count = above;
    return true;
  }

  SymmetricSolver::Residuals SymmetricSolver::residuals(const RitzPairs &pairs) const
  {
    const int         n_modes = pairs.values.size();
    const MultiVector KV = K * *pairs.vectors, MV = M * *pairs.vectors;
    MultiVector       R(KV);
    for (int j = 0; j < n_modes; ++j)
      if (!is_rigid(pairs.values[j]))
        R.col(j) -= pairs.values[j] * MV.col(j);

    const std::vector<double> norm_R = column_norms(R), norm_KV = column_norms(KV), norm_MV = column_norms(MV),
                              norm_V = column_norms(*pairs.vectors);
    const double norm_K              = row_sum_norm(K);

    Residuals residuals;
    for (int j = 0; j < n_modes; ++j)
      {
        const bool   rigid    = is_rigid(pairs.values[j]);
        const double scale    = rigid ? count.limit * norm_MV[j] : norm_KV[j];
        const double rounding = 10. * std::numeric_limits<double>::epsilon() * norm_K * norm_V[j] / scale;
        residuals.values.push_back(norm_R[j] / scale);
        const double excess = residuals.values[j] / std::max({options.tolerance, rounding, rigid ? largest_rigid_residual : 0.});
        // The negated comparison makes NaN the worst value
        if (!(excess <= residuals.excess))
          {
            residuals.excess = excess;
            residuals.worst  = j;
          }
      }
    return residuals;
  }

  SymmetricSolver::Residuals SymmetricSolver::refine(RitzPairs &pairs)
  {
    // LAPACK's errors are proportional to the largest of all eigenvalues; reduce them before rigid-body modes are identified
    if (is_dense())
      pairs = rayleigh_ritz(*pairs.vectors);
    Residuals result = residuals(pairs);
    for (int step = 0; step < most_refinements && !(result.excess <= 1.); ++step)
      {
        const int   n = pairs.vectors->n_columns();
        MultiVector W(pairs.vectors->map(), n);
        ShiftInvert(inverse(), M, nullptr).apply(*pairs.vectors, W);
        RitzPairs refined = rayleigh_ritz(orthonormalize(M, nullptr, W, 1e-12));
        pairs.values.assign(refined.values.begin(), refined.values.begin() + n);
        pairs.vectors.emplace(view(*refined.vectors, 0, n));
        result = residuals(pairs);
      }
    return result;
  }

  SymmetricModes SymmetricSolver::accept(const RitzPairs &pairs, const Residuals &result) const
  {
    const auto fail = [&](const std::string &message, const std::string &change) { throw SolverError(message, options.what, change); };
    if (static_cast<int>(pairs.values.size()) != count.n_modes || !(pairs.values.back() <= count.limit * (1. + 1e-8)))
      fail_incomplete(std::upper_bound(pairs.values.begin(), pairs.values.end(), count.limit) - pairs.values.begin());
    if (pairs.values.front() < -hidden_square)
      fail(text("the stiffness is not positive semidefinite: its lowest eigenvalue is ", pairs.values.front(), " rad²/s²"),
           "check the materials and mounts or the matrices; with gyroscopic forces, lower the rotation speed");
    if (!(result.excess <= 1.))
      {
        std::ostringstream message;
        message << "mode " << result.worst + 1 << " of " << count.n_modes << " has a relative residual of " << result.values[result.worst]
                << ", " << result.excess << " times the limit";
        fail(message.str(), "raise Real modes/Tolerance, or choose another Real modes/Solver");
      }

    SymmetricModes modes;
    modes.residuals   = result.values;
    modes.eigenvalues = pairs.values;
    for (double &value : modes.eigenvalues)
      if (is_rigid(value))
        {
          value = 0.;
          ++modes.n_rigid_body;
        }
    modes.vectors = std::make_shared<MultiVector>(*pairs.vectors);
    return modes;
  }

  void SymmetricSolver::fail_incomplete(const int n_found) const
  {
    throw SolverError(text(counted(n_found, "mode was", "modes were"), " found, but ", count.n_modes,
                           count.n_modes == 1 ? " exists" : " exist", " below ", decimal_text(hertz(std::sqrt(count.limit))), " Hz"),
                      options.what, "choose another Real modes/Solver, or move the end of the band away from a cluster of modes");
  }

  bool SymmetricSolver::is_rigid(const double value) const
  {
    return !(value > hidden_square);
  }
} // namespace Squeal
