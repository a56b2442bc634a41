#pragma once

#include <squeal/parameters/declarations.h>

#include <vector>

namespace Squeal
{
  /// Damping ratio of modes of one frequency.
  struct ModalDampingRatio
  {
    double frequency; ///< [Hz]
    double ratio;     ///< ζ [-]
  };

  /**
   * Damping given mode by mode (section `Damping`). That of the materials is
   * with the materials, that of the contact with the operation.
   */
  struct DampingParameters
  {
    std::vector<ModalDampingRatio> modal_ratios; ///< ascending frequencies; empty: none

    /// ζ of a mode of @p frequency [Hz]: linear between the entries, constant beyond the first and last; 0 if there are none.
    double modal_ratio(double frequency) const;

    void declare(Declarations &declarations);

    /// Throws ParameterError.
    void check() const;
  };
} // namespace Squeal
