#pragma once

#include "ghost_exchange.h"

#include <squeal/linear_algebra/sparse_matrix.h>

#include <cmath>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

namespace Squeal
{
  /// Vectors that sparse kernels take at a time: 64 bytes of single precision in each row.
  constexpr int panel_width = 16;

  /// One row of a panel: an entry of each of its vectors, in the registers of the processor.
  template <typename Real>
  struct alignas(panel_width * sizeof(Real)) PanelRow
  {
    typedef Real Lanes __attribute__((vector_size(panel_width * sizeof(Real))));
    Lanes        lanes;
  };

  /// Some vectors stored by rows, own rows first, then those of other processes that a matrix refers to.
  template <typename Real>
  using Panel = std::vector<PanelRow<Real>>;

  /// A sparse matrix for products with panels, in single or double precision: rows and columns of this process by their places.
  template <typename Real>
  struct PanelMatrix
  {
    explicit PanelMatrix(const SparseMatrix &A)
      : n_rows(A.rows().n_local())
      , n_own_columns(A.columns().n_local())
    {
      std::unordered_map<int, int> place_of_ghost;
      std::vector<int>             ghosts;
      SparseMatrix::Row            row;
      start.push_back(0);
      for (int i = 0; i < n_rows; ++i)
        {
          A.get_row(i, row);
          for (auto &[number, value] : row)
            {
              int place = A.columns().place(number);
              if (place < 0)
                {
                  const auto [found, is_new] = place_of_ghost.try_emplace(number, n_own_columns + static_cast<int>(ghosts.size()));
                  if (is_new)
                    ghosts.push_back(number);
                  place = found->second;
                }
              number = place;
            }
          std::sort(row.begin(), row.end());
          for (const auto &[place, entry] : row)
            if (entry != 0.)
              {
                column.push_back(place);
                value.push_back(static_cast<Real>(entry));
              }
          start.push_back(column.size());
        }
      column.shrink_to_fit();
      value.shrink_to_fit();
      exchange = GhostExchange(A.columns(), ghosts);
    }

    /// Rows that a panel X needs for A X.
    std::size_t n_columns() const
    {
      return n_own_columns + exchange.size();
    }

    /// Fills the rows of X that other processes own.
    void update_ghosts(Panel<Real> &X) const
    {
      exchange(X.data(), X.data() + n_own_columns);
    }

    int                      n_rows, n_own_columns;
    std::vector<std::size_t> start; ///< start[i], ..., start[i+1]: entries of row i
    std::vector<int>         column;
    std::vector<Real>        value;
    GhostExchange            exchange;
  };

  // Kernels, compiled for several generations of processors; ghosts of X are those that update_ghosts() left.

  /// Y = A X.
  void panel_product(const PanelMatrix<float> &A, const Panel<float> &X, Panel<float> &Y);
  void panel_product(const PanelMatrix<double> &A, const Panel<double> &X, Panel<double> &Y);

  /// X += A Y.
  void panel_add_product(const PanelMatrix<float> &A, const Panel<float> &Y, Panel<float> &X);

  /// What the Gauss-Seidel method needs of the rows of a matrix beside its entries.
  struct PanelSmoother
  {
    explicit PanelSmoother(const PanelMatrix<float> &A);

    std::vector<std::size_t> diagonal;         ///< place of the diagonal entry among the entries
    std::vector<float>       inverse_diagonal; ///< of D = diagonal + |entries of columns of other processes|, with which it converges
    std::vector<float>       excess;           ///< D − diagonal
  };

  /// Its first sweep, from X = 0 forwards: (L + D) X = B. Rows of other processes do not take part.
  void panel_first_sweep(const PanelMatrix<float> &A, const PanelSmoother &smoother, const Panel<float> &B, Panel<float> &X);

  /// R = B − A X after that sweep, of which the upper triangle is left.
  void panel_first_residual(const PanelMatrix<float> &A, const PanelSmoother &smoother, const Panel<float> &X, Panel<float> &R);

  /// A sweep backwards: X += (D + U)⁻¹ (B − A X).
  void panel_backward_sweep(const PanelMatrix<float> &A, const PanelSmoother &smoother, const Panel<float> &B, Panel<float> &X);
} // namespace Squeal
