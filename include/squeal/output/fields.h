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
  /// A complex mode as the field writer needs it.
  struct ModeField
  {
    std::string                       name;         ///< of its files, without extension
    std::complex<double>              lambda;       ///< [rad/s]
    std::vector<std::complex<double>> displacement; ///< on the free dofs, rows of this process
    std::vector<std::complex<double>> reactions;    ///< r_n of each pair of contact nodes [N per unit amplitude]; compression negative
    std::string                       title = {};   ///< what its files say of the mode
    std::vector<double> energy_input        = {};   ///< what each pair adds to the divergence rate, over its area [1/m²]; empty: not known
  };

  /// A mode without friction, of the coupled bodies or of one component, as the field writer needs it.
  struct RealModeField
  {
    std::string              name;         ///< of its file, without extension
    std::string              title;        ///< what the file says of the mode
    std::vector<double>      displacement; ///< on the free dofs, rows of this process
    std::optional<Component> component;    ///< the bodies to write; nothing: all
  };

  /// A mode file in a list through which ParaView steps.
  struct ListedMode
  {
    std::string name;      ///< of its file, without extension
    double      frequency; ///< [Hz]
  };

  /// What an animation shows of a mode.
  struct AnimationOptions
  {
    unsigned int frames_per_period = 16;
    unsigned int periods           = 1;
    bool         grows             = false; ///< multiplied by e^{Rt}
  };

  /// A state of contact as the field writer needs it; one value for each pair of contact nodes.
  struct ContactField
  {
    std::vector<double>          displacement;    ///< on the free dofs [m], rows of this process, with that of the backplates
    std::vector<Eigen::Vector3d> backplates;      ///< displacement of the backplate of each component [m]
    std::vector<double>          reactions;       ///< R_n0 [N]
    std::vector<double>          gaps;            ///< [m]
    std::vector<double>          radial_damping;  ///< c_b [N s/m]
    std::vector<double>          sliding_damping; ///< c_t [N s/m]
  };

  /**
   * Writes fields as files of VTK (.vtu), each with its mesh, single precision, and lists of them (.pvd), for ParaView. All processes must call.
   *
   * Modes are scaled so that the largest modulus of a displacement is one, and rounded to multiples of 2⁻¹⁶. On the bodies are
   * `displacement_real`, `displacement_imag`,
   * `amplitude` (root of the sum of |u|² over the components), `phase` (argument of each component [rad]) and the cell fields of a piece; on
   * the contact faces, in files `NAME_contact.vtu`, `normal_reaction_real` and `normal_reaction_imag` [N] in the same scale, `closed` (1: the
   * node belongs to S_0) and, where it is known, `energy_input` [1/m²]. The title of a mode is the text `mode` of the file's field data.
   */
  class FieldWriter
  {
  public:
    /// @param closed numbers of the pairs that are in contact, among those of @p interface
    FieldWriter(const Model &model, const ContactInterface &interface, const std::vector<unsigned int> &closed, const ResultFolder &folder);

    /// Writes shapes on points without cells, as a system file gives them; there are no contact faces.
    /// @param points those of this process, with their dofs
    FieldWriter(const std::vector<Node> &points, const RowMap &dofs, const ResultFolder &folder);

    /// Files `modes/NAME*.vtu`.
    void write_mode(const ModeField &mode);

    /// A file `modes/NAME.vtu` with `displacement` and `amplitude`, in the same scale.
    void write_mode(const RealModeField &mode);

    /**
     * A file `NAME.pvd` through which ParaView steps, and `NAME_contact.pvd` where the modes have contact faces: frequencies [Hz] as times that
     * ParaView keeps apart, each beyond the one before by at least 10⁻⁶ of it.
     *
     * @param modes that have been written, in ascending order of frequency
     */
    void write_list(const std::string &name, const std::vector<ListedMode> &modes) const;

    /**
     * Writes periods of several modes on the surface of the bodies as `animations/NAME.pvd`; time is in periods. Each mode is a vector
     * field with the name of the mode, rounded to multiples of 1/4096. The largest amplitude is one: at all times without growth, in the last
     * picture of a growing mode and in the first of a decaying one. Without growth the last picture is one step before the end, so that the
     * animation can be looped; with growth it is at the end.
     */
    void write_animation(const std::string &name, const std::vector<ModeField> &modes, const AnimationOptions &options);

    /**
     * `sliding_state.vtu` with `displacement` [m] on the bodies, and
     * `sliding_state_contact.vtu` with `pressure` (−R_n0 over the area of the
     * node) [Pa], `normal_reaction` [N], `gap` [m], `closed`, `c_b` and `c_t`
     * [N s/m] on the contact faces.
     */
    void write_contact_state(const ContactField &state);

  private:
    /// A mesh, and the piece of a file that has no more yet.
    struct Stage
    {
      explicit Stage(FieldMesh given);
      FieldMesh mesh;
      VtuPiece  piece;
    };

    /// All bodies, or those of a component.
    const Stage &bodies(const std::optional<Component> &component);

    void write(const Stage &stage, const std::string &name, const std::string &title, const std::vector<VertexField> &fields) const;

    /// Fields on the contact faces: names, and values of the pairs of contact nodes.
    void write_contact(const std::string                                                       &name,
                       const std::string                                                       &title,
                       const std::vector<std::pair<const char *, const std::vector<double> *>> &fields) const;

    const Model                                               *model; ///< null: points
    const MPI_Comm                                             communicator;
    const ResultFolder                                        &folder;
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> dofs;   ///< free ones of the cells of this process
    std::vector<double>                                        areas;  ///< of the pairs of contact nodes [m²]
    std::vector<double>                                        closed; ///< 1 for pairs in contact
    std::map<std::optional<Component>, Stage>                  stages;
    std::optional<Stage>                                       surface; ///< of animations
    const Stage                                                contact_faces;
    std::vector<int>                                           pairs; ///< of the vertices of these; -1: overhangs the disc
  };
} // namespace Squeal
