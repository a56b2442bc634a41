#pragma once

#include <squeal/bases/component_modes.h>
#include <squeal/contact/updated_inverse.h>
#include <squeal/eigen/symmetric_modes.h>
#include <squeal/studies/scene.h>

#include <memory>
#include <string>
#include <vector>

namespace Squeal
{
  /// Modes without friction, and the inverse that serves them and every μ.
  struct FrictionlessModes
  {
    ComponentModes                  disc, pins_free, pins_sliding; ///< up to somewhat beyond the band, which labels modes at its end
    double                          shift;                         ///< of the inverse [rad/s]; positive if the disc is free
    std::unique_ptr<UpdatedInverse> inverse;
    SymmetricModes                  real;       ///< coupled, in the band and its margin
    std::vector<ModeIdentity>       identities; ///< of the coupled modes
    std::vector<std::string>        labels;
  };

  /**
   * The number of real coupled modes by inertia, component modes, the factorisation, and the real coupled modes up to
   * (1 + @p margin) times the end of the band, as steps of the run. Throws ParameterError if
   * there are more modes than the parameters allow.
   */
  FrictionlessModes frictionless_modes(const Scene &scene, const Linearisation &linearisation, Run &run, double margin = 0.);

  /// Adds the modal damping that the parameters ask for to the linearised system: that of the modes in the band.
  void add_modal_damping(const FrictionlessModes &modes, const Parameters &parameters, Linearisation &linearisation);

  /// Names of coupled modes after the component modes that they resemble; @p imaginary_part may be null.
  std::vector<ModeIdentity> identify_coupled(const Scene             &scene,
                                             const Linearisation     &linearisation,
                                             const FrictionlessModes &modes,
                                             const MultiVector       &real_part,
                                             const MultiVector       *imaginary_part);

  /// Labels with the marks of doublets, see mark_doublets(); the first @p n_rigid_body are `RB`.
  std::vector<std::string> labels_of(const std::vector<ModeIdentity> &identities,
                                     int                              n_rigid_body = 0,
                                     const std::vector<double>       &growth_rates = {});

  /// Modes inside the band, of ascending @p eigenvalues [rad²/s²].
  std::size_t n_in_band(const std::vector<double> &eigenvalues, double largest_eigenvalue);
} // namespace Squeal
