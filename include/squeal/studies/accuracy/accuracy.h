// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/estimates/common_points.h>
#include <squeal/estimates/discretisation_error.h>
#include <squeal/studies/steps/friction_modes.h>

namespace Squeal
{
  /// A mesh and element of an accuracy study.
  struct MeshAndElement
  {
    Element  element;
    Outlines outlines; ///< not used for quadratic elements
    double   factor;   ///< refinement relative to the given mesh [-]

    /// "incompatible modes, true area, x 1.5".
    std::string text() const;

    /// text() without the factor, common to all meshes of a family.
    std::string family() const;
  };

  /// Eigenvalues computed by one method, one for each full-order mode.
  struct ModesByMethod
  {
    std::string                       method; ///< "full order", or the name of a basis
    int                               size;   ///< number of unknowns of the eigenproblem
    Cost                              cost;   ///< from meshing to modes; memory of all processes
    std::vector<std::complex<double>> lambda; ///< [rad/s]

    /// Estimated |δλ| / |λ| due to the eigensolver [-]: estimates of the solver or, without them, ½ √ε_res with eq. (16) of the paper; zero
    /// for reduced bases.
    std::vector<double> algebraic_errors;
  };

  /// The model solved on one mesh.
  struct SolvedMesh
  {
    MeshAndElement             mesh;
    int                        n_dofs, n_contact_nodes;
    ModesAtPoints              modes; ///< full-order modes in the band and its margin
    std::vector<ModeLabel>     labels;
    std::size_t                n_unstable;
    std::vector<ModesByMethod> methods; ///< first method: full order
  };

  /// A mesh and element that could not be solved.
  struct LeftOut
  {
    MeshAndElement mesh;
    std::string    reason;
  };

  /// Results for all meshes and elements.
  struct SolvedMeshes
  {
    std::vector<SolvedMesh> meshes;   ///< the coarsest first
    std::vector<LeftOut>    left_out; ///< meshes that could not be solved or have too many dofs
  };

  /// Solves the model on all requested meshes and elements, at full order and with the requested bases, each as a step of the run. Mode
  /// shapes are stored at the points of the first solved mesh.
  SolvedMeshes solve_meshes(Run &run);

  /// Limit of a quantity of a mode for vanishing mesh width.
  struct Limit
  {
    std::optional<Extrapolation> sequence; ///< empty if only one mesh has the mode
    double                       value = 0., uncertainty = 0.;
  };

  /// A mode on all meshes of a family, and its limits.
  struct ConvergedMode
  {
    ModeLabel        label;      ///< label on the finest mesh
    bool             in_cluster; ///< true if the mode mixes with other modes on at least one mesh, see pair_modes()
    std::vector<int> numbers;    ///< index of the mode on every mesh; -1: no counterpart
    Limit            frequency;  ///< [Hz]
    Limit            divergence; ///< [-]
  };

  /// Modes of one element and outline on successively finer meshes.
  struct ConvergedFamily
  {
    std::string                     name;
    std::vector<const SolvedMesh *> members; ///< the finest last
    std::vector<ConvergedMode>      modes;   ///< in the order of the modes on the finest mesh
    double                          error;   ///< rms of the relative frequency errors on the finest mesh, including uncertainties [-]
  };

  /**
   * Extrapolates the frequencies and divergence rates of every family of two or more meshes to zero mesh width; modes are paired by shape
   * with modes of the finest mesh. With two meshes, the assumed order is twice the degree of the element. In clusters, and for three or
   * more meshes without a reliable order of convergence, the limit is the value of the finest mesh.
   */
  std::vector<ConvergedFamily> converged_families(const std::vector<SolvedMesh> &meshes, double maximum_frequency);

  /// Family with the smallest error; throws SolverError if there is none.
  const ConvergedFamily &best_family(const std::vector<ConvergedFamily> &families);

  /// Error contributions.
  struct ErrorKinds
  {
    double total          = 0.; ///< error relative to the extrapolated value
    double discretisation = 0.; ///< error of the full-order value on this mesh, relative to the extrapolated value
    double reduction      = 0.; ///< error of the basis, relative to the full-order value on this mesh
    double algebraic      = 0.; ///< error of the eigensolver, estimated from residuals
  };

  /// A reference mode and its counterpart on one mesh by one method.
  struct ModeErrors
  {
    const ConvergedMode *reference;
    int                  number;           ///< index of the mode on the mesh; -1: no counterpart
    double               overlap;          ///< overlap of both shapes [-]
    bool                 in_cluster;       ///< true for one of several modes that mix differently on each mesh
    double               frequency;        ///< [Hz]
    double               divergence;       ///< [-]
    ErrorKinds           frequency_error;  ///< relative error [-]
    ErrorKinds           divergence_error; ///< difference of divergence rates [-]
  };

  /// All modes of the band on one mesh by one method, with errors.
  struct ComparedMethod
  {
    const SolvedMesh       *mesh;
    const ModesByMethod    *method;
    std::vector<ModeErrors> modes;
    ErrorKinds              largest_frequency;  ///< [-]
    double                  rms_frequency;      ///< rms of the total errors [-]
    ErrorKinds              largest_divergence; ///< largest errors of modes outside clusters [-]
    int                     n_in_cluster, n_lost;
    bool                    on_front = false; ///< Pareto-optimal in CPU time and largest frequency error, without lost modes
  };

  /// Compares all meshes and methods with the reference modes up to a frequency [Hz].
  std::vector<ComparedMethod> compare(const std::vector<SolvedMesh> &meshes, const ConvergedFamily &reference, double maximum_frequency);
} // namespace Squeal
