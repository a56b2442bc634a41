#include <squeal/parameters/study.h>

namespace Squeal
{
  extern const Study stability_study, dissipation_study, reduction_study, sweep_study;

  const std::vector<const Study *> &studies()
  {
    static const std::vector<const Study *> all = {&stability_study, &dissipation_study, &reduction_study, &sweep_study};
    return all;
  }
} // namespace Squeal
