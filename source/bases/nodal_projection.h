// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/model/model.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace Squeal
{
  /// A function is dropped if its component orthogonal to the other functions has a relative norm below this limit, which is well above
  /// rounding errors [-].
  constexpr double smallest_rest = 1e-8;

  /// Sum over all processes, bitwise identical on all of them.
  inline DenseMatrix summed(const MPI_Comm communicator, DenseMatrix parts)
  {
    sum_over_processes(communicator, parts.data(), parts.size());
    agree(communicator, parts);
    return parts;
  }

  /// Least-squares projection of nodal fields on a few functions in the mass-weighted inner product; nodes are distributed.
  class Projection
  {
  public:
    /**
     * @param functions  n_nodes × n_functions, rows of this process
     * @param weights    n_nodes
     */
    Projection(const MPI_Comm communicator, const DenseMatrix &functions, const Eigen::VectorXd &weights)
      : communicator(communicator)
      , roots(weights.cwiseSqrt())
      , Q(roots.asDiagonal() * functions)
      , R(DenseMatrix::Identity(functions.cols(), functions.cols()))
    {
      // Gram-Schmidt, twice; linearly dependent functions (r^k on a single radius) are dropped
      for (Eigen::Index j = 0; j < Q.cols(); ++j)
        {
          const double before = norm(j);
          for (int pass = 0; pass < 2 && j > 0; ++pass)
            {
              // Use a one-column matrix: for a vector, Eigen would call gemv with a leading dimension of zero on processes without rows
              const DenseMatrix c = summed(communicator, Q.leftCols(j).transpose() * Q.middleCols(j, 1));
              R.col(j).head(j) += c.col(0);
              Q.middleCols(j, 1).noalias() -= Q.leftCols(j) * c;
            }
          const double after = norm(j);
          if (after / before > smallest_rest)
            {
              R(j, j) = after;
              Q.col(j) /= after;
            }
          else
            Q.col(j).setZero();
        }
    }

    /// Coefficients of fields in the orthonormal functions, n_functions × k; the sum of their squares is the energy of the projection.
    DenseMatrix coefficients(const DenseMatrix &fields) const
    {
      return summed(communicator, Q.transpose() * (roots.asDiagonal() * fields));
    }

    /// Converts coefficients of the orthonormal functions to coefficients of the original functions.
    Eigen::VectorXd factors(const Eigen::VectorXd &orthonormal_coefficients) const
    {
      return R.triangularView<Eigen::Upper>().solve(orthonormal_coefficients);
    }

  private:
    double norm(const Eigen::Index j) const
    {
      return std::sqrt(summed(communicator, DenseMatrix::Constant(1, 1, Q.col(j).squaredNorm()))(0, 0));
    }

    MPI_Comm        communicator;
    Eigen::VectorXd roots; ///< square roots of the weights
    DenseMatrix     Q, R;  ///< functions times roots = Q R; dropped functions are zero in Q and have ones on the diagonal of R
  };

  /// 1, x, x², ... as columns.
  inline DenseMatrix powers(const Eigen::VectorXd &x, const int n_powers)
  {
    DenseMatrix result = DenseMatrix::Ones(x.size(), n_powers);
    for (int k = 1; k < n_powers; ++k)
      result.col(k) = result.col(k - 1).cwiseProduct(x);
    return result;
  }

  /// Nodes of one component with rows on this process. Clamped nodes have no rows and are at rest.
  struct Nodes
  {
    MPI_Comm                        communicator;
    std::vector<std::array<int, 3>> rows;      ///< local rows of the displacements
    Eigen::MatrixX3d                positions; ///< [m]
    Eigen::VectorXd                 masses;    ///< [kg]

    Nodes(const Model &model, const std::vector<double> &nodal_masses, const unsigned int component)
      : communicator(model.communicator())
    {
      const RowMap             &map = model.free_map();
      std::vector<const Node *> nodes;
      std::vector<double>       chosen;
      for (std::size_t i = 0; i < nodal_masses.size(); ++i)
        if (const Node &node = model.nodes()[i]; node.component == component && map.place(node.dofs[0]) >= 0)
          {
            nodes.push_back(&node);
            rows.push_back({{map.place(node.dofs[0]), map.place(node.dofs[1]), map.place(node.dofs[2])}});
            chosen.push_back(nodal_masses[i]);
          }
      masses = as_column(chosen);
      positions.resize(nodes.size(), 3);
      for (std::size_t i = 0; i < nodes.size(); ++i)
        positions.row(i) = Eigen::RowVector3d::Map(nodes[i]->position.data());
    }

    Eigen::MatrixX3d displacements(const MultiVector &modes, const int j) const
    {
      Eigen::MatrixX3d u(rows.size(), 3);
      for (std::size_t i = 0; i < rows.size(); ++i)
        for (unsigned int k = 0; k < 3; ++k)
          u(i, k) = modes(rows[i][k], j);
      return u;
    }

    double largest(const Eigen::VectorXd &values) const
    {
      return largest_of_processes(communicator, values.size() > 0 ? values.maxCoeff() : -std::numeric_limits<double>::infinity());
    }
  };
} // namespace Squeal
