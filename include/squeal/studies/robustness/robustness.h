// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/studies/designs/design_work.h>
#include <squeal/studies/robustness/uncertainty.h>
#include <squeal/studies/steps/system_family.h>
#include <squeal/studies/sweep/sweep_charts.h>

namespace Squeal
{
  /// An uncertain number.
  struct UncertainNumber
  {
    std::string  name; ///< name for tables: "Pin material/Density", with the pin if each pin has its own value
    std::string  parameter;
    std::string  pin; ///< volume with this value; empty: all volumes of the parameter
    Distribution distribution;
    bool         is_relative = false;                                ///< the distribution is in per cent of the nominal value
    const char  *where       = "parameter Robustness/Distributions"; ///< location in error messages
  };

  /// The samples of a study.
  struct SamplePlan
  {
    std::vector<UncertainNumber> numbers;
    DenseMatrix                  values;         ///< one row for each sample
    int                          n_independent;  ///< number of leading samples that are independent, for probabilities
    bool                         has_indices;    ///< the samples come from saltelli_samples(), for Sobol' indices
    int                          n_followed = 0; ///< number of leading independent samples that are followed over the sweep

    int n() const
    {
      return static_cast<int>(values.rows());
    }
  };

  /// Draws samples of the uncertain parameters. Throws ParameterError for invalid distributions.
  ///
  /// @param current nominal value of a parameter, by its name
  /// @param pins    volumes of pins, which may have individual values
  SamplePlan sample_plan(const RobustnessParameters                       &parameters,
                         const std::function<double(const std::string &)> &current,
                         const std::vector<std::string>                   &pins);

  /// Designs used as samples of the parameters of a system file, with @p current values where a design has none.
  SamplePlan listed_samples(const DesignPlan &plan, const std::function<double(const std::string &)> &current);

  /// Nominal value of a parameter of a system file. Throws ParameterError if there is no such parameter.
  double value_in(const SystemFile &file, const std::string &name, const Parameters &parameters);

  /// Nominal value of a parameter of a meshed model. Throws ParameterError unless it is a number.
  double nominal_value(const Parameters &parameters, const std::string &name, const char *where = "parameter Robustness/Distributions");

  /// Volumes of pins that use the common pin material.
  std::vector<std::string> alike_pins(const Scene &scene, const Parameters &parameters);

  /// Parameters of a sample. Throws ParameterError if they are invalid.
  Parameters with_sample(const Parameters &parameters, const SamplePlan &samples, int sample);

  /// Parameters of a system file at the values of a sample.
  Parameters system_with_sample(const Parameters &parameters, const SamplePlan &samples, int sample);

  /// Samples as operating points of contact sets; each contact set has one system. `line` of a point is the index of its sample.
  struct SampledSystems
  {
    SweepPlan                      plan;      ///< one line for each sample that is followed over the sweep
    std::vector<FrictionlessModes> middles;   ///< modes at the mean sample of each contact set in the plan
    std::vector<std::size_t>       n_samples; ///< number of leading points of each contact set that are samples; others belong to lines
    std::vector<FamilyScales>      scales;    ///< scales of each contact set; empty for a system file

    /// Converts an additional sample to a point of the first contact set; `line` of the point is the index of the sample.
    std::function<OperatingPoint(const SamplePlan &, int sample)> point;
  };

  /// Systems of the samples of an assembled model, as steps of the run. Throws ParameterError if a parameter is not a coefficient of a
  /// term.
  SampledSystems sampled_scene(const Scene &scene, const BodyTerms &bodies, const SamplePlan &samples, Run &run);

  /// Systems of the samples of a system file.
  SampledSystems sampled_file(SystemFile file, const SamplePlan &samples, Run &run);

  /// A mode in the band of a sample.
  struct SampledMode
  {
    std::complex<double> lambda;
    double               error; ///< estimated |δλ| / |λ| [-]
    Verdict              verdict;
    std::string          label;
    bool                 is_alone; ///< no other mode of the sample has this label

    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &lambda &error &verdict &label &is_alone;
    }
  };

  /// Modes of a sample in ascending order of frequency.
  using Sample = std::vector<SampledMode>;

  /// Largest estimated error of λ of the modes [-].
  double largest_error(const Sample &sample);

  /// Onsets of the modes of a sample.
  struct FollowedSample
  {
    std::vector<SquealOnset> onsets;       ///< one onset for each label and divergence rate in each contact set
    std::size_t              n_missed = 0; ///< number of friction coefficients without results within the tolerance

    /// First onset of modes with this label, or of any mode if the label is empty, at this divergence rate; null: none.
    const SquealOnset *first(double divergence_rate, const std::string &label = "") const;
  };

  /// Results of the samples.
  struct SolvedSamples
  {
    std::vector<std::optional<Sample>> samples;  ///< empty for samples without results within the tolerance
    std::vector<FollowedSample>        followed; ///< onsets of the first samples
  };

  /// Creates the model of a contact set of samples.
  std::unique_ptr<SweepModel> sample_model(const SampledSystems &systems, std::size_t contact_set, Run &run);

  /// Solves operating points of a system without a definite part, each at full order; failed points are omitted.
  ErrorControlledSweep solve_directly(const SweepModel &model, const std::vector<OperatingPoint> &points, const KeepPoint &keep);

  /// Solves operating points within the tolerance, with the basis of their contact set or, without a basis, at full order. A step of the run
  /// with this name. Batches grow in size, so that few points are evaluated with a basis that is still too small.
  ///
  /// @param n_training number of leading points at which the basis is extended and compressed
  ErrorControlledSweep solve_points(SweepModel                        &model,
                                    const std::vector<OperatingPoint> &points,
                                    int                                n_training,
                                    double                             tolerance,
                                    const KeepPoint                   &keep,
                                    const std::string                 &name);

  /// Function that receives the model of a contact set after the samples of this set are solved, and all samples solved so far.
  using KeepModel = std::function<void(std::size_t contact_set, const SweepModel &, const std::vector<std::optional<Sample>> &)>;

  /// Solves all samples, with one reduced model for each contact set or, without a definite part, at full order. Steps of the run. If @p
  /// checkpoint is not null, it supplies the samples that an interrupted run has stored, and stores the new ones.
  SolvedSamples solve_samples(const SampledSystems &systems,
                              int                   n_samples,
                              double                tolerance,
                              Run                  &run,
                              const Checkpoint     *checkpoint = nullptr,
                              const KeepModel      &keep       = nullptr);

  /// Throws ParameterError if the reduced models of the samples cannot be written as system files.
  void check_reduced_system(const SampledSystems &systems);

  /// `Output/Write system = reduced`: writes the reduced model of a contact set, valid in the box that its samples cover.
  void write_reduced_system(const SampledSystems                     &systems,
                            std::size_t                               contact_set,
                            const SamplePlan                         &plan,
                            const std::vector<std::optional<Sample>> &samples,
                            const SweepModel                         &model);

  /// Follows the modes of lines over the friction coefficient with the basis of the samples, which is extended if a point misses
  /// Sweep/Tolerance, or at full order without a basis. A step of the run.
  ///
  /// @param n_samples number of leading points of the contact set that do not belong to a line
  void follow_samples(SweepModel &model, std::size_t n_samples, std::vector<FollowedSample> &followed);

  /// Writes the tables of onsets and prints their distributions.
  void write_onsets(const std::vector<FollowedSample> &followed, const std::string &parameter, Run &run);

  /// Columns with the number of a sample and its uncertain numbers; rows are indices of samples. @p plan must outlive them.
  Columns<int> sample_columns(const SamplePlan &plan);

  /// One row for each sample.
  Table sample_table(const SamplePlan &plan, const std::vector<std::optional<Sample>> &samples);
  /// One row for each mode of the independent samples.
  Table cloud_table(const SamplePlan &plan, const std::vector<std::optional<Sample>> &samples);

  /// Writes the tables of the samples and prints a summary.
  void write_samples(const SamplePlan &plan, const std::vector<std::optional<Sample>> &samples, Run &run);

  /// Mode with the largest divergence rate among the unstable modes of a sample; −1: none.
  int leading_mode(const Sample &sample);
} // namespace Squeal
