// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/studies/designs/design_solution.h>
#include <squeal/studies/steps/parameter_usage.h>

#include <deal.II/base/utilities.h>

namespace Squeal
{
  /// Folder next to the results @p output for an unfinished study; not touched by ResultFolder.
  std::string checkpoint_folder(const std::string &output);

  /// Stored results of an unfinished study.
  class Checkpoint
  {
  public:
    /// Collective; the root creates the @p folder if necessary. @p key contains everything that affects results. Throws FileError if the
    /// folder contains another study, or anything else.
    Checkpoint(const std::filesystem::path &folder, const std::string &key, MPI_Comm communicator);

    /// Opens the checkpoint in a worker process of the study.
    explicit Checkpoint(const std::filesystem::path &folder);

    /// The process that created it removes the folder if nothing has been stored.
    ~Checkpoint();

    Checkpoint(const Checkpoint &)            = delete;
    Checkpoint &operator=(const Checkpoint &) = delete;

    /// Stores an object that Boost serialises; a killed run leaves a complete file or none.
    template <typename Object>
    void keep(const std::string &name, const Object &object) const
    {
      write(name, dealii::Utilities::pack(object, false));
    }

    /// A stored object; nothing if there is none with this name.
    template <typename Object>
    std::optional<Object> find(const std::string &name) const
    {
      const std::vector<char> packed = read(name);
      return packed.empty() ? std::nullopt : std::optional(dealii::Utilities::unpack<Object>(packed, false));
    }

    const std::filesystem::path folder;

  private:
    void              write(const std::string &name, const std::vector<char> &packed) const;
    std::vector<char> read(const std::string &name) const;

    bool is_creator = false;
  };

  /// The reference modes and the finished designs of an unfinished study of designs.
  class DesignStore : public Checkpoint
  {
  public:
    using Checkpoint::Checkpoint;

    /// Folder in which a worker process solves designs.
    std::filesystem::path folder_of(const std::vector<int> &designs) const;

    /// Stored result of a design; nothing if it is not finished.
    std::optional<DesignResult> find(int design) const;

    /// Number of finished designs among some.
    std::size_t n_known(const std::vector<int> &designs) const;

    /// Stores the result of a design.
    void keep(const DesignResult &result) const;

    /// File with the reference modes, in the folder of the study.
    static constexpr const char *reference_file = "reference.modes";
  };

  /**
   * Solves designs in separate, concurrent processes (base/worker_process.h). A failure is recorded in the result of the design and does
   * not affect the others.
   *
   * @param batches    designs that one process solves in turn; finished designs of a family are solved again to rebuild its basis
   * @param unfinished initial result of a design
   * @param arguments  of the command line, from which worker processes read the designs
   */
  void solve_side_by_side(const std::vector<std::vector<int>>             &batches,
                          unsigned int                                     n_side_by_side,
                          const DesignStore                               &store,
                          const std::function<DesignResult(int)>          &unfinished,
                          const std::function<void(const DesignResult &)> &report,
                          const std::vector<std::string>                  &arguments);

  /// Designs, and the numbers of those to be solved by a run.
  struct DesignWork
  {
    DesignPlan       plan;
    std::vector<int> designs; ///< counted from one
  };

  /// Everything that affects the results of a study of a @p model: version, parameters and model.
  std::string study_key(const Run &run, const std::string &model);

  /// The mesh of a model, for study_key().
  std::string model_key(const Scene &scene);

  /// Key of everything that affects the results of a study; @p plan: designs known beforehand.
  std::string design_key(const Run &run, const Scene &scene, const DesignPlan &plan);

  /// Parameters of the sweep of a design; nothing if it is rejected, with an optional @p reason.
  std::optional<Parameters> parameters_of(const Run &run, const DesignPlan &plan, int design, std::string *reason = nullptr);

  /// Initial result of a design, before it is solved.
  DesignResult unfinished(const Run &run, const DesignPlan &plan, int design);

  /// Message of an error, in one line.
  std::string in_one_line(const Error &error);

  /// Reference modes for the labels of designs: from a file written by another process, or computed from the given model.
  ReferenceModes design_reference(Scene &scene, Run &run, const std::filesystem::path &file);

  /// Solves all designs that are not in the store, in separate processes. @p arguments of the command line let worker processes read the
  /// same plan. Collective.
  std::vector<DesignResult> solve_all(Scene                          &scene,
                                      Run                            &run,
                                      const DesignWork               &work,
                                      const DesignStore              &store,
                                      const std::vector<std::string> &arguments);

  /// Writes the tables of designs and reports the quietest one.
  void write_designs(const std::vector<std::string> &names, const std::vector<DesignResult> &results, Run &run);

  /// Creates a study of designs with the common parameters and usage rules; @p own_rules take precedence.
  Study study_of_designs(const char *name, void (*run)(Scene &, Run &), std::vector<UsageRule> own_rules);

  /// Writes the parameter file NAME of a design, as a sweep.
  void write_parameter_file(Parameters design, const std::string &name, const Run &run);

  /// Variables of a plan without effect on the designs, with the reason. Throws ParameterError as with_design() does.
  std::vector<UnusedParameter> unused_variables(const Parameters &parameters, const DesignPlan &plan);

  /// Throws ParameterError if a variable is not a parameter; if it has no effect, so that formally different designs are equal; or if a
  /// value is rejected both with all others unchanged and in every design that contains it. Invalid combinations are reported in the rows
  /// of their designs.
  void check_designs(const Parameters &parameters, const DesignPlan &plan);

  /// check_designs() for a search in ranges: only the ends are checked, individually.
  void check_ranges(const Parameters &parameters, const std::vector<DesignVariable> &variables);
} // namespace Squeal
