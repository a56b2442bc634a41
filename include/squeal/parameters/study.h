#pragma once

#include <vector>

namespace Squeal
{
  struct Parameters;
  struct ProblemSize;
  class Run;
  struct Scene;

  /// Why a run does not use something, for a message; null if it does.
  using Reason = const char *;

  inline Reason unless(const bool is_used, const Reason reason)
  {
    return is_used ? nullptr : reason;
  }

  /// When a parameter, or all of a section, is of no use.
  struct UsageRule
  {
    const char *path; ///< "Section/Name", or "Section/" for all of it
    Reason (*why_unused)(const Parameters &);
  };

  /**
   * A question that a run may answer, with all that the program has to know of it. Each stands in the file that
   * answers it.
   */
  struct Study
  {
    const char *name;            ///< in `set Study = ...`
    void (*run)(Scene &, Run &); ///< the scene is meshed

    /// Paths of parameters and sections that only this study uses, and others that list them, too.
    std::vector<const char *> own_parameters = {};

    /// When it leaves parameters unused, its own or others'. For those that it names the general rules do not hold.
    std::vector<UsageRule> rules = {};

    /// Why no mode shape is written; null if some are.
    Reason (*no_mode_shapes)(const Parameters &) = nullptr;

    /// Whether it solves for modes with friction; null: always.
    bool (*has_friction)(const Parameters &) = nullptr;

    /// Memory that it takes beside what modes of the scene do [byte]; null: little.
    double (*further_memory)(const Parameters &, const ProblemSize &, double n_modes) = nullptr;

    /// Throws ParameterError where parameters do not fit the study; null: nothing to check.
    void (*check)(const Parameters &) = nullptr;
  };

  /// All studies, the default first. Parameter files name them; they are listed where they are made, in studies/.
  const std::vector<const Study *> &studies();
} // namespace Squeal
