// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense.h>

#include <boost/serialization/array_wrapper.hpp>
#include <boost/serialization/complex.hpp>
#include <boost/serialization/vector.hpp>

/// Boost serialisation of dense matrices: both sizes, then entries by columns.
namespace boost::serialization
{
  template <class Archive, typename Number>
  void serialize(Archive &archive, Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic> &A, const unsigned int /*version*/)
  {
    Eigen::Index   rows = A.rows(), columns = A.cols();
    archive &rows &columns;
    if (typename Archive::is_loading())
      A.resize(rows, columns);
    archive &make_array(A.data(), A.size());
  }
} // namespace boost::serialization
