#include <squeal/base/assignment.h>
#include <squeal/base/conventions.h>
#include <squeal/base/decision.h>
#include <squeal/base/exceptions.h>
#include <squeal/stability/branches.h>
#include <squeal/stability/mode_links.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    const Decision divergent("divergence rate of a mode of a chart", negligible_divergence);
    /// The same where only rounding errors of λ of a multiple mode count.
    const Decision just_divergent("divergence rate of a mode among others of nearly the same lambda", 1e-11);
    /// An estimated error may be that much too small.
    constexpr double safety = 3.;
    /// Weight of closeness of λ beside overlaps of vectors.
    constexpr double closeness_weight = 0.01;
    /// |Re λ_1 + Re λ_2| and |Im λ_1 − Im λ_2| of ±R + iω by R.
    constexpr double mirror_tolerance = 1e-6;
    /// δ² / |λ|² of pairs far enough from their coalescence for corrections to be read there.
    constexpr double separate = 1e-6;
    /// |λ_1 − λ_2| / |λ_1| of modes that may meet within a step.
    constexpr double nearby = 0.1;
    /// Part of δ², or of Re λ, that an approach must leave to be worth a look.
    constexpr double remaining = 0.3;
    /// Steps of a search that may halve less than the interval before it is halved.
    constexpr int patience = 2;

    bool is_neutral(const Complex &lambda)
    {
      return !divergent.exceeded_by(std::abs(lambda.real()) / lambda.imag());
    }

    /// −1: decays, 0: neutral, 1: grows, by as much per radian as @p counts.
    int growth_class(const Complex &lambda, const Decision &counts = divergent)
    {
      return !counts.exceeded_by(std::abs(lambda.real()) / lambda.imag()) ? 0 : lambda.real() > 0. ? 1 : -1;
    }

    Complex square_difference(const Complex &x, const Complex &y)
    {
      return (x - y) * (x - y);
    }

    /// A step between neighbouring points.
    struct Interval
    {
      std::optional<ModeLinks> links;
      int                      stalls = 0; ///< how often in a row it shrank by less than half
    };

    /// A sign to be located in a step, of a function of the branches.
    struct Search
    {
      enum Kind
      {
        growth,      ///< Re λ
        coalescence, ///< δ²
        end_of_band, ///< Im λ − ω_max
        real_axis    ///< ((λ − λ̄)/2)², of real λ afterwards
      };
      Kind kind;
      int  interval;
      int  branch, partner;
      bool upward;           ///< onset, or entering the band
      bool at_once  = false; ///< neutral at the first point of the chart
      bool multiple = false; ///< two modes that nothing tells apart from the first point up to this interval
    };

    /// The list of points with the modes of each branch.
    class Sweep
    {
    public:
      Sweep(const EvaluateChart &evaluate_, const ChartOptions &options_)
        : evaluate(evaluate_)
        , options(options_)
      {}

      StabilityChart run(const std::vector<double> &grid)
      {
        insert(grid, false);
        for (;;)
          {
            follow();
            find_events();
            const std::vector<double> wanted = requests();
            if (wanted.empty())
              break;
            insert(wanted, true);
          }
        return chart();
      }

    private:
      // ------------------------------------------------- points

      double mu(const int k) const
      {
        return points[k].friction_coefficient;
      }

      double width(const int k) const
      {
        return mu(k + 1) - mu(k);
      }

      /// Intervals of this width are not searched further.
      double tolerance(const int k) const
      {
        return std::max(options.threshold_tolerance,
                        8. * std::numeric_limits<double>::epsilon() * std::max(std::abs(mu(k)), std::abs(mu(k + 1))));
      }

      int n_points() const
      {
        return static_cast<int>(points.size());
      }

      void insert(const std::vector<double> &values, const bool refines)
      {
        if (values.empty())
          return;
        std::vector<ChartPoint> found = evaluate(values);
        if (found.size() != values.size())
          throw SolverError(std::to_string(found.size()) + " sets of modes instead of " + std::to_string(values.size()),
                            "modes over the friction coefficient", "this is a mistake in the program: please report it");
        for (std::size_t i = 0; i < values.size(); ++i)
          {
            found[i].friction_coefficient = values[i];
            const int k                   = std::lower_bound(points.begin(), points.end(), values[i],
                                                             [](const ChartPoint &p, const double value) { return p.friction_coefficient < value; }) -
                          points.begin();
            points.insert(points.begin() + k, std::move(found[i]));
            is_refinement.insert(is_refinement.begin() + k, refines);
            if (k > 0 && k + 1 < n_points())
              {
                const int  stalls      = intervals[k - 1].stalls + 1;
                const bool left_halved = width(k - 1) <= width(k);
                intervals[k - 1]       = {std::nullopt, left_halved ? 0 : stalls};
                intervals.insert(intervals.begin() + k, {std::nullopt, left_halved ? stalls : 0});
              }
            else if (n_points() > 1)
              intervals.emplace_back();
          }
        if (refines)
          n_refinements += static_cast<int>(values.size());
        for (std::size_t k = 0; k < intervals.size(); ++k)
          if (!intervals[k].links)
            intervals[k].links = link_modes(points[k], points[k + 1], options.largest_frequency);
      }

      // ------------------------------------------------- branches

      /// Vectors of the modes at a point; within a multiple λ those nearest to the vectors of the branches before.
      struct Carried
      {
        ComplexDenseMatrix   right, left;
        std::vector<Complex> lambda; ///< at the last point where it was not multiple
      };

      void follow()
      {
        branches.clear();
        branch_of.assign(points.size(), {});
        if (points.empty())
          return;
        Carried carried{points[0].right, points[0].left, points[0].lambda};
        for (std::size_t j = 0; j < points[0].lambda.size(); ++j)
          begin_branch(0, static_cast<int>(j));
        for (int k = 0; k + 1 < n_points(); ++k)
          {
            const std::vector<int> image = images(k, carried);
            branch_of[k + 1].assign(points[k + 1].lambda.size(), -1);
            for (std::size_t i = 0; i < image.size(); ++i)
              if (image[i] >= 0)
                {
                  branches[branch_of[k][i]].modes[k + 1] = image[i];
                  branch_of[k + 1][image[i]]             = branch_of[k][i];
                }
            for (std::size_t j = 0; j < branch_of[k + 1].size(); ++j)
              if (branch_of[k + 1][j] < 0)
                begin_branch(k + 1, static_cast<int>(j));
            carry(k, image, carried);
          }
      }

      void begin_branch(const int k, const int mode)
      {
        branch_of[k].resize(points[k].lambda.size(), -1);
        branch_of[k][mode] = static_cast<int>(branches.size());
        branches.push_back({std::vector<int>(points.size(), -1)});
        branches.back().modes[k] = mode;
      }

      /// The mode at point k + 1 of each mode at point k, or -1.
      std::vector<int> images(const int k, const Carried &carried) const
      {
        std::vector<int> image(points[k].lambda.size(), -1);
        for (const ModeBlock &block : intervals[k].links->blocks)
          {
            const std::vector<int> match = match_in_block(k, block, carried);
            for (std::size_t i = 0; i < match.size(); ++i)
              image[block.first[i]] = block.second[match[i]];
          }
        return image;
      }

      std::vector<int> match_in_block(const int k, const ModeBlock &block, const Carried &carried) const
      {
        const std::vector<Complex> &lambda = points[k + 1].lambda;
        const int                   n      = static_cast<int>(block.first.size());
        if (n == 1)
          return {0};
        if (n == 2)
          {
            const Complex a1 = carried.lambda[block.first[0]], a2 = carried.lambda[block.first[1]];
            const Complex b1 = lambda[block.second[0]], b2 = lambda[block.second[1]];
            if (const int before = pair_sign(a1, a2), after = pair_sign(b1, b2); before * after < 0)
              {
                const auto first_comes_first = [](const Complex &x, const Complex &y, const int sign) {
                  return sign < 0 ? x.imag() < y.imag() : x.real() > y.real();
                };
                return first_comes_first(a1, a2, before) == first_comes_first(b1, b2, after) ? std::vector<int>{0, 1} :
                                                                                               std::vector<int>{1, 0};
              }
          }

        // Vectors where they say who is who, else λ that would lie on a smooth curve
        const int            r = std::max(carried.right.n_rows(), points[k + 1].right.n_rows());
        DenseMatrix          overlaps(n, n);
        std::vector<Complex> predicted;
        double               farthest = 0.;
        for (const int i : block.first)
          predicted.push_back(extrapolated(k, i));
        for (const Complex &x : predicted)
          for (const int j : block.second)
            farthest = std::max(farthest, std::abs(x - lambda[j]));
        const auto add_overlaps = [&](const ComplexDenseMatrix &before, const ComplexDenseMatrix &after) {
          const auto C = multiply(padded(selected_columns(before, block.first), r), padded(selected_columns(after, block.second), r), true);
          for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
              overlaps(i, j) += 0.5 * std::norm(C(i, j));
        };
        add_overlaps(carried.right, points[k + 1].right);
        add_overlaps(carried.left, points[k + 1].left);
        // Among modes that nothing else tells apart the growing ones stay growing, however slowly they do
        const auto grow_alike = [](const Complex &x, const Complex &y) {
          return growth_class(x, just_divergent) == growth_class(y, just_divergent);
        };
        const double weight = block.resolved ? closeness_weight : 1.;
        return best_assignment(n, n, [&](const int i, const int j) {
          const Complex before = points[k].lambda[block.first[i]], after = lambda[block.second[j]];
          const double  distance = std::abs(predicted[i] - after);
          return overlaps(i, j) - (farthest > 0. ? weight * distance / farthest : 0.) + (grow_alike(before, after) ? n : 0.);
        });
      }

      /// λ at point k + 1 from the points before.
      Complex extrapolated(const int k, const int mode) const
      {
        const Complex here   = points[k].lambda[mode];
        const int     before = k > 0 ? branches[branch_of[k][mode]].modes[k - 1] : -1;
        // The slope of a much shorter step says nothing about this one
        if (before < 0 || width(k - 1) < 0.1 * width(k))
          return here;
        return here + (here - points[k - 1].lambda[before]) * (width(k) / width(k - 1));
      }

      /// Carries vectors from point k to the next.
      void carry(const int k, const std::vector<int> &image, Carried &carried) const
      {
        const ChartPoint             &next    = points[k + 1];
        const std::vector<int>        cluster = mode_clusters(next.lambda);
        std::vector<std::vector<int>> members(next.lambda.size());
        std::vector<int>              origin(next.lambda.size(), -1);
        for (std::size_t i = 0; i < image.size(); ++i)
          if (image[i] >= 0)
            origin[image[i]] = static_cast<int>(i);
        for (std::size_t j = 0; j < cluster.size(); ++j)
          members[cluster[j]].push_back(static_cast<int>(j));

        Carried result{next.right, next.left, next.lambda};
        for (const std::vector<int> &all : members)
          {
            std::vector<int> from, to;
            for (const int j : all)
              if (all.size() > 1 && origin[j] >= 0)
                {
                  from.push_back(origin[j]);
                  to.push_back(j);
                  result.lambda[j] = carried.lambda[origin[j]];
                }
            if (!to.empty())
              {
                project(selected_columns(next.right, all), selected_columns(carried.right, from), result.right, to);
                project(selected_columns(next.left, all), selected_columns(carried.left, from), result.left, to);
              }
          }
        carried = std::move(result);
      }

      /// Columns @p to of Y become the parts of the columns of X in the span of @p vectors, normalised.
      static void project(const ComplexDenseMatrix &vectors, const ComplexDenseMatrix &X, ComplexDenseMatrix &Y, const std::vector<int> &to)
      {
        const int                r = std::max(vectors.n_rows(), X.n_rows());
        const ComplexDenseMatrix Q = orthonormal_basis(padded(vectors, r)).Q;
        const ComplexDenseMatrix P = multiply(Q, multiply(Q, padded(X, r), true));
        for (std::size_t j = 0; j < to.size(); ++j)
          {
            const Complex *part = P.column(static_cast<int>(j));
            double         norm = 0.;
            for (int row = 0; row < r; ++row)
              norm += std::norm(part[row]);
            if (norm > 0.)
              for (int row = 0; row < Y.n_rows(); ++row)
                Y(row, to[j]) = part[row] / std::sqrt(norm);
          }
      }

      // ------------------------------------------------- events

      /// Number of the mode of a branch, -1 beyond the chart.
      int mode(const int branch, const int k) const
      {
        return k < 0 || k >= n_points() ? -1 : branches[branch].modes[k];
      }

      Complex lambda(const int branch, const int k) const
      {
        return points[k].lambda[mode(branch, k)];
      }

      void find_events()
      {
        searches.clear();
        for (int k = 0; k + 1 < n_points(); ++k)
          {
            for (std::size_t branch = 0; branch < branches.size(); ++branch)
              {
                const int b = static_cast<int>(branch), m0 = mode(b, k), m1 = mode(b, k + 1);
                if (m0 >= 0 && m1 >= 0)
                  {
                    find_threshold(k, b);
                    const bool before = in_band(b, k), after = in_band(b, k + 1);
                    if (before != after)
                      searches.push_back({Search::end_of_band, k, b, -1, after});
                  }
              }
            // A list that is cut may lose modes beyond the band
            const ModeLinks &links = *intervals[k].links;
            const int        n_new = n_real(k + 1) - n_real(k);
            for (const int i : links.lost)
              if (n_new > 0 && points[k].lambda[i].imag() <= options.largest_frequency)
                searches.push_back({Search::real_axis, k, branch_of[k][i], -1, false});
            for (const int j : links.gained)
              if (n_new < 0 && points[k + 1].lambda[j].imag() <= options.largest_frequency)
                searches.push_back({Search::real_axis, k, branch_of[k + 1][j], -1, true});
          }
      }

      int n_real(const int k) const
      {
        return static_cast<int>(points[k].real_values.size()) + points[k].n_zeros;
      }

      bool in_band(const int branch, const int k) const
      {
        return mode(branch, k) >= 0 && lambda(branch, k).imag() <= options.largest_frequency;
      }

      void find_threshold(const int k, const int branch)
      {
        const Complex before = lambda(branch, k), after = lambda(branch, k + 1);
        if (is_growing(before) == is_growing(after))
          return;
        const bool onset   = is_growing(after);
        const int  growing = onset ? k + 1 : k, other = onset ? k : k + 1;
        const int  partner = mirror_branch(branch, growing);
        Search     search{Search::growth, k, branch, -1, onset};
        if (partner >= 0 && mode(partner, other) >= 0 && is_neutral(lambda(branch, other)) && is_neutral(lambda(partner, other)))
          {
            search.kind    = Search::coalescence;
            search.partner = partner;
          }
        enclose(search);
        search.at_once =
          search.interval == 0 && onset && is_neutral(lambda(branch, 0)) && (search.kind == Search::growth || is_double(search, 0));
        if (onset && search.kind == Search::coalescence && search.interval > 0)
          {
            search.multiple = true;
            for (int point = 0; point <= search.interval && search.multiple; ++point)
              search.multiple = is_double(search, point);
          }
        searches.push_back(search);
      }

      /// Whether two modes are one double mode at a point.
      bool is_double(const Search &search, const int k) const
      {
        return mode(search.branch, k) >= 0 && mode(search.partner, k) >= 0 &&
               std::abs(lambda(search.branch, k) - lambda(search.partner, k)) <= indistinguishable * std::abs(lambda(search.branch, k));
      }

      /**
       * Moves the interval of a threshold to where the function itself changes
       * sign: the growth of a mode is seen only beyond what is negligible.
       */
      void enclose(Search &search) const
      {
        const int direction = search.upward ? -1 : 1;
        for (int k = search.upward ? search.interval : search.interval + 1;; k += direction)
          {
            const auto f = value(search, k);
            if (f && *f <= 0.)
              search.interval = search.upward ? k : k - 1;
            if (!f || *f <= 0. || !is_neutral(lambda(search.branch, k)))
              return;
          }
      }

      /// The branch with −R + iω where this one has R + iω, or -1.
      int mirror_branch(const int branch, const int k) const
      {
        const Complex here  = lambda(branch, k);
        int           best  = -1;
        double        least = mirror_tolerance * std::abs(here.real());
        // Close to a coalescence, R is small and known to rounding errors of λ only
        least = std::max(least, 1e-13 * std::abs(here));
        for (std::size_t j = 0; j < points[k].lambda.size(); ++j)
          if (const double distance = std::abs(points[k].lambda[j] + std::conj(here));
              static_cast<int>(j) != mode(branch, k) && distance <= least)
            {
              least = distance;
              best  = branch_of[k][j];
            }
        return best;
      }

      /// The function whose zero is searched, where the branches exist.
      std::optional<double> value(const Search &search, const int k) const
      {
        if (k < 0 || k >= n_points())
          return std::nullopt;
        const int m = mode(search.branch, k), n = search.partner >= 0 ? mode(search.partner, k) : -1;
        if (search.kind == Search::real_axis)
          return m >= 0 ? -points[k].lambda[m].imag() * points[k].lambda[m].imag() : real_pair(search, k);
        if (m < 0 || (search.partner >= 0 && n < 0))
          return std::nullopt;
        switch (search.kind)
          {
            case Search::growth:
              return points[k].lambda[m].real();
            case Search::coalescence:
              return square_difference(points[k].lambda[m], points[k].lambda[n]).real();
            default:
              return points[k].lambda[m].imag() - options.largest_frequency;
          }
      }

      /// ((λ_1 − λ_2)/2)² of neighbouring real values that a mode, last seen nearby, has become.
      std::optional<double> real_pair(const Search &search, const int k) const
      {
        const int                  seen   = search.upward ? search.interval + 1 : search.interval;
        const double               centre = lambda(search.branch, seen).real();
        const std::vector<double> &values = points[k].real_values;
        std::optional<double>      best;
        double                     least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i + 1 < values.size(); ++i)
          if (const double distance = std::abs(0.5 * (values[i] + values[i + 1]) - centre); distance < least)
            {
              least = distance;
              best  = 0.25 * (values[i] - values[i + 1]) * (values[i] - values[i + 1]);
            }
        return best;
      }

      // ------------------------------------------------- refinement

      /// Friction coefficients that would tell more.
      std::vector<double> requests() const
      {
        std::vector<double> wanted;
        for (const Search &search : searches)
          if (!located(search))
            wanted.push_back(proposal(search));
        for (int k = 0; k + 1 < n_points(); ++k)
          if (width(k) > options.smallest_step)
            {
              if (!intervals[k].links->resolved)
                wanted.push_back(0.5 * (mu(k) + mu(k + 1)));
              else
                for (const auto &suspicions : {interactions(k), approaches(k)})
                  wanted.insert(wanted.end(), suspicions.begin(), suspicions.end());
            }
        std::sort(wanted.begin(), wanted.end());

        // Two searches may want nearly the same
        std::vector<double> result;
        for (const double value : wanted)
          if (result.empty() || value - result.back() > 0.25 * options.threshold_tolerance)
            result.push_back(value);

        // The last evaluations are spread over the range
        const std::size_t left = std::max(0, options.maximum_refinements - n_refinements);
        if (result.size() > left)
          {
            for (std::size_t i = 0; i < left; ++i)
              result[i] = result[i * result.size() / left];
            result.resize(left);
          }
        return result;
      }

      bool located(const Search &search) const
      {
        return search.multiple || width(search.interval) <= tolerance(search.interval) || (search.at_once && grows_at_once(search));
      }

      /**
       * Whether a branch that is neutral at the first point grows from there on:
       * Re λ ~ μ, or δ² ~ μ² of a double mode, with a factor that linear
       * extrapolation leaves positive.
       */
      bool grows_at_once(const Search &search) const
      {
        if (width(0) <= options.smallest_step)
          return true;
        const auto near = value(search, 1), far = value(search, 2);
        if (!near || !far || !is_growing(lambda(search.branch, 2)))
          return false;
        const double power = search.kind == Search::coalescence ? 2. : 1., h1 = mu(1) - mu(0), h2 = mu(2) - mu(0);
        const double q1 = *near / std::pow(h1, power), q2 = *far / std::pow(h2, power), q0 = q1 + (q1 - q2) * h1 / (h2 - h1);
        return q0 > 0.5 * q1 && q0 < 2. * q1;
      }

      /// Where to look next for a zero.
      double proposal(const Search &search) const
      {
        const int    k = search.interval;
        const double l = mu(k), r = mu(k + 1), middle = 0.5 * (l + r);
        const auto   fl = value(search, k), fr = value(search, k + 1);
        if (search.at_once || !fl || !fr || !(*fl * *fr <= 0.) || *fl == *fr || intervals[k].stalls >= patience)
          return middle;

        double x = l - *fl * (r - l) / (*fr - *fl);
        // The nearer neighbour as a third point of inverse quadratic interpolation
        const auto before = value(search, k - 1), after = value(search, k + 2);
        const bool left = before && (!after || width(k - 1) < width(k + 1));
        if (const auto fc = left ? before : after; fc && *fc != *fl && *fc != *fr)
          {
            const double c = left ? mu(k - 1) : mu(k + 2);
            const double q = l * *fr * *fc / ((*fl - *fr) * (*fl - *fc)) + r * *fl * *fc / ((*fr - *fl) * (*fr - *fc)) +
                             c * *fl * *fr / ((*fc - *fl) * (*fc - *fr));
            if (q > l && q < r)
              x = q;
          }
        // Beyond the zero, seen from the nearer end: the interval closes, and no point lies on a coalescence, where vectors are lost
        const double margin = 0.5 * std::min(tolerance(k), r - l);
        return std::clamp(x + (x < middle ? 0.5 : -0.5) * margin, l + margin, r - margin);
      }

      /**
       * Where branches that change places in a step would meet if they interact.
       * With λ_a diagonal and B = X Λ_b X⁻¹ for Φ_b = Φ_a X, the 2 × 2 problem is linear
       * between; at the meeting point t its δ² is 4 t² B_12 B_21.
       */
      std::vector<double> interactions(const int k) const
      {
        std::vector<double> result;
        const ChartPoint   &a = points[k], &b = points[k + 1];
        const int           r = std::max(a.right.n_rows(), b.right.n_rows());
        for (std::size_t p = 0; p < branches.size(); ++p)
          for (std::size_t q = 0; q < p; ++q)
            {
              if (mode(p, k) < 0 || mode(q, k) < 0 || mode(p, k + 1) < 0 || mode(q, k + 1) < 0)
                continue;
              const Complex before = lambda(p, k) - lambda(q, k), after = lambda(p, k + 1) - lambda(q, k + 1);
              const double  size = std::abs(lambda(p, k)), least = indistinguishable * size;
              if (before.imag() * after.imag() >= 0. || std::min(std::abs(before), std::abs(after)) <= least)
                continue;
              const auto X = transformation(padded(selected_columns(a.right, {mode(p, k), mode(q, k)}), r),
                                            padded(selected_columns(b.right, {mode(p, k + 1), mode(q, k + 1)}), r));
              if (!X.exists)
                continue;
              const double  t            = before.imag() / (before.imag() - after.imag());
              const Complex product      = -X.X(0, 0) * X.inverse(0, 1) * X.X(1, 1) * X.inverse(1, 0) * after * after;
              const Complex discriminant = 4. * t * t * product;
              const double  gap          = std::sqrt(std::abs(discriminant));
              // Frequencies that only repel each other do so over gap / slope
              const bool   repel  = discriminant.real() < 0. && is_neutral(lambda(p, k)) && is_neutral(lambda(q, k));
              const double extent = gap * width(k) / std::abs(after.imag() - before.imag());
              if (gap > least && !(repel && extent < options.smallest_step))
                {
                  const double x = mu(k) + t * width(k), margin = 0.25 * options.smallest_step;
                  result.push_back(std::clamp(x, mu(k) + margin, mu(k + 1) - margin));
                }
            }
        return result;
      }

      /**
       * Where something may have happened that neither end of a step shows: Re λ of a
       * decaying mode, or δ² of two modes at some distance, is about to reach zero
       * according to the polynomial through the points around.
       */
      std::vector<double> approaches(const int k) const
      {
        std::vector<double> result;
        const auto          look = [&](const Search &search) {
          if (const auto peak = peak_within(search))
            result.push_back(*peak);
        };
        const int n = static_cast<int>(branches.size());
        for (int p = 0; p < n; ++p)
          {
            if (mode(p, k) < 0 || mode(p, k + 1) < 0)
              continue;
            const Complex before = lambda(p, k), after = lambda(p, k + 1);
            if (growth_class(before) < 0 && growth_class(after) < 0)
              look({Search::growth, k, p, -1, true});
            for (int q = 0; q < p; ++q)
              if (mode(q, k) >= 0 && mode(q, k + 1) >= 0)
                {
                  const double x = before.imag() - lambda(q, k).imag(), y = after.imag() - lambda(q, k + 1).imag(), size = before.imag();
                  if (x * y > 0. && std::max(std::abs(x), std::abs(y)) < nearby * size &&
                      std::min(std::abs(x), std::abs(y)) > indistinguishable * size)
                    look({Search::coalescence, k, p, q, true});
                }
          }
        return result;
      }

      /// Where a negative function comes close to zero within a step, closer than at its ends.
      std::optional<double> peak_within(const Search &search) const
      {
        const int           k = search.interval;
        std::vector<double> x, f;
        for (int point = k - 1; point <= k + 2; ++point)
          if (const auto y = value(search, point))
            {
              // Differences over much shorter steps are rounding errors here
              if ((point < k && (width(point) < 0.1 * width(k) || *y > *value(search, k))) ||
                  (point > k + 1 && (width(point - 1) < 0.1 * width(k) || *y > *value(search, k + 1))))
                continue;
              x.push_back(mu(point));
              f.push_back(*y);
            }
        const double ends = std::max(*value(search, k), *value(search, k + 1));
        if (x.size() < 3 || ends >= 0.)
          return std::nullopt;

        double                peak = remaining * ends;
        std::optional<double> result;
        constexpr int         n_samples = 16;
        for (int i = 1; i < n_samples; ++i)
          {
            const double t   = mu(k) + width(k) * i / n_samples;
            double       sum = 0.;
            for (std::size_t a = 0; a < x.size(); ++a)
              {
                double term = f[a];
                for (std::size_t b = 0; b < x.size(); ++b)
                  if (a != b)
                    term *= (t - x[b]) / (x[a] - x[b]);
                sum += term;
              }
            if (sum > peak)
              {
                peak   = sum;
                result = t;
              }
          }
        return result;
      }

      // ------------------------------------------------- results

      /// Zero of a search, with what is left of its interval.
      std::pair<double, double> zero(const Search &search) const
      {
        const int    k = search.interval;
        const double l = mu(k), r = mu(k + 1);
        if (search.at_once && grows_at_once(search))
          return {l, 0.};
        // The growth of a double mode emerges from rounding errors only here
        if (search.multiple)
          return {mu(0), r - mu(0)};
        if (width(k) > tolerance(k))
          return {0.5 * (l + r), 0.5 * (r - l)};
        const auto fl = value(search, k), fr = value(search, k + 1);
        if (!fl || !fr || !(*fl * *fr < 0.))
          return {0.5 * (l + r), r - l};
        return {l - *fl * (r - l) / (*fr - *fl), r - l};
      }

      /// |df/dμ| over the points around an interval.
      double slope(const Search &search) const
      {
        int first = search.interval, last = search.interval + 1;
        if (value(search, first - 1))
          --first;
        if (value(search, last + 1))
          ++last;
        const auto fl = value(search, first), fr = value(search, last);
        return fl && fr ? std::abs(*fr - *fl) / (mu(last) - mu(first)) : 0.;
      }

      /**
       * What corrections change of Re λ or Im λ to second order, the latter without regard to its
       * sign; no more than the uncertainty of λ, which is what remains where no corrections are known.
       */
      double uncertainty_of_lambda(const Search &search, double (*part)(const Complex &)) const
      {
        double result = 0.;
        for (const int k : {search.interval, search.interval + 1})
          if (const int m = mode(search.branch, k); m >= 0)
            {
              const ChartPoint &point = points[k];
              const double      bound = m < static_cast<int>(point.uncertainties.size()) ? point.uncertainties[m] : 0.;
              if (m >= point.corrections.n_rows() || part == nullptr)
                {
                  result = std::max(result, bound);
                  continue;
                }
              const ComplexDenseMatrix &D      = point.corrections;
              double                    change = std::abs(part(D(m, m)));
              for (int j = 0; j < D.n_columns(); ++j)
                if (const Complex product = D(m, j) * D(j, m); j != m && product != 0.)
                  change += std::abs(product / (point.lambda[m] - point.lambda[j]));
              result = std::max(result, std::min(change, bound));
            }
        return result;
      }

      /// What corrections change of δ² at point k.
      double change_of_discriminant(const Search &search, const int k) const
      {
        const ComplexDenseMatrix &D = points[k].corrections;
        const int                 i = mode(search.branch, k), j = mode(search.partner, k);
        if (std::max(i, j) >= D.n_rows() || std::max(i, j) >= D.n_columns())
          return 0.;
        const Complex shift = D(i, i) - D(j, j);
        return std::abs(shift * (2. * (points[k].lambda[i] - points[k].lambda[j]) + shift) + 4. * D(i, j) * D(j, i));
      }

      /// Shift of μ at a coalescence by corrections read on both sides at points away from it.
      double shift_of_coalescence(const Search &search, const double threshold) const
      {
        double result = 0.;
        for (const int direction : {-1, 1})
          {
            const int start = direction < 0 ? search.interval : search.interval + 1;
            int       best  = -1;
            for (int k = start; value(search, k); k += direction)
              {
                const double f = *value(search, k);
                if (best >= 0 && (f * *value(search, start) < 0. || std::abs(f) < std::abs(*value(search, best))))
                  break;
                best = k;
                if (std::abs(f) > separate * std::norm(lambda(search.branch, k)) || !is_refinement[k])
                  break;
              }
            if (best < 0)
              continue;
            const double f = std::abs(*value(search, best));
            if (mu(best) == threshold)
              continue;
            const double distance = std::abs(mu(best) - threshold), change = change_of_discriminant(search, best);
            if (f > 0.)
              // δ² ~ (μ − μ_0)² where a double mode grows at once, else linear
              result = std::max(result, search.at_once || search.multiple ? distance * std::sqrt(change / f) : distance * change / f);
          }
        return result;
      }

      double uncertainty(const Search &search, const double threshold) const
      {
        if (search.kind == Search::coalescence)
          return safety * shift_of_coalescence(search, threshold);
        const auto   real  = [](const Complex &x) { return x.real(); };
        const auto   imag  = [](const Complex &x) { return x.imag(); };
        const double error = search.kind == Search::growth      ? uncertainty_of_lambda(search, real) :
                             search.kind == Search::end_of_band ? uncertainty_of_lambda(search, imag) :
                                                                  uncertainty_of_lambda(search, nullptr);
        if (error == 0.)
          return 0.;
        const double rate = slope(search);
        if (search.kind == Search::real_axis)
          {
            // Im λ = √|f| changes by the error: f by 2 √|f| times as much, away from the axis
            const int k = search.upward ? search.interval + 1 : search.interval;
            return safety * 2. * lambda(search.branch, k).imag() * error / rate;
          }
        return safety * error / rate;
      }

      Complex lambda_at(const Search &search, const double threshold) const
      {
        const int  k    = search.multiple ? 0 : search.interval;
        const auto mean = [&](const int point) {
          return search.partner >= 0 ? 0.5 * (lambda(search.branch, point) + lambda(search.partner, point)) : lambda(search.branch, point);
        };
        const double t = (threshold - mu(k)) / width(k);
        return (1. - t) * mean(k) + t * mean(k + 1);
      }

      StabilityChart chart()
      {
        StabilityChart   result;
        std::vector<int> change(n_points(), 0);
        for (const Search &search : searches)
          {
            const auto [threshold, left] = zero(search);
            const double total           = left + uncertainty(search, threshold);
            if (search.kind == Search::growth || search.kind == Search::coalescence)
              result.thresholds.push_back(
                {threshold, total, search.upward ? ThresholdEvent::onset : ThresholdEvent::restabilisation,
                 search.kind == Search::growth ? ThresholdMechanism::zero_growth : ThresholdMechanism::coalescence, search.branch,
                 search.partner, lambda_at(search, threshold)});
            else
              {
                result.crossings.push_back({threshold, total, search.branch, search.upward,
                                            search.kind == Search::real_axis ? BandEdge::real_axis : BandEdge::end_of_band});
                change[search.interval + 1] += search.upward ? 1 : -1;
              }
          }
        const auto ascending = [](const auto &x, const auto &y) { return x.friction_coefficient < y.friction_coefficient; };
        std::stable_sort(result.thresholds.begin(), result.thresholds.end(), ascending);
        std::stable_sort(result.crossings.begin(), result.crossings.end(), ascending);

        int expected = 0;
        for (int k = 0; k < n_points(); ++k)
          {
            const auto &values = points[k].lambda;
            ChartCount  count;
            count.friction_coefficient = mu(k);
            count.n_modes              = static_cast<int>(
              std::count_if(values.begin(), values.end(), [&](const Complex &l) { return l.imag() <= options.largest_frequency; }));
            expected           = k == 0 ? count.n_modes : expected + change[k];
            count.n_expected   = expected;
            count.n_overdamped = static_cast<int>(points[k].real_values.size()) / 2;
            result.counts.push_back(count);
            if (k + 1 < n_points() && !intervals[k].links->resolved)
              ++result.n_doubtful_steps;
          }
        result.points        = std::move(points);
        result.is_refinement = std::move(is_refinement);
        result.branches      = std::move(branches);
        return result;
      }

      const EvaluateChart &evaluate;
      const ChartOptions  &options;

      std::vector<ChartPoint>       points;
      std::vector<bool>             is_refinement;
      std::vector<Interval>         intervals;
      std::vector<Branch>           branches;
      std::vector<std::vector<int>> branch_of; ///< branch of each mode of each point
      std::vector<Search>           searches;
      int                           n_refinements = 0;
    };
  } // namespace

  bool is_growing(const Complex &lambda)
  {
    return lambda.real() > 0. && divergent.exceeded_by(lambda.real() / lambda.imag());
  }

  StabilityChart stability_chart(const std::vector<double> &grid, const EvaluateChart &evaluate, const ChartOptions &options)
  {
    for (std::size_t i = 1; i < grid.size(); ++i)
      if (!(grid[i] > grid[i - 1]))
        throw Error("friction coefficient " + std::to_string(grid[i]) + " follows " + std::to_string(grid[i - 1]),
                    "modes over the friction coefficient", "give friction coefficients in ascending order, each once");
    for (const auto &[quantity, name] : {std::make_pair(options.largest_frequency, "end of the band"),
                                         {options.threshold_tolerance, "tolerance of thresholds"},
                                         {options.smallest_step, "smallest step"}})
      if (!(quantity > 0.))
        throw Error("the " + std::string(name) + " is " + std::to_string(quantity), "modes over the friction coefficient",
                    "give a positive value");
    return Sweep(evaluate, options).run(grid);
  }
} // namespace Squeal
