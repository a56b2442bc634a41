// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/linear_algebra/dense_eigenproblems.h>
#include <squeal/linear_algebra/dense_lu.h>
#include <squeal/sliding/contact_problem.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <set>

namespace Squeal
{
  namespace
  {
    /// Limit up to which tension (relative to the largest reaction) and overlap (relative to the largest gap) are rounding errors [-].
    constexpr double rounding_of_contact = 1e-13;
    /// L = −Bᵀ, a condition of uniqueness, counts as satisfied if the difference relative to B is below this limit, the level of rounding
    /// errors [-].
    constexpr double symmetric_motions = 1e-10;
    /// Two solutions are equal if the difference of their reactions relative to the largest reaction is below this limit [-]: nodes that
    /// just touch may be open or closed.
    constexpr double same_reactions = 1e-8;

    /// Number of block steps without a decrease of violations before single nodes are toggled.
    constexpr int patience = 8;

    /// Number of steps of the friction coefficient from 0 to μ, and of random active sets, that are tried if a direct attempt fails.
    constexpr int n_continuation_steps = 10;
    constexpr int n_random_starts      = 40;

    /// Solution of the linear problem for a given active set, and its violations.
    struct Iterate
    {
      ContactSolution  solution;
      std::vector<int> violated;      ///< closed nodes in tension, open nodes with overlap
      double           pull, overlap; ///< largest tension [N] and overlap [m]
    };

    class ActiveSetSolver
    {
    public:
      ActiveSetSolver(const ContactProblem &problem, const double mu)
        : problem(problem)
        , G(problem.flexibility(mu))
      {
        const auto one_for_zero = [](const double size) { return size > 0. ? size : 1.; };
        unit                    = G.diagonal().cwiseAbs().mean();
        motion_sizes            = problem.motions.cwiseAbs().colwise().maxCoeff().transpose().unaryExpr(one_for_zero);
        balance_sizes           = problem.balance.cwiseAbs().rowwise().maxCoeff().unaryExpr(one_for_zero);
      }

      /**
       * Reactions (zero at open nodes), followed by motions, (n_c + n_z) × k, for which gaps at closed nodes are zero and the equations of
       * equilibrium hold.
       *
       * @param initial_gap n_c × k
       * @param forces      n_z × k
       *
       * Throws SolverError if the closed nodes do not determine the reactions.
       */
      DenseMatrix reactions_and_motions(const std::vector<bool> &closed, const DenseMatrix &initial_gap, const DenseMatrix &forces) const
      {
        const int        n_z = problem.forces.size(), k = initial_gap.cols();
        std::vector<int> nodes;
        for (int c = 0; c < G.rows(); ++c)
          if (closed[c])
            nodes.push_back(c);
        const int n = nodes.size();

        // [G_CC/unit  B_C; L_C  0] [r; z/unit] = [−g_0/unit; f]; columns of B and rows of L are scaled to a largest entry of 1
        DenseMatrix A = DenseMatrix::Zero(n + n_z, n + n_z), b(n + n_z, k);
        A << G(nodes, nodes) / unit, problem.motions(nodes, Eigen::placeholders::all) * motion_sizes.cwiseInverse().asDiagonal(),
          balance_sizes.cwiseInverse().asDiagonal() * problem.balance(Eigen::placeholders::all, nodes), DenseMatrix::Zero(n_z, n_z);
        b << -initial_gap(nodes, Eigen::placeholders::all) / unit, (forces.array().colwise() / balance_sizes.array()).matrix();
        for (const int held : problem.held)
          {
            A(n + held, n + held) = 1.;
            b.row(n + held).setZero();
          }
        const RealLU lu = regular_lu(A, "steady sliding, equations of the closed contact nodes");
        DenseMatrix  x  = lu.solve(b);
        // One step of iterative refinement, so that the reactions balance the load up to rounding errors
        x += lu.solve(b - A * x);

        DenseMatrix result                      = DenseMatrix::Zero(G.rows() + n_z, k);
        result(nodes, Eigen::placeholders::all) = x.topRows(n);
        result.bottomRows(n_z)                  = unit * (x.bottomRows(n_z).array().colwise() / motion_sizes.array()).matrix();
        return result;
      }

      /// Solution for an active set; throws SolverError if the closed nodes do not determine the reactions.
      Iterate solve(std::vector<bool> closed) const
      {
        const DenseMatrix     x = reactions_and_motions(closed, as_column(problem.initial_gap), as_column(problem.forces));
        Eigen::VectorXd       r = x.col(0).head(G.rows());
        const Eigen::VectorXd z = x.col(0).tail(x.rows() - G.rows());
        Eigen::VectorXd       g = as_column(problem.initial_gap) + problem.motions * z + G * r;
        for (int c = 0; c < G.rows(); ++c)
          if (closed[c])
            g[c] = 0.;
        const double largest_reaction = max_norm(r), largest_gap = std::max(max_norm(g), unit * largest_reaction);
        Iterate      result{{}, {}, 0., 0.};
        for (int c = 0; c < G.rows(); ++c)
          {
            // If all reactions or gaps are zero, the quotient is NaN and the comparison is false: no violation
            const bool pulls    = closed[c] && r[c] / largest_reaction > rounding_of_contact;
            const bool overlaps = !closed[c] && g[c] / largest_gap > rounding_of_contact;
            if (pulls || overlaps)
              result.violated.push_back(c);
            result.pull    = std::max(result.pull, pulls ? r[c] : 0.);
            result.overlap = std::max(result.overlap, overlaps ? g[c] : 0.);
          }
        r               = r.cwiseMin(0.);
        g               = g.cwiseMin(0.);
        result.solution = {{r.begin(), r.end()}, {g.begin(), g.end()}, {z.begin(), z.end()}, std::move(closed), 0};
        return result;
      }

      /// Closes the node with the smallest gap for each equation of equilibrium without closed nodes.
      void support_backplates(std::vector<bool> &closed, const std::vector<double> &gaps) const
      {
        for (int k = 0; k < problem.balance.rows(); ++k)
          {
            int nearest = -1;
            for (int c = 0; c < problem.balance.cols(); ++c)
              if (problem.balance(k, c) != 0.)
                {
                  if (closed[c])
                    {
                      nearest = -1;
                      break;
                    }
                  if (nearest < 0 || gaps[c] > gaps[nearest])
                    nearest = c;
                }
            if (nearest >= 0)
              closed[nearest] = true;
          }
      }

      double flexibility_unit() const
      {
        return unit;
      }

    private:
      const ContactProblem &problem;
      DenseMatrix           G;
      double                unit;                        ///< mean diagonal entry of G [m/N]
      Eigen::VectorXd       motion_sizes, balance_sizes; ///< largest entries of the columns of B and of the rows of L
    };

    /// Best iterate of an attempt, which is a solution if no node violates the conditions.
    using Attempt = std::optional<Iterate>;

    bool is_better(const Iterate &a, const Iterate &b, const double unit)
    {
      return std::max(a.pull, a.overlap / unit) < std::max(b.pull, b.overlap / unit);
    }

    Attempt pivot(const ActiveSetSolver &solver, std::vector<bool> closed, const std::vector<double> &initial_gap)
    {
      const int                   most_steps = 30 + 2 * closed.size();
      Attempt                     best;
      std::size_t                 fewest = closed.size() + 1;
      int                         left   = patience;
      std::set<std::vector<bool>> seen; // active sets of single toggles: a repeated set means a cycle
      solver.support_backplates(closed, initial_gap);
      for (int step = 0; step <= most_steps; ++step)
        {
          Iterate iterate;
          try
            {
              iterate = solver.solve(closed);
            }
          catch (const SolverError &)
            {
              return best;
            }
          iterate.solution.n_steps = step;
          if (!best || iterate.violated.empty() || is_better(iterate, *best, solver.flexibility_unit()))
            best = iterate;
          if (iterate.violated.empty())
            return best;

          if (iterate.violated.size() < fewest)
            {
              fewest = iterate.violated.size();
              left   = patience;
            }
          else
            --left;
          if (left < 0 && !seen.insert(closed).second)
            return best;
          if (left >= 0)
            for (const int c : iterate.violated)
              closed[c] = !closed[c];
          else
            closed[iterate.violated.back()] = !closed[iterate.violated.back()];
          solver.support_backplates(closed, iterate.solution.gaps);
        }
      return best;
    }

    std::vector<bool> random_set(std::mt19937 &generator, const std::size_t size)
    {
      // Use the raw bits of the generator, which are the same with every standard library
      const auto        threshold = generator();
      std::vector<bool> closed(size);
      for (std::size_t c = 0; c < size; ++c)
        closed[c] = generator() < threshold;
      return closed;
    }
  } // namespace

  ContactSolution solve_contact(const ContactProblem &problem)
  {
    const std::size_t     n  = problem.initial_gap.size();
    const double          mu = problem.friction_coefficient;
    const ActiveSetSolver solver(problem, mu);
    Attempt               best;
    const auto            succeeds = [&](const Attempt &attempt) {
      if (attempt && (!best || is_better(*attempt, *best, solver.flexibility_unit())))
        best = attempt;
      return attempt && attempt->violated.empty();
    };

    const std::vector<bool> all(n, true);
    if (succeeds(pivot(solver, all, problem.initial_gap)))
      return best->solution;

    // Continuation from the solution without friction, in steps of μ
    std::vector<bool> closed = all;
    for (int step = 0; step <= n_continuation_steps; ++step)
      {
        const bool    last    = step == n_continuation_steps;
        const Attempt attempt = last ? pivot(solver, closed, problem.initial_gap) :
                                       pivot(ActiveSetSolver(problem, mu * step / n_continuation_steps), closed, problem.initial_gap);
        if (attempt)
          closed = attempt->solution.closed;
        if (last && succeeds(attempt))
          return best->solution;
      }

    std::mt19937 generator(1);
    for (int start = 0; start < n_random_starts; ++start)
      if (succeeds(pivot(solver, random_set(generator, n), problem.initial_gap)))
        return best->solution;

    throw SolverError(text("no steady sliding state was found at friction coefficient ", mu, ": ",
                           best ? text("in the best iterate, ", best->violated.size(), " of ", n,
                                       " contact nodes violate the contact conditions, by up to ", best->pull, " N of tension and ",
                                       best->overlap, " m of overlap") :
                                  "the closed contact nodes do not determine the reactions in any attempt"),
                      "steady sliding", "lower the friction coefficient or the gaps, or set Steady sliding/Contact state = equal load");
  }

  DenseMatrix reaction_rates(const ContactProblem    &problem,
                             const std::vector<bool> &closed,
                             const DenseMatrix       &gap_rates,
                             const DenseMatrix       &force_rates)
  {
    return ActiveSetSolver(problem, problem.friction_coefficient)
      .reactions_and_motions(closed, gap_rates, force_rates)
      .topRows(gap_rates.rows());
  }

  ContactUniqueness contact_uniqueness(const ContactProblem &problem, const ContactSolution &solution, const unsigned int n_searches)
  {
    const std::size_t n = problem.initial_gap.size();
    ContactUniqueness result{0., false, 0, false, {}};

    const double asymmetry = max_norm(problem.motions + problem.balance.transpose()), scale = max_norm(problem.motions);
    if (scale == 0. || !(asymmetry / scale > symmetric_motions))
      {
        const DenseMatrix S       = -0.5 * (problem.tangential_flexibility + problem.tangential_flexibility.transpose());
        const double      largest = symmetric_eigenpairs(S, problem.normal_flexibility).values.back();
        result.unique_below       = largest > 0. ? 1. / largest : std::numeric_limits<double>::infinity();
        result.meets_condition    = problem.friction_coefficient < (1. - 1e-8) * result.unique_below;
      }
    if (result.meets_condition)
      return result;

    const ActiveSetSolver solver(problem, problem.friction_coefficient);
    std::mt19937          generator(2);
    for (; result.n_searches < n_searches && !result.found_other; ++result.n_searches)
      {
        const Attempt attempt = pivot(solver, random_set(generator, n), problem.initial_gap);
        if (attempt && attempt->violated.empty() && attempt->solution.closed != solution.closed)
          {
            // Compare reactions, because nodes that just touch may count as closed or open
            const auto r       = as_column(solution.reactions);
            result.found_other = max_norm(as_column(attempt->solution.reactions) - r) / max_norm(r) > same_reactions;
            result.other       = attempt->solution;
          }
      }
    return result;
  }
} // namespace Squeal
