#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/modes/power_balance.h>

#include <numeric>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Re(uᴴ A u) of the dofs of each component.
    class QuadraticForms
    {
    public:
      QuadraticForms(const Model &model, const MultiVector &real_part, const MultiVector &imaginary_part)
        : component(model.free_map().n_local())
        , n_components(model.component_names().size())
        , re(real_part)
        , im(imaginary_part)
      {
        for (const Node &node : model.nodes())
          for (const int dof : node.dofs)
            if (const int i = model.free_map().place(dof); i >= 0)
              component[i] = node.component;
      }

      std::vector<double> of(const std::shared_ptr<const SparseMatrix> &A) const
      {
        std::vector<double> result(n_components, 0.);
        if (!A)
          return result;
        const MultiVector A_re = *A * re, A_im = *A * im;
        for (int i = 0; i < re.n_local_rows(); ++i)
          result[component[i]] += re(i, 0) * A_re(i, 0) + im(i, 0) * A_im(i, 0);
        sum_over_processes(re.communicator(), result.data(), result.size());
        return result;
      }

    private:
      std::vector<unsigned int> component; ///< of the rows of this process
      const std::size_t         n_components;
      const MultiVector        &re, &im;
    };

    /// Displacements of both nodes of every contact pair, on every process.
    class ContactDisplacements
    {
    public:
      ContactDisplacements(const Model            &model,
                           const ContactInterface &interface,
                           const MultiVector      &real_part,
                           const MultiVector      &imaginary_part)
        : values(12, DenseMatrix::Index(interface.size()))
      {
        values.setZero();
        const auto add = [&](const Node &node, const int first_row, const std::size_t pair) {
          for (int d = 0; d < 3; ++d)
            if (const int i = real_part.map().place(node.dofs[d]); i >= 0)
              {
                values(first_row + d, pair)     = real_part(i, 0);
                values(first_row + 3 + d, pair) = imaginary_part(i, 0);
              }
        };
        for (std::size_t pair = 0; pair < interface.size(); ++pair)
          {
            add(interface[pair].disc_node, 0, pair);
            add(interface[pair].pin_node, 6, pair);
          }
        sum_over_processes(model.communicator(), values.data(), values.size());
      }

      Complex of_disc(const Eigen::Vector3d &direction, const std::size_t pair) const
      {
        return along(direction, 0, pair);
      }

      Complex of_pin(const Eigen::Vector3d &direction, const std::size_t pair) const
      {
        return along(direction, 6, pair);
      }

    private:
      Complex along(const Eigen::Vector3d &direction, const int first_row, const std::size_t pair) const
      {
        return {direction.dot(values.col(pair).segment<3>(first_row)), direction.dot(values.col(pair).segment<3>(first_row + 3))};
      }

      DenseMatrix values; ///< real and imaginary parts of the disc's node, then those of the pin's, pair by pair
    };

    double total(const std::vector<double> &values)
    {
      return std::accumulate(values.begin(), values.end(), 0.);
    }

    /// φᴴ C_m φ
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
    const MultiVector          re = *coupled.kernel * real_part, im = *coupled.kernel * imaginary_part;
    const QuadraticForms       forms(model, re, im);
    const ContactDisplacements displacements(model, interface, re, im);
    const auto                 reactions = normal_reactions(coupled, {lambda}, real_part, imaginary_part);
    const double               speed     = std::norm(lambda); // |λ|²
    const double               energy    = (speed * total(forms.of(bodies.mass)) + total(forms.of(bodies.stiffness))) / 4.;
    const double               to_rate   = 1. / (2. * lambda.imag() * energy); // from a power

    PowerBalance result;
    result.bodies = forms.of(bodies.damping);
    for (double &body : result.bodies)
      body *= -0.5 * speed * to_rate;
    result.modal_damping = -0.5 * speed * modal_damping(coupled, real_part, imaginary_part) * to_rate;
    for (std::size_t node = 0; node < interface.size(); ++node)
      {
        const ContactNode &pair            = interface[node];
        const Complex      along_t_of_disc = displacements.of_disc(pair.sliding, node),
                      along_t_of_pin       = displacements.of_pin(pair.sliding, node);
        const Complex along_b              = displacements.of_disc(pair.radial, node) - displacements.of_pin(pair.radial, node);
        const auto    friction             = [&](const Complex &displacement) {
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
