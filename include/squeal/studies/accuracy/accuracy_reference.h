#pragma once

#include <squeal/estimates/extrapolation.h>
#include <squeal/studies/accuracy/accuracy_solutions.h>

#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// A mode on all meshes of a family, and what it tends to.
  struct ConvergedMode
  {
    ModeLabel                    label;                    ///< on the finest mesh
    bool                         in_cluster;               ///< on some pair of meshes, see pair_modes()
    std::vector<int>             numbers;                  ///< of the mode on every mesh; -1 where it has no counterpart
    double                       frequency, divergence;    ///< of the limit [Hz], [-]
    double                       frequency_uncertainty;    ///< estimated [Hz]
    double                       divergence_uncertainty;   ///< estimated [-]
    std::optional<Extrapolation> frequencies, divergences; ///< nothing where one mesh alone has the mode
  };

  /// Modes of one element and outline on finer and finer meshes.
  struct ConvergedFamily
  {
    std::string                     name;
    std::vector<const SolvedMesh *> members; ///< the finest last
    std::vector<ConvergedMode>      modes;   ///< of the finest mesh, in its order
    double                          error;   ///< of the frequencies on the finest mesh, with their uncertainty, root mean square [-]
  };

  /**
   * Extrapolates the modes of every family of two meshes or more in the mesh width, frequencies and divergence rates each by
   * themselves, paired by shape with those of the finest mesh. The mean of ω² or anything else is not taken: a family converges as it does.
   * Where no order of convergence is observed the limit is that with twice the degree of the element as order if there are two
   * meshes, and the value of the finest mesh if there are more. In clusters, whose members the mesh decides, it is that of the finest mesh, too.
   */
  std::vector<ConvergedFamily> converged_families(const std::vector<SolvedMesh> &meshes, double maximum_frequency);

  /// The family with the least error; throws SolverError if there is none.
  const ConvergedFamily &best_family(const std::vector<ConvergedFamily> &families);
} // namespace Squeal
