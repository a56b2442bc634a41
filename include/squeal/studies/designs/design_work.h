// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/studies/designs/design_solution.h>
#include <squeal/studies/steps/parameter_usage.h>

namespace Squeal
{
  /// Folder next to the results @p output that holds an unfinished study; a ResultFolder does not touch it.
  std::string checkpoint_folder(const std::string &output);

  /// Where an unfinished study of designs is kept: what identifies it, the reference modes, and the designs that are finished.
  class DesignStore
  {
  public:
    /// All processes must call; that of the root makes the @p folder if it does not exist. @p key names everything on which results depend.
    /// Throws FileError if another study lies there, or something else.
    DesignStore(const std::filesystem::path &folder, const std::string &key, MPI_Comm communicator);

    /// For a process that solves designs of the study that is kept there.
    explicit DesignStore(const std::filesystem::path &folder);

    /// Folder in which a process of its own solves designs.
    std::filesystem::path folder_of(const std::vector<int> &designs) const;

    /// What has been found of a design; nothing if it is not finished.
    std::optional<DesignResult> find(int design) const;

    /// How many of some designs are finished.
    std::size_t n_known(const std::vector<int> &designs) const;

    /// Keeps what became of a design.
    void keep(const DesignResult &result) const;

    const std::filesystem::path folder;

    /// File with the modes by which designs are named, in the folder of the study.
    static constexpr const char *reference_file = "reference.modes";

  private:
    /// With the result of a design.
    std::filesystem::path file_of(int design) const;
  };

  /**
   * Solves designs in processes of their own (base/worker_process.h), several side by side. Whatever happens to one, its result says so and
   * the others go on.
   *
   * @param batches    numbers of designs that one process solves in turn; finished designs of a family are solved again to rebuild its basis
   * @param unfinished result of a design without what is to be found
   * @param arguments  of the command line, from which a process reads the designs
   */
  void solve_side_by_side(const std::vector<std::vector<int>>             &batches,
                          unsigned int                                     n_side_by_side,
                          const DesignStore                               &store,
                          const std::function<DesignResult(int)>          &unfinished,
                          const std::function<void(const DesignResult &)> &report,
                          const std::vector<std::string>                  &arguments);

  /// Designs, with the numbers of those that a run is to solve.
  struct DesignWork
  {
    DesignPlan       plan;
    std::vector<int> designs; ///< from one on
  };

  /// Everything on which the results of a study depend; @p plan: designs that are known beforehand.
  std::string design_key(const Run &run, const Scene &scene, const DesignPlan &plan);

  /// The parameters of a design, of a sweep; nothing if it is refused, and then the @p reason if it is wanted.
  std::optional<Parameters> parameters_of(const Run &run, const DesignPlan &plan, int design, std::string *reason = nullptr);

  /// The result of a design before it is solved.
  DesignResult unfinished(const Run &run, const DesignPlan &plan, int design);

  /// What an error says, in one line.
  std::string in_one_line(const Error &error);

  /// The modes by which designs are named: from a file in which another process has left them, or those of the scene.
  ReferenceModes design_reference(Scene &scene, Run &run, const std::filesystem::path &file);

  /// Solves designs in processes of their own, but for those that the store knows already. @p arguments are those of the command line from
  /// which another process reads the same plan. All processes must call.
  std::vector<DesignResult> solve_all(Scene                          &scene,
                                      Run                            &run,
                                      const DesignWork               &work,
                                      const DesignStore              &store,
                                      const std::vector<std::string> &arguments);

  /// Writes the tables of designs, and says which is the quietest.
  void write_designs(const std::vector<std::string> &names, const std::vector<DesignResult> &results, Run &run);

  /// What studies of designs have in common; parameters that they use differently have rules of their own in front.
  Study study_of_designs(const char *name, void (*run)(Scene &, Run &), std::vector<UsageRule> own_rules);

  /// Writes the parameter file NAME of a design, a sweep of which that is.
  void write_parameter_file(Parameters design, const std::string &name, const Run &run);

  /// Variables of a plan that change nothing in what its designs are, with the reason. Throws ParameterError as with_design() does.
  std::vector<UnusedParameter> unused_variables(const Parameters &parameters, const DesignPlan &plan);

  /// Throws ParameterError if a variable is no parameter; if it changes nothing, so that designs are equal that are written differently; if
  /// a value is refused both with all others as they are and in every design that has it. Values that only together make no sense are told
  /// in the rows of their designs.
  void check_designs(const Parameters &parameters, const DesignPlan &plan);

  /// The same for a search in ranges, of which only the ends are checked, and only by their own bounds.
  void check_ranges(const Parameters &parameters, const std::vector<DesignVariable> &variables);
} // namespace Squeal
