// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/studies/steps/imported_modes.h>

namespace Squeal
{
  extern const Study stability_study, reduction_study, sweep_study, accuracy_study, ingredients_study, design_study, search_study,
    robustness_study, sensitivity_study, updating_study;

  const std::vector<const Study *> &studies()
  {
    static const std::vector<const Study *> all = {&stability_study,  &reduction_study,   &sweep_study,  &sensitivity_study,
                                                   &accuracy_study,   &ingredients_study, &design_study, &search_study,
                                                   &robustness_study, &updating_study};
    return all;
  }

  void run_study(Run &run)
  {
    if (run.parameters.system)
      {
        if (run.is_dry)
          read_system(run);
        else
          run.parameters.study->run_of_system(run);
        return;
      }
    Scene scene = mesh_scene(run);
    if (run.is_dry)
      run.progress.note("  dry run: nothing was computed or written");
    else
      run.parameters.study->run(scene, run);
  }
} // namespace Squeal
