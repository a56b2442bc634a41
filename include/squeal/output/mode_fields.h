#pragma once

#include <squeal/contact/contact_interface.h>
#include <squeal/linear_algebra/dense_matrix.h>
#include <squeal/model/model.h>
#include <squeal/output/result_folder.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/lac/vector.h>

#include <complex>
#include <memory>
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
    std::vector<std::complex<double>> reactions;    ///< r_n of each contact node [N per unit amplitude]; compression negative
  };

  /**
   * Writes modes for ParaView (VTU): on the bodies `displacement_real`,
   * `displacement_imag`, `amplitude` (modulus of each component; its magnitude
   * is the overall amplitude) and `phase` (argument of each component [rad]),
   * scaled to a largest amplitude of one, with the cell field `component`; on
   * the contact faces, in a file of their own, `normal_reaction_real` and
   * `normal_reaction_imag` [N] in the same scale. All processes must call.
   */
  class ModeFieldWriter
  {
  public:
    ModeFieldWriter(const Model &model, const ContactInterface &interface, const ResultFolder &folder);

    /// `modes/NAME.vtu` and `modes/NAME_contact.vtu`.
    void write_mode(const ModeField &mode) const;

    /**
     * One period Re(φ e^{iωt}) without growth as `animations/NAME.pvd` with
     * @p n_frames pictures; time in the file is in seconds.
     */
    void write_animation(const ModeField &mode, unsigned int n_frames) const;

  private:
    /// A field on all dofs of deal.II from one on the free dofs.
    template <typename Function>
    dealii::Vector<double> dof_vector(const ModeField &mode, const Function &value) const;

    void write_contact(const ModeField &mode) const;

    const Model                         &model;
    const ContactInterface              &interface;
    const ResultFolder                  &folder;
    dealii::Vector<double>               components;
    dealii::Triangulation<2, 3>          contact_mesh;
    std::unique_ptr<dealii::FE_Q<2, 3>>  contact_fe;
    dealii::DoFHandler<2, 3>             contact_dofs;
    std::vector<unsigned int>            contact_node_of_dof;
  };
} // namespace Squeal
