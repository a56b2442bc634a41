#pragma once

#include <cmath>

namespace Squeal
{
  /// Nodes of the face of a pin that is filled by three blocks of k × k elements: 3 k (k + 1) + 1.
  inline unsigned int nodes_of_pin_face(const unsigned int k)
  {
    return 3 * k * (k + 1) + 1;
  }

  /// The number k of elements on the edge of a block of a pin face with that many nodes, not rounded.
  inline double blocks_of_pin_face(const double nodes)
  {
    return (std::sqrt(12. * nodes - 3.) - 3.) / 6.;
  }
} // namespace Squeal
