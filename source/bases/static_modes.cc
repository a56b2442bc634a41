#include <squeal/base/exceptions.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/bases/static_modes.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/linear_algebra/sparse.h>

#include <vector>

namespace Squeal
{
  namespace
  {
    bool belongs_to(const Node &node, const Component component)
    {
      return (node.component == 0) == (component == Component::disc);
    }

    /// X with the rows of the other component at zero, times @p factor.
    MultiVector restricted(const Model &model, const Component component, const MultiVector &X, const double factor)
    {
      MultiVector result(X.Map(), X.NumVectors());
      for (const Node &node : model.nodes())
        if (belongs_to(node, component))
          for (const int dof : node.dofs)
            if (const int i = dof >= 0 ? X.Map().LID(dof) : -1; i >= 0)
              for (int j = 0; j < X.NumVectors(); ++j)
                result[j][i] = factor * X[j][i];
      return result;
    }

    /// Pᵀ as vectors, n × n_c.
    MultiVector transposed(const SparseMatrix &P)
    {
      return transpose_times(P, unit_vectors(P.RangeMap()));
    }
  } // namespace

  StaticModes::StaticModes(const Model               &model,
                           const ContactInterface    &interface,
                           const ContactOperators    &contact,
                           const SecondOrderSystem   &system,
                           const StaticResponse      &response,
                           const double               largest_circular_frequency,
                           const FactorizationLibrary library)
    : model(model)
    , interface(interface)
    , contact(contact)
    , system(system)
    , response(response)
    , largest_circular_frequency(largest_circular_frequency)
    , library(library)
  {}

  const MultiVector &StaticModes::normal_attachment() const
  {
    if (!normal)
      normal = std::make_unique<MultiVector>(response.solve(transposed(*contact.normal)));
    return *normal;
  }

  const MultiVector &StaticModes::tangential_attachment() const
  {
    if (!tangential)
      tangential = std::make_unique<MultiVector>(response.solve(transposed(*contact.tangential)));
    return *tangential;
  }

  MultiVector StaticModes::normal_attachment(const Component component) const
  {
    return restricted(model, component, normal_attachment(), component == Component::disc ? 1. : -1.);
  }

  MultiVector StaticModes::rubbing_attachment(const double friction_coefficient) const
  {
    MultiVector result = normal_attachment();
    result.Update(friction_coefficient, tangential_attachment(), 1.);
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
    const bool        disc = component == Component::disc;
    std::vector<bool> selected(model.component_names().size());
    for (std::size_t c = 0; c < selected.size(); ++c)
      selected[c] = (c == 0) == disc;
    const auto T = component_kernel(model, interface, selected, ContactBoundary::sliding);

    // Motions that neither the mounts nor the rigid faces resist
    std::optional<MultiVector> motions;
    if (const MultiVector *N = response.rigid_body_modes(); disc && N != nullptr)
      if (const auto sliding = contact_motions(*contact.normal, *N).sliding)
        motions = coordinates(*T, *sliding);

    // u = u_0 + T q, u_0 = n at one node; TᵀK (u_0 + T q) = 0
    MultiVector         u = restricted(model, component, transposed(*contact.normal), disc ? 1. : -1.);
    const InertiaRelief sliding(congruence(*system.stiffness, *T), congruence(*system.mass, *T), motions, largest_circular_frequency,
                                library,
                                disc ? "stiffness of the disc with sliding contact" : "stiffness of the pins with sliding contact");
    MultiVector         forces = transpose_times(*T, *system.stiffness * u);
    forces.Scale(-1.);
    u.Update(1., *T * sliding.solve(forces), 1.);
    return u;
  }

  const MultiVector *StaticModes::rigid_body_modes() const
  {
    return response.rigid_body_modes();
  }

  int StaticModes::n_contact() const
  {
    return contact.normal->NumGlobalRows();
  }

  MultiVector friction_response(const CoupledSystem &system, const UpdatedInverse &inverse, const MultiVector &real_modes, const Side side)
  {
    const auto V_K = normal_reactions(system, 0);
    if (!V_K)
      return MultiVector(real_modes.Map(), real_modes.NumVectors());
    if (side == Side::right)
      return inverse.attachment_modes() * replicate(*V_K * real_modes);
    return inverse.solve_frictionless(transpose_times(*V_K, *system.friction_forces->sparse_transpose() * real_modes));
  }

  MultiVector damping_response(const CoupledSystem  &system,
                               const UpdatedInverse &inverse,
                               const MultiVector    &real_modes,
                               const double          friction_coefficient)
  {
    if (!system.has_damping())
      throw SolverError("there is no damping to respond to", "response of the real modes to damping",
                        "set Operation/Radial dissipation or the Rayleigh coefficients of a material, or leave this response out");
    return inverse.solve_frictionless(times(system.terms, system.at(friction_coefficient), 1, real_modes));
  }
} // namespace Squeal
