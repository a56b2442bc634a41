#include <squeal/model/cell_integrals.h>
#include <squeal/model/rotation.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    /// ∫ of a function of N_i, ∂_θ N_i, N_j and ∂_θ N_j for shape functions of the same direction.
    template <typename Integrand>
    void integrate(const FEValues<3> &values, FullMatrix<double> &matrix, const Integrand &integrand)
    {
      const auto &fe = values.get_fe();
      matrix         = 0.;
      for (const unsigned int q : values.quadrature_point_indices())
        {
          const Point<3> &x         = values.quadrature_point(q);
          const auto      turned_by = [&](const unsigned int i) {
            return x[0] * values.shape_grad(i, q)[1] - x[1] * values.shape_grad(i, q)[0];
          };
          for (const unsigned int i : values.dof_indices())
            for (const unsigned int j : values.dof_indices())
              if (fe.system_to_component_index(i).first == fe.system_to_component_index(j).first)
                matrix(i, j) += integrand(values.shape_value(i, q), turned_by(i), values.shape_value(j, q), turned_by(j)) * values.JxW(q);
        }
    }
  } // namespace

  void add_rotation(BodyTerms &bodies, const Model &model, const double angular_velocity)
  {
    const CellPredicate is_disc   = [](const Cell &cell) { return cell->material_id() == 0; };
    const MakeIntegrals integrals = [&model] {
      const auto values = std::make_shared<FEValues<3>>(model.mapping(), model.dof_handler().get_fe(), QGauss<3>(model.degree() + 1),
                                                        update_values | update_gradients | update_quadrature_points | update_JxW_values);
      const CellIntegral gyroscopic = [values](const Cell &cell, FullMatrix<double> &G) {
        values->reinit(cell);
        integrate(*values, G,
                  [](const double v, const double turned_v, const double u, const double turned_u) { return v * turned_u - turned_v * u; });
      };
      const CellIntegral convective = [values](const Cell &, FullMatrix<double> &N) {
        integrate(*values, N, [](double, const double turned_v, double, const double turned_u) { return turned_v * turned_u; });
      };
      return std::vector{gyroscopic, convective};
    };
    const auto matrices = assemble_cells(model, is_disc, integrals);

    const std::string speed = BodyParameter::angular_velocity, density = BodyParameter::density(model.component_names().front());
    bodies.values[speed] = {angular_velocity};
    bodies.terms.push_back(
      sparse_term("gyroscopic forces of the disc", 1, {1., {{density, 1}, {speed, 1}}}, matrices[0], Symmetry::skew, TermKind::rotation));
    bodies.terms.push_back(sparse_term("convective stiffness of the disc", 0, {-1., {{density, 1}, {speed, 2}}}, matrices[1],
                                       Symmetry::symmetric, TermKind::rotation));
  }
} // namespace Squeal
