// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/conventions.h>
#include <squeal/contact/contact_operators.h>
#include <squeal/estimates/mode_groups.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    /// Minimum energy share of a disc mode [-].
    constexpr double half = 0.5;

    /// uᴴ A u and the contribution of the selected rows, for each column of a complex u.
    struct QuadraticForms
    {
      QuadraticForms(const SparseMatrix &A, const MultiVector &selection, const MultiVector &real_part, const MultiVector &imaginary_part)
        : whole(real_part.n_columns(), 0.)
        , part(whole)
      {
        for (const MultiVector *u : {&real_part, &imaginary_part})
          {
            MultiVector               Au    = A * *u;
            const std::vector<double> sum   = column_products(*u, Au);
            Au.local()                      = selection.col(0).asDiagonal() * Au.local();
            const std::vector<double> share = column_products(*u, Au);
            for (std::size_t j = 0; j < whole.size(); ++j)
              {
                whole[j] += sum[j];
                part[j] += share[j];
              }
          }
      }

      std::vector<double> whole, part;
    };
  } // namespace

  std::vector<double> energy_shares(const SecondOrderSystem                 &bodies,
                                    const MultiVector                       &selection,
                                    const std::vector<std::complex<double>> &lambda,
                                    const MultiVector                       &real_part,
                                    const MultiVector                       &imaginary_part)
  {
    const QuadraticForms mass(*bodies.mass, selection, real_part, imaginary_part),
      stiffness(*bodies.stiffness, selection, real_part, imaginary_part);
    std::vector<double> shares;
    for (std::size_t j = 0; j < lambda.size(); ++j)
      shares.push_back((std::norm(lambda[j]) * mass.part[j] + stiffness.part[j]) /
                       (std::norm(lambda[j]) * mass.whole[j] + stiffness.whole[j]));
    return shares;
  }

  std::vector<double> disc_shares(const Model             &model,
                                  const SecondOrderSystem &bodies,
                                  const SparseMatrix      &kernel,
                                  const ComplexModes      &modes)
  {
    MultiVector selection(model.free_map(), 1);
    for (const Node &node : model.nodes())
      if (belongs_to(node, Component::disc))
        for (const int dof : node.dofs)
          if (const int i = selection.map().place(dof); i >= 0)
            selection(i, 0) = 1.;
    return energy_shares(bodies, selection, modes.lambda, kernel * *modes.real_part, kernel * *modes.imaginary_part);
  }

  std::vector<std::string> frictionless_groups(const std::vector<double> &disc_shares, const std::vector<ModeLabel> &pin_labels)
  {
    std::vector<std::string> groups;
    for (std::size_t j = 0; j < disc_shares.size(); ++j)
      groups.push_back(disc_shares[j] >= half ? "disc" : shape_text(pin_labels[j]));
    return groups;
  }

  std::vector<std::string> friction_groups(const std::vector<double>               &disc_shares,
                                           const std::vector<std::complex<double>> &lambda,
                                           const std::vector<bool>                 &unstable)
  {
    std::vector<std::string> groups;
    for (std::size_t j = 0; j < disc_shares.size(); ++j)
      {
        const bool is_strong = modal_quantities(lambda[j]).divergence_rate > weak_divergence;
        groups.push_back(disc_shares[j] >= half ? "disc" :
                         !unstable[j]           ? "other pins" :
                         is_strong              ? "unstable pins" :
                                                  "weakly unstable pins");
      }
    return groups;
  }

  namespace
  {
    /// Directions whose squared norm is below this fraction of the largest are rounding errors: squares are accurate to 1e-16 [-].
    constexpr double negligible_square = 1e-12;

    /// W with Wᴴ G W = 1 for a Hermitian positive semidefinite G, without directions that are rounding errors.
    ComplexDenseMatrix whitening(const ComplexDenseMatrix &G)
    {
      const Eigen::SelfAdjointEigenSolver<ComplexDenseMatrix> pairs(G);
      const Eigen::VectorXd                                  &values = pairs.eigenvalues(); // ascending
      const Eigen::Index                                      n_kept = std::count_if(
                                             values.begin(), values.end(), [&values](const double value) { return value / values[values.size() - 1] > negligible_square; });
      return pairs.eigenvectors().rightCols(n_kept) * values.tail(n_kept).cwiseSqrt().cwiseInverse().asDiagonal();
    }
  } // namespace

  ComplexDenseMatrix hermitian_products(const DenseMatrix &G)
  {
    const Eigen::Index m = G.rows() / 2, n = G.cols() / 2;
    ComplexDenseMatrix result(m, n);
    result.real() = G.topLeftCorner(m, n) + G.bottomRightCorner(m, n);
    result.imag() = G.topRightCorner(m, n) - G.bottomLeftCorner(m, n);
    return result;
  }

  Eigen::VectorXd squared_cosines(const ComplexDenseMatrix &A, const ComplexDenseMatrix &B, const ComplexDenseMatrix &C)
  {
    const ComplexDenseMatrix products = whitening(A).adjoint() * C * whitening(B);
    const ComplexDenseMatrix squares =
      products.cols() <= products.rows() ? ComplexDenseMatrix(products.adjoint() * products) : products * products.adjoint();
    return squares.selfadjointView<Eigen::Lower>().eigenvalues();
  }

  Eigen::RowVectorXd shares_in_span(const ComplexDenseMatrix &A, const ComplexDenseMatrix &C, const ComplexDenseMatrix &B)
  {
    return (whitening(A).adjoint() * C).colwise().squaredNorm().cwiseQuotient(B.diagonal().real().transpose());
  }
} // namespace Squeal
