// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/bases/component_modes.h>
#include <squeal/estimates/judged_modes.h>
#include <squeal/output/fields.h>
#include <squeal/studies/steps/scene.h>

namespace Squeal
{
  /// Frictionless modes of the linearised model, with component modes and labels.
  struct FrictionlessModes : SystemModes
  {
    Linearisation          linearisation;
    ComponentModes         disc, pins_free, pins_sliding; ///< disc and sliding pins: slightly beyond the band; see imported_modes()
    std::vector<ModeLabel> labels;                        ///< labels of the coupled modes

    /// Component modes for the labels of coupled modes.
    std::vector<const ComponentModes *> references() const
    {
      return linearisation.scene != nullptr ? std::vector{&disc, &pins_sliding} : std::vector{&disc};
    }

    /// Contributions of component modes to coupled modes; @p imaginary_part may be null.
    std::vector<ShapeShares> shape_shares(const MultiVector &real_part, const MultiVector *imaginary_part) const;

    /// Products of the component modes with coupled vectors, n_coupled × r, for shape_shares() of reduced models.
    std::vector<DenseMatrix> reference_products(const MultiVector &vectors) const;

    /// Labels of coupled modes, without the signs of doublets; @p imaginary_part may be null.
    std::vector<ModeLabel> identify(const MultiVector &real_part, const MultiVector *imaginary_part) const;

  private:
    /// Coupled vectors on the uncoupled dofs, and the mass matrix there.
    MultiVector         on_bodies(const MultiVector &vectors) const;
    const SparseMatrix &mass_of_bodies() const;
  };

  /// Counts the real coupled modes by inertia, then computes component modes, the factorisation, and the real coupled modes up to (1 + @p
  /// margin) times the end of the band, as steps of the run. Throws ParameterError if there are more modes than the parameters allow, or if
  /// the rotation speed is supercritical.
  FrictionlessModes frictionless_modes(const Linearisation &linearisation, Run &run, double margin = 0.);

  /// Adds the modal damping from the parameters to the linearised system, for the modes in the band.
  void add_modal_damping(FrictionlessModes &modes, const Parameters &parameters);

  /// Assembles and linearises a model; computes its frictionless modes with modal damping, as steps of the run.
  FrictionlessModes damped_modes(Scene &scene, Run &run);

  /// A component mode in the band, as listed in tables.
  struct ListedComponentMode
  {
    const char           *component, *contact; ///< "disc" or "pins", "free" or "sliding"
    const ComponentModes *set;
    int                   number; ///< index in the set, from 0
    ModeLabel             label;  ///< label with the sign of a doublet

    double frequency() const; ///< [Hz]
  };

  /// Component modes with ω² ≤ @p largest_eigenvalue: free disc, sliding pins and free pins, each set in ascending order of frequency.
  std::vector<ListedComponentMode> listed_component_modes(const FrictionlessModes &modes, double largest_eigenvalue);

  /// Labelled complex modes at one friction coefficient.
  struct FrictionModes : JudgedModes
  {
    std::vector<ModeLabel> labels;
    Cost                   cost; ///< cost of the solution
    std::string            at;   ///< " at mu = 0.5", for messages
  };

  /// Labels @p modes from any solver; sets their cost to zero.
  FrictionModes named_modes(const FrictionlessModes &frictionless, JudgedModes modes);

  /// Complex modes of the band by the chosen solver.
  FrictionModes friction_modes(const FrictionlessModes &frictionless, double mu, Run &run);

  /// Records condition numbers and significant digits of the eigenvalues of @p modes (estimates/conditioning.h) in the run record, and
  /// warns if the errors exceed @p tolerance, the permitted relative error of eigenvalues.
  void record_conditioning(const CoupledSystem &system,
                           const ComplexModes  &modes,
                           const Conditioning  &conditioning,
                           double               tolerance,
                           Run                 &run);

  /// Travelling-wave shares of each disc mode; WaveShares::positive is along the rotation of the disc. Empty for other modes, or if the
  /// disc does not turn about z.
  std::vector<std::optional<WaveShares>> waves_with_rotation(const FrictionlessModes &frictionless,
                                                             const FrictionModes     &friction,
                                                             const SlidingVelocity   &velocity);

  /// Field of a complex mode, given as coupled displacements n × 1: displacements of the uncoupled bodies and normal reactions at all pairs
  /// of contact nodes. Collective.
  ModeField mode_field(const Linearisation        &linearisation,
                       const std::string          &name,
                       const std::complex<double> &lambda,
                       const MultiVector          &real_part,
                       const MultiVector          &imaginary_part);

  /// Verdict of the run: static divergence, squeal and undecided modes, one line each, or stable.
  std::vector<std::string> verdict(const FrictionModes &modes, double maximum_frequency);

  /// Explains a difference between the numbers of real modes and of modes with friction; empty if they agree. A mode that has stopped
  /// oscillating is replaced by two real eigenvalues. @p maximum_rate [1/s] of the band; 0: not set.
  std::string note_on_count(const FrictionModes &modes, std::size_t n_real_modes, double maximum_rate);

  /// Reports the number of modes that are neutral within rounding errors although the system has damping; empty if there are none, or no
  /// damping.
  std::string note_on_weak_damping(const CoupledSystem &system, const FrictionModes &modes);
} // namespace Squeal
