// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <map>
#include <vector>

namespace Squeal::Testing
{
  using Complex = std::complex<double>;

  /// max |A - Aᵀ| / max |A| of a square matrix; 0 for a zero matrix.
  inline double symmetry_defect(const SparseMatrix &A)
  {
    const double scale = max_norm(A);
    return scale == 0. ? 0. : max_norm(*add(1., A, -1., *transpose(A))) / scale;
  }

  /// Distribution of rows over the processes.
  enum class Distribution
  {
    even,
    first_process_empty, ///< process 0 has no rows if there are other processes
    last_process_all     ///< only the last process has rows
  };

  inline RowMap rows(const int n, const Distribution distribution = Distribution::even)
  {
    const int n_processes = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD),
              rank        = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    if (n_processes == 1 || distribution == Distribution::even)
      return RowMap::even(n, MPI_COMM_WORLD);
    if (distribution == Distribution::last_process_all)
      return RowMap(rank == n_processes - 1 ? n : 0, MPI_COMM_WORLD);
    const int share = n / (n_processes - 1);
    return RowMap(rank == 0 ? 0 : (rank == n_processes - 1 ? n - share * (n_processes - 2) : share), MPI_COMM_WORLD);
  }

  /// Random entries in [−1, 1], broadcast because a library may advance the random sequence on a single process.
  inline DenseMatrix agreed_random_matrix(const int n_rows, const int n_columns)
  {
    DenseMatrix result = DenseMatrix::Random(n_rows, n_columns);
    agree(MPI_COMM_WORLD, result);
    return result;
  }

  using Row = std::map<int, double>; ///< entry of each column

  /// A sparse matrix whose row i is @p row(i).
  inline std::shared_ptr<SparseMatrix> sparse(const RowMap &row_map, const RowMap &column_map, const std::function<Row(int)> &row)
  {
    return std::make_shared<SparseMatrix>(row_map, column_map, [&](const int i, SparseMatrix::Row &entries) {
      const Row given = row(row_map.number(i));
      entries.assign(given.begin(), given.end());
    });
  }

  /// The sparse form of a matrix A that all processes store.
  inline std::shared_ptr<SparseMatrix> sparse(const RowMap &row_map, const RowMap &column_map, const DenseMatrix &A)
  {
    return sparse(row_map, column_map, [&A](const int i) {
      Row row;
      for (int j = 0; j < A.cols(); ++j)
        if (A(i, j) != 0.)
          row[j] = A(i, j);
      return row;
    });
  }

  inline std::shared_ptr<SparseMatrix> sparse(const DenseMatrix &A)
  {
    return sparse(rows(A.rows()), rows(A.cols()), A);
  }

  /// diag(f(0), f(1), ...).
  inline std::shared_ptr<SparseMatrix> diagonal(const RowMap &row_map, const std::function<double(int)> &f)
  {
    return sparse(row_map, row_map, [&](const int i) { return Row{{i, f(i)}}; });
  }

  /**
   * @p n_copies uncoupled Laplacians (7-point stencil) on cubes of m³ points with
   * zero boundary values; eigenvalues Σ_d 2 - 2 cos(π k_d / (m + 1)).
   */
  inline std::shared_ptr<SparseMatrix> laplacian(const int m, const int n_copies, const Distribution distribution = Distribution::even)
  {
    const RowMap map = rows(m * m * m * n_copies, distribution);
    return sparse(map, map, [m](const int i) {
      Row row{{i, 6.}};
      for (const int step : {1, m, m * m})
        {
          const int coordinate = (i / step) % m;
          if (coordinate > 0)
            row[i - step] = -1.;
          if (coordinate < m - 1)
            row[i + step] = -1.;
        }
      return row;
    });
  }

  inline std::vector<double> laplacian_eigenvalues(const int m, const int n_copies)
  {
    std::vector<double> values;
    const auto          lambda = [m](const int k) { return 2. - 2. * std::cos(M_PI * k / (m + 1)); };
    for (int copy = 0; copy < n_copies; ++copy)
      for (int i = 1; i <= m; ++i)
        for (int j = 1; j <= m; ++j)
          for (int k = 1; k <= m; ++k)
            values.push_back(lambda(i) + lambda(j) + lambda(k));
    std::sort(values.begin(), values.end());
    return values;
  }

  /// Stiffness and mass of an elastic body.
  struct Body
  {
    std::shared_ptr<SparseMatrix> stiffness, mass;
  };

  /**
   * A steel plate of @p cells cubes of edge @p h [m] in trilinear hexahedra, free
   * or on an elastic foundation @p foundation [N/m³] at its lower face.
   */
  inline Body plate(const std::array<int, 3> cells,
                    const double             h,
                    const double             foundation,
                    const Distribution       distribution = Distribution::even)
  {
    const double E = 210e9, nu = 0.3, density = 7850.;
    const double lame = E * nu / ((1. + nu) * (1. - 2. * nu)), shear = E / (2. * (1. + nu));

    std::array<std::array<double, 24>, 24> K = {}, M = {};
    for (int q = 0; q < 8; ++q)
      {
        double x[3];
        for (int d = 0; d < 3; ++d)
          x[d] = 0.5 + ((q >> d) & 1 ? 0.5 : -0.5) / std::sqrt(3.);
        const double weight = h * h * h / 8.;
        double       value[8], gradient[8][3];
        for (int a = 0; a < 8; ++a)
          {
            double f[3], g[3];
            for (int d = 0; d < 3; ++d)
              {
                f[d] = (a >> d) & 1 ? x[d] : 1. - x[d];
                g[d] = ((a >> d) & 1 ? 1. : -1.) / h;
              }
            value[a] = f[0] * f[1] * f[2];
            for (int d = 0; d < 3; ++d)
              gradient[a][d] = g[d] * f[(d + 1) % 3] * f[(d + 2) % 3];
          }
        for (int a = 0; a < 8; ++a)
          for (int b = 0; b < 8; ++b)
            {
              double dot = 0.;
              for (int d = 0; d < 3; ++d)
                dot += gradient[a][d] * gradient[b][d];
              for (int i = 0; i < 3; ++i)
                {
                  for (int j = 0; j < 3; ++j)
                    K[3 * a + i][3 * b + j] += weight * (lame * gradient[a][i] * gradient[b][j] + shear * gradient[a][j] * gradient[b][i]);
                  K[3 * a + i][3 * b + i] += weight * shear * dot;
                  M[3 * a + i][3 * b + i] += weight * density * value[a] * value[b];
                }
            }
      }

    const int    nx = cells[0] + 1, ny = cells[1] + 1, nz = cells[2] + 1;
    const RowMap map      = rows(3 * nx * ny * nz, distribution);
    const auto   assemble = [&](const auto &element, const double spring) {
      return sparse(map, map, [&](const int dof) {
        Row       row;
        const int node = dof / 3, component = dof % 3;
        // Number across the thickness first to keep the bandwidth small
        const int position[3] = {node / (nz * ny), (node / nz) % ny, node % nz};
        for (int a = 0; a < 8; ++a)
          {
            int  corner[3];
            bool inside = true;
            for (int d = 0; d < 3; ++d)
              {
                corner[d] = position[d] - ((a >> d) & 1);
                inside    = inside && corner[d] >= 0 && corner[d] < cells[d];
              }
            if (inside)
              for (int b = 0; b < 8; ++b)
                {
                  const int other = ((corner[0] + (b & 1)) * ny + corner[1] + ((b >> 1) & 1)) * nz + corner[2] + ((b >> 2) & 1);
                  for (int j = 0; j < 3; ++j)
                    row[3 * other + j] += element[3 * a + component][3 * b + j];
                }
          }
        if (position[2] == 0)
          row[dof] += spring;
        return row;
      });
    };
    return {assemble(K, foundation * h * h), assemble(M, 0.)};
  }

  inline double largest_entry(const MultiVector &X)
  {
    return max_norm(replicate(X));
  }

  /// Largest relative difference between columns of @p X and @p Y.
  inline double relative_difference(const MultiVector &X, const MultiVector &Y)
  {
    const auto norms = column_norms(X - Y), sizes = column_norms(Y);
    double     result = 0.;
    for (std::size_t j = 0; j < norms.size(); ++j)
      result = std::max(result, norms[j] / sizes[j]);
    return result;
  }

  /// Relative distance between each value and its counterpart in @p others, assigned one to one; both lists must have the same size.
  inline std::vector<double> distances(const std::vector<Complex> &values, std::vector<Complex> others)
  {
    EXPECT_EQ(values.size(), others.size());
    std::vector<double> result;
    if (values.size() != others.size())
      return result;
    for (const Complex &value : values)
      {
        const auto nearest = std::min_element(
          others.begin(), others.end(), [&](const Complex &a, const Complex &b) { return std::abs(a - value) < std::abs(b - value); });
        result.push_back(std::abs(*nearest - value) / std::abs(value));
        others.erase(nearest);
      }
    return result;
  }

  inline double largest(const std::vector<double> &values)
  {
    return values.empty() ? std::numeric_limits<double>::infinity() : *std::max_element(values.begin(), values.end());
  }
} // namespace Squeal::Testing
