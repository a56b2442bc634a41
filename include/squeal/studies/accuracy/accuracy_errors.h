#pragma once

#include <squeal/studies/accuracy/accuracy_reference.h>

#include <vector>

namespace Squeal
{
  /// An error by its kinds.
  struct ErrorKinds
  {
    double total          = 0.; ///< against the extrapolated value
    double discretisation = 0.; ///< of full order on this mesh, against the same
    double reduction      = 0.; ///< of the basis, against full order on this mesh
    double algebraic      = 0.; ///< what the solver leaves, estimated from residuals
  };

  /// A mode of the reference beside its counterpart by one mesh and method.
  struct ModeErrors
  {
    const ConvergedMode *reference;
    int                  number;           ///< of the mode on the mesh; -1 where it has no counterpart
    double               overlap;          ///< of both shapes [-]
    bool                 in_cluster;       ///< the mesh decides which mode of a cluster is its counterpart
    double               frequency;        ///< [Hz]
    double               divergence;       ///< [-]
    ErrorKinds           frequency_error;  ///< relative [-]
    ErrorKinds           divergence_error; ///< difference of divergence rates [-]
  };

  /// All modes of the band by one mesh and method, with their errors.
  struct ComparedMethod
  {
    const SolvedMesh       *mesh;
    const ModesByMethod    *method;
    std::vector<ModeErrors> modes;
    ErrorKinds              largest_frequency;  ///< [-]
    double                  rms_frequency;      ///< of the total errors [-]
    ErrorKinds              largest_divergence; ///< of modes outside of clusters [-]
    int                     n_in_cluster, n_lost;
    bool                    on_front = false; ///< none is faster and has a smaller largest frequency error
  };

  /// All meshes and methods against the modes of the reference up to a frequency [Hz].
  std::vector<ComparedMethod> compare(const std::vector<SolvedMesh> &meshes, const ConvergedFamily &reference, double maximum_frequency);
} // namespace Squeal
