#pragma once

#include <functional>
#include <string>
#include <vector>

namespace Squeal
{
  /// A change that makes a model cheaper.
  struct CheaperChange
  {
    std::string ingredient; ///< of several changes of one ingredient at most one is made
    double      severity;   ///< its effect by itself in units of the accuracy asked for; up to 1 it keeps it
  };

  /// Changes that keep the accuracy together.
  struct ChangesTogether
  {
    std::vector<int> changes;       ///< by their numbers, ascending; empty: the model as it is
    std::vector<int> put_back;      ///< of changes that keep it by themselves but not together, in the order of their removal
    int              n_solved = 0;  ///< combinations that were tried
    double           severity = 0.; ///< of all together
  };

  /**
   * Makes all changes that keep the accuracy by themselves, of one ingredient the first in the list, and tries them
   * together. While the accuracy is not kept the change with the largest effect by itself is replaced by the next one of its ingredient
   * with a smaller effect, or left out if there is none.
   *
   * @param severity_of of changes made together; not asked for none, and for one alone it is that of the change
   */
  ChangesTogether cheapest_changes(const std::vector<CheaperChange>                            &changes,
                                   const std::function<double(const std::vector<int> &chosen)> &severity_of);
} // namespace Squeal
