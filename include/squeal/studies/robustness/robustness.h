// SPDX-License-Identifier: GPL-3.0-or-later

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
    bool         is_relative = false;                                ///< its distribution is in percent of the nominal value
    const char  *where       = "parameter Robustness/Distributions"; ///< for messages
  };

  /// The samples of a study.
  struct SamplePlan
  {
    std::vector<UncertainNumber> numbers;
    DenseMatrix                  values;        ///< a row for each sample
    int                          n_independent; ///< of them, the first ones: probabilities follow from these
    bool                         has_indices;   ///< all of them are saltelli_samples()
    int n_followed = 0; ///< of the independent ones, the first: their modes are followed over the friction coefficient

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

  /// The value of a parameter of a system file as the parameters have it. Throws ParameterError if there is no such parameter.
  double value_in(const SystemFile &file, const std::string &name, const Parameters &parameters);

  /// The value of a parameter of a scene. Throws ParameterError unless it is a number.
  double nominal_value(const Parameters &parameters, const std::string &name, const char *where = "parameter Robustness/Distributions");

  /// Volumes of pins that have no material of their own.
  std::vector<std::string> alike_pins(const Scene &scene, const Parameters &parameters);

  /// The scene of a sample. Throws ParameterError where it makes no sense.
  Parameters with_sample(const Parameters &parameters, const SamplePlan &samples, int sample);

  /// The system file at the values of a sample.
  Parameters system_with_sample(const Parameters &parameters, const SamplePlan &samples, int sample);

  /// Samples as operating points of contact sets, each of which has a system: `line` of a point is the number of its sample.
  struct SampledSystems
  {
    SweepPlan                      plan;      ///< a line for each sample that is followed over the friction coefficient
    std::vector<FrictionlessModes> middles;   ///< of each contact set of the plan, in the middle of its samples
    std::vector<std::size_t>       n_samples; ///< of the points of each contact set, the first ones: the others are those of lines

    /// A further sample as a point of the first contact set, of the same numbers; its `line` is the number of the sample.
    std::function<OperatingPoint(const SamplePlan &, int sample)> point;
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

  /// Where the modes of a sample begin to grow over the friction coefficient.
  struct FollowedSample
  {
    std::vector<SquealOnset> onsets;       ///< once for each label and divergence rate in a contact set
    std::size_t              n_missed = 0; ///< friction coefficients that miss the tolerance

    /// The first onset of the modes of a label, or of all modes if it is empty, with this divergence rate; null: none.
    const SquealOnset *first(double divergence_rate, const std::string &label = "") const;
  };

  /// What is found of samples.
  struct SolvedSamples
  {
    std::vector<std::optional<Sample>> samples;  ///< nothing where the tolerance is missed
    std::vector<FollowedSample>        followed; ///< the first ones
  };

  /// Starts the model of a contact set of samples, whose errors are estimated for @p tolerance.
  std::unique_ptr<SweepModel> sample_model(const SampledSystems &systems, std::size_t contact_set, double tolerance, Run &run);

  /// Solves operating points of a system without a definite part, each at full order; those that cannot be solved are left.
  ErrorControlledSweep solve_directly(const SweepModel &model, const std::vector<OperatingPoint> &points, const KeepPoint &keep);

  /// Solves operating points to the tolerance by the basis of their contact set, or at full order without one, as a step of the run with this name: set by set, each
  /// larger than all before it, so that few points are evaluated by a basis that is still too small.
  ///
  /// @param n_training first points at which the basis is grown and compressed
  ErrorControlledSweep solve_points(SweepModel                        &model,
                                    const std::vector<OperatingPoint> &points,
                                    int                                n_training,
                                    double                             tolerance,
                                    const KeepPoint                   &keep,
                                    const std::string                 &name);

  /// Solves all samples by one reduced model for each contact set, as steps of the run.
  SolvedSamples solve_samples(const SampledSystems &systems, int n_samples, double tolerance, Run &run);

  /// Follows the modes of lines over the friction coefficient by the basis of the samples, which grows where a point misses
  /// Sweep/Tolerance, as a step of the run.
  ///
  /// @param n_samples first points of the contact set that are on no line
  void follow_samples(SweepModel &model, std::size_t n_samples, std::vector<FollowedSample> &followed);

  /// Writes the tables of onsets and says when modes begin to grow.
  void write_onsets(const std::vector<FollowedSample> &followed, const std::string &parameter, Run &run);

  /// A row for each sample, and one for each mode of the independent ones.
  Table sample_table(const SamplePlan &plan, const std::vector<std::optional<Sample>> &samples);
  Table cloud_table(const SamplePlan &plan, const std::vector<std::optional<Sample>> &samples);

  /// Writes the tables and says what they mean.
  void write_samples(const SamplePlan &plan, const std::vector<std::optional<Sample>> &samples, Run &run);

  /// The largest divergence rate of a sample whose verdict is unstable, and its mode; −1: none is.
  int leading_mode(const Sample &sample);
} // namespace Squeal
