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
    /// Pᵀ diag(c) P; null if all c vanish.
    std::shared_ptr<const SparseMatrix> damping_along(const SparseMatrix &P, const std::vector<double> &coefficients)
    {
      if (std::all_of(coefficients.begin(), coefficients.end(), [](const double c) { return c == 0.; }))
        return nullptr;

      Epetra_Vector c(P.RowMap());
      for (int i = 0; i < c.MyLength(); ++i)
        c[i] = coefficients[P.RowMap().GID(i)];
      SparseMatrix scaled(P);
      scaled.LeftScale(c);
      return multiply(P, scaled, true, false);
    }
  } // namespace

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

  std::shared_ptr<const SparseMatrix>
  contact_damping(const ContactOperators &contact, const std::vector<double> &c_b, const std::vector<double> &c_t)
  {
    const auto along_b = damping_along(*contact.radial, c_b), along_t = damping_along(*contact.tangential, c_t);
    if (along_b && along_t)
      return add(1., *along_b, 1., *along_t);
    return along_b ? along_b : along_t;
  }

  CoupledSystem couple(const SecondOrderSystem                   &system,
                       const ContactOperators                    &contact,
                       const std::shared_ptr<const SparseMatrix> &contact_damping)
  {
    const SparseMatrix &T_c = *contact.kernel;

    CoupledSystem coupled;
    coupled.kernel                 = contact.kernel;
    coupled.frictionless.mass      = congruence(*system.mass, T_c);
    coupled.frictionless.stiffness = congruence(*system.stiffness, T_c);
    std::shared_ptr<const SparseMatrix> damping = system.damping;
    if (contact_damping)
      damping = damping ? add(1., *damping, 1., *contact_damping) : contact_damping;
    if (damping)
      coupled.frictionless.damping = congruence(*damping, T_c);

    coupled.friction_forces = multiply(T_c, *contact.tangential, true, true);
    const auto half_reaction = [&](const SparseMatrix &matrix) {
      auto V = multiply(*multiply(*contact.normal, matrix, false, false), T_c, false, false);
      V->Scale(0.5);
      return V;
    };
    coupled.normal_stiffness = half_reaction(*system.stiffness);
    if (system.damping)
      coupled.normal_damping = half_reaction(*system.damping);
    coupled.normal_mass = half_reaction(*system.mass);
    return coupled;
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
