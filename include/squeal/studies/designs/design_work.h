// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/studies/designs/design_solution.h>
#include <squeal/studies/steps/parameter_usage.h>

#include <deal.II/base/utilities.h>

namespace Squeal
{
  /// Folder for the results of an unfinished study, next to the folder @p output of its final results.
  std::string checkpoint_folder(const std::string &output);

  /// Stored results of an unfinished study.
  class Checkpoint
  {
  public:
    /// Collective; the root process creates the @p folder if necessary. @p key contains everything that affects results. Throws FileError
    /// if the folder contains another study or other files.
    Checkpoint(const std::filesystem::path &folder, const std::string &key, MPI_Comm communicator);

    /// Opens the checkpoint in a worker process of the study.
    explicit Checkpoint(const std::filesystem::path &folder);

    /// Removes the folder if nothing has been stored; only on the root process, and not in worker processes.
    ~Checkpoint();

    Checkpoint(const Checkpoint &)            = delete;
    Checkpoint &operator=(const Checkpoint &) = delete;

    /// Stores a Boost-serialisable object; its file is complete or absent even if the run is killed.
    template <typename Object>
    void keep(const std::string &name, const Object &object) const
    {
      write(name, dealii::Utilities::pack(object, false));
    }

    /// A stored object; empty if no object has this name.
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

  /// The reference modes and the solved designs of an unfinished study of designs.
  class DesignStore : public Checkpoint
  {
  public:
    using Checkpoint::Checkpoint;

    /// Folder in which a worker process solves designs.
    std::filesystem::path folder_of(const std::vector<int> &designs) const;

    /// Stored result of a design; empty if it is not finished.
    std::optional<DesignResult> find(int design) const;

    /// Number of @p designs that are finished.
    std::size_t n_known(const std::vector<int> &designs) const;

    void keep(const DesignResult &result) const;

    /// File with the reference modes, in the folder of the study.
    static constexpr const char *reference_file = "reference.modes";
  };

  /**
   * Solves designs in separate, concurrent processes (base/worker_process.h). A failure is recorded in the result of its design and does
   * not affect other designs.
   *
   * @param batches    lists of designs, each for one process; finished designs of a family are solved again to rebuild its basis
   * @param unfinished initial result of a design, before it is solved
   * @param arguments  command-line arguments, passed to worker processes so that they read the same designs
   */
  void solve_side_by_side(const std::vector<std::vector<int>>             &batches,
                          unsigned int                                     n_side_by_side,
                          const DesignStore                               &store,
                          const std::function<DesignResult(int)>          &unfinished,
                          const std::function<void(const DesignResult &)> &report,
                          const std::vector<std::string>                  &arguments);

  /// All designs of a study, and the numbers of the designs that a run solves.
  struct DesignWork
  {
    DesignPlan       plan;
    std::vector<int> designs; ///< numbers of the designs, from 1
  };

  /// Text with everything that affects the results of a study: program version, parameters and @p model.
  std::string study_key(const Run &run, const std::string &model);

  /// Cell counts and checksum of the mesh, for study_key().
  std::string model_key(const Scene &scene);

  /// study_key() with the designs of the @p plan.
  std::string design_key(const Run &run, const Scene &scene, const DesignPlan &plan);

  /// Parameters of the sweep of a design; empty if it is rejected. @p reason receives the reason unless it is null.
  std::optional<Parameters> parameters_of(const Run &run, const DesignPlan &plan, int design, std::string *reason = nullptr);

  /// Initial result of a design, before it is solved.
  DesignResult unfinished(const Run &run, const DesignPlan &plan, int design);

  std::string in_one_line(const Error &error);

  /// Reference modes for the labels of designs, read from the file if it exists, otherwise computed from the given model.
  ReferenceModes design_reference(Scene &scene, Run &run, const std::filesystem::path &file);

  /// Solves the designs that are not in the store, in separate processes with the same command-line @p arguments. Collective.
  std::vector<DesignResult> solve_all(Scene                          &scene,
                                      Run                            &run,
                                      const DesignWork               &work,
                                      const DesignStore              &store,
                                      const std::vector<std::string> &arguments);

  /// Writes the tables of designs and prints the quietest designs.
  void write_designs(const std::vector<std::string> &names, const std::vector<DesignResult> &results, Run &run);

  /// Creates a study of designs with the common parameters and usage rules; @p own_rules take precedence.
  Study study_of_designs(const char *name, void (*run)(Scene &, Run &), std::vector<UsageRule> own_rules);

  /// Writes the parameter file @p name of a design.
  void write_parameter_file(Parameters design, const std::string &name, const Run &run);

  /// Variables of a plan that have no effect on any design, with reasons.
  std::vector<UnusedParameter> unused_variables(const Parameters &parameters, const DesignPlan &plan);

  /// Throws ParameterError if a variable is not a parameter or has no effect, or if a value is rejected both individually and in every
  /// design that contains it. In a file of designs, variables without effect are allowed unless two designs differ only in such variables.
  /// Other invalid combinations are reported in the rows of their designs.
  void check_designs(const Parameters &parameters, const DesignPlan &plan);

  /// Throws ParameterError if a variable of a search is not a parameter or has no effect, or if an end of its range cannot be set.
  void check_ranges(const Parameters &parameters, const std::vector<DesignVariable> &variables);
} // namespace Squeal
