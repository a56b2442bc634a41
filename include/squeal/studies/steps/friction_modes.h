#pragma once

#include <squeal/estimates/judged_modes.h>
#include <squeal/output/fields.h>
#include <squeal/studies/steps/frictionless_modes.h>

#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /// Complex modes at one friction coefficient with their names.
  struct FrictionModes : JudgedModes
  {
    std::vector<ModeLabel> labels;
    Cost                   cost; ///< of the solution
  };

  /// Names @p modes, however they were found. Their cost is left zero.
  FrictionModes named_modes(const FrictionlessModes &frictionless, JudgedModes modes);

  /// Complex modes of the band by the solver that the parameters choose.
  FrictionModes friction_modes(const FrictionlessModes &frictionless, double mu, Run &run);

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
