// SPDX-License-Identifier: GPL-3.0-or-later

#include "input.h"

#include <squeal/studies/designs/design_solution.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  std::string key(const std::string &material)
  {
    return family_key(Parameters::read("/dev/null", {"Materials/Orthotropic=pin_top_1: " + material}));
  }
} // namespace

TEST(DesignFamilies, OrthotropicModuliShareAFactor)
{
  const std::string here = key("2e9, 1.66e9, 1e9, 0.2, 0.1, 0.15, 0.83e9, 0.4e9, 0.3e9, 2600");
  EXPECT_EQ(key("2.2e9, 1.826e9, 1.1e9, 0.2, 0.1, 0.15, 913000000.0000001, 0.44e9, 0.33e9, 2900"), here);
  EXPECT_NE(key("2e9, 1.66e9, 1e9, 0.2, 0.1, 0.15, 0.84e9, 0.4e9, 0.3e9, 2600"), here);
  EXPECT_NE(key("2e9, 1.66e9, 1e9, 0.2, 0.11, 0.15, 0.83e9, 0.4e9, 0.3e9, 2600"), here);
}
