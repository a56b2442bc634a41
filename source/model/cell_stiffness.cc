// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/model/cell_stiffness.h>
#include <squeal/linear_algebra/dense.h>

#include <Eigen/Cholesky>

namespace Squeal
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int n_modes = 9;

    /// A displacement field in a single direction.
    struct Displacement
    {
      unsigned int component;
      Tensor<1, 3> gradient;
    };

    /// det J₀ J₀⁻ᵀ of the trilinear map of a hexahedron at its centre.
    Tensor<2, 3> centre_gradients(const ElementValues &values)
    {
      const auto  &corners = topology(Shape::hexahedron).corners;
      Tensor<2, 3> J;
      for (unsigned int v = 0; v < corners.size(); ++v)
        for (unsigned int a = 0; a < 3; ++a)
          {
            const double derivative = (corners[v][a] > 0.5 ? 1. : -1.) / 4.;
            for (unsigned int i = 0; i < 3; ++i)
              J[i][a] += derivative * values.node(v)[i];
          }
      return determinant(J) * transpose(invert(J));
    }

    void add_incompatible_modes(const ElementValues       &values,
                                const unsigned int         q,
                                const Tensor<2, 3>        &centre_gradients,
                                std::vector<Displacement> &displacements)
    {
      // The reference cell is [0, 1]³: ξ = 2 x̂ − 1
      const Point<3> &x     = values.reference_point(q);
      const double    det_J = determinant(values.jacobian(q));
      for (unsigned int a = 0; a < 3; ++a)
        {
          Tensor<1, 3> reference_gradient;
          reference_gradient[a]       = -4. * (2. * x[a] - 1.);
          const Tensor<1, 3> gradient = centre_gradients * reference_gradient / det_J;
          for (unsigned int b = 0; b < 3; ++b)
            displacements.push_back({b, gradient});
        }
    }

    /// Stress C : ∇φ of a displacement field.
    Tensor<2, 3> stress_of(const ElasticLaw::Stiffness &C, const Displacement &displacement)
    {
      const unsigned int *columns = voigt[displacement.component];
      double              stress[6];
      for (unsigned int m = 0; m < 6; ++m)
        stress[m] = C(m, columns[0]) * displacement.gradient[0] + C(m, columns[1]) * displacement.gradient[1] +
                    C(m, columns[2]) * displacement.gradient[2];
      Tensor<2, 3> result;
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int b = 0; b < 3; ++b)
          result[a][b] = stress[voigt[a][b]];
      return result;
    }

    /// Eliminates the last unknowns by the Schur complement of a positive definite matrix.
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
      // Use L⁻¹ K_αu, because the product of its transpose with itself is exactly symmetric
      const DenseMatrix half = modes.llt().matrixL().solve(coupling);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j <= i; ++j)
          condensed(i, j) = condensed(j, i) = full(i, j) - half.col(i).dot(half.col(j));
    }
  } // namespace

  void add_stiffness(const ElementValues &values, const Element element, const ElasticLaw &law, FullMatrix<double> &stiffness)
  {
    const bool                has_modes = element == Element::incompatible_modes && values.element().shape == Shape::hexahedron;
    const unsigned int        n         = stiffness.m() + (has_modes ? n_modes : 0);
    const Tensor<2, 3>        at_centre = has_modes ? centre_gradients(values) : Tensor<2, 3>();
    FullMatrix<double>        with_modes(has_modes ? n : 0);
    FullMatrix<double>       &K = has_modes ? with_modes : stiffness;
    std::vector<Displacement> displacements;
    for (unsigned int q = 0; q < values.n_points(); ++q)
      {
        displacements.clear();
        for (unsigned int i = 0; i < values.n_nodes(); ++i)
          for (unsigned int c = 0; c < 3; ++c)
            displacements.push_back({c, values.gradient(i, q)});
        if (has_modes)
          add_incompatible_modes(values, q, at_centre, displacements);
        const ElasticLaw::Stiffness C = law.at(values.point(q)) * values.JxW(q);
        for (unsigned int i = 0; i < n; ++i)
          {
            const Tensor<2, 3> stress = stress_of(C, displacements[i]);
            for (unsigned int j = 0; j <= i; ++j)
              K(i, j) += stress[displacements[j].component] * displacements[j].gradient;
          }
      }
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < i; ++j)
        K(j, i) = K(i, j);
    if (has_modes)
      condense(with_modes, stiffness);
  }
} // namespace Squeal
