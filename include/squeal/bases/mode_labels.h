#pragma once

#include <squeal/contact/contact_interface.h>
#include <squeal/linear_algebra/dense_matrix.h>
#include <squeal/model/model.h>

#include <string>
#include <vector>

namespace Squeal
{
  /**
   * Names of disc modes from their Fourier content about the axis (section 4.1
   * of the paper): A, R or C for dominant axial, radial or circumferential
   * kinetic energy, then nodal circles m and nodal diameters n: `A0-4`. Of each
   * displacement component the content of a harmonic n is the energy of its
   * least-squares projection on { r^k cos nθ, r^k sin nθ }, k = 0 ... 4, weighted
   * by nodal masses; nodal circles are the sign changes of the radial profile
   * of the dominant harmonic.
   *
   * @param modes        n_free × k displacements
   * @param nodal_masses n_nodes, lumped [kg]
   */
  std::vector<std::string> disc_labels(const Model &model, const std::vector<double> &nodal_masses, const DenseMatrix &modes);

  /**
   * Names of pin modes: F flexural, T torsional, L longitudinal about the axis
   * through the centre of each pin's contact nodes along its normal, by the
   * larger energy, numbered in ascending order of frequency: the first two F
   * modes of every pin are F1. Modes must come in that order.
   */
  std::vector<std::string> pin_labels(const Model               &model,
                                      const ContactInterface    &interface,
                                      const std::vector<double> &nodal_masses,
                                      const DenseMatrix         &modes);

  /// Label of a mode that resembles none of the component modes left for it.
  inline constexpr const char *no_label = "unnamed";

  /// Family and order of a pin mode's label, without the sign of a doublet: `F1`; empty for any other label.
  std::string pin_family(const std::string &label);

  /**
   * Suffixes ` -` and ` +` to labels that occur exactly twice; none to no_label.
   * ` +` gets the mode that grows, or grows more; where neither grows, the one of
   * the higher frequency. That is the rule for every table of every study.
   *
   * @param labels       of modes in the order of their frequencies
   * @param growth_rates of each mode, zero for one that does not grow [any unit]; empty: none grows
   */
  void mark_doublets(std::vector<std::string> &labels, const std::vector<double> &growth_rates = {});
} // namespace Squeal
