// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/bases/component_modes.h>
#include <squeal/estimates/judged_modes.h>
#include <squeal/output/fields.h>
#include <squeal/studies/steps/scene.h>

namespace Squeal
{
  /// Modes of the linearised scene without friction, with what the scene adds: components and names.
  struct FrictionlessModes : SystemModes
  {
    Linearisation  linearisation;
    ComponentModes disc, pins_free, pins_sliding; ///< up to somewhat beyond the band, which labels modes at its end; see imported_modes()
    std::vector<ModeLabel> labels;                ///< of the coupled modes

    /// Component modes that give coupled ones their names.
    std::vector<const ComponentModes *> references() const
    {
      return linearisation.scene != nullptr ? std::vector{&disc, &pins_sliding} : std::vector{&disc};
    }

    /// What coupled modes have of them; @p imaginary_part may be null.
    std::vector<ShapeShares> shape_shares(const MultiVector &real_part, const MultiVector *imaginary_part) const;

    /// Products of the references with vectors of the coupled system, n_coupled × r, for shape_shares() of reduced models.
    std::vector<DenseMatrix> reference_products(const MultiVector &vectors) const;

    /// Identities of coupled modes, without the signs of doublets; @p imaginary_part may be null.
    std::vector<ModeLabel> identify(const MultiVector &real_part, const MultiVector *imaginary_part) const;

  private:
    /// Coupled vectors on the uncoupled dofs, and the mass there.
    MultiVector         on_bodies(const MultiVector &vectors) const;
    const SparseMatrix &mass_of_bodies() const;
  };

  /// The number of real coupled modes by inertia, component modes, the factorisation, and the real coupled modes up to (1 + @p margin)
  /// times the end of the band, as steps of the run. Throws ParameterError if there are more modes than the parameters allow.
  FrictionlessModes frictionless_modes(const Linearisation &linearisation, Run &run, double margin = 0.);

  /// Adds the modal damping that the parameters ask for to the linearised system: that of the modes in the band.
  void add_modal_damping(FrictionlessModes &modes, const Parameters &parameters);

  /// Assembles and linearises a scene; its modes with the modal damping of the parameters, as steps of the run.
  FrictionlessModes damped_modes(Scene &scene, Run &run);

  /// A mode of a component in the band, as the tables list it.
  struct ListedComponentMode
  {
    const char           *component, *contact; ///< "disc" or "pins", "free" or "sliding"
    const ComponentModes *set;
    int                   number; ///< in the set, from 0
    ModeLabel             label;  ///< with the sign of a doublet

    double frequency() const; ///< [Hz]
  };

  /// Component modes with ω² ≤ @p largest_eigenvalue: of the free disc, the sliding pins and the free pins, each set ascending.
  std::vector<ListedComponentMode> listed_component_modes(const FrictionlessModes &modes, double largest_eigenvalue);

  /// Complex modes at one friction coefficient with their names.
  struct FrictionModes : JudgedModes
  {
    std::vector<ModeLabel> labels;
    Cost                   cost; ///< of the solution
    std::string            at;   ///< " at mu = 0.5", for messages
  };

  /// Names @p modes, however they were found. Their cost is left zero.
  FrictionModes named_modes(const FrictionlessModes &frictionless, JudgedModes modes);

  /// Complex modes of the band by the solver that the parameters choose.
  FrictionModes friction_modes(const FrictionlessModes &frictionless, double mu, Run &run);

  /// Keeps condition numbers and the digits that the eigenvalues of @p modes keep (estimates/conditioning.h) in the run record, and warns
  /// where they are fewer than @p tolerance asks for, the relative error of eigenvalues that the parameters allow.
  void record_conditioning(const CoupledSystem &system,
                           const ComplexModes  &modes,
                           const Conditioning  &conditioning,
                           double               tolerance,
                           Run                 &run);

  /// How each disc mode travels, WaveShares::positive along with the rotation of the disc; nothing for other modes, and where the disc
  /// does not turn about z.
  std::vector<std::optional<WaveShares>> waves_with_rotation(const FrictionlessModes &frictionless,
                                                             const FrictionModes     &friction,
                                                             const SlidingVelocity   &velocity);

  /// Field of a complex mode, coupled displacements n × 1, on the uncoupled bodies, with the normal reactions at all pairs of contact
  /// nodes. All processes must call.
  ModeField mode_field(const Linearisation        &linearisation,
                       const std::string          &name,
                       const std::complex<double> &lambda,
                       const MultiVector          &real_part,
                       const MultiVector          &imaginary_part);

  /// Stable, squeal or static divergence, one line for each.
  std::vector<std::string> verdict(const FrictionModes &modes, double maximum_frequency);

  /// Where the numbers of real modes and of modes with friction differ, what became of the difference; else empty. Two real eigenvalues
  /// stand for one mode that has stopped oscillating. @p maximum_rate [1/s] of the band; 0: none is given.
  std::string note_on_count(const FrictionModes &modes, std::size_t n_real_modes, double maximum_rate);

  /// How many modes neither grow nor decay by more than rounding errors although there is damping; empty where all do, or none is damped.
  std::string note_on_weak_damping(const CoupledSystem &system, const FrictionModes &modes);
} // namespace Squeal
