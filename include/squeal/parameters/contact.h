// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/parameters/declarations.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Surfaces that rub: one of the disc, one of another body.
  struct ContactPair
  {
    std::string disc, pin;
    double      friction_factor  = 1.; ///< friction coefficient of the pair over that of Operation/Friction coefficient [-]
    double      normal_stiffness = 0.; ///< k of the contact [N/m³]; zero: nothing yields, the constraint
  };

  /// Surfaces that are bonded: nodes of the slave move with the master.
  struct TiedPair
  {
    std::string slave, master;
  };

  /// What rubs what, and what is bonded (section `Contact`).
  struct ContactParameters
  {
    std::vector<ContactPair> pairs = {{"disc_contact", "pin_contact"}};
    std::vector<TiedPair>    tied;

    void declare(Declarations &declarations);

    /// Throws ParameterError.
    void check() const;
  };
} // namespace Squeal
