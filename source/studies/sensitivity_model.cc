#include <squeal/base/conventions.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/studies/sensitivity_model.h>
#include <squeal/tracking/mode_links.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    constexpr int main_line = 0;

    /// Relative step of parameters of the operation: contact damping is a product of powers of them or nearly so.
    constexpr double operation_step = 1e-4;

    /// Least friction coefficient, and slope [s/m], that steps are related to.
    constexpr double least_of_operation = 1e-2;

    /// Condition number κ of an eigenvalue from which it is differentiated together with that which it is about to meet [-].
    constexpr double coalescing_condition = 1000.;

    /// Distances from a coalescence, of that to the next event of either branch [-]: within them δ² is nearly linear.
    constexpr double first_distance = 0.03;

    /// How often the distances are divided by ten if modes could not be followed over them.
    constexpr int most_attempts = 3;

    /// Growths of the basis.
    constexpr int most_growths = 6;

    // --------------------------------------------------------- modes of interest

    /// Eigenvalues that are differentiated together: the first is that of interest.
    struct ModeGroup
    {
      std::vector<int> modes; ///< of a point
      Differentiated   kind;
    };

    ModeGroup group_of(const ChartPoint &point, const int mode, const Complex &D)
    {
      const std::vector<int> clusters = mode_clusters(point.lambda);
      ModeGroup              result{{mode}, Differentiated::eigenvalue};
      for (int j = 0; j < static_cast<int>(clusters.size()); ++j)
        if (j != mode && clusters[j] == clusters[mode])
          {
            result.modes.push_back(j);
            result.kind = Differentiated::cluster;
          }
      if (result.kind == Differentiated::cluster)
        return result;
      // Vectors have unit M-norms
      if (2. * std::abs(point.lambda[mode]) <= coalescing_condition * std::abs(D))
        return result;
      int    partner  = -1;
      double parallel = 0.;
      for (int j = 0; j < static_cast<int>(point.lambda.size()); ++j)
        if (const double overlap = std::abs(point.right.col(mode).dot(point.right.col(j))); j != mode && overlap > parallel)
          {
            partner  = j;
            parallel = overlap;
          }
      if (partner < 0)
        return result;
      return {{mode, partner}, Differentiated::pair};
    }

    /// Growing modes of the band by divergence rate; where there are none, all by divergence rate.
    std::vector<int> modes_of_interest(const SweepModel &model, const ChartPoint &point, const std::size_t most)
    {
      std::vector<int> growing, all;
      for (int j = 0; j < static_cast<int>(point.lambda.size()); ++j)
        if (model.is_in_band(point.lambda[j]))
          {
            all.push_back(j);
            if (point.verdicts[j] == Verdict::unstable)
              growing.push_back(j);
          }
      std::vector<int> &result = growing.empty() ? all : growing;
      std::stable_sort(result.begin(), result.end(), [&](const int a, const int b) {
        return modal_quantities(point.lambda[a]).divergence_rate > modal_quantities(point.lambda[b]).divergence_rate;
      });
      result.resize(std::min(result.size(), most));
      return result;
    }

    std::vector<ModeLabel> labels_of(const SweepModel &model, const ChartPoint &point, const std::vector<int> &modes)
    {
      std::vector<int>    all;
      std::vector<double> growth;
      for (int j = 0; j < static_cast<int>(point.lambda.size()); ++j)
        if (model.is_in_band(point.lambda[j]))
          {
            all.push_back(j);
            growth.push_back(point.verdicts[j] == Verdict::unstable ? point.lambda[j].real() : 0.);
          }
      std::vector<ModeLabel> labels = model.labels(point, all), result;
      mark_doublets(labels, growth);
      for (const int mode : modes)
        result.push_back(labels[std::find(all.begin(), all.end(), mode) - all.begin()]);
      return result;
    }

    /// The mode of a point nearest to each λ, each once.
    std::vector<int> nearest_modes(const ChartPoint &point, const std::vector<ModeSensitivity> &modes)
    {
      std::vector<int> result;
      for (const ModeSensitivity &mode : modes)
        {
          int nearest = -1;
          for (int j = 0; j < static_cast<int>(point.lambda.size()); ++j)
            if (std::find(result.begin(), result.end(), j) == result.end() &&
                (nearest < 0 || std::abs(point.lambda[j] - mode.lambda) < std::abs(point.lambda[nearest] - mode.lambda)))
              nearest = j;
          result.push_back(nearest);
        }
      return result;
    }

    ModeSensitivity sensitivity_of(const SensitivityModel &model, const ChartPoint &point, const int mode)
    {
      const SensitivityProducts own      = model.products(point, {mode});
      const ModeGroup           group    = group_of(point, mode, own.D(0, 0));
      const SensitivityProducts products = group.modes.size() == 1 ? own : model.products(point, group.modes);
      std::vector<int>          all(group.modes.size());
      std::iota(all.begin(), all.end(), 0);
      ModeSensitivity result{point.lambda[mode], {}, point.verdicts[mode] == Verdict::unstable, group.kind, {}, {}};
      for (const ComplexDenseMatrix &N : products.N)
        result.derivatives.push_back(mean_derivative(N, products.D, all));
      return result;
    }

    // ---------------------------------------------------------------- thresholds

    /// Modes of a point that go on those of another one; nothing where that cannot be told.
    std::optional<std::vector<int>> followed(const ChartPoint       &from,
                                             const std::vector<int> &modes,
                                             const ChartPoint       &to,
                                             const double            omega_max)
    {
      const ModeLinks  links = link_modes(from, to, omega_max);
      std::vector<int> result;
      std::vector<int> rest = modes;
      for (const ModeBlock &block : links.blocks)
        if (std::any_of(block.first.begin(), block.first.end(),
                        [&](const int j) { return std::find(modes.begin(), modes.end(), j) != modes.end(); }))
          {
            // Blocks of other modes, too, do not tell which is which
            for (const int j : block.first)
              if (const auto found = std::find(rest.begin(), rest.end(), j); found != rest.end())
                rest.erase(found);
              else
                return {};
            result.insert(result.end(), block.second.begin(), block.second.end());
          }
      if (!rest.empty() || result.size() != modes.size())
        return {};
      return result;
    }

    /// The point of a chart nearest to a friction coefficient at which all of some branches have modes; −1: none.
    int nearest_point(const StabilityChart &chart, const double friction_coefficient, const std::vector<int> &branches)
    {
      int result = -1;
      for (int i = 0; i < static_cast<int>(chart.points.size()); ++i)
        if (std::all_of(branches.begin(), branches.end(), [&](const int b) { return chart.branches[b].modes[i] >= 0; }) &&
            (result < 0 || std::abs(chart.points[i].friction_coefficient - friction_coefficient) <
                             std::abs(chart.points[result].friction_coefficient - friction_coefficient)))
          result = i;
      return result;
    }

    /// Friction coefficients at which a threshold is looked at, with the modes there.
    struct ThresholdSample
    {
      double           friction_coefficient;
      std::vector<int> modes;
    };

    class ThresholdDerivatives
    {
    public:
      ThresholdDerivatives(SensitivityModel &model, const StabilityChart &chart, const Threshold &threshold)
        : model(model)
        , chart(chart)
        , threshold(threshold)
        , branches(threshold.partner >= 0 ? std::vector<int>{threshold.branch, threshold.partner} : std::vector<int>{threshold.branch})
        , step(first_distance * room())
      {}

      /// With the present basis. All processes must call.
      ThresholdSensitivity find()
      {
        result = {&threshold, "", {}, {}};
        if (threshold.friction_coefficient <= chart.points.front().friction_coefficient)
          result.obstacle = "grows from the first friction coefficient on: a multiple eigenvalue that friction splits";
        else if (threshold.mechanism == ThresholdMechanism::zero_growth)
          at_zero_growth();
        else
          for (int attempt = 0; attempt < most_attempts; ++attempt, step *= 0.1)
            {
              result.obstacle.clear();
              at_coalescence();
              if (result.obstacle.empty())
                break;
            }
        return result;
      }

      /// Where the modes were looked at last.
      const std::vector<ThresholdSample> &samples() const
      {
        return last_samples;
      }

    private:
      /// Distance to the next event of either branch, and to the ends of the chart.
      double room() const
      {
        const double mu     = threshold.friction_coefficient;
        double       result = std::min(mu - chart.points.front().friction_coefficient, chart.points.back().friction_coefficient - mu);
        for (const Threshold &other : chart.thresholds)
          for (const int b : branches)
            if (&other != &threshold && (other.branch == b || other.partner == b))
              result = std::min(result, std::abs(other.friction_coefficient - mu));
        return std::max(result, 0.);
      }

      /// The modes of both branches at a friction coefficient, with their point.
      const ChartPoint *sample(const double mu)
      {
        const int        i = nearest_point(chart, mu, branches);
        std::vector<int> from;
        for (const int b : branches)
          from.push_back(chart.branches[b].modes[i]);
        model.sweep.evaluate(main_line, {mu});
        const ChartPoint &there = model.sweep.known.at({main_line, mu});
        const auto        to    = followed(chart.points[i], from, there, model.sweep.largest_circular_frequency);
        if (!to)
          {
            result.obstacle = "its modes mix with others nearby";
            return nullptr;
          }
        last_samples.push_back({mu, *to});
        return &there;
      }

      int friction() const
      {
        const auto &all = model.parameters;
        return static_cast<int>(
          std::find_if(all.begin(), all.end(),
                       [](const SensitivityParameter &p) { return p.operation == &OperationParameters::friction_coefficient; }) -
          all.begin());
      }

      void at_zero_growth()
      {
        last_samples.clear();
        const ChartPoint *point = sample(threshold.friction_coefficient);
        if (point == nullptr)
          return;
        const int                 mode     = last_samples.back().modes.front();
        const SensitivityProducts products = model.products(*point, {mode});
        std::vector<double>       rates;
        for (const ComplexDenseMatrix &N : products.N)
          rates.push_back(eigenvalue_derivative(N, products.D, 0).real());
        for (const double rate : rates)
          result.derivatives.push_back(-rate / rates[friction()]);
        result.errors.assign(rates.size(), 0.);
      }

      void at_coalescence()
      {
        const double mu = threshold.friction_coefficient;
        last_samples.clear();
        if (!(step > 3. * threshold.uncertainty))
          {
            result.obstacle = "another event of its modes is too close";
            return;
          }
        std::vector<std::array<Complex, 3>> means(model.parameters.size(), std::array<Complex, 3>{});
        for (int distance = 1; distance <= 3; ++distance)
          for (const int side : {-1, 1})
            {
              const ChartPoint *point = sample(mu + side * distance * step);
              if (point == nullptr)
                return;
              const SensitivityProducts products = model.products(*point, last_samples.back().modes);
              for (std::size_t p = 0; p < means.size(); ++p)
                means[p][distance - 1] += 0.5 * squared_difference_derivative(products.N[p], products.D, products.lambda, 0, 1);
            }
        const ValueAtCentre slope = value_at_centre(means[friction()]);
        for (const auto &mean : means)
          {
            const ValueAtCentre value = value_at_centre(mean);
            const double        rate  = -(value.value / slope.value).real();
            result.derivatives.push_back(rate);
            result.errors.push_back((value.error + std::abs(rate) * slope.error) / std::abs(slope.value));
          }
      }

      SensitivityModel            &model;
      const StabilityChart        &chart;
      const Threshold             &threshold;
      const std::vector<int>       branches;
      double                       step; ///< of the friction coefficient
      ThresholdSensitivity         result;
      std::vector<ThresholdSample> last_samples;
    };

    // -------------------------------------------------------------------- rounds

    /// Largest modulus of a part of derivatives with respect to ln p.
    double largest(const std::vector<SensitivityParameter> &parameters,
                   const std::vector<Complex>              &derivatives,
                   double (*part)(const Complex &))
    {
      double result = 0.;
      for (std::size_t p = 0; p < parameters.size(); ++p)
        result = std::max(result, std::abs(parameters[p].value * part(derivatives[p])));
      return result;
    }

    double real_part(const Complex &z)
    {
      return z.real();
    }

    double imaginary_part(const Complex &z)
    {
      return z.imag();
    }

    /// Keeps the changes since an earlier basis; returns the largest one over the largest derivative of its mode.
    double compare(std::vector<ModeSensitivity>            &modes,
                   const std::vector<ModeSensitivity>      &before,
                   const std::vector<SensitivityParameter> &parameters)
    {
      double result = 0.;
      for (std::size_t m = 0; m < modes.size(); ++m)
        {
          ModeSensitivity &mode = modes[m];
          for (std::size_t p = 0; p < mode.derivatives.size(); ++p)
            mode.changes.push_back(mode.derivatives[p] - before[m].derivatives[p]);
          result =
            std::max(result, largest(parameters, mode.changes, imaginary_part) / largest(parameters, mode.derivatives, imaginary_part));
          // A neutral mode has a growth rate by rounding alone, and so have its derivatives
          if (const double scale = largest(parameters, mode.derivatives, real_part); scale > negligible_divergence * std::abs(mode.lambda))
            result = std::max(result, largest(parameters, mode.changes, real_part) / scale);
        }
      return result;
    }

    /// Grows the basis by the residuals of modes; returns why it cannot, or nothing.
    std::string grow(SensitivityModel &model, const std::vector<ChartModel::ModesAt> &sets, const unsigned int maximum_basis)
    {
      ChartModel &reduced = *model.sweep.reduced;
      const auto  vectors = reduced.new_vectors(sets);
      if (!vectors)
        return "rounding errors leave no new direction";
      if (reduced.size() + vectors->n_columns() > static_cast<int>(maximum_basis))
        return text("the basis would exceed ", maximum_basis, " vectors");
      reduced.extend(*vectors);
      // Points that were evaluated with a smaller basis do not count
      model.sweep.known.clear();
      return "";
    }

    ChartModel::ModesAt modes_at(const SweepModel &sweep, const ChartPoint &point, const std::vector<int> &modes)
    {
      return {sweep.plan.point(main_line, point.friction_coefficient, sweep.regime.closed), &point, modes};
    }
  } // namespace

  SensitivityProducts SensitivityModel::products(const ChartPoint &point, const std::vector<int> &modes) const
  {
    const ReducedModel &reduced = sweep.reduced->reduced();
    const auto          shapes  = [&](const ComplexDenseMatrix &X) {
      return reduced.basis() * halves(with_rows(X(Eigen::all, modes), reduced.size()));
    };
    Eigentriples triples{{}, shapes(point.right), shapes(point.left)};
    for (const int mode : modes)
      triples.lambda.push_back(point.lambda[mode]);

    const double          mu      = point.friction_coefficient;
    const CoupledSystem  &coupled = sweep.frictionless.linearisation.coupled;
    const ParameterValues values  = coupled.at(mu, sweep.plan.point(main_line, mu, sweep.regime.closed).values);
    const Eigentriples    apart   = on_bodies(sweep.frictionless.linearisation.contact, mu, triples);
    const TermProducts    of_contact(coupled.terms, triples), of_bodies(bodies.terms, apart);

    const Eigentriples alone = on_bodies(sweep.frictionless.linearisation.contact, 0., triples); // without friction in the left vectors
    const auto         k     = static_cast<int>(modes.size());
    const auto         r_n   = normal_reactions(coupled, triples.lambda, view(triples.right, 0, k), view(triples.right, k, k));

    SensitivityProducts result{triples.lambda, of_contact.by_lambda(values), {}};
    for (const SensitivityParameter &parameter : parameters)
      {
        ComplexDenseMatrix N = of_bodies.along(bodies.values, parameter.body_rates);
        if (!parameter.derivative.empty())
          N += TermProducts(parameter.derivative, apart).pencil(bodies.values);
        if (parameter.operation != nullptr)
          N += of_contact.along(values, contact_rates(parameter, mu));
        if (parameter.contact)
          N += by_moved_contact(*parameter.contact, mu, alone, r_n);
        result.N.push_back(std::move(N));
      }
    return result;
  }

  ComplexDenseMatrix SensitivityModel::by_moved_contact(const ContactMotion      &motion,
                                                        const double              friction_coefficient,
                                                        const Eigentriples       &apart,
                                                        const ComplexDenseMatrix &reactions) const
  {
    const Scene              &scene     = sweep.plan.scene;
    const OperationParameters operation = sweep.plan.lines[main_line].at(friction_coefficient);
    const auto                state     = sweep.plan.sliding_state(operation);
    const auto                k         = static_cast<Eigen::Index>(apart.lambda.size());
    ComplexDenseMatrix        result    = ComplexDenseMatrix::Zero(k, k);
    const bool                all       = sweep.regime.closed.size() == scene.interface.size();
    for (const bool is_after : {false, true})
      {
        const ContactInterface &interface = is_after ? motion.after : motion.before;
        const double            sign      = is_after ? 1. : -1.;
        ContactInterface        closed;
        for (const unsigned int c : sweep.regime.closed)
          closed.push_back(interface[c]);
        const ContactOperators contact = !all     ? contact_operators(*scene.model, closed) :
                                         is_after ? motion.operators_after :
                                                    motion.operators_before;
        // Friction: −μ P_tᵀ r_n. The reactions of a motion do not change, since normals do not
        const ComplexDenseMatrix slip = from_halves(replicate(*contact.tangential * apart.left));
        result -= sign / motion.step * friction_coefficient * (slip.transpose() * reactions);
        const ContactDamping damping = selected(state_of_contact(interface, state, operation).damping, sweep.regime.closed);
        if (const auto C = contact_damping(contact, damping))
          {
            const ComplexDenseMatrix forms = product_of_halves(gram(apart.left, *C * apart.right));
            for (Eigen::Index j = 0; j < k; ++j)
              result.col(j) += sign / motion.step * apart.lambda[j] * forms.col(j);
          }
      }
    return result;
  }

  ParameterValues SensitivityModel::contact_rates(const SensitivityParameter &parameter, const double friction_coefficient) const
  {
    const OperationParameters operation = sweep.plan.lines[main_line].at(friction_coefficient);
    const double              step      = operation_step * std::max(std::abs(operation.*parameter.operation), least_of_operation);
    const auto                damping   = [&](const double change) {
      OperationParameters changed = operation;
      changed.*parameter.operation += change;
      const StateOfContact state = state_of_contact(sweep.plan.scene.interface, sweep.plan.sliding_state(changed), changed);
      return selected(state.damping, sweep.regime.closed).values();
    };
    const ParameterValues after = damping(step);
    ParameterValues       rates = damping(-step);
    for (auto &[name, list] : rates)
      for (std::size_t c = 0; c < list.size(); ++c)
        list[c] = (after.at(name)[c] - list[c]) / (2. * step);
    if (parameter.operation == &OperationParameters::friction_coefficient)
      rates[SystemParameter::friction] = {1.};
    return rates;
  }

  std::vector<ModeSensitivity> mode_sensitivities(SensitivityModel &model, Run &run)
  {
    SweepModel                  &sweep  = model.sweep;
    const SensitivityParameters &wanted = run.parameters.sensitivity;
    std::vector<ModeSensitivity> result;
    std::string                  why_stopped;
    int                          n_growths = 0;
    run.progress.begin("Derivatives of modes");
    sweep.known.clear();
    while (true)
      {
        const ChartPoint             point = sweep.evaluate(main_line, {run.parameters.operation.friction_coefficient}).front();
        const std::vector<int>       modes = result.empty() ? modes_of_interest(sweep, point, wanted.modes) : nearest_modes(point, result);
        std::vector<ModeSensitivity> now;
        for (const int mode : modes)
          now.push_back(sensitivity_of(model, point, mode));
        const auto labels = labels_of(sweep, point, modes);
        for (std::size_t m = 0; m < modes.size(); ++m)
          now[m].label = labels[m];
        const double change = result.empty() ? std::numeric_limits<double>::infinity() : compare(now, result, model.parameters);
        result              = std::move(now);
        run.progress.update(text("change ", change));
        if (change <= wanted.tolerance)
          break;
        if (n_growths == most_growths)
          why_stopped = text("after ", most_growths, " growths of the basis they still change by ", change);
        else
          why_stopped = grow(model, {modes_at(sweep, point, modes)}, run.parameters.sweep.maximum_basis);
        if (!why_stopped.empty())
          break;
        ++n_growths;
      }
    run.progress.finish(text(result.size(), " modes, ", model.parameters.size(), " parameters; ", sweep.reduced->size(), " vectors after ",
                             n_growths, n_growths == 1 ? " growth" : " growths"));
    if (!why_stopped.empty())
      run.warn("derivatives of modes miss Sensitivity/Tolerance: " + why_stopped);
    return result;
  }

  std::vector<ThresholdSensitivity> threshold_sensitivities(SensitivityModel &model, const SweepChart &chart, Run &run)
  {
    SweepModel                       &sweep = model.sweep;
    std::vector<ThresholdDerivatives> thresholds;
    for (const Threshold &threshold : chart.chart.thresholds)
      thresholds.emplace_back(model, chart.chart, threshold);
    const auto find = [&](const char *what) {
      std::vector<ThresholdSensitivity> result;
      for (ThresholdDerivatives &threshold : thresholds)
        {
          run.progress.update(text(what, result.size() + 1, " of ", thresholds.size()));
          result.push_back(threshold.find());
        }
      return result;
    };

    run.progress.begin("Derivatives of thresholds");
    std::vector<ThresholdSensitivity> result = find("threshold ");
    std::vector<ChartModel::ModesAt>  sets;
    for (const ThresholdDerivatives &threshold : thresholds)
      for (const ThresholdSample &sample : threshold.samples())
        sets.push_back(modes_at(sweep, sweep.known.at({main_line, sample.friction_coefficient}), sample.modes));
    if (!sets.empty())
      {
        const std::string why_not = grow(model, sets, run.parameters.sweep.maximum_basis);
        if (!why_not.empty())
          run.warn("derivatives of thresholds are those of the basis of the sweep: " + why_not);
        else
          {
            std::vector<ThresholdSensitivity> now = find("once more threshold ");
            for (std::size_t t = 0; t < now.size(); ++t)
              for (std::size_t p = 0; p < std::min(now[t].derivatives.size(), result[t].derivatives.size()); ++p)
                now[t].errors[p] += std::abs(now[t].derivatives[p] - result[t].derivatives[p]);
            result = std::move(now);
          }
      }
    const auto n = std::count_if(result.begin(), result.end(), [](const ThresholdSensitivity &t) { return t.obstacle.empty(); });
    run.progress.finish(text(n, " of ", result.size(), " thresholds, ", sweep.reduced->size(), " vectors"));
    return result;
  }
} // namespace Squeal
