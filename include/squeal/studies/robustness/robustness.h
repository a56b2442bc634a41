#pragma once

#include <squeal/parameters/design_plan.h>
#include <squeal/studies/robustness/uncertainty.h>
#include <squeal/studies/sweep/sweep_charts.h>

namespace Squeal
{
  /// A number that differs from sample to sample.
  struct UncertainNumber
  {
    std::string  name; ///< for tables: "Pin material/Density", with the pin where each has its own
    std::string  parameter;
    std::string  pin; ///< the volume whose number it is; empty: all that the parameter sets
    Distribution distribution;
  };

  /// The samples of a study.
  struct SamplePlan
  {
    std::vector<UncertainNumber> numbers;
    DenseMatrix                  values;        ///< a row for each sample
    int                          n_independent; ///< of them, the first ones: probabilities follow from these
    bool                         has_indices;   ///< all of them are saltelli_samples()

    int n() const
    {
      return static_cast<int>(values.rows());
    }
  };

  /// @param current value that a parameter has, by its name
  /// @param pins    volumes of pins, each of which may have its own numbers
  SamplePlan sample_plan(const RobustnessParameters                       &parameters,
                         const std::function<double(const std::string &)> &current,
                         const std::vector<std::string>                   &pins);

  /// Designs as samples: lists of values of the parameters of a system file, which has values of its own where a design has none.
  SamplePlan listed_samples(const DesignPlan &plan, const std::function<double(const std::string &)> &current);

  /// The value of a parameter of a system file as the run has it. Throws ParameterError if there is no such parameter.
  double value_in(const SystemFile &file, const std::string &name, const Run &run);

  /// The scene of a sample. Throws ParameterError where it makes no sense.
  Parameters with_sample(const Parameters &parameters, const SamplePlan &samples, int sample);

  /// Samples as operating points of contact sets, each of which has a system: `line` of a point is the number of its sample.
  struct SampledSystems
  {
    SweepPlan                      plan;    ///< without lines
    std::vector<FrictionlessModes> middles; ///< of each contact set of the plan, in the middle of its samples
  };

  /// The systems of the samples of an assembled scene, as steps of the run. Throws ParameterError where a parameter is no coefficient of a
  /// term.
  SampledSystems sampled_scene(const Scene &scene, const BodyTerms &bodies, const SamplePlan &samples, Run &run);

  /// The same of a system file.
  SampledSystems sampled_file(SystemFile file, const SamplePlan &samples, Run &run);

  /// A mode of the band at a sample.
  struct SampledMode
  {
    std::complex<double> lambda;
    double               error; ///< estimated |δλ| / |λ| [-]
    Verdict              verdict;
    std::string          label;
    bool                 is_alone; ///< no other mode of the sample has the label
  };

  /// The modes of a sample, in the order of their frequencies.
  using Sample = std::vector<SampledMode>;

  /// Solves all samples by one reduced model for each contact set, as steps of the run; nothing where the tolerance is missed.
  std::vector<std::optional<Sample>> solve_samples(const SampledSystems &systems, int n_samples, double tolerance, Run &run);

  /// A row for each sample, and one for each mode of the independent ones.
  Table sample_table(const SamplePlan &plan, const std::vector<std::optional<Sample>> &samples);
  Table cloud_table(const SamplePlan &plan, const std::vector<std::optional<Sample>> &samples);

  /// Writes the tables and says what they mean.
  void write_samples(const SamplePlan &plan, const std::vector<std::optional<Sample>> &samples, Run &run);

  /// The largest divergence rate of a sample whose verdict is unstable, and its mode; −1: none is.
  int leading_mode(const Sample &sample);
} // namespace Squeal
