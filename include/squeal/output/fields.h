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
    std::string                       name;         ///< of its files, without extension
    std::complex<double>              lambda;       ///< [rad/s]
    std::vector<std::complex<double>> displacement; ///< on the free dofs, rows of this process
    std::vector<std::complex<double>> reactions;    ///< r_n of each pair of contact nodes [N per unit amplitude]; compression negative
    std::string                       title = {};   ///< description of the mode in its files
    std::vector<double> energy_input        = {};   ///< contribution of each pair to the divergence rate per area [1/m²]; empty: unknown
  };

  /// A mode without friction, of the coupled bodies or of one component, for output.
  struct RealModeField
  {
    std::string              name;         ///< of its file, without extension
    std::string              title;        ///< description of the mode in its file
    std::vector<double>      displacement; ///< on the free dofs, rows of this process
    std::optional<Component> component;    ///< the bodies to write; nothing: all
  };

  /// An entry of a list of mode files for ParaView.
  struct ListedMode
  {
    std::string name;      ///< of its file, without extension
    double      frequency; ///< [Hz]
  };

  /// Options of the animation of a mode.
  struct AnimationOptions
  {
    unsigned int frames_per_period = 16;
    unsigned int periods           = 1;
    bool         grows             = false; ///< multiplied by e^{Rt}
  };

  /// A contact state for output; one value for each pair of contact nodes.
  struct ContactField
  {
    std::vector<double>          displacement;    ///< on the free dofs [m], rows of this process, including the motion of the backplates
    std::vector<Eigen::Vector3d> backplates;      ///< displacement of the backplate of each component [m]
    std::vector<double>          reactions;       ///< R_n0 [N]
    std::vector<double>          gaps;            ///< [m]
    std::vector<double>          radial_damping;  ///< c_b [N s/m]
    std::vector<double>          sliding_damping; ///< c_t [N s/m]
  };

  /**
   * Writes fields as VTK files (.vtu), each with its mesh, in single precision, and lists of them (.pvd), for ParaView. Collective.
   *
   * Modes are scaled to a largest displacement modulus of one and rounded to multiples of 2⁻¹⁶. Files of the bodies contain
   * `displacement_real`, `displacement_imag`, `amplitude` (root of the sum of |u|² over the components), `phase` (argument of each
   * component [rad]) and the cell fields of a piece; files `NAME_contact.vtu` of the contact faces contain `normal_reaction_real` and
   * `normal_reaction_imag` [N] in the same scale, `closed` (1: the node belongs to S_0) and, if known, `energy_input` [1/m²]. The title of
   * a mode is the text `mode` in the field data.
   */
  class FieldWriter
  {
  public:
    /// @param closed indices of the closed pairs among @p interface
    FieldWriter(const Model &model, const ContactInterface &interface, const std::vector<unsigned int> &closed, const ResultFolder &folder);

    /// Writes shapes on points without cells, from a system file; there are no contact faces.
    /// @param points points of this process, with their dofs
    FieldWriter(const std::vector<Node> &points, const RowMap &dofs, const ResultFolder &folder);

    /// Writes `modes/NAME*.vtu`.
    void write_mode(const ModeField &mode);

    /// Writes `modes/NAME.vtu` with `displacement` and `amplitude`, in the same scale.
    void write_mode(const RealModeField &mode);

    /**
     * Writes `NAME.pvd`, a sequence of modes for ParaView, and `NAME_contact.pvd` if the modes have contact faces. Times are frequencies
     * [Hz], at least a relative 10⁻⁶ apart so that ParaView distinguishes them.
     *
     * @param modes modes already written, in ascending order of frequency
     */
    void write_list(const std::string &name, const std::vector<ListedMode> &modes) const;

    /**
     * Writes periods of several modes on the surface of the bodies as `animations/NAME.pvd`; time is in periods. Each mode is a vector
     * field with its name, rounded to multiples of 1/4096. The largest amplitude is one: constant without growth, in the last frame of a
     * growing mode and in the first frame of a decaying one. Without growth the last frame is one step before the end, so that the
     * animation can be looped; with growth it is at the end.
     */
    void write_animation(const std::string &name, const std::vector<ModeField> &modes, const AnimationOptions &options);

    /**
     * Writes `sliding_state.vtu` with `displacement` [m] on the bodies, and `sliding_state_contact.vtu` with `pressure` (−R_n0 over the
     * area of the node) [Pa], `normal_reaction` [N], `gap` [m], `closed`, `c_b` and `c_t` [N s/m] on the contact faces.
     */
    void write_contact_state(const ContactField &state);

  private:
    /// A mesh, and the reusable beginning of its files.
    struct Stage
    {
      explicit Stage(FieldMesh given);
      FieldMesh mesh;
      VtuPiece  piece;
    };

    /// All bodies, or those of one component.
    const Stage &bodies(const std::optional<Component> &component);

    void write(const Stage &stage, const std::string &name, const std::string &title, const std::vector<VertexField> &fields) const;

    /// Writes fields on the contact faces: names, and values at the pairs of contact nodes.
    void write_contact(const std::string                                                       &name,
                       const std::string                                                       &title,
                       const std::vector<std::pair<const char *, const std::vector<double> *>> &fields) const;

    const Model                                               *model; ///< null: points
    const MPI_Comm                                             communicator;
    const ResultFolder                                        &folder;
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> dofs;   ///< free dofs of the cells of this process
    std::vector<double>                                        areas;  ///< areas of the pairs of contact nodes [m²]
    std::vector<double>                                        closed; ///< 1 for pairs in contact
    std::map<std::optional<Component>, Stage>                  stages;
    std::optional<Stage>                                       surface; ///< surface for animations
    const Stage                                                contact_faces;
    std::vector<int>                                           pairs; ///< pair of each vertex; -1: no pair, the face overhangs the disc
  };
} // namespace Squeal
