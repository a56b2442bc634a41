#include "lane_kernels.h"
#include "processors.h"

namespace Squeal
{
  namespace
  {
    /// Columns that are taken together: as many streams of numbers as a processor fetches ahead of their use.
    constexpr int columns_together = 8;

    /// @p n columns of V.
    template <int n, int width>
    SQUEAL_INLINE void products_of(const TallBlock &V, const int first, const LaneRow<width> *W, LaneRow<width> *S)
    {
      const double  *column[n];
      LaneRow<width> sum[n];
      for (int a = 0; a < n; ++a)
        {
          column[a] = V.values + (first + a) * V.stride;
          sum[a]    = S[first + a];
        }
      for (int i = 0; i < V.n_rows; ++i)
        {
          const LaneRow<width> w = W[i];
          for (int a = 0; a < n; ++a)
            add_multiple(sum[a], column[a][i], w);
        }
      for (int a = 0; a < n; ++a)
        S[first + a] = sum[a];
    }

    template <int n, int width>
    SQUEAL_INLINE void combinations_of(const TallBlock &V, const int first, const LaneRow<width> *S, LaneRow<width> *W)
    {
      const double  *column[n];
      LaneRow<width> factor[n];
      for (int a = 0; a < n; ++a)
        {
          column[a] = V.values + (first + a) * V.stride;
          factor[a] = S[first + a];
        }
      for (int i = 0; i < V.n_rows; ++i)
        {
          LaneRow<width> w = W[i];
          for (int a = 0; a < n; ++a)
            add_multiple(w, column[a][i], factor[a]);
          W[i] = w;
        }
    }

    template <int width>
    SQUEAL_INLINE void all_products(const TallBlock &V, const LaneRow<width> *W, LaneRow<width> *S)
    {
      int j = 0;
      for (; j + columns_together <= V.n_columns; j += columns_together)
        products_of<columns_together>(V, j, W, S);
      for (; j < V.n_columns; ++j)
        products_of<1>(V, j, W, S);
    }

    template <int width>
    SQUEAL_INLINE void all_combinations(const TallBlock &V, const LaneRow<width> *S, LaneRow<width> *W)
    {
      int j = 0;
      for (; j + columns_together <= V.n_columns; j += columns_together)
        combinations_of<columns_together>(V, j, S, W);
      for (; j < V.n_columns; ++j)
        combinations_of<1>(V, j, S, W);
    }

    /// Four sums side by side, since one has to wait for its last addition.
    template <int width>
    SQUEAL_INLINE void all_rows(const SparseRows &A, const LaneRow<width> *X, LaneRow<width> *Y)
    {
      constexpr int n_sums = 32 / width;
      for (int i = 0; i < A.n_rows; ++i)
        {
          LaneRow<width> sum[n_sums] = {};
          int            k           = A.start[i];
          for (; k + n_sums <= A.start[i + 1]; k += n_sums)
            for (int s = 0; s < n_sums; ++s)
              add_multiple(sum[s], A.value[k + s], X[A.column[k + s]]);
          for (; k < A.start[i + 1]; ++k)
            add_multiple(sum[0], A.value[k], X[A.column[k]]);
          for (int s = 1; s < n_sums; ++s)
            add_row(sum[0], sum[s]);
          Y[i] = sum[0];
        }
    }
  } // namespace

  SQUEAL_PROCESSORS void add_products(const TallBlock &V, const LaneRow<8> *W, LaneRow<8> *S)
  {
    all_products(V, W, S);
  }

  SQUEAL_PROCESSORS void add_products(const TallBlock &V, const LaneRow<16> *W, LaneRow<16> *S)
  {
    all_products(V, W, S);
  }

  SQUEAL_PROCESSORS void add_combinations(const TallBlock &V, const LaneRow<8> *S, LaneRow<8> *W)
  {
    all_combinations(V, S, W);
  }

  SQUEAL_PROCESSORS void add_combinations(const TallBlock &V, const LaneRow<16> *S, LaneRow<16> *W)
  {
    all_combinations(V, S, W);
  }

  SQUEAL_PROCESSORS void set_products(const SparseRows &A, const LaneRow<8> *X, LaneRow<8> *Y)
  {
    all_rows(A, X, Y);
  }

  SQUEAL_PROCESSORS void set_products(const SparseRows &A, const LaneRow<16> *X, LaneRow<16> *Y)
  {
    all_rows(A, X, Y);
  }
} // namespace Squeal
