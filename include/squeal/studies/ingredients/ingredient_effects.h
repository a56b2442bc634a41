#pragma once

#include <squeal/bases/mode_label.h>
#include <squeal/parameters/ingredients.h>
#include <squeal/studies/steps/model_variants.h>

#include <complex>
#include <optional>
#include <vector>

namespace Squeal
{
  /// A mode of the reference beside its counterpart in a variant. Where there is only one of them the other has no value.
  struct ModeChange
  {
    ModeLabel                           label;              ///< in the reference; in the variant if it has no counterpart there
    std::optional<std::complex<double>> reference, variant; ///< λ [rad/s]
    bool                                unstable_reference = false, unstable_variant = false;
    double                              overlap    = 0.;    ///< of the shapes; see PairedMode [-]
    bool                                in_cluster = false; ///< single modes have no counterpart by shape: λ decides within the cluster

    /// Change of the frequency [%]; of a mode without counterpart what takes it to the end of the band at @p band_end [rad/s].
    double frequency(double band_end) const;

    /// Change of the divergence rate [percentage points]; nothing for a mode without counterpart.
    std::optional<double> divergence() const;

    /// One grows by more than a weak divergence rate where the other one does not grow, or is not there.
    bool changes_verdict() const;
  };

  /// What a variant changes, in all modes.
  struct Effect
  {
    std::vector<ModeChange> modes;    ///< in the order of the reference, then those that only the variant has
    double                  band_end; ///< of the variant [rad/s]
    int                     n_growing_real_reference, n_growing_real_variant;

    /// The mode whose frequency, or divergence rate, changes most, of those in the band of both; null if there is none.
    const ModeChange *largest_frequency() const;
    const ModeChange *largest_divergence() const;

    /// Absolute values of these [%, percentage points].
    double frequency() const;
    double divergence() const;

    std::size_t n_unstable(bool in_variant) const;
    std::size_t n_lost() const; ///< modes of the reference without counterpart

    bool changes_verdict() const;

    /// The largest change in units of the accuracy asked for: up to 1 a model keeps it; infinite where the verdict changes.
    double severity(const IngredientsParameters &accuracy) const;
  };

  /// Pairs the modes of a variant with those of the reference by pair_modes() and compares them. All processes must call.
  Effect effect_of(const SolvedModel &reference, const SolvedModel &variant);
} // namespace Squeal
