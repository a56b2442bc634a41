#include <squeal/contact/coupled_system.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/linear_algebra/sparse.h>

#include <Epetra_Vector.h>

#include <algorithm>
#include <complex>

namespace Squeal
{
  namespace
  {
    using Matrix = std::shared_ptr<const SparseMatrix>;

    bool all_zero(const std::vector<double> &coefficients)
    {
      return std::all_of(coefficients.begin(), coefficients.end(), [](const double c) { return c == 0.; });
    }

    Epetra_Vector on_map(const Epetra_Map &map, const std::vector<double> &values)
    {
      Epetra_Vector result(map);
      for (int i = 0; i < result.MyLength(); ++i)
        result[i] = values[map.GID(i)];
      return result;
    }

    /// Pᵀ diag(c) P; null if all c vanish.
    Matrix damping_along(const SparseMatrix &P, const std::vector<double> &coefficients)
    {
      if (all_zero(coefficients))
        return nullptr;

      SparseMatrix scaled(P);
      scaled.LeftScale(on_map(P.RowMap(), coefficients));
      return multiply(P, scaled, true, false);
    }

    /// A + B; a missing one counts as zero.
    Matrix sum(const Matrix &A, const Matrix &B)
    {
      if (A && B)
        return add(1., *A, 1., *B);
      return A ? A : B;
    }
  } // namespace

  bool ContactDamping::is_zero() const
  {
    return all_zero(radial) && all_zero(sliding);
  }

  const Epetra_Map &CoupledSystem::map() const
  {
    return frictionless.stiffness->RowMap();
  }

  bool CoupledSystem::has_damping() const
  {
    return frictionless.damping || modal_damping;
  }

  MultiVector CoupledSystem::damping_times(const MultiVector &X) const
  {
    if (!modal_damping)
      return *frictionless.damping * X;
    MultiVector result = *modal_damping * X;
    if (frictionless.damping)
      result.Update(1., *frictionless.damping * X, 1.);
    return result;
  }

  std::shared_ptr<const SparseMatrix> contact_damping(const ContactOperators &contact, const ContactDamping &damping)
  {
    return sum(damping_along(*contact.radial, damping.radial), damping_along(*contact.tangential, damping.sliding));
  }

  CoupledSystem couple(const SecondOrderSystem &system, const ContactOperators &contact, const ContactDamping &damping)
  {
    const SparseMatrix &T_c = *contact.kernel;

    CoupledSystem coupled;
    coupled.kernel                 = contact.kernel;
    coupled.frictionless.mass      = congruence(*system.mass, T_c);
    coupled.frictionless.stiffness = congruence(*system.stiffness, T_c);
    if (system.damping)
      coupled.body_damping = congruence(*system.damping, T_c);

    coupled.friction_forces = multiply(T_c, *contact.tangential, true, true);
    coupled.radial_motion   = multiply(*contact.radial, T_c, false, false);
    const auto half_reaction = [&](const SparseMatrix &matrix) {
      auto V = multiply(*multiply(*contact.normal, matrix, false, false), T_c, false, false);
      V->Scale(0.5);
      return V;
    };
    coupled.normal_stiffness = half_reaction(*system.stiffness);
    if (system.damping)
      coupled.normal_damping = half_reaction(*system.damping);
    coupled.normal_mass = half_reaction(*system.mass);
    return with_contact_damping(coupled, damping);
  }

  CoupledSystem with_contact_damping(const CoupledSystem &system, const ContactDamping &damping)
  {
    CoupledSystem result   = system;
    result.contact_damping = damping;
    Matrix along_t;
    if (!all_zero(damping.sliding))
      {
        const SparseMatrix &A = *system.friction_forces;
        SparseMatrix        scaled(A);
        scaled.RightScale(on_map(A.DomainMap(), damping.sliding));
        along_t = multiply(scaled, A, false, true);
      }
    result.frictionless.damping = sum(system.body_damping, sum(damping_along(*system.radial_motion, damping.radial), along_t));
    return result;
  }

  CoupledSystem undamped(const CoupledSystem &system)
  {
    CoupledSystem result        = system;
    result.frictionless.damping = nullptr;
    result.body_damping         = nullptr;
    result.normal_damping       = nullptr;
    result.modal_damping        = nullptr;
    result.contact_damping      = {};
    return result;
  }

  SecondOrderSystem with_friction(const CoupledSystem &system, const double mu)
  {
    SecondOrderSystem result = system.frictionless;
    if (mu == 0.)
      return result;
    const auto friction = [&](const SparseMatrix &V) { return multiply(*system.friction_forces, V, false, false); };
    result.stiffness = add(1., *system.frictionless.stiffness, -mu, *friction(*system.normal_stiffness));
    if (system.normal_damping)
      result.damping = add(1., *system.frictionless.damping, -mu, *friction(*system.normal_damping));
    result.mass = add(1., *system.frictionless.mass, -mu, *friction(*system.normal_mass));
    return result;
  }

  std::shared_ptr<const SparseMatrix> pencil_at(const SecondOrderSystem &system, const double shift)
  {
    if (shift == 0.)
      return system.stiffness;
    std::shared_ptr<const SparseMatrix> result = add(1., *system.stiffness, shift * shift, *system.mass);
    if (system.damping)
      result = add(1., *result, shift, *system.damping);
    return result;
  }

  void normal_reactions(const CoupledSystem                     &system,
                        const std::vector<std::complex<double>> &lambda,
                        const MultiVector                       &real_part,
                        const MultiVector                       &imaginary_part,
                        DenseMatrix                             &reaction_real,
                        DenseMatrix                             &reaction_imaginary)
  {
    using Complex = std::complex<double>;

    const DenseMatrix K_re = replicate(*system.normal_stiffness * real_part), K_im = replicate(*system.normal_stiffness * imaginary_part);
    const DenseMatrix M_re = replicate(*system.normal_mass * real_part), M_im = replicate(*system.normal_mass * imaginary_part);
    DenseMatrix       C_re, C_im;
    if (system.normal_damping)
      {
        C_re = replicate(*system.normal_damping * real_part);
        C_im = replicate(*system.normal_damping * imaginary_part);
      }
    reaction_real      = K_re;
    reaction_imaginary = K_im;
    for (int j = 0; j < K_re.n_columns(); ++j)
      {
        const Complex square = lambda[j] * lambda[j];
        for (int i = 0; i < K_re.n_rows(); ++i)
          {
            Complex r = Complex(K_re(i, j), K_im(i, j)) + square * Complex(M_re(i, j), M_im(i, j));
            if (system.normal_damping)
              r += lambda[j] * Complex(C_re(i, j), C_im(i, j));
            reaction_real(i, j)      = r.real();
            reaction_imaginary(i, j) = r.imag();
          }
      }
  }
} // namespace Squeal
