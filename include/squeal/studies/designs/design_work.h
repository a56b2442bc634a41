#pragma once

#include <squeal/parameters/design_plan.h>
#include <squeal/studies/designs/design_queue.h>
#include <squeal/studies/steps/reference_modes.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// Designs, with the numbers of those that a run is to solve.
  struct DesignWork
  {
    DesignPlan       plan;
    std::vector<int> designs; ///< from one on
  };

  /// Everything on which the results of a study depend; @p plan: designs that are known beforehand.
  std::string design_key(const Run &run, const Scene &scene, const DesignPlan &plan);

  /// The parameters of a design, of a sweep; nothing if it is refused, and then the @p reason.
  std::optional<Parameters> parameters_of(const Run &run, const DesignPlan &plan, int design, std::string &reason);

  /// The result of a design before it is solved.
  DesignResult unfinished(const Run &run, const DesignPlan &plan, int design);

  /// What an error says, in one line.
  std::string in_one_line(const Error &error);

  /// The modes by which designs are named: from a file in which another process has left them, or those of the scene.
  ReferenceModes design_reference(Scene &scene, Run &run, const std::filesystem::path &file);

  /**
   * Solves designs in processes of their own, but for those that the store knows already.
   *
   * @param arguments of the command line, from which another process reads the same plan
   *
   * All processes must call.
   */
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
} // namespace Squeal
