// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/coupled_system.h>
#include <squeal/system/system_file.h>

#include <optional>

namespace Squeal
{
  /**
   * A coupled system from a system file, for charts, reduction and sensitivities.
   *
   * Mass and stiffness are the symmetric sparse terms at the @p values. The dofs are scaled, u = D v with powers of two in D, so that the
   * diagonal of K + ω² M is about one (zero diagonal entries are replaced by the largest entry of the row). Results then do not depend on
   * the units of the dofs, and matrices may be badly scaled. D is the kernel of the system.
   *
   * If μ is the varied parameter, low-rank friction terms that are proportional to μ and share a left factor are kept. Symmetric
   * low-rank terms in λ are also kept. Other low-rank terms are multiplied out.
   *
   * Symmetric parts of unsymmetric matrices (TermKind::circulatory) are included in mass and stiffness if these are then definite;
   * otherwise they count as friction. If neither choice is definite, mass and stiffness are null: use direct_modes().
   *
   * @param values  values of all parameters, for mass and stiffness
   * @param varied  parameter of charts
   * @param largest_circular_frequency ω [rad/s]
   */
  CoupledSystem imported_system(const SystemFile      &file,
                                const ParameterValues &values,
                                const std::string     &varied,
                                double                 largest_circular_frequency);

  /// Shift s for which K + s² M is positive definite: 0, or 0.02 ω if K is semidefinite up to rounding; otherwise empty.
  std::optional<double> definite_shift(const CoupledSystem &system, double largest_circular_frequency);
} // namespace Squeal
