#include <squeal/model/cell_stiffness.h>
#include <squeal/linear_algebra/dense.h>

#include <Eigen/Cholesky>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int n_modes = 9;

    /// Jacobian of the trilinear map of a cell at its centre.
    Tensor<2, 3> centre_jacobian(const FEValues<3> &values)
    {
      const auto  &cell = values.get_cell();
      Tensor<2, 3> J;
      for (const unsigned int v : cell->vertex_indices())
        for (unsigned int a = 0; a < 3; ++a)
          {
            const double derivative = (v >> a & 1 ? 1. : -1.) / 4.; // vertices are numbered lexicographically
            for (unsigned int i = 0; i < 3; ++i)
              J[i][a] += derivative * cell->vertex(v)[i];
          }
      return J;
    }

    /// Eliminates the last unknowns: the Schur complement of a positive definite matrix.
    void condense(const FullMatrix<double> &full, FullMatrix<double> &condensed)
    {
      const unsigned int n = condensed.m(), m = full.m() - n;
      DenseMatrix        coupling(m, n), modes(m, m);
      for (unsigned int i = 0; i < m; ++i)
        {
          for (unsigned int j = 0; j < n; ++j)
            coupling(i, j) = full(n + i, j);
          for (unsigned int j = 0; j < m; ++j)
            modes(i, j) = full(n + i, n + j);
        }
      // L⁻¹ K_αu: its square is symmetric to the last bit
      const DenseMatrix half = modes.llt().matrixL().solve(coupling);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j <= i; ++j)
          condensed(i, j) = condensed(j, i) = full(i, j) - half.col(i).dot(half.col(j));
    }
  } // namespace

  CellStiffness::CellStiffness(const Element element, const double poisson_ratio)
    : element(element)
    , shear_modulus(1. / (2. * (1. + poisson_ratio)))
    , lame(2. * shear_modulus * poisson_ratio / (1. - 2. * poisson_ratio))
  {}

  UpdateFlags CellStiffness::update_flags(const Element element)
  {
    return update_gradients | update_JxW_values | (element == Element::incompatible_modes ? update_jacobians : update_default);
  }

  void CellStiffness::add_incompatible_modes(const FEValues<3> &values, const unsigned int quadrature_point)
  {
    // deal.II's cell is [0, 1]³: ξ = 2 x̂ − 1
    const Point<3> &x     = values.get_quadrature().point(quadrature_point);
    const double    det_J = values.jacobian(quadrature_point).determinant();
    for (unsigned int a = 0; a < 3; ++a)
      {
        Tensor<1, 3> reference_gradient;
        reference_gradient[a]       = -4. * (2. * x[a] - 1.);
        const Tensor<1, 3> gradient = centre_gradients * reference_gradient / det_J;
        for (unsigned int b = 0; b < 3; ++b)
          displacements.push_back({b, gradient});
      }
  }

  void CellStiffness::integrate(const FEValues<3> &values, FullMatrix<double> &stiffness)
  {
    const auto         &fe        = values.get_fe();
    const bool          has_modes = element == Element::incompatible_modes;
    const unsigned int  n         = fe.n_dofs_per_cell() + (has_modes ? n_modes : 0);
    FullMatrix<double> &K         = has_modes ? with_modes : stiffness;
    if (has_modes)
      {
        const Tensor<2, 3> J0 = centre_jacobian(values);
        centre_gradients      = determinant(J0) * transpose(invert(J0));
        with_modes.reinit(n, n);
      }
    K = 0.;
    for (const unsigned int q : values.quadrature_point_indices())
      {
        displacements.clear();
        for (const unsigned int i : values.dof_indices())
          displacements.push_back({fe.system_to_component_index(i).first, values.shape_grad(i, q)});
        if (has_modes)
          add_incompatible_modes(values, q);
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j <= i; ++j)
            {
              // For φ_i = N_i e_a, φ_j = N_j e_b:
              // 2 ε:ε = δ_ab ∇N_i·∇N_j + ∂_b N_i ∂_a N_j and div div = ∂_a N_i ∂_b N_j
              const auto &[a, grad_i] = displacements[i];
              const auto &[b, grad_j] = displacements[j];
              double k                = shear_modulus * grad_i[b] * grad_j[a] + lame * grad_i[a] * grad_j[b];
              if (a == b)
                k += shear_modulus * (grad_i * grad_j);
              K(i, j) += k * values.JxW(q);
            }
      }
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < i; ++j)
        K(j, i) = K(i, j);
    if (has_modes)
      condense(with_modes, stiffness);
  }
} // namespace Squeal
