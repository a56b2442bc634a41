#include <squeal/linear_algebra/replicate.h>
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
        : component(model.free_map().n())
        , n_components(model.component_names().size())
        , re(real_part)
        , im(imaginary_part)
        , u(joined(real_part, imaginary_part))
      {
        for (const Node &node : model.nodes())
          for (const int dof : node.dofs)
            if (dof >= 0)
              component[dof] = node.component;
      }

      std::vector<double> of(const std::shared_ptr<const SparseMatrix> &A) const
      {
        std::vector<double> result(n_components, 0.);
        if (!A)
          return result;
        const std::vector<Complex> Au = joined(*A * re, *A * im);
        for (std::size_t i = 0; i < u.size(); ++i)
          result[component[i]] += (std::conj(u[i]) * Au[i]).real();
        return result;
      }

      /// Displacement of a node along a direction.
      Complex along(const Eigen::Vector3d &direction, const Node &node) const
      {
        Complex result = 0.;
        for (int d = 0; d < 3; ++d)
          if (node.dofs[d] >= 0)
            result += direction[d] * u[node.dofs[d]];
        return result;
      }

    private:
      static std::vector<Complex> joined(const MultiVector &real_part, const MultiVector &imaginary_part)
      {
        const DenseMatrix    x = replicate(real_part), y = replicate(imaginary_part);
        std::vector<Complex> result;
        for (Eigen::Index i = 0; i < x.rows(); ++i)
          result.emplace_back(x(i, 0), y(i, 0));
        return result;
      }

      std::vector<unsigned int>  component;
      const std::size_t          n_components;
      const MultiVector         &re, &im;
      const std::vector<Complex> u;
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
        if (term.name == SystemParameter::modal_damping)
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
    const MultiVector    re = *coupled.kernel * real_part, im = *coupled.kernel * imaginary_part;
    const QuadraticForms forms(model, re, im);
    const auto           reactions = normal_reactions(coupled, {lambda}, real_part, imaginary_part);
    const double         speed     = std::norm(lambda); // |λ|²
    const double         energy    = (speed * total(forms.of(bodies.mass)) + total(forms.of(bodies.stiffness))) / 4.;
    const double         to_rate   = 1. / (2. * lambda.imag() * energy); // from a power

    PowerBalance result;
    result.bodies = forms.of(bodies.damping);
    for (double &body : result.bodies)
      body *= -0.5 * speed * to_rate;
    result.modal_damping = -0.5 * speed * modal_damping(coupled, real_part, imaginary_part) * to_rate;
    for (std::size_t node = 0; node < interface.size(); ++node)
      {
        const ContactNode &pair = interface[node];
        const Node        &disc = model.nodes()[pair.disc_node], &pin = model.nodes()[pair.pin_node];
        const Complex      along_t_of_disc = forms.along(pair.sliding, disc), along_t_of_pin = forms.along(pair.sliding, pin);
        const Complex      along_b  = forms.along(pair.radial, disc) - forms.along(pair.radial, pin);
        const auto         friction = [&](const Complex &displacement) {
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
