#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/sparse.h>
#include <squeal/linear_algebra/sparse_determinant.h>
#include <squeal/stability/condensed_determinant.h>
#include <squeal/stability/contour_count.h>

#include <Epetra_Comm.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <sstream>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    const char *const place = "count of complex modes by the argument principle";

    /// ‖F‖_F of a step. Between its ends F may exceed it, but must stay below 1.
    constexpr double largest_change = 0.5;

    /// ‖ΔN N⁻¹‖ at the points; between them N⁻¹ may be twice as large.
    constexpr double largest_truncation = 0.25;

    /// Bounds of the truncation of N: the first try, and where rounding ends it.
    constexpr double first_tolerance = 1e-7, least_tolerance = 1e-13;

    /// Steps below this part of ω_high mean that a zero lies on the contour; so close may no real mode be to its ends.
    constexpr double shortest_step = 1e-9;

    // ------------------------------------------------------------------- contour

    /// Corners of what is followed, counterclockwise, and how often it makes up the whole contour.
    struct Contour
    {
      Contour(const ContourOptions &options, const bool damped)
        : high(options.largest_frequency)
        , low(options.lowest_frequency > 0. ? options.lowest_frequency : 1e-3 * high)
        , width(options.largest_growth > 0. ? options.largest_growth : 0.1 * high)
        , multiplicity(damped ? 1 : 2)
      {
        if (!(high > low))
          throw SolverError(number(hertz(high)) + " Hz as the end of the band, " + number(hertz(low)) + " Hz as its beginning", place,
                            "let the band end above its beginning");
        if (damped)
          corners = {{0., low}, {width, low}, {width, high}, {-width, high}, {-width, low}, {0., low}};
        else
          corners = {{0., low}, {width, low}, {width, high}, {0., high}};
      }

      static std::string number(const double value)
      {
        std::ostringstream stream;
        stream << value;
        return stream.str();
      }

      /// Largest |λ|.
      double radius() const
      {
        return std::hypot(width, high);
      }

      [[noreturn]] void refuse(const std::string &why, const Complex lambda) const
      {
        throw SolverError("the count is refused: " + why + " at " + number(hertz(lambda.imag())) + " Hz with a growth rate of " +
                            number(lambda.real()) + " 1/s",
                          place,
                          std::abs(lambda.real()) < width ? "move the end of the band off the mode, or allow more points" :
                                                            "choose another width of the contour, or allow more points");
      }

      double               high, low, width;
      int                  multiplicity;
      std::vector<Complex> corners;
    };

    // -------------------------------------------------------- phase from step to step

    /// What a step to another point of the contour would be.
    struct Step
    {
      double size;               ///< acceptable up to 1, and about proportional to the length
      double phase;              ///< of the determinant [rad]
      double largest_phase = 0.; ///< of its parts
    };

    /// A determinant that is followed along the contour.
    class FollowedDeterminant
    {
    public:
      virtual ~FollowedDeterminant() = default;

      virtual void start(Complex lambda)   = 0;
      virtual Step attempt(Complex lambda) = 0;

      /// Goes to the point of the last attempt.
      virtual void accept() = 0;

      /// What must not be exceeded whatever the size of the step turns out to be [rad/s].
      virtual double longest_step(const Complex) const
      {
        return std::numeric_limits<double>::infinity();
      }

      int n_points = 0;
    };



    /// The determinant of a small matrix.
    class FollowedDense : public FollowedDeterminant
    {
    public:
      /// The matrix A at a point and, of use for a bound of errors, what multiplies its inverse there.
      struct Sample
      {
        ComplexDenseMatrix   matrix;
        std::vector<Complex> scaling;     ///< diagonal B; empty: I
        double               offset = 0.; ///< the error is bounded by offset + factor ‖A⁻¹ B‖
        double               factor = 0.;
      };
      using Function = std::function<Sample(Complex)>;

      /// @p poles of the matrix on the positive imaginary axis, to which steps are kept short
      FollowedDense(Function function, std::vector<double> poles, const double largest_phase_step, const Epetra_Comm &comm)
        : function(std::move(function))
        , poles(std::move(poles))
        , largest_phase_step(largest_phase_step)
        , comm(comm)
      {}

      void start(const Complex lambda) override
      {
        set_next(evaluate(lambda));
        accept();
      }

      Step attempt(const Complex lambda) override
      {
        Sample             sample = evaluate(lambda);
        ComplexDenseMatrix F      = sample.matrix;
        current.factors->solve(F);
        Complex trace = 0.;
        for (int j = 0; j < F.n_columns(); ++j)
          {
            F(j, j) -= 1.;
            trace += F(j, j);
          }
        // A NaN must not reach LAPACK.
        const double        norm   = frobenius_norm(F);
        std::vector<double> agreed = {std::isfinite(norm) ? std::min(norm, frobenius_norm(balanced(F))) : norm, trace.imag()};
        agree_on(agreed);
        const double infinity = std::numeric_limits<double>::infinity();
        Step         step{std::isfinite(agreed[0]) ? agreed[0] / largest_change : infinity, 0.};
        if (step.size > 1.)
          return step;

        set_next(std::move(sample));
        step.phase = next.argument - current.argument;
        step.phase += 2. * M_PI * std::round((agreed[1] - step.phase) / (2. * M_PI));
        step.largest_phase = std::abs(step.phase);
        // Farther from the trace than the bound: rounding has spoilt one of the two.
        if (!(std::abs(step.phase - agreed[1]) <= -std::log(1. - agreed[0]) - agreed[0] + 1e-6))
          return {infinity, 0.};
        step.size = std::max(step.size, step.largest_phase / largest_phase_step);
        return step;
      }

      void accept() override
      {
        current = std::move(next);
        error   = std::max(error, current.error);
      }

      double longest_step(const Complex lambda) const override
      {
        double distance = std::numeric_limits<double>::infinity();
        for (const double omega : poles)
          distance = std::min({distance, std::abs(lambda - Complex(0., omega)), std::abs(lambda + Complex(0., omega))});
        return 0.5 * distance;
      }

      double error = 0.; ///< largest bound so far

    private:
      struct Point
      {
        std::unique_ptr<ComplexDenseLU> factors;
        double                          argument = 0., error = 0.;
      };

      Sample evaluate(const Complex lambda)
      {
        ++n_points;
        return function(lambda);
      }

      void set_next(Sample sample)
      {
        const int n  = sample.matrix.n_rows();
        next.factors = std::make_unique<ComplexDenseLU>(std::move(sample.matrix));
        double norm  = std::sqrt(n) * next.factors->inverse_norm();
        if (!sample.scaling.empty() && std::isfinite(norm))
          {
            ComplexDenseMatrix X(n, n);
            for (int i = 0; i < n; ++i)
              X(i, i) = sample.scaling[i];
            next.factors->solve(X);
            norm = frobenius_norm(X);
          }
        std::vector<double> agreed = {next.factors->log_determinant().imag(), sample.offset + sample.factor * norm};
        agree_on(agreed);
        next.argument = agreed[0];
        next.error    = agreed[1];
      }

      /// Every process computes the same; steps are decided upon what process 0 found.
      void agree_on(std::vector<double> &values) const
      {
        DenseMatrix none;
        agree(comm, none, values);
      }

      const Function            function;
      const std::vector<double> poles;
      const double              largest_phase_step;
      const Epetra_Comm        &comm;
      Point                     current, next;
    };



    /// det Q.
    class FollowedSparse : public FollowedDeterminant
    {
    public:
      FollowedSparse(const SparseDeterminant &determinant, const double largest_phase_step)
        : determinant(determinant)
        , largest_phase_step(largest_phase_step)
      {}

      void start(const Complex lambda) override
      {
        next = {lambda, evaluate(lambda)};
        accept();
      }

      Step attempt(const Complex lambda) override
      {
        const Complex middle = evaluate(0.5 * (current.lambda + lambda));
        next                 = {lambda, evaluate(lambda)};
        const Complex first = change(current.logarithm, middle), second = change(middle, next.logarithm);
        const double  largest = std::max(std::abs(first), std::abs(second));
        return {std::isfinite(largest) ? largest / largest_phase_step : std::numeric_limits<double>::infinity(),
                first.imag() + second.imag(), std::max(std::abs(first.imag()), std::abs(second.imag()))};
      }

      void accept() override
      {
        current = next;
      }

    private:
      struct Point
      {
        Complex lambda, logarithm;
      };

      Complex evaluate(const Complex lambda)
      {
        ++n_points;
        return determinant.logarithm(lambda);
      }

      static Complex change(const Complex from, const Complex to)
      {
        return {to.real() - from.real(), std::remainder(to.imag() - from.imag(), 2. * M_PI)};
      }

      const SparseDeterminant &determinant;
      const double             largest_phase_step;
      Point                    current, next;
    };

    // ------------------------------------------------------------------- following

    /// Turns of the determinant along the contour; n_points and largest_phase_step of @p count take account of them.
    int turns(FollowedDeterminant  &determinant,
              const Contour        &contour,
              const ContourOptions &options,
              ContourCount         &count,
              Progress             &progress)
    {
      double phase = 0., length = 0.1 * contour.width;
      determinant.start(contour.corners.front());
      for (std::size_t side = 1; side < contour.corners.size(); ++side)
        {
          const Complex from = contour.corners[side - 1], to = contour.corners[side];
          const double  end       = std::abs(to - from);
          const Complex direction = (to - from) / end;
          for (double position = 0.; position < end;)
            {
              const Complex lambda = from + position * direction;
              const double  rest   = end - position;
              length               = std::min({length, rest, determinant.longest_step(lambda)});
              if (length < std::min(rest, shortest_step * contour.high))
                contour.refuse("a mode lies on the contour", lambda);
              if (determinant.n_points >= options.maximum_points)
                contour.refuse("more than " + std::to_string(options.maximum_points) + " points are needed; it was given up", lambda);

              const bool last = length == rest;
              const Step step = determinant.attempt(last ? to : lambda + length * direction);
              if (step.size <= 1.)
                {
                  determinant.accept();
                  phase += step.phase;
                  count.largest_phase_step = std::max(count.largest_phase_step, step.largest_phase);
                  position                 = last ? end : position + length;
                  length *= std::min(2., 0.8 / std::max(step.size, 0.1));
                }
              else
                length *= std::clamp(0.8 / step.size, 0.1, 0.5);
            }
          progress.update(std::to_string(determinant.n_points) + " points of the contour");
        }
      count.n_points += determinant.n_points;

      const double turns = contour.multiplicity * phase / (2. * M_PI), whole = std::round(turns);
      if (!(std::abs(turns - whole) < 1e-3))
        throw SolverError("the determinant does not return to its phase: " + Contour::number(turns) + " turns", place,
                          "choose another end of the band or another width of the contour");
      return whole;
    }

    /// Real modes inside, by inertia.
    int n_frictionless_modes(const CoupledSystem &system, const Contour &contour)
    {
      const auto below = [&](const double omega) {
        return count_modes(*system.stiffness, *system.mass, omega * omega, "real modes of the coupled system");
      };
      return below(contour.high) - below(contour.low);
    }

    // ------------------------------------------------------------------ both methods

    std::vector<ContourCount> count_condensed(const CoupledSystem       &system,
                                              const std::vector<double> &mu,
                                              const ContourOptions      &options,
                                              const Contour             &contour,
                                              Progress                  &progress)
    {
      const SparseMatrix &K = *system.stiffness, &M = *system.mass;

      // The real modes, and the inverse that gives both them and the series
      progress.update("real modes beyond the band");
      SymmetricModesOptions real = options.real_modes;
      if (real.what == SymmetricModesOptions().what)
        real.what = "real modes of the coupled system";
      std::unique_ptr<Factorization> factor;
      if (real.inverse == nullptr)
        {
          factor       = factorize_positive_definite(real.shift > 0. ? *add(1., K, real.shift, M) : K, real.library, real.what);
          real.inverse = factor.get();
        }
      const double         deflation_end = std::max(1.05, options.deflation) * contour.radius();
      const SymmetricModes modes         = symmetric_modes(K, M, deflation_end * deflation_end, real);

      // Their number inside, by inertia alone
      const int n_frictionless = n_frictionless_modes(system, contour);
      int       n_inside       = 0;
      for (const double eigenvalue : modes.eigenvalues)
        {
          const double omega = std::sqrt(std::max(0., eigenvalue));
          n_inside += omega > contour.low && omega < contour.high;
          for (const double end : {contour.low, contour.high})
            if (std::abs(omega - end) < shortest_step * contour.high)
              contour.refuse("a real mode lies on the contour", {0., end});
        }
      if (n_inside != n_frictionless)
        throw SolverError(std::to_string(n_inside) + " real modes were found in the band, " + std::to_string(n_frictionless) + " exist",
                          place, "move the end of the band off the mode next to it");

      CondensedDeterminantRequest request;
      request.lambda = {{0., contour.low}, {contour.width, contour.low}, {contour.width, contour.high}, {0., contour.high}};
      for (const double friction : mu)
        request.largest_friction_coefficient = std::max(request.largest_friction_coefficient, std::abs(friction));
      request.tolerance = first_tolerance;

      std::vector<ContourCount>                   results;
      std::unique_ptr<const CondensedDeterminant> determinant;
      while (results.size() < mu.size())
        {
          if (!determinant)
            {
              progress.update("moments of the complement");
              determinant = std::make_unique<CondensedDeterminant>(system, modes, deflation_end, *real.inverse, real.shift, request);
            }
          const double  friction = mu[results.size()];
          FollowedDense complement(
            [&](const Complex lambda) {
              return FollowedDense::Sample{determinant->complement(lambda, friction), {}, 0., determinant->truncation(lambda, friction)};
            },
            {}, options.largest_phase_step, M.Comm());
          FollowedDense on_modes(
            [&](const Complex lambda) {
              CondensedDeterminant::OnModes sample = determinant->on_modes(lambda, friction);
              const double                  bound  = determinant->truncation(lambda, friction);
              return FollowedDense::Sample{std::move(sample.matrix), std::move(sample.resonances), bound * sample.complement_inverse,
                                           bound * sample.gain};
            },
            determinant->frequencies(), options.largest_phase_step, M.Comm());

          ContourCount count;
          count.n_frictionless = n_frictionless;
          count.n_modes        = n_frictionless + turns(complement, contour, options, count, progress);
          count.n_modes += turns(on_modes, contour, options, count, progress);
          count.truncation_bound = std::max(complement.error, on_modes.error);
          count.n_moments        = determinant->n_moments();
          count.n_deflated       = modes.eigenvalues.size();
          if (count.truncation_bound <= largest_truncation)
            {
              results.push_back(count);
              continue;
            }
          request.tolerance *= 0.2 * largest_truncation / count.truncation_bound;
          if (!(request.tolerance >= least_tolerance))
            throw SolverError(
              "the count is refused: the determinant is not known well enough on the contour, which passes a mode too closely", place,
              "move the end of the band, or choose another width of the contour");
          determinant.reset();
        }
      return results;
    }



    std::vector<ContourCount> count_sparse(const CoupledSystem       &system,
                                           const std::vector<double> &mu,
                                           const ContourOptions      &options,
                                           const Contour             &contour,
                                           Progress                  &progress)
    {
      const int                 n_frictionless = n_frictionless_modes(system, contour);
      std::vector<ContourCount> results;
      for (const double friction : mu)
        {
          const SecondOrderSystem matrices = with_friction(system, friction);
          const SparseDeterminant determinant(*matrices.mass, matrices.damping.get(), *matrices.stiffness);
          FollowedSparse          followed(determinant, options.largest_phase_step);
          ContourCount            count;
          count.n_frictionless = n_frictionless;
          count.n_modes        = turns(followed, contour, options, count, progress);
          results.push_back(count);
        }
      return results;
    }
  } // namespace



  ContourMethod contour_method(const CoupledSystem &system)
  {
    const bool confined = std::all_of(system.terms.begin(), system.terms.end(), [&system](const Term &term) {
      return !term.matrix || term.matrix == system.mass || term.matrix == system.stiffness || term.vanishes(system.values);
    });
    return confined ? ContourMethod::condensed : ContourMethod::sparse_lu;
  }



  std::vector<ContourCount> count_by_contour(const CoupledSystem       &system,
                                             const std::vector<double> &mu,
                                             const ContourOptions      &options,
                                             Progress                  &progress)
  {
    const Contour contour(options, system.has_damping());
    return options.method == ContourMethod::condensed ? count_condensed(system, mu, options, contour, progress) :
                                                        count_sparse(system, mu, options, contour, progress);
  }
} // namespace Squeal
