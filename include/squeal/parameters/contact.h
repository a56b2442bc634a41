// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/parameters/declarations.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// A pair of sliding surfaces: one of the disc, one of another body.
  struct ContactPair
  {
    std::string disc, pin;
    double      friction_factor  = 1.; ///< multiplies Operation/Friction coefficient [-]
    double      normal_stiffness = 0.; ///< k of the contact [N/m³]; zero: rigid contact
  };

  /// A pair of bonded surfaces: nodes of the slave follow the master.
  struct TiedPair
  {
    std::string slave, master;
  };

  /// Sliding and bonded surfaces (section `Contact`).
  struct ContactParameters
  {
    std::vector<ContactPair> pairs = {{"disc_contact", "pin_contact"}};
    std::vector<TiedPair>    tied;

    void declare(Declarations &declarations);

    /// Throws ParameterError.
    void check() const;
  };
} // namespace Squeal
