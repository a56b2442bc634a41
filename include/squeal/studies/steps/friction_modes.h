#pragma once

#include <squeal/estimates/conditioning.h>
#include <squeal/modes/complex_modes.h>
#include <squeal/modes/verdict.h>
#include <squeal/output/fields.h>
#include <squeal/studies/steps/frictionless_modes.h>

#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// Complex modes at one friction coefficient with their names and which of them grow.
  struct FrictionModes
  {
    ComplexModes           modes;
    std::vector<ModeLabel> labels;
    std::vector<Verdict>   verdicts; ///< with the uncertainty of λ
    std::vector<bool>      unstable; ///< beyond their uncertainty
    Conditioning           conditioning;
    int  n_slow = 0; ///< pairs of λ that count as zero but belong to no rigid body, such as slow decay against strong dampers
    Cost cost;       ///< of the solution

    std::size_t n_unstable() const;

    /// Modes of this verdict.
    std::size_t n_of(Verdict verdict) const;

    /// Real eigenvalues λ > 0: static divergence.
    std::size_t n_growing_real() const;
  };

  /// Names @p modes, however they were found, and decides which of them grow. Their cost is left zero.
  FrictionModes named_modes(const FrictionlessModes &frictionless, ComplexModes modes);

  /// Complex modes of the band by the solver that the parameters choose.
  FrictionModes friction_modes(const FrictionlessModes &frictionless, double mu, Run &run);

  /**
   * Relative errors of λ by which growth is judged. The largest of all counts for every mode, since that of a single one may be much
   * too small by chance; but a slow mode, of which cancellation in the stiffness takes many digits, has its own.
   */
  std::vector<double> uncertainties(const CoupledSystem &system, const ComplexModes &modes, const Conditioning &conditioning);

  /**
   * Keeps condition numbers and the digits that the eigenvalues of @p modes keep (estimates/conditioning.h) in the run record, and warns
   * where they are fewer than @p tolerance asks for, the relative error of eigenvalues that the parameters allow.
   */
  void record_conditioning(const CoupledSystem &system,
                           const ComplexModes  &modes,
                           const Conditioning  &conditioning,
                           double               tolerance,
                           Run                 &run);

  /// How each disc mode travels, WaveShares::positive along with the rotation of the disc; nothing for other modes.
  std::vector<std::optional<WaveShares>> waves_with_rotation(const FrictionlessModes &frictionless,
                                                             const FrictionModes     &friction,
                                                             Rotation                 rotation);

  /**
   * Field of a complex mode, coupled displacements n × 1, on the uncoupled
   * bodies, with the normal reactions at all pairs of contact nodes. All processes must call.
   */
  ModeField mode_field(const Linearisation        &linearisation,
                       const std::string          &name,
                       const std::complex<double> &lambda,
                       const MultiVector          &real_part,
                       const MultiVector          &imaginary_part);

  /// Stable, squeal or static divergence, one line for each.
  std::vector<std::string> verdict(const FrictionModes &modes, double mu, double maximum_frequency);

  /**
   * Where the numbers of real modes and of modes with friction differ, what became of the difference; else empty. Two real
   * eigenvalues stand for one mode that has stopped oscillating.
   */
  std::string note_on_count(const FrictionModes &modes, std::size_t n_real_modes);

  /// How many modes neither grow nor decay by more than rounding errors although there is damping; empty where all do, or none is damped.
  std::string note_on_weak_damping(const CoupledSystem &system, const FrictionModes &modes);
} // namespace Squeal
