#pragma once

#include <squeal/contact/contact_interface.h>
#include <squeal/linear_algebra/dense.h>
#include <squeal/model/model.h>
#include <squeal/output/result_folder.h>

#include <deal.II/lac/vector.h>

#include <array>
#include <complex>
#include <string>
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
   * scale, and `closed` (1: the node belongs to S_0).
   */
  class FieldWriter
  {
  public:
    /// @param closed numbers of the pairs that are in contact, among those of @p interface
    FieldWriter(const Model &model, const ContactInterface &interface, const std::vector<unsigned int> &closed, const ResultFolder &folder);

    /// `modes/NAME.vtu` and `modes/NAME_contact.vtu`.
    void write_mode(const ModeField &mode) const;

    /**
     * One period Re(φ e^{iωt}) without growth as `animations/NAME.pvd` with
     * @p n_frames pictures; time in the file is in seconds.
     */
    void write_animation(const ModeField &mode, unsigned int n_frames) const;

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
