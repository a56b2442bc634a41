#pragma once

#include <squeal/parameters/parameters.h>

#include <string>
#include <vector>

namespace Squeal
{
  /**
   * Parameters, as "Section/Name", in which a run differs from the scene of the paper's Table 1: shape of disc and pins,
   * materials, mounts and contact as by default. The mesh and the operation may differ.
   */
  std::vector<std::string> differences_from_paper_scene(const Parameters &parameters);

  /// The same for what its complex modes hang on: friction, load and speed, and that nothing but the contact damps them.
  std::vector<std::string> differences_from_paper_operation(const Parameters &parameters);

  inline bool is_paper_scene(const Parameters &parameters)
  {
    return differences_from_paper_scene(parameters).empty();
  }

  inline bool is_paper_operation(const Parameters &parameters)
  {
    return differences_from_paper_operation(parameters).empty();
  }
} // namespace Squeal
