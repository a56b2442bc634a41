#pragma once

#include <squeal/output/fields.h>

#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/lac/vector.h>

#include <array>
#include <utility>

namespace Squeal
{
  /// A field on the dofs of deal.II: those of the cells of a process.
  using DofVector = dealii::LinearAlgebra::distributed::Vector<double>;

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
   * Writes fields as files of VTK (.vtu), each with the whole mesh. All processes must call.
   *
   * The amplitude has three components, the moduli of those of the displacement; its magnitude is the overall amplitude. Modes have the
   * field `phase` (argument of each component [rad]) as well. Fields on the contact faces are in files of their own,
   * `modes/NAME_contact.vtu`. The title of a mode is the text `mode` of the file's field data. Lists and animations are .pvd files.
   */
  class VtuWriter : public ModeFieldWriter
  {
  public:
    /// @param closed numbers of the pairs that are in contact, among those of @p interface
    VtuWriter(const Model &model, const ContactInterface &interface, const std::vector<unsigned int> &closed, const ResultFolder &folder);

    void write_mode(const ModeField &mode) override;

    void write_mode(const RealModeField &mode) override;

    void write_list(const std::string &name, const std::vector<ListedMode> &modes) override;

    void write_animation(const ModeField &mode, const AnimationOptions &options) override;

    /**
     * `sliding_state.vtu` with `displacement` [m] on the bodies, and
     * `sliding_state_contact.vtu` with `pressure` (−R_n0 over the area of the
     * node) [Pa], `normal_reaction` [N], `gap` [m], `closed`, `c_b` and `c_t`
     * [N s/m] on the contact faces.
     */
    void write_contact_state(const ContactField &state) const;

  private:
    /// A field on the dofs of deal.II from one on the free dofs, rows of this process.
    template <typename Number, typename Function>
    DofVector dof_vector(const std::vector<Number> &displacement, const Function &value) const;

    /// Fields on the contact faces: values of the pairs of contact nodes with their names.
    void write_contact(const std::string &file, const std::vector<std::pair<const std::vector<double> *, const char *>> &fields) const;

    const Model                             &model;
    const ContactInterface                  &interface;
    const ResultFolder                      &folder;
    dealii::Vector<double>                   components;
    std::vector<double>                      closed;        ///< 1 for pairs in contact
    std::vector<std::array<unsigned int, 4>> contact_faces; ///< of the pins, by pairs of contact nodes; on process 0
  };
} // namespace Squeal
