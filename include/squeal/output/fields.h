#pragma once

#include <squeal/contact/contact_operators.h>
#include <squeal/linear_algebra/dense.h>
#include <squeal/model/model.h>
#include <squeal/output/result_folder.h>

#include <deal.II/lac/vector.h>

#include <array>
#include <complex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace Squeal
{
  /// A complex mode as the field writer needs it.
  struct ModeField
  {
    std::string                       name;         ///< of its files, without extension
    std::complex<double>              lambda;       ///< [rad/s]
    std::vector<std::complex<double>> displacement; ///< on the free dofs
    std::vector<std::complex<double>> reactions;    ///< r_n of each pair of contact nodes [N per unit amplitude]; compression negative
    std::string                       title = {};   ///< what the file says of the mode
  };

  /// A mode without friction, of the coupled bodies or of one component, as the field writer needs it.
  struct RealModeField
  {
    std::string              name;         ///< of its file, without extension
    std::string              title;        ///< what the file says of the mode
    std::vector<double>      displacement; ///< on the free dofs
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
    std::vector<double> displacement;    ///< on the free dofs [m], with the travel of the backplates
    std::vector<double> approach;        ///< travel of the backplate of each component towards the disc [m]
    std::vector<double> reactions;       ///< R_n0 [N]
    std::vector<double> gaps;            ///< [m]
    std::vector<double> radial_damping;  ///< c_b [N s/m]
    std::vector<double> sliding_damping; ///< c_t [N s/m]
  };

  /**
   * Writes fields for ParaView (VTU). All processes must call.
   *
   * Modes: on the bodies `displacement_real`, `displacement_imag`, `amplitude`
   * (modulus of each component; its magnitude is the overall amplitude) and
   * `phase` (argument of each component [rad]), scaled to a largest amplitude of
   * one, with the cell field `component`; on the contact faces, in a file of
   * their own, `normal_reaction_real` and `normal_reaction_imag` [N] in the same
   * scale, and `closed` (1: the node belongs to S_0). The title of a mode is the text `mode` of the file's field data.
   */
  class FieldWriter
  {
  public:
    /// @param closed numbers of the pairs that are in contact, among those of @p interface
    FieldWriter(const Model &model, const ContactInterface &interface, const std::vector<unsigned int> &closed, const ResultFolder &folder);

    /// `modes/NAME.vtu` and `modes/NAME_contact.vtu`.
    void write_mode(const ModeField &mode) const;

    /// `modes/NAME.vtu` with `displacement` and `amplitude` (modulus of each component), scaled to a largest amplitude of one.
    void write_mode(const RealModeField &mode) const;

    /**
     * `NAME.pvd`, which lists files of `modes/` with their frequencies [Hz] as times. ParaView shows files of equal times
     * on top of each other. Each time therefore exceeds the one before by at least 10⁻⁶ of it.
     *
     * @param modes in ascending order of frequency
     */
    void write_list(const std::string &name, const std::vector<ListedMode> &modes) const;

    /**
     * Periods of Re(φ e^{iωt}), or of Re(φ e^{λt}) where the animation grows, as `animations/NAME.pvd`; time in the file is in
     * seconds. The largest amplitude is one: at all times without growth, in the last picture of a mode that grows and in
     * the first of one that decays. Without growth the last picture comes one step before the end, so that it may be
     * repeated; with growth at the end.
     */
    void write_animation(const ModeField &mode, const AnimationOptions &options) const;

    /**
     * `sliding_state.vtu` with `displacement` [m] on the bodies, and
     * `sliding_state_contact.vtu` with `pressure` (−R_n0 over the area of the
     * node) [Pa], `normal_reaction` [N], `gap` [m], `closed`, `c_b` and `c_t`
     * [N s/m] on the contact faces.
     */
    void write_contact_state(const ContactField &state) const;

  private:
    /// A field on all dofs of deal.II from one on the free dofs.
    template <typename Number, typename Function>
    dealii::Vector<double> dof_vector(const std::vector<Number> &displacement, const Function &value) const;

    /// Fields on the contact faces: values of the pairs of contact nodes with their names.
    void write_contact(const std::string &file, const std::vector<std::pair<const std::vector<double> *, const char *>> &fields) const;

    const Model                             &model;
    const ContactInterface                  &interface;
    const ResultFolder                      &folder;
    dealii::Vector<double>                   components;
    std::vector<double>                      closed;        ///< 1 for pairs in contact
    std::vector<std::array<unsigned int, 4>> contact_faces; ///< of the pins, by pairs of contact nodes
  };
} // namespace Squeal
