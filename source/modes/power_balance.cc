// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/modes/power_balance.h>

#include <numeric>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Re(uᴴ A u) over the dofs of each component; zeros if A is null.
    std::vector<double> forms(const Model                               &model,
                              const std::shared_ptr<const SparseMatrix> &A,
                              const MultiVector                         &re,
                              const MultiVector                         &im)
    {
      std::vector<double> result(model.component_names().size(), 0.);
      if (!A)
        return result;
      const MultiVector A_re = *A * re, A_im = *A * im;
      for (const Node &node : model.nodes())
        for (const int dof : node.dofs)
          if (const int i = model.free_map().place(dof); i >= 0)
            result[node.component] += re(i, 0) * A_re(i, 0) + im(i, 0) * A_im(i, 0);
      sum_over_processes(re.communicator(), result.data(), result.size());
      return result;
    }

    /// Complex displacements of one side of the contact nodes, 3 × n_c, on every process.
    Eigen::Matrix3Xcd displacements(const ContactInterface &interface,
                                    const WeightedNodes ContactNode::*const side,
                                    const MultiVector                      &re,
                                    const MultiVector                      &im)
    {
      Eigen::Matrix3Xcd result = Eigen::Matrix3Xcd::Zero(3, interface.size());
      for (std::size_t n = 0; n < interface.size(); ++n)
        for (const auto &[node, weight] : interface[n].*side)
          for (int d = 0; d < 3; ++d)
            if (const int i = re.map().place(node.dofs[d]); i >= 0)
              result(d, n) += weight * Complex(re(i, 0), im(i, 0));
      sum_over_processes(re.communicator(), reinterpret_cast<double *>(result.data()), 2 * result.size());
      return result;
    }

    double total(const std::vector<double> &values)
    {
      return std::accumulate(values.begin(), values.end(), 0.);
    }

    /// φᴴ C_m φ of the modal damping.
    double modal_damping(const CoupledSystem &coupled, const MultiVector &real_part, const MultiVector &imaginary_part)
    {
      double result = 0.;
      for (const Term &term : coupled.terms)
        if (term.kind == TermKind::modal_damping)
          for (const MultiVector *part : {&real_part, &imaginary_part})
            {
              const DenseMatrix y = term.right->transpose_times(*part);
              result += (y.transpose() * term.weighted(y, coupled.values))(0, 0);
            }
      return result;
    }

    double coefficient(const std::vector<double> &values, const std::size_t node)
    {
      return values.empty() ? 0. : values[node];
    }
  } // namespace

  double PowerBalance::sum() const
  {
    double result = total(bodies) + modal_damping;
    for (std::size_t node = 0; node < into_disc.size(); ++node)
      result += at(node);
    return result;
  }

  PowerBalance power_balance(const SecondOrderSystem    &bodies,
                             const Model                &model,
                             const CoupledSystem        &coupled,
                             const ContactInterface     &interface,
                             const ContactDamping       &damping,
                             const double                friction_coefficient,
                             const std::complex<double> &lambda,
                             const MultiVector          &real_part,
                             const MultiVector          &imaginary_part)
  {
    const MultiVector       re = *coupled.kernel * real_part, im = *coupled.kernel * imaginary_part;
    const Eigen::Matrix3Xcd of_disc = displacements(interface, &ContactNode::on_disc, re, im),
                            of_pin  = displacements(interface, &ContactNode::on_pin, re, im);
    const auto   reactions          = normal_reactions(coupled, {lambda}, real_part, imaginary_part);
    const double speed              = std::norm(lambda); // |λ|²
    const double energy  = (speed * total(forms(model, bodies.mass, re, im)) + total(forms(model, bodies.stiffness, re, im))) / 4.;
    const double to_rate = 1. / (2. * lambda.imag() * energy); // converts a power into a contribution to ξ

    PowerBalance result;
    result.bodies = forms(model, bodies.damping, re, im);
    for (double &body : result.bodies)
      body *= -0.5 * speed * to_rate;
    result.modal_damping = -0.5 * speed * modal_damping(coupled, real_part, imaginary_part) * to_rate;
    for (std::size_t node = 0; node < interface.size(); ++node)
      {
        const Eigen::Vector3d t = interface[node].friction * interface[node].sliding, &b = interface[node].radial;
        const Complex         along_t_of_disc = t.dot(of_disc.col(node)), along_t_of_pin = t.dot(of_pin.col(node)),
                      along_b = b.dot(of_disc.col(node) - of_pin.col(node));
        const auto friction   = [&](const Complex &displacement) {
          return 0.5 * friction_coefficient * (std::conj(lambda * displacement) * reactions(node, 0)).real() * to_rate;
        };
        result.into_disc.push_back(friction(along_t_of_disc));
        result.into_pins.push_back(friction(-along_t_of_pin));
        result.radial_damping.push_back(-0.5 * coefficient(damping.radial, node) * speed * std::norm(along_b) * to_rate);
        result.sliding_damping.push_back(-0.5 * coefficient(damping.sliding, node) * speed * std::norm(along_t_of_disc - along_t_of_pin) *
                                         to_rate);
      }
    return result;
  }
} // namespace Squeal
