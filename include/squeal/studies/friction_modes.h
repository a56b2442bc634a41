#pragma once

#include <squeal/stability/complex_modes.h>
#include <squeal/studies/frictionless_modes.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Complex modes at one friction coefficient with their names and which of them grow.
  struct FrictionModes
  {
    ComplexModes              modes;
    std::vector<ModeIdentity> identities;
    std::vector<std::string>  labels;
    std::vector<bool>         unstable; ///< beyond what their accuracy leaves open

    std::size_t n_unstable() const;
  };

  /// Complex modes of the band by the solver that the parameters choose, as a step of the run called @p step.
  FrictionModes friction_modes(const Scene             &scene,
                               const Linearisation     &linearisation,
                               const FrictionlessModes &frictionless,
                               double                   mu,
                               Run                     &run,
                               const std::string       &step = "Complex modes");

  /// Stable or squeal, in one sentence.
  std::string verdict(const FrictionModes &modes, double mu, double maximum_frequency);
} // namespace Squeal
