#include "processors.h"
#include "supernode_kernels.h"

#include <cstddef>

namespace Squeal
{
  namespace
  {
    /// Columns of a supernode that are taken together: as many streams of numbers as a processor fetches ahead of their use.
    constexpr int most_columns = 8;

    template <int width>
    SQUEAL_INLINE void scale(LaneRow<width> &y, const double factor)
    {
      for (int p = 0; p < LaneRow<width>::n_parts; ++p)
        y.part[p] *= factor;
    }

    /// The supernode from row and column @p first on.
    SQUEAL_INLINE Supernode rest_of(const Supernode &L, const int first)
    {
      return {L.n_columns - first, L.n_rows - first, L.values + first + static_cast<std::size_t>(first) * L.n_rows};
    }

    /// The first @p n columns of L, whose columns are @p stride apart.
    template <int n, int width>
    SQUEAL_INLINE void columns_forward(const Supernode &L, const int stride, LaneRow<width> *Y)
    {
      const double  *column[n];
      LaneRow<width> x[n];
      for (int a = 0; a < n; ++a)
        {
          column[a] = L.values + static_cast<std::size_t>(a) * stride;
          x[a]      = Y[a];
        }
      for (int a = 0; a < n; ++a)
        {
          scale(x[a], 1. / column[a][a]);
          for (int b = a + 1; b < n; ++b)
            add_multiple(x[b], -column[a][b], x[a]);
        }
      for (int a = 0; a < n; ++a)
        Y[a] = x[a];
      for (int i = n; i < L.n_rows; ++i)
        {
          LaneRow<width> y = Y[i];
          for (int a = 0; a < n; ++a)
            add_multiple(y, -column[a][i], x[a]);
          Y[i] = y;
        }
    }

    template <int n, int width>
    SQUEAL_INLINE void columns_backward(const Supernode &L, const int stride, LaneRow<width> *Y)
    {
      const double  *column[n];
      LaneRow<width> x[n];
      for (int a = 0; a < n; ++a)
        {
          column[a] = L.values + static_cast<std::size_t>(a) * stride;
          x[a]      = Y[a];
        }
      for (int i = n; i < L.n_rows; ++i)
        {
          const LaneRow<width> y = Y[i];
          for (int a = 0; a < n; ++a)
            add_multiple(x[a], -column[a][i], y);
        }
      for (int a = n - 1; a >= 0; --a)
        {
          for (int b = a + 1; b < n; ++b)
            add_multiple(x[a], -column[a][b], x[b]);
          scale(x[a], 1. / column[a][a]);
        }
      for (int a = 0; a < n; ++a)
        Y[a] = x[a];
    }

    // Eight columns at a time, then four, two and one of what is left; backwards in the opposite order

    template <int width>
    SQUEAL_INLINE void forward(const Supernode &L, LaneRow<width> *Y)
    {
      int j = 0;
      for (; j + most_columns <= L.n_columns; j += most_columns)
        columns_forward<most_columns>(rest_of(L, j), L.n_rows, Y + j);
      if (L.n_columns & 4)
        {
          columns_forward<4>(rest_of(L, j), L.n_rows, Y + j);
          j += 4;
        }
      if (L.n_columns & 2)
        {
          columns_forward<2>(rest_of(L, j), L.n_rows, Y + j);
          j += 2;
        }
      if (L.n_columns & 1)
        columns_forward<1>(rest_of(L, j), L.n_rows, Y + j);
    }

    template <int width>
    SQUEAL_INLINE void backward(const Supernode &L, LaneRow<width> *Y)
    {
      int j = L.n_columns;
      if (L.n_columns & 1)
        {
          j -= 1;
          columns_backward<1>(rest_of(L, j), L.n_rows, Y + j);
        }
      if (L.n_columns & 2)
        {
          j -= 2;
          columns_backward<2>(rest_of(L, j), L.n_rows, Y + j);
        }
      if (L.n_columns & 4)
        {
          j -= 4;
          columns_backward<4>(rest_of(L, j), L.n_rows, Y + j);
        }
      while (j > 0)
        {
          j -= most_columns;
          columns_backward<most_columns>(rest_of(L, j), L.n_rows, Y + j);
        }
    }
  } // namespace

  SQUEAL_PROCESSORS void solve_forward(const Supernode &L, LaneRow<4> *Y)
  {
    forward(L, Y);
  }

  SQUEAL_PROCESSORS void solve_forward(const Supernode &L, LaneRow<8> *Y)
  {
    forward(L, Y);
  }

  SQUEAL_PROCESSORS void solve_forward(const Supernode &L, LaneRow<16> *Y)
  {
    forward(L, Y);
  }

  SQUEAL_PROCESSORS void solve_backward(const Supernode &L, LaneRow<4> *Y)
  {
    backward(L, Y);
  }

  SQUEAL_PROCESSORS void solve_backward(const Supernode &L, LaneRow<8> *Y)
  {
    backward(L, Y);
  }

  SQUEAL_PROCESSORS void solve_backward(const Supernode &L, LaneRow<16> *Y)
  {
    backward(L, Y);
  }
} // namespace Squeal
