#pragma once

#include "processors.h"

#include <algorithm>
#include <cstddef>

namespace Squeal
{
  /// One row of some vectors, an entry of each, in registers of the processor.
  template <int width>
  struct LaneRow
  {
    static constexpr int lanes   = width < 8 ? width : 8;
    static constexpr int n_parts = width / lanes;
    typedef double       Lanes __attribute__((vector_size(lanes * sizeof(double))));
    Lanes                part[n_parts];
  };

  template <int width>
  SQUEAL_INLINE void add_row(LaneRow<width> &y, const LaneRow<width> &x)
  {
    for (int p = 0; p < LaneRow<width>::n_parts; ++p)
      y.part[p] += x.part[p];
  }

  template <int width>
  SQUEAL_INLINE void add_multiple(LaneRow<width> &y, const double factor, const LaneRow<width> &x)
  {
    for (int p = 0; p < LaneRow<width>::n_parts; ++p)
      y.part[p] += factor * x.part[p];
  }

  /// Where the entries of one vector are among those of all rows; they are @p width numbers apart.
  template <int width>
  double *lane(LaneRow<width> *rows, const int number)
  {
    return reinterpret_cast<double *>(rows) + number;
  }

  template <int width>
  const double *lane(const LaneRow<width> *rows, const int number)
  {
    return reinterpret_cast<const double *>(rows) + number;
  }

  /// Rows that stay in the nearest cache while their columns are copied one after the other.
  constexpr int rows_of_copy = 64;

  /// @p n columns of X, @p stride numbers apart, to lanes, zeros in the others.
  template <int width>
  void to_lanes(const double *X, const std::size_t stride, const int n_rows, const int n, LaneRow<width> *rows)
  {
    for (int begin = 0; begin < n_rows; begin += rows_of_copy)
      {
        const int end = std::min(begin + rows_of_copy, n_rows);
        if (n < width)
          std::fill(rows + begin, rows + end, LaneRow<width>{});
        for (int j = 0; j < n; ++j)
          {
            const double *column = X + j * stride;
            double       *target = lane(rows, j);
            for (int i = begin; i < end; ++i)
              target[static_cast<std::size_t>(i) * width] = column[i];
          }
      }
  }

  /// The way back.
  template <int width>
  void from_lanes(const LaneRow<width> *rows, double *Y, const std::size_t stride, const int n_rows, const int n)
  {
    for (int begin = 0; begin < n_rows; begin += rows_of_copy)
      for (int j = 0; j < n; ++j)
        {
          const int     end    = std::min(begin + rows_of_copy, n_rows);
          double       *column = Y + j * stride;
          const double *source = lane(rows, j);
          for (int i = begin; i < end; ++i)
            column[i] = source[static_cast<std::size_t>(i) * width];
        }
  }
} // namespace Squeal
