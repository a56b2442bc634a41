// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/contact/coupled_system.h>
#include <squeal/system/system_file.h>

#include <optional>

namespace Squeal
{
  /**
   * The system of a file as one that charts, reduction and sensitivities work on.
   *
   * Its mass and stiffness are the symmetric sparse terms at the @p values. Its dofs are scaled, u = D v with D from powers of two, so that
   * the diagonal of K + ω² M is about one (largest entries of rows replace diagonal entries of zero): results do not depend on the units
   * of the dofs, and entries of very different size are no difficulty. D is the kernel of the system.
   *
   * Low-rank terms of friction, linear in a varied parameter μ with a common left factor, stay as they are and vanish at μ = 0; so do
   * symmetric ones in λ. Other terms of low rank are multiplied out.
   *
   * Symmetric parts of unsymmetric matrices (TermKind::circulatory) belong to mass and stiffness if these are definite then, else they
   * count as friction. Where there is no definite part either way, mass and stiffness are null: direct_modes() is for these.
   *
   * @param values  of all parameters, at which mass and stiffness are taken
   * @param varied  parameter of charts
   * @param largest_circular_frequency ω [rad/s]
   */
  CoupledSystem imported_system(const SystemFile      &file,
                                const ParameterValues &values,
                                const std::string     &varied,
                                double                 largest_circular_frequency);

  /// A shift s with which K + s² M is positive definite: 0, or 2 % of ω where K is semidefinite to rounding; nothing if it is not.
  std::optional<double> definite_shift(const CoupledSystem &system, double largest_circular_frequency);
} // namespace Squeal
