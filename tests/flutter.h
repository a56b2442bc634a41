#pragma once

#include "solutions.h"

namespace Squeal::Testing
{
  /// ẍ + K̃ x = 0 of two unit masses with one contact, K̃ = [3, 0.7 − s μ; 0.7, 2]: the modes coalesce where 1 + 2.8 (0.7 − s μ) = 0.
  inline CoupledSystem flutter(const double s)
  {
    const RowMap map = rows(2), contact = rows(1);
    return system_of({diagonal(map, [](int) { return 1.; }), nullptr,
                      sparse(map, map,
                             [](const int i) {
                               return i == 0 ? Row{{0, 3.}, {1, 0.7}} : Row{{0, 0.7}, {1, 2.}};
                             })},
                     sparse(contact, map,
                            [](int) {
                              return Row{{0, 1.}};
                            }),
                     sparse(contact, map, [s](int) {
                       return Row{{1, s}};
                     }));
  }
} // namespace Squeal::Testing
