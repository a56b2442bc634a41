// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/studies/designs/design_solution.h>
#include <squeal/studies/steps/parameter_usage.h>

namespace Squeal
{
  /// Folder next to the results @p output for an unfinished study; not touched by ResultFolder.
  std::string checkpoint_folder(const std::string &output);

  /// Stored state of an unfinished study of designs: its key, the reference modes, and the finished designs.
  class DesignStore
  {
  public:
    /// Collective; the root creates the @p folder if necessary. @p key contains everything that affects results. Throws FileError if the
    /// folder contains another study, or anything else.
    DesignStore(const std::filesystem::path &folder, const std::string &key, MPI_Comm communicator);

    /// Opens the store in a worker process of the study.
    explicit DesignStore(const std::filesystem::path &folder);

    /// Folder in which a worker process solves designs.
    std::filesystem::path folder_of(const std::vector<int> &designs) const;

    /// Stored result of a design; nothing if it is not finished.
    std::optional<DesignResult> find(int design) const;

    /// Number of finished designs among some.
    std::size_t n_known(const std::vector<int> &designs) const;

    /// Stores the result of a design.
    void keep(const DesignResult &result) const;

    const std::filesystem::path folder;

    /// File with the reference modes, in the folder of the study.
    static constexpr const char *reference_file = "reference.modes";

  private:
    /// File with the result of a design.
    std::filesystem::path file_of(int design) const;
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
