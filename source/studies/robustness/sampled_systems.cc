// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/tasks.h>
#include <squeal/parameters/design_plan.h>
#include <squeal/studies/robustness/robustness.h>
#include <squeal/studies/steps/system_family.h>

#include <map>

namespace Squeal
{
  namespace
  {
    /// Material constants that may differ from pin to pin.
    const std::map<std::string, double Material::*> numbers_of_pins = {{"Pin material/Young modulus", &Material::young_modulus},
                                                                       {"Pin material/Density", &Material::density},
                                                                       {"Pin material/Rayleigh alpha", &Material::rayleigh_alpha},
                                                                       {"Pin material/Rayleigh beta", &Material::rayleigh_beta}};

    constexpr const char *where_uncertain = "parameter Robustness/Distributions";

    /// Parameters with a separate but equal material for each pin that has its own uncertain numbers.
    Parameters with_single_pins(Parameters parameters, const std::vector<UncertainNumber> &numbers)
    {
      std::vector<VolumeMaterial> &volumes = parameters.materials.volumes;
      for (const UncertainNumber &number : numbers)
        if (!number.pin.empty() && !parameters.materials.has_own(number.pin))
          volumes.push_back({parameters.materials.of(number.pin), number.pin});
      return parameters;
    }

    /// Parameter values of the bodies' terms.
    ParameterValues values_of_bodies(const Scene &scene, const Parameters &parameters)
    {
      ParameterValues result = body_values(*scene.model, parameters.materials);
      if (parameters.operation.rotating_disc)
        result[BodyParameter::angular_velocity] = {parameters.operation.angular_velocity()};
      return result;
    }

    /// Throws ParameterError if an uncertain parameter affects more than coefficients of terms.
    void check_coefficients(const Parameters &parameters, const SamplePlan &samples)
    {
      const std::string scene = text_without_coefficients(parameters);
      for (Eigen::Index j = 0; j < samples.values.cols(); ++j)
        {
          const UncertainNumber &number = samples.numbers[static_cast<std::size_t>(j)];
          if (number.pin.empty() && text_without_coefficients(with_design(parameters, {number.parameter},
                                                                          {exact_text(samples.values(0, j))}, number.where)) != scene)
            throw ParameterError(
              in_quotes(number.parameter) +
                " cannot vary between samples, because it is not a coefficient of a term, or its term is zero in the model",
              number.where,
              "vary moduli, densities, Rayleigh coefficients, mounts, friction coefficient, load, speed or slope with "
              "nonzero nominal values, or use Study = geometry for other parameters");
        }
    }
  } // namespace

  SamplePlan sample_plan(const RobustnessParameters                       &parameters,
                         const std::function<double(const std::string &)> &current,
                         const std::vector<std::string>                   &pins)
  {
    SamplePlan result;
    for (const UncertainParameter &uncertain : parameters.uncertain_parameters())
      {
        Distribution distribution = uncertain.distribution;
        const double value        = current(uncertain.name);
        if (uncertain.is_relative)
          {
            if (!(value > 0.))
              throw ParameterError(in_quotes(uncertain.name) + " is " + exact_text(value) +
                                     "; percentages require a positive nominal value",
                                   where_uncertain, "give absolute numbers, without %");
            for (double &x : distribution.numbers)
              x *= value / 100.;
          }
        if (!uncertain.for_each_pin)
          {
            result.numbers.push_back({uncertain.name, uncertain.name, "", distribution, uncertain.is_relative});
            continue;
          }
        if (numbers_of_pins.count(uncertain.name) == 0)
          throw ParameterError("`for each pin` is not available for " + in_quotes(uncertain.name), where_uncertain,
                               "use it only for Young modulus, Density, Rayleigh alpha and Rayleigh beta of Pin material");
        if (pins.empty())
          throw ParameterError("`for each pin` has no effect, because no pin uses the constants of Pin material", where_uncertain,
                               "remove " + in_quotes(uncertain.name) + ", or use Pin material for at least one pin");
        for (const std::string &pin : pins)
          result.numbers.push_back({uncertain.name + " of " + pin, uncertain.name, pin, distribution, uncertain.is_relative});
      }

    const auto  d            = static_cast<int>(result.numbers.size());
    DenseMatrix correlations = DenseMatrix::Identity(d, d);
    const auto  place        = [&](const std::string &name) {
      return std::find_if(result.numbers.begin(), result.numbers.end(), [&](const UncertainNumber &x) { return x.name == name; }) -
             result.numbers.begin();
    };
    const auto given = parameters.parsed_correlations();
    for (const Correlation &c : given)
      correlations(place(c.first), place(c.second)) = correlations(place(c.second), place(c.first)) = c.value;
    std::vector<Distribution> distributions;
    for (const UncertainNumber &number : result.numbers)
      distributions.push_back(number.distribution);

    result.has_indices = parameters.has_indices && given.empty();
    const int n = static_cast<int>(parameters.n_samples), half = (n + 1) / 2;
    result.values        = result.has_indices ? saltelli_samples(distributions, half, parameters.seed) :
                                                independent_samples(distributions, correlations, n, parameters.seed);
    result.n_independent = result.has_indices ? 2 * half : n;
    result.n_followed    = static_cast<int>(parameters.n_onsets);
    if (result.n_followed > result.n_independent)
      throw ParameterError(text("onsets are requested for ", counted(result.n_followed, "sample"), ", but there are only ",
                                counted(result.n_independent, "independent sample")),
                           "parameter Robustness/Samples with onsets", "lower it, or raise Robustness/Number of samples");
    return result;
  }

  SamplePlan listed_samples(const DesignPlan &plan, const std::function<double(const std::string &)> &current)
  {
    SamplePlan result;
    result.values        = DenseMatrix(plan.designs.size(), plan.names.size());
    result.n_independent = result.n();
    result.has_indices   = false;
    for (std::size_t j = 0; j < plan.names.size(); ++j)
      {
        const std::string &name = plan.names[j];
        result.numbers.push_back({name, name, "", {}});
        for (std::size_t i = 0; i < plan.designs.size(); ++i)
          {
            const std::string &given = plan.designs[i][j];
            const auto         value = given.empty() ? std::optional(current(name)) : parse_number(given);
            if (!value)
              throw ParameterError(in_quotes(given) + " for " + in_quotes(name) + " is not a finite number", plan.where_is(i),
                                   "give a number");
            result.values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = *value;
          }
      }
    return result;
  }

  double nominal_value(const Parameters &parameters, const std::string &name, const char *where)
  {
    const std::string value = current_value(parameters, name, where);
    if (const auto number = parse_number(value))
      return *number;
    throw ParameterError("the value of " + in_quotes(name) + " is " + in_quotes(value) + ", not a number", where,
                         "give a parameter with a number, or select the k-th number of a list with Section/Name[k]");
  }

  std::vector<std::string> alike_pins(const Scene &scene, const Parameters &parameters)
  {
    std::vector<std::string> result;
    for (const std::string &volume : scene.model->volume_names())
      if (!is_of_disc(volume) && !parameters.materials.has_own(volume))
        result.push_back(volume);
    return result;
  }

  double value_in(const SystemFile &file, const std::string &name, const Parameters &parameters)
  {
    std::map<std::string, double> given     = parameters.system.values;
    const FileParameter          *parameter = file.find(name);
    given.emplace(name, parameter != nullptr ? parameter->value : 0.);
    return file.values(given).at(name).front(); // throws for unknown parameters
  }

  Parameters with_sample(const Parameters &parameters, const SamplePlan &samples, const int sample)
  {
    Parameters result = parameters;
    for (std::size_t j = 0; j < samples.numbers.size(); ++j)
      if (const UncertainNumber &number = samples.numbers[j]; number.pin.empty())
        result = with_design(result, {number.parameter}, {exact_text(samples.values(sample, static_cast<Eigen::Index>(j)))}, number.where);
    result = with_single_pins(result, samples.numbers);
    for (std::size_t j = 0; j < samples.numbers.size(); ++j)
      for (VolumeMaterial &own : result.materials.volumes)
        if (own.volume == samples.numbers[j].pin)
          own.*numbers_of_pins.at(samples.numbers[j].parameter) = samples.values(sample, static_cast<Eigen::Index>(j));
    result.materials.check();
    result.operation.check();
    return result;
  }

  Parameters system_with_sample(const Parameters &parameters, const SamplePlan &samples, const int sample)
  {
    Parameters result  = parameters;
    result.system.file = std::filesystem::absolute(result.system.path()).string();
    for (std::size_t j = 0; j < samples.numbers.size(); ++j)
      result.system.values[samples.numbers[j].parameter] = samples.values(sample, static_cast<Eigen::Index>(j));
    return result;
  }

  SampledSystems sampled_scene(const Scene &scene, const BodyTerms &bodies, const SamplePlan &samples, Run &run)
  {
    const Parameters &parameters = run.parameters;
    check_coefficients(parameters, samples);

    run.progress.begin("Samples");
    SampledSystems                   result{sweep_plan(scene, std::vector<SweepLine>(), run), {}, {}, {}, {}};
    std::vector<ParameterValues>     members(samples.n());
    std::vector<OperationParameters> operations(samples.n());
    run_tasks(samples.n(), [&](const int s) {
      const Parameters sample = with_sample(parameters, samples, s);
      members[s]              = values_of_bodies(scene, sample);
      operations[s]           = sample.operation;
    });
    const bool bodies_vary = std::any_of(members.begin(), members.end(), [&](const auto &values) { return values != members.front(); });
    if (bodies_vary && (parameters.needs_steady_sliding() || !parameters.damping.modal_ratios.empty()))
      throw ParameterError("steady sliding and modal damping require fixed materials and mounts", where_uncertain,
                           "vary only friction coefficient, load, speed and slope; or set Steady sliding/Contact state = equal load and "
                           "leave Damping/Modal damping ratio empty");
    std::vector<ContactRegime> &regimes   = result.plan.regimes;
    const auto                  add_point = [&](OperationParameters operation, const double mu, const int s) {
      operation.friction_coefficient = mu;
      const StateOfContact state = state_of_contact(*scene.model, scene.interface, result.plan.sliding_state(operation), operation);
      regime_of(state.closed, regimes).points.push_back({mu, selected(state.damping, state.closed).values(), s});
    };
    for (int s = 0; s < samples.n(); ++s)
      add_point(operations[s], operations[s].friction_coefficient, s);
    for (const ContactRegime &regime : regimes)
      result.n_samples.push_back(regime.points.size());
    const std::vector<double> grid = parameters.sweep.friction_coefficients.linear();
    for (int s = 0; s < samples.n_followed; ++s)
      {
        result.plan.lines.push_back({SweepLine::Kind::main, operations[s], 0., grid});
        for (const double mu : grid)
          add_point(operations[s], mu, s);
      }
    result.n_samples.resize(regimes.size(), 0);
    run.progress.finish(text(counted(samples.n(), "sample"), " of ", counted(samples.numbers.size(), "uncertain number"), ", ",
                             counted(regimes.size(), "contact set")));

    for (ContactRegime &regime : regimes)
      {
        std::vector<ParameterValues> here;
        for (const OperatingPoint &point : regime.points)
          here.push_back(members[point.line]);
        const OperatingPoint &most        = most_damped(regime);
        OperationParameters   operation   = operations[most.line];
        operation.friction_coefficient    = most.friction_coefficient;
        const Linearisation linearisation = linearise(scene, result.plan.sliding_state(operation), operation);
        SystemFamily        family        = system_family(bodies, here, linearisation, band_margin, run);
        add_modal_damping(family.middle, parameters);
        for (std::size_t i = 0; i < here.size(); ++i)
          {
            const ParameterValues &values = family.terms.members[i];
            regime.points[i].values.insert(values.begin(), values.end());
            // Values are the same in every contact set, because the bodies do not vary if there are several contact sets
            if (const int s = regime.points[i].line; s < samples.n_followed)
              result.plan.lines[s].values = values;
          }
        result.middles.push_back(std::move(family.middle));
        result.scales.push_back(family.scales);
        if (!result.point)
          result.point = [&scene, &parameters, closed = regime.closed, family](const SamplePlan &further, const int s) {
            const Parameters     sample = with_sample(parameters, further, s);
            const StateOfContact state  = state_of_contact(*scene.model, scene.interface, {}, sample.operation);
            OperatingPoint       point{sample.operation.friction_coefficient, family.member(values_of_bodies(scene, sample)), s};
            point.values.merge(selected(state.damping, closed).values());
            return point;
          };
      }
    return result;
  }

  SampledSystems sampled_file(SystemFile file, const SamplePlan &samples, Run &run)
  {
    const auto        swept     = samples.n_followed > 0 ? std::optional(swept_parameter(file, run)) : std::nullopt;
    const std::string varied    = swept ? swept->name : file.default_varied();
    const auto        values_at = [&parameters = run.parameters, names = file](const SamplePlan &plan, const Eigen::RowVectorXd &numbers) {
      std::map<std::string, double> values = parameters.system.values;
      for (std::size_t j = 0; j < plan.numbers.size(); ++j)
        values[plan.numbers[j].parameter] = numbers[static_cast<Eigen::Index>(j)];
      return names.values(values);
    };
    SampledSystems result;
    result.plan.scene     = nullptr;
    result.plan.axis.name = varied;
    result.plan.values    = values_at(samples, samples.values.colwise().mean());
    ContactRegime all{1, {}, {}};
    result.point = [values_at, varied](const SamplePlan &plan, const int s) {
      const ParameterValues values = values_at(plan, plan.values.row(s));
      return OperatingPoint{values.at(varied).front(), values, s};
    };
    for (int s = 0; s < samples.n(); ++s)
      all.points.push_back(result.point(samples, s));
    result.n_samples = {all.points.size()};
    for (int s = 0; s < samples.n_followed; ++s)
      {
        result.plan.lines.push_back({SweepLine::Kind::main, {}, 0., swept->values.linear(), all.points[s].values});
        for (const double value : result.plan.lines.back().friction_coefficients)
          all.points.push_back(result.plan.point(s, value, {}));
      }
    result.plan.regimes.push_back(std::move(all));
    const CoupledSystem whole =
      imported_system(file, result.plan.values, varied, circular_frequency(run.parameters.discretization.maximum_frequency));
    result.plan.file = std::move(file);
    result.middles.push_back(starting_modes(whole, run));
    return result;
  }
} // namespace Squeal
