// SPDX-License-Identifier: GPL-3.0-or-later

#include "nodal_projection.h"

#include <squeal/bases/mode_labels.h>

#include <Eigen/Geometry>

#include <map>

namespace Squeal
{
  namespace
  {
    /// Axis of a pin: through the centre of its contact nodes along their mean normal.
    struct PinAxis
    {
      Eigen::Vector3d centre = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::Zero();
      int             n_contact = 0;
    };

    std::map<unsigned int, PinAxis> pin_axes(const ContactInterface &interface)
    {
      std::map<unsigned int, PinAxis> axes;
      for (const ContactNode &contact : interface)
        {
          PinAxis &axis = axes[contact.pin];
          axis.centre += contact.position;
          axis.direction += contact.normal;
          ++axis.n_contact;
        }
      for (auto &[pin, axis] : axes)
        {
          axis.centre /= axis.n_contact;
          axis.direction.normalize();
        }
      return axes;
    }

    /// Adds the bending, torsional and longitudinal energy of each mode, 3 × k, from its projections on polynomials of the height.
    void add_energies(const Nodes &pin, const PinAxis &axis, const MultiVector &modes, DenseMatrix &energies)
    {
      constexpr int          n_height_functions = 4;
      const Eigen::Vector3d  along              = axis.direction;
      const Eigen::MatrixX3d places             = pin.positions.rowwise() - axis.centre.transpose();
      const Eigen::VectorXd  heights            = places * along;
      const Eigen::MatrixX3d arms               = places - heights * along.transpose();
      const Eigen::VectorXd  radii              = arms.rowwise().norm();
      Eigen::MatrixX3d       around             = arms.rowwise().cross(along); // unit vectors about the axis, zero on it
      for (Eigen::Index i = 0; i < radii.size(); ++i)
        around.row(i) /= radii[i] > 0. ? radii[i] : 1.;

      const DenseMatrix functions = powers(heights / pin.largest(heights.cwiseAbs()), n_height_functions);
      const Projection  translation(pin.communicator, functions, pin.masses),
        torsion(pin.communicator, radii.asDiagonal() * functions, pin.masses);

      for (int m = 0; m < modes.n_columns(); ++m)
        {
          const Eigen::MatrixX3d u       = pin.displacements(modes, m);
          const Eigen::VectorXd  axially = u * along;
          energies(0, m) += translation.coefficients(u - axially * along.transpose()).squaredNorm();
          energies(1, m) += torsion.coefficients(u.cwiseProduct(around).rowwise().sum()).squaredNorm();
          energies(2, m) += translation.coefficients(axially).squaredNorm();
        }
    }

    bool is_pin(const Model &model, const std::size_t body)
    {
      return model.component_names()[body].rfind(PhysicalNames::pin_prefix, 0) == 0;
    }

    /// Σ m |u|² over the nodes of each body, bodies × modes.
    DenseMatrix body_energies(const Model &model, const std::vector<double> &nodal_masses, const MultiVector &modes)
    {
      DenseMatrix result = DenseMatrix::Zero(model.component_names().size(), modes.n_columns());
      for (std::size_t i = 0; i < nodal_masses.size(); ++i)
        for (const int dof : model.nodes()[i].dofs)
          if (const int row = modes.map().place(dof); row >= 0)
            result.row(model.nodes()[i].component) += nodal_masses[i] * modes.local().row(row).cwiseAbs2();
      return summed(model.communicator(), result);
    }
  } // namespace

  std::vector<ModeLabel> pin_labels(const Model               &model,
                                    const ContactInterface    &interface,
                                    const std::vector<double> &nodal_masses,
                                    const MultiVector         &modes)
  {
    auto axes = pin_axes(interface);
    for (auto axis = axes.begin(); axis != axes.end();)
      axis = is_pin(model, axis->first) ? std::next(axis) : axes.erase(axis);
    const DenseMatrix           of_bodies = body_energies(model, nodal_masses, modes);
    std::map<Eigen::Index, int> n_of_body;
    DenseMatrix                 energies = DenseMatrix::Zero(3, modes.n_columns());
    for (const auto &[pin, axis] : axes)
      add_energies(Nodes(model, nodal_masses, pin), axis, modes, energies);

    // Number the modes of each family in ascending order: each pin has one T1, one L1 and two F1 modes
    constexpr std::array<ModeFamily, 3> families = {{ModeFamily::flexural, ModeFamily::torsional, ModeFamily::longitudinal}};
    std::vector<ModeLabel>              labels;
    std::array<int, 3>                  count{};
    const int                           n_pins    = axes.size();
    const std::array<int, 3>            per_order = {{2 * n_pins, n_pins, n_pins}};
    for (int m = 0; m < modes.n_columns(); ++m)
      {
        Eigen::Index f, body;
        of_bodies.col(m).maxCoeff(&body);
        if (!is_pin(model, body))
          {
            labels.push_back({ModeFamily::body, 0, 0, ++n_of_body[body], DoubletSign::none, 0., model.component_names()[body]});
            continue;
          }
        energies.col(m).maxCoeff(&f);
        labels.push_back({families[f], 0, 0, count[f]++ / per_order[f] + 1});
      }
    return labels;
  }
} // namespace Squeal
