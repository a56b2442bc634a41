#pragma once

#include <squeal/estimates/common_points.h>
#include <squeal/studies/steps/friction_modes.h>

#include <complex>
#include <optional>
#include <string>
#include <vector>

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

  /// All that the parameters ask for, the coarsest meshes first.
  std::vector<MeshAndElement> meshes_and_elements(const Parameters &parameters);

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

  /**
   * Solves scenes on meshes one after the other, at full order and with the bases that the parameters name; modes are kept at the points of
   * the first mesh.
   */
  class AccuracySolver
  {
  public:
    explicit AccuracySolver(Run &run);

    /// Nothing where that cannot be done, as of a mesh that does not come about or has more dofs than the parameters allow. Each is a step of the run.
    std::optional<SolvedMesh> solve(const MeshAndElement &mesh);

    /// What could not be solved so far.
    const std::vector<LeftOut> &left_out() const
    {
      return missing;
    }

  private:
    SolvedMesh solved(const MeshAndElement &mesh);

    Parameters with(const MeshAndElement &mesh) const;

    Run                        &run;
    const double                resident_before; ///< memory of this process before the first mesh [byte]
    std::optional<CommonPoints> points;
    std::vector<LeftOut>        missing;
  };
} // namespace Squeal
