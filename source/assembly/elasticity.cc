#include <squeal/assembly/elasticity.h>
#include <squeal/base/exceptions.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <map>
#include <sstream>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    /// Numbers of a cell's free dofs; local positions of the clamped ones are left out.
    struct FreeDofs
    {
      std::vector<TrilinosWrappers::types::int_type> numbers;
      std::vector<unsigned int>                      local;

      void reinit(const Model &model, const std::vector<types::global_dof_index> &cell_dofs)
      {
        numbers.clear();
        local.clear();
        for (unsigned int i = 0; i < cell_dofs.size(); ++i)
          if (const int number = model.free_dof(cell_dofs[i]); number >= 0)
            {
              numbers.push_back(number);
              local.push_back(i);
            }
      }
    };

    void add_to(TrilinosWrappers::SparseMatrix &matrix, const FreeDofs &dofs, const FullMatrix<double> &cell_matrix)
    {
      const unsigned int               n = dofs.numbers.size();
      std::vector<types::global_dof_index> columns(dofs.numbers.begin(), dofs.numbers.end());
      std::vector<double>              values(n);
      for (unsigned int i = 0; i < n; ++i)
        {
          for (unsigned int j = 0; j < n; ++j)
            values[j] = cell_matrix(dofs.local[i], dofs.local[j]);
          matrix.add(columns[i], columns, values);
        }
    }

    /// Refuses an element that is turned inside out, as curved edges can do where straight ones do not.
    void check_orientation(const FEValues<3> &values, const std::string &component)
    {
      for (unsigned int q = 0; q < values.n_quadrature_points; ++q)
        if (!(values.JxW(q) > 0.))
          {
            std::ostringstream where;
            where << "component " << component << ", element with centre (" << values.get_cell()->center() << ") m";
            throw MeshError("the element is inverted: its Jacobian is not positive everywhere", where.str(),
                            "make the elements at curved boundaries smaller, e.g. by Geometry/Nodes per pin face or "
                            "Geometry/Element size, or use Discretization/Degree = 1");
          }
    }

    /// ∫ 2 G ε:ε + Λ div div and ∫ ρ φ·φ over one cell.
    void integrate_cell(const FEValues<3> &values, const Material &material, FullMatrix<double> &K, FullMatrix<double> &M)
    {
      const double G      = material.young_modulus / (2. * (1. + material.poisson_ratio));
      const double Lambda = 2. * G * material.poisson_ratio / (1. - 2. * material.poisson_ratio);
      const auto  &fe     = values.get_fe();
      K                   = 0.;
      M                   = 0.;
      for (unsigned int q = 0; q < values.n_quadrature_points; ++q)
        for (unsigned int i = 0; i < fe.n_dofs_per_cell(); ++i)
          {
            const unsigned int a      = fe.system_to_component_index(i).first;
            const auto        &grad_i = values.shape_grad(i, q);
            for (unsigned int j = 0; j <= i; ++j)
              {
                // For φ_i = N_i e_a, φ_j = N_j e_b:
                // 2 ε:ε = δ_ab ∇N_i·∇N_j + ∂_b N_i ∂_a N_j and div div = ∂_a N_i ∂_b N_j
                const unsigned int b      = fe.system_to_component_index(j).first;
                const auto        &grad_j = values.shape_grad(j, q);
                double             k      = G * grad_i[b] * grad_j[a] + Lambda * grad_i[a] * grad_j[b];
                if (a == b)
                  {
                    k += G * (grad_i * grad_j);
                    M(i, j) += material.density * values.shape_value(i, q) * values.shape_value(j, q) * values.JxW(q);
                  }
                K(i, j) += k * values.JxW(q);
              }
          }
      for (unsigned int i = 0; i < fe.n_dofs_per_cell(); ++i)
        for (unsigned int j = 0; j < i; ++j)
          {
            K(j, i) = K(i, j);
            M(j, i) = M(i, j);
          }
    }

    /// ∫ φ·S φ over one mounted face.
    void integrate_mount(const FEFaceValues<3> &values, const ElasticMount &mount, FullMatrix<double> &K)
    {
      const auto &fe = values.get_fe();
      K              = 0.;
      for (unsigned int q = 0; q < values.n_quadrature_points; ++q)
        {
          const Point<3> &x = values.quadrature_point(q);
          const double    r = std::hypot(x[0], x[1]);
          const Tensor<1, 3> e_r({x[0] / r, x[1] / r, 0.}), e_theta({-x[1] / r, x[0] / r, 0.}), e_z({0., 0., 1.});
          const Tensor<2, 3> S = mount.radial * outer_product(e_r, e_r) + mount.tangential * outer_product(e_theta, e_theta) +
                                 mount.axial * outer_product(e_z, e_z);
          for (unsigned int i = 0; i < fe.n_dofs_per_cell(); ++i)
            for (unsigned int j = 0; j < fe.n_dofs_per_cell(); ++j)
              K(i, j) += S[fe.system_to_component_index(i).first][fe.system_to_component_index(j).first] *
                         values.shape_value(i, q) * values.shape_value(j, q) * values.JxW(q);
        }
    }
  } // namespace

  SecondOrderSystem assemble(const Model &model, const MaterialParameters &materials)
  {
    const auto &dof_handler = model.dof_handler();
    const auto &fe          = dof_handler.get_fe();
    const auto &map         = model.free_map();

    std::map<types::boundary_id, ElasticMount> mounts;
    for (const ElasticMount &mount : materials.mounts)
      mounts[model.surface_id(mount.surface)] = mount;

    const auto material_of = [&materials](const types::material_id component) -> const Material & {
      return component == 0 ? materials.disc : materials.pin;
    };
    const bool damped = materials.disc.is_damped() || materials.pin.is_damped();

    // Sparsity of the free dofs; that of the damping holds only what is damped
    IndexSet owned(map.NumGlobalElements());
    if (map.NumMyElements() > 0)
      owned.add_range(map.MinMyGID(), map.MaxMyGID() + 1);
    TrilinosWrappers::SparsityPattern    pattern(owned, model.communicator()), damping_pattern(owned, model.communicator());
    std::vector<types::global_dof_index> cell_dofs(fe.n_dofs_per_cell());
    FreeDofs                             free;
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          cell->get_dof_indices(cell_dofs);
          free.reinit(model, cell_dofs);
          for (const auto row : free.numbers)
            {
              pattern.add_entries(row, free.numbers.begin(), free.numbers.end());
              if (material_of(cell->material_id()).is_damped())
                damping_pattern.add_entries(row, free.numbers.begin(), free.numbers.end());
            }
        }
    pattern.compress();
    TrilinosWrappers::SparseMatrix stiffness, mass, damping;
    stiffness.reinit(pattern);
    mass.reinit(pattern);
    if (damped)
      {
        damping_pattern.compress();
        damping.reinit(damping_pattern);
      }

    // Cells and their mounted faces
    FEValues<3>        values(model.mapping(), fe, QGauss<3>(model.degree() + 1), update_values | update_gradients | update_JxW_values);
    FEFaceValues<3>    face_values(model.mapping(), fe, QGauss<2>(model.degree() + 1),
                                   update_values | update_quadrature_points | update_JxW_values);
    FullMatrix<double> K(fe.n_dofs_per_cell(), fe.n_dofs_per_cell()), M(K), C(K), K_mount(K);
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          check_orientation(values, model.component_names()[cell->material_id()]);
          const Material &material = material_of(cell->material_id());
          integrate_cell(values, material, K, M);
          cell->get_dof_indices(cell_dofs);
          free.reinit(model, cell_dofs);
          // Before the mounts join the stiffness
          if (material.is_damped())
            {
              C.equ(material.rayleigh_alpha, M, material.rayleigh_beta, K);
              add_to(damping, free, C);
            }
          for (const unsigned int f : cell->face_indices())
            if (const auto it = mounts.find(cell->face(f)->boundary_id()); cell->at_boundary(f) && it != mounts.end())
              {
                face_values.reinit(cell, f);
                integrate_mount(face_values, it->second, K_mount);
                K.add(1., K_mount);
              }
          add_to(stiffness, free, K);
          add_to(mass, free, M);
        }
    stiffness.compress(VectorOperation::add);
    mass.compress(VectorOperation::add);
    if (damped)
      damping.compress(VectorOperation::add);

    const auto copy = [](const TrilinosWrappers::SparseMatrix &matrix) {
      return std::make_shared<SparseMatrix>(static_cast<const SparseMatrix &>(matrix.trilinos_matrix()));
    };
    return {copy(mass), damped ? copy(damping) : nullptr, copy(stiffness)};
  }
} // namespace Squeal
