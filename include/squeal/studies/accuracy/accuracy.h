// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/common_points.h>
#include <squeal/estimates/discretisation_error.h>
#include <squeal/studies/steps/friction_modes.h>

namespace Squeal
{
  /// A mesh and element by which a study of accuracy solves its scene.
  struct MeshAndElement
  {
    Element  element;
    Outlines outlines; ///< of no matter to quadratic elements
    double   factor;   ///< times as fine as the mesh of the scene [-]

    /// "incompatible modes, true area, x 1.5".
    std::string text() const;

    /// The same without the factor: what meshes of one family have in common.
    std::string family() const;
  };

  /// Eigenvalues by one method: those of the modes of full order, each by its counterpart.
  struct ModesByMethod
  {
    std::string                       method; ///< "full order", or the name of a basis
    int                               size;   ///< unknowns of the eigenproblem
    Cost                              cost;   ///< of all from the mesh to the modes; memory of all processes together
    std::vector<std::complex<double>> lambda; ///< [rad/s]

    /// Estimated |δλ| / |λ| of what the solver leaves: ½ √ε_res, with eq. (16) of the paper, to first order where modes are far apart [-].
    std::vector<double> algebraic_errors;
  };

  /// A scene solved on one mesh.
  struct SolvedMesh
  {
    MeshAndElement             mesh;
    int                        n_dofs, n_contact_nodes;
    ModesAtPoints              modes; ///< of full order, in the band and its margin
    std::vector<ModeLabel>     labels;
    std::size_t                n_unstable;
    std::vector<ModesByMethod> methods; ///< full order first
  };

  /// A mesh and element without a solution.
  struct LeftOut
  {
    MeshAndElement mesh;
    std::string    reason;
  };

  /// What came of all meshes and elements.
  struct SolvedMeshes
  {
    std::vector<SolvedMesh> meshes;   ///< the coarsest first
    std::vector<LeftOut>    left_out; ///< that do not come about or have more dofs than the parameters allow
  };

  /// Solves scenes on the meshes and with the elements that the parameters ask for, at full order and with the bases that they name, each
  /// as a step of the run. Modes are kept at the points of the first mesh.
  SolvedMeshes solve_meshes(Run &run);

  /// What a quantity of a mode tends to.
  struct Limit
  {
    std::optional<Extrapolation> sequence; ///< nothing where one mesh alone has the mode
    double                       value = 0., uncertainty = 0.;
  };

  /// A mode on all meshes of a family, and what it tends to.
  struct ConvergedMode
  {
    ModeLabel        label;      ///< on the finest mesh
    bool             in_cluster; ///< on some pair of meshes, see pair_modes()
    std::vector<int> numbers;    ///< of the mode on every mesh; -1 where it has no counterpart
    Limit            frequency;  ///< [Hz]
    Limit            divergence; ///< [-]
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
   * Extrapolates the modes of every family of two meshes or more in the mesh width, frequencies and divergence rates each by themselves,
   * paired by shape with those of the finest mesh. The mean of ω² or anything else is not taken: a family converges as it does. Where no
   * order of convergence is observed the limit is that with twice the degree of the element as order if there are two meshes, and the value
   * of the finest mesh if there are more. In clusters, whose members the mesh decides, it is that of the finest mesh, too.
   */
  std::vector<ConvergedFamily> converged_families(const std::vector<SolvedMesh> &meshes, double maximum_frequency);

  /// The family with the least error; throws SolverError if there is none.
  const ConvergedFamily &best_family(const std::vector<ConvergedFamily> &families);

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
