// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/bases/static_modes.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <vector>

namespace Squeal
{
  namespace
  {
    /// X times @p factor with the rows of the other component set to zero.
    MultiVector restricted(const Model &model, const Component component, const MultiVector &X, const double factor)
    {
      MultiVector result(X.map(), X.n_columns());
      for (const Node &node : model.nodes())
        if (belongs_to(node, component))
          for (const int dof : node.dofs)
            if (const int i = X.map().place(dof); i >= 0)
              for (int j = 0; j < X.n_columns(); ++j)
                result(i, j) = factor * X(i, j);
      return result;
    }
  } // namespace

  StaticModes::StaticModes(const Model               &model,
                           const ContactInterface    &interface,
                           const ContactOperators    &contact,
                           const SecondOrderSystem   &system,
                           const InertiaRelief       &response,
                           const double               largest_circular_frequency,
                           const FactorizationLibrary library)
    : response(response)
    , model(model)
    , interface(interface)
    , contact(contact)
    , system(system)
    , largest_circular_frequency(largest_circular_frequency)
    , library(library)
  {}

  const MultiVector &StaticModes::normal_attachment() const
  {
    if (!normal)
      normal = std::make_unique<MultiVector>(attachment_modes(response, *contact.normal));
    return *normal;
  }

  const MultiVector &StaticModes::tangential_attachment() const
  {
    if (!tangential)
      tangential = std::make_unique<MultiVector>(attachment_modes(response, *contact.tangential));
    return *tangential;
  }

  MultiVector StaticModes::normal_attachment(const Component component) const
  {
    return restricted(model, component, normal_attachment(), component == Component::disc ? 1. : -1.);
  }

  MultiVector StaticModes::rubbing_attachment(const double friction_coefficient) const
  {
    MultiVector result = normal_attachment();
    result += friction_coefficient * tangential_attachment();
    return result;
  }

  const MultiVector &StaticModes::constraint(const Component component) const
  {
    auto &modes = constraints[component == Component::disc ? 0 : 1];
    if (!modes)
      modes = std::make_unique<MultiVector>(constraint_modes(component));
    return *modes;
  }

  MultiVector StaticModes::constraint_modes(const Component component) const
  {
    const bool disc = component == Component::disc;
    const auto T    = component_kernel(model, interface, component, ContactBoundary::sliding);

    // Rigid-body motions that neither mounts nor rigid faces resist
    std::optional<MultiVector> motions;
    if (const MultiVector *N = response.rigid_body_modes(); disc && N != nullptr)
      if (const auto sliding = contact_motions(*contact.normal, *N).sliding)
        motions = coordinates(*T, *sliding);

    // u = u_0 + T q with u_0 = n at one node and TᵀK (u_0 + T q) = 0
    MultiVector u = restricted(model, component, transpose_times(*contact.normal, unit_vectors(contact.normal->rows())), disc ? 1. : -1.);
    const InertiaRelief sliding(congruence(*system.stiffness, *T), congruence(*system.mass, *T), motions, largest_circular_frequency,
                                library,
                                disc ? "stiffness of the disc with sliding contact" : "stiffness of the pins with sliding contact");
    MultiVector         forces = transpose_times(*T, *system.stiffness * u);
    forces *= -1.;
    u += *T * sliding.solve(forces);
    return u;
  }

  MultiVector friction_response(const CoupledSystem &system, const UpdatedInverse &inverse, const MultiVector &real_modes, const Side side)
  {
    const auto V_K = normal_reactions(system, 0.);
    if (!V_K)
      return MultiVector(real_modes.map(), real_modes.n_columns());
    if (side == Side::right)
      return inverse.attachment_modes_times(replicate(*V_K * real_modes));
    return inverse.solve_frictionless(transpose_times(*V_K, *system.friction_forces->sparse_transpose() * real_modes));
  }

  MultiVector damping_response(const CoupledSystem  &system,
                               const UpdatedInverse &inverse,
                               const MultiVector    &real_modes,
                               std::optional<double> friction_coefficient)
  {
    if (!system.has_damping())
      throw SolverError("the system has no damping", "response of the real modes to damping",
                        "set Operation/Radial dissipation or the Rayleigh coefficients of a material, or omit this response");
    return inverse.solve_frictionless(
      times(system.terms, friction_coefficient ? system.at(*friction_coefficient) : system.values, 1, real_modes));
  }
} // namespace Squeal
