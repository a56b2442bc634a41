#include <squeal/estimates/subspaces.h>

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    /// Squared norm of a direction over the largest, up to which it is a rounding error: squares leave 1e-16.
    constexpr double negligible_square = 1e-12;

    /// W with Wᴴ G W = 1 for a Hermitian positive semidefinite G, without the directions that are rounding errors.
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
