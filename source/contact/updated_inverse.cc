#include <squeal/contact/updated_inverse.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/linear_algebra/sparse.h>

namespace Squeal
{
  UpdatedInverse::UpdatedInverse(const CoupledSystem &system, const double shift, const FactorizationLibrary library)
  {
    V      = pencil_at({system.normal_mass, system.normal_damping, system.normal_stiffness}, shift);
    factor = factorize_positive_definite(*pencil_at(system.frictionless, shift), library, "stiffness of the coupled system without friction");

    const MultiVector A = *system.friction_forces * unit_vectors(system.friction_forces->DomainMap());
    X                   = std::make_unique<MultiVector>(A.Map(), A.NumVectors());
    factor->apply(A, *X);
    VX = replicate(*V * *X);
  }

  void UpdatedInverse::set_friction_coefficient(const double mu)
  {
    friction_coefficient = mu;
    correction           = std::make_unique<DenseLU>(add(identity(VX.n_rows()), VX, -mu),
                                           "stiffness with friction, condensed to the contact nodes");
  }

  void UpdatedInverse::apply(const MultiVector &B, MultiVector &Y) const
  {
    factor->apply(B, Y);
    if (friction_coefficient == 0.)
      return;
    DenseMatrix reactions = replicate(*V * Y);
    correction->solve(reactions);
    multiply_add(friction_coefficient, *X, reactions, 1., Y);
  }

  void UpdatedInverse::apply_frictionless(const MultiVector &B, MultiVector &Y) const
  {
    factor->apply(B, Y);
  }

  const Epetra_Map &UpdatedInverse::map() const
  {
    return factor->map();
  }

  const MultiVector &UpdatedInverse::attachment_modes() const
  {
    return *X;
  }

  const Factorization &UpdatedInverse::frictionless() const
  {
    return *factor;
  }
} // namespace Squeal
