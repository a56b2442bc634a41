#include <squeal/model/cell_integrals.h>
#include <squeal/model/cell_stiffness.h>
#include <squeal/model/elasticity.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <functional>
#include <map>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    /// Refuses an element that is turned inside out, as curved edges can do where straight ones do not.
    void check_orientation(const FEValues<3> &values, const std::string &component)
    {
      for (unsigned int q = 0; q < values.n_quadrature_points; ++q)
        if (!(values.JxW(q) > 0.))
          throw MeshError("the element is inverted: its Jacobian is not positive everywhere",
                          text("component ", component, ", element with centre (", values.get_cell()->center(), ") m"),
                          "make the elements at curved boundaries smaller, e.g. by Geometry/Nodes per pin face or "
                          "Geometry/Element size, or choose another Discretization/Element than quadratic");
    }

    /// ∫ of an integrand(i, j, q) over one cell, of shape functions of the same direction.
    template <typename Integrand>
    void integrate(const FEValues<3> &values, FullMatrix<double> &matrix, const Integrand &integrand)
    {
      const auto &fe = values.get_fe();
      matrix         = 0.;
      for (const unsigned int q : values.quadrature_point_indices())
        for (const unsigned int i : values.dof_indices())
          for (const unsigned int j : values.dof_indices())
            if (fe.system_to_component_index(i).first == fe.system_to_component_index(j).first)
              matrix(i, j) += integrand(i, j, q) * values.JxW(q);
    }

    enum Direction
    {
      radial,
      tangential,
      axial
    };

    /// Adds ∫ (e·φ) (e·φ) over one mounted face, e the unit vector of a direction about the z axis.
    void integrate_mount(const FEFaceValues<3> &values, const int direction, FullMatrix<double> &K)
    {
      const auto &fe = values.get_fe();
      for (unsigned int q = 0; q < values.n_quadrature_points; ++q)
        {
          const Point<3>    &x = values.quadrature_point(q);
          const double       r = std::hypot(x[0], x[1]);
          const Tensor<1, 3> e = direction == axial      ? Tensor<1, 3>({0., 0., 1.}) :
                                 direction == tangential ? Tensor<1, 3>({-x[1] / r, x[0] / r, 0.}) :
                                                           Tensor<1, 3>({x[0] / r, x[1] / r, 0.});
          for (unsigned int i = 0; i < fe.n_dofs_per_cell(); ++i)
            for (unsigned int j = 0; j < fe.n_dofs_per_cell(); ++j)
              K(i, j) += e[fe.system_to_component_index(i).first] * e[fe.system_to_component_index(j).first] * values.shape_value(i, q) *
                         values.shape_value(j, q) * values.JxW(q);
        }
    }

    /// Terms of a body: stiffness and mass at unit coefficient, once more as its damping.
    void add_body(BodyTerms &bodies, const Model &model, const types::material_id component, const Material &material)
    {
      const std::string  &name      = model.component_names()[component];
      const CellPredicate belongs   = [component](const Cell &cell) { return cell->material_id() == component; };
      const MakeIntegrals integrals = [&] {
        const auto values = std::make_shared<FEValues<3>>(model.mapping(), model.dof_handler().get_fe(), QGauss<3>(model.degree() + 1),
                                                          update_values | CellStiffness::update_flags(model.element()));
        const auto cell_stiffness    = std::make_shared<CellStiffness>(model.element(), material.poisson_ratio);
        const CellIntegral stiffness = [values, cell_stiffness, &name](const Cell &cell, FullMatrix<double> &K) {
          values->reinit(cell);
          check_orientation(*values, name);
          cell_stiffness->integrate(*values, K);
        };
        // The values are those of the cell whose stiffness has been integrated
        const CellIntegral mass = [values](const Cell &, FullMatrix<double> &M) {
          integrate(*values, M,
                    [&values](const auto i, const auto j, const auto q) { return values->shape_value(i, q) * values->shape_value(j, q); });
        };
        return std::vector{stiffness, mass};
      };
      const auto  matrices = assemble_cells(model, belongs, integrals);
      const auto &K = matrices[0], &M = matrices[1];

      const std::string young = BodyParameter::young_modulus(name), density = BodyParameter::density(name),
                        alpha = BodyParameter::rayleigh_alpha(name), beta = BodyParameter::rayleigh_beta(name);
      bodies.terms.push_back(sparse_term("stiffness, " + name, 0, {1., {{young, 1}}}, K));
      bodies.terms.push_back(sparse_term("mass, " + name, 2, {1., {{density, 1}}}, M));
      bodies.terms.push_back(sparse_term("damping by stiffness, " + name, 1, {1., {{beta, 1}, {young, 1}}}, K));
      bodies.terms.push_back(sparse_term("damping by mass, " + name, 1, {1., {{alpha, 1}, {density, 1}}}, M));
    }

    /// K_e of a mounted surface in a direction.
    std::shared_ptr<const SparseMatrix> mount_matrix(const Model &model, const std::string &surface, const int direction)
    {
      const auto is_mounted = [&ids = model.surface_ids(surface)](const Cell &cell, const unsigned int f) {
        return cell->at_boundary(f) && ids.count(cell->face(f)->boundary_id()) > 0;
      };
      const CellPredicate has_mount = [&](const Cell &cell) {
        const auto faces = cell->face_indices();
        return std::any_of(faces.begin(), faces.end(), [&](const unsigned int f) { return is_mounted(cell, f); });
      };
      const MakeIntegrals integrals = [&] {
        const auto values = std::make_shared<FEFaceValues<3>>(model.mapping(), model.dof_handler().get_fe(), QGauss<2>(model.degree() + 1),
                                                              update_values | update_quadrature_points | update_JxW_values);
        return std::vector<CellIntegral>{[values, direction, is_mounted](const Cell &cell, FullMatrix<double> &K) {
          K = 0.;
          for (const unsigned int f : cell->face_indices())
            if (is_mounted(cell, f))
              {
                values->reinit(cell, f);
                integrate_mount(*values, direction, K);
              }
        }};
      };
      return assemble_cells(model, has_mount, integrals)[0];
    }
  } // namespace

  namespace BodyParameter
  {
    std::string young_modulus(const std::string &body)
    {
      return "Young's modulus, " + body;
    }

    std::string density(const std::string &body)
    {
      return "density, " + body;
    }

    std::string rayleigh_alpha(const std::string &body)
    {
      return "Rayleigh alpha, " + body;
    }

    std::string rayleigh_beta(const std::string &body)
    {
      return "Rayleigh beta, " + body;
    }
  } // namespace BodyParameter

  std::vector<MountParameter> mount_parameters(const MaterialParameters &materials)
  {
    constexpr const char       *directions[] = {"radial", "tangential", "axial"};
    std::vector<MountParameter> result;
    const auto add = [&](const std::vector<Mount> &mounts, const char *list, const char *quantity, const char *unit, const int power) {
      for (const Mount &mount : mounts)
        for (const int d : {radial, tangential, axial})
          if (const double value = mount.along(d); value != 0.)
            result.push_back({text(directions[d], ' ', quantity, ", ", mount.surface),
                              text("Mounts/", list, ": ", mount.surface, ' ', directions[d]), unit, value, power, mount.surface, d});
    };
    add(materials.mounts, "Elastic mounts", "stiffness", "N/m^3", 0);
    add(materials.dashpots, "Dashpots", "dashpots", "N s/m^3", 1);
    return result;
  }

  ParameterValues body_values(const Model &model, const MaterialParameters &materials)
  {
    ParameterValues result;
    for (const std::string &body : model.component_names())
      {
        const Material material                     = materials.of(body);
        result[BodyParameter::young_modulus(body)]  = {material.young_modulus};
        result[BodyParameter::density(body)]        = {material.density};
        result[BodyParameter::rayleigh_alpha(body)] = {material.rayleigh_alpha};
        result[BodyParameter::rayleigh_beta(body)]  = {material.rayleigh_beta};
      }
    for (const MountParameter &mount : mount_parameters(materials))
      result[mount.name] = {mount.value};
    return result;
  }

  BodyTerms body_terms(const Model &model, const MaterialParameters &materials)
  {
    BodyTerms bodies{{}, body_values(model, materials)};
    for (unsigned int component = 0; component < model.component_names().size(); ++component)
      add_body(bodies, model, component, materials.of(model.component_names()[component]));
    std::map<std::pair<std::string, int>, std::shared_ptr<const SparseMatrix>> matrices; // springs and dashpots of a surface share theirs
    for (const MountParameter &mount : mount_parameters(materials))
      {
        auto &matrix = matrices[{mount.surface, mount.direction}];
        if (!matrix)
          matrix = mount_matrix(model, mount.surface, mount.direction);
        bodies.terms.push_back(
          sparse_term("mount, " + mount.name, mount.power, {1., {{mount.name, 1}}}, matrix, Symmetry::symmetric, TermKind::mount));
      }
    return bodies;
  }

  void add_rotation(BodyTerms &bodies, const Model &model, const double angular_velocity)
  {
    const CellPredicate is_disc   = [](const Cell &cell) { return cell->material_id() == 0; };
    const MakeIntegrals integrals = [&model] {
      const auto values = std::make_shared<FEValues<3>>(model.mapping(), model.dof_handler().get_fe(), QGauss<3>(model.degree() + 1),
                                                        update_values | update_gradients | update_quadrature_points | update_JxW_values);
      const auto turned = [values](const unsigned int i, const unsigned int q) { // ∂_θ of a shape function
        const Point<3> &x = values->quadrature_point(q);
        return x[0] * values->shape_grad(i, q)[1] - x[1] * values->shape_grad(i, q)[0];
      };
      const CellIntegral gyroscopic = [values, turned](const Cell &cell, FullMatrix<double> &G) {
        values->reinit(cell);
        integrate(*values, G, [&](const auto i, const auto j, const auto q) {
          return values->shape_value(i, q) * turned(j, q) - turned(i, q) * values->shape_value(j, q);
        });
      };
      const CellIntegral convective = [values, turned](const Cell &, FullMatrix<double> &N) {
        integrate(*values, N, [&](const auto i, const auto j, const auto q) { return turned(i, q) * turned(j, q); });
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
