// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/contact_operators.h>
#include <squeal/model/model.h>
#include <squeal/output/vtu_file.h>

#include <complex>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace dealii::Utilities::MPI
{
  class Partitioner;
}

namespace Squeal
{
  /// A complex mode for output.
  struct ModeField
  {
    std::string                       name;         ///< name of its files, without extension
    std::complex<double>              lambda;       ///< [rad/s]
    std::vector<std::complex<double>> displacement; ///< u on the free dofs, rows of this process
    std::vector<std::complex<double>> reactions;    ///< r_n of each pair of contact nodes, negative in compression [N per unit amplitude]
    std::string                       title = {};   ///< description of the mode in its files
    std::vector<double> energy_input        = {};   ///< contribution of each pair to the divergence rate, per area [1/m²]; empty: unknown
  };

  /// A mode without friction, of the coupled bodies or of one component, for output.
  struct RealModeField
  {
    std::string              name;         ///< name of its file, without extension
    std::string              title;        ///< description of the mode in its file
    std::vector<double>      displacement; ///< u on the free dofs, rows of this process
    std::optional<Component> component;    ///< bodies that are written; no value: all bodies
  };

  /// An entry of a list of mode files for ParaView.
  struct ListedMode
  {
    std::string name;      ///< name of its file, without extension
    double      frequency; ///< [Hz]
  };

  struct AnimationOptions
  {
    unsigned int frames_per_period = 16;
    unsigned int periods           = 1;
    bool         grows             = false; ///< true: the motion is multiplied by e^{Rt}
  };

  /// A contact state for output, with one value for each pair of contact nodes.
  struct ContactField
  {
    std::vector<double>          displacement;    ///< u on the free dofs [m], rows of this process, including the motion of the backplates
    std::vector<Eigen::Vector3d> backplates;      ///< displacement of the backplate of each component [m]
    std::vector<double>          reactions;       ///< R_n0 [N]
    std::vector<double>          gaps;            ///< g [m]
    std::vector<double>          radial_damping;  ///< c_b [N s/m]
    std::vector<double>          sliding_damping; ///< c_t [N s/m]
  };

  /**
   * Writes fields as VTK files (.vtu) in single precision, each with its mesh, and lists of such files (.pvd) for ParaView. Collective.
   *
   * Modes are scaled so that the largest modulus of the displacements is one, and rounded to multiples of 2⁻¹⁶. Files of the bodies contain
   * `displacement_real`, `displacement_imag`, `amplitude` (root of the sum of |u|² over the components), `phase` (argument of each
   * component [rad]) and the cell fields of a piece; files `NAME_contact.vtu` of the contact faces contain `normal_reaction_real` and
   * `normal_reaction_imag` [N] in the scale of the displacements, `closed` (1: the node belongs to S_0) and, if known, `energy_input`
   * [1/m²]. The field data contain the title of the mode as the string `mode`.
   */
  class FieldWriter
  {
  public:
    /// @param closed indices of the closed pairs in @p interface
    FieldWriter(const Model &model, const ContactInterface &interface, const std::vector<unsigned int> &closed, const ResultFolder &folder);

    /// Constructs a writer for mode shapes of a system file, on points without cells and contact faces.
    /// @param points points of this process, with their dofs
    FieldWriter(const std::vector<Node> &points, const RowMap &dofs, const ResultFolder &folder);

    /// Writes `modes/NAME*.vtu`.
    void write_mode(const ModeField &mode);

    /// Writes `modes/NAME.vtu` with `displacement` and `amplitude`, scaled as for complex modes.
    void write_mode(const RealModeField &mode);

    /**
     * Writes `NAME.pvd`, a sequence of modes for ParaView, and `NAME_contact.pvd` if the modes have contact faces. The times are
     * frequencies [Hz] with relative distances of at least 10⁻⁶, so that ParaView distinguishes them.
     *
     * @param modes modes that have been written, in ascending order of frequency
     */
    void write_list(const std::string &name, const std::vector<ListedMode> &modes) const;

    /**
     * Writes periods of several modes on the surface of the bodies as `animations/NAME.pvd`; time is in periods. Each mode is a vector
     * field with its name, rounded to multiples of 1/4096. The largest amplitude is one; with growth, it occurs in the last frame of a
     * growing mode and in the first frame of a decaying mode. Without growth, the last frame is one step before the end, so that the
     * animation can be looped; with growth, it is at the end.
     */
    void write_animation(const std::string &name, const std::vector<ModeField> &modes, const AnimationOptions &options);

    /**
     * Writes `sliding_state.vtu` with `displacement` [m] on the bodies, and `sliding_state_contact.vtu` with `pressure` (−R_n0 over the
     * area of the node) [Pa], `normal_reaction` [N], `gap` [m], `closed`, `c_b` and `c_t` [N s/m] on the contact faces.
     */
    void write_contact_state(const ContactField &state);

  private:
    /// A mesh, and the part of the VTK files that is common to all files of this mesh.
    struct Stage
    {
      explicit Stage(FieldMesh given);
      FieldMesh mesh;
      VtuPiece  piece;
    };

    /// Mesh of all bodies or of one component.
    const Stage &bodies(const std::optional<Component> &component);

    void write(const Stage &stage, const std::string &name, const std::string &title, const std::vector<VertexField> &fields) const;

    /// Writes fields on the contact faces, given by their names and values at the pairs of contact nodes.
    void write_contact(const std::string                                                       &name,
                       const std::string                                                       &title,
                       const std::vector<std::pair<const char *, const std::vector<double> *>> &fields) const;

    const Model                                               *model; ///< null: points without cells
    const MPI_Comm                                             communicator;
    const ResultFolder                                        &folder;
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> dofs;   ///< free dofs of the cells of this process
    std::vector<double>                                        areas;  ///< areas of the pairs of contact nodes [m²]
    std::vector<double>                                        closed; ///< 1 for pairs in contact
    std::map<std::optional<Component>, Stage>                  stages;
    std::optional<Stage>                                       surface;
    const Stage                                                contact_faces;
    std::vector<int> pairs; ///< pair of each vertex; -1: no pair, because the face overhangs the disc
  };
} // namespace Squeal
