#pragma once

#include <squeal/bases/rigid_body.h>
#include <squeal/contact/contact_operators.h>
#include <squeal/sliding/contact_problem.h>

#include <optional>

namespace Squeal
{
  /**
   * Motions of the disc that its mounts leave free and the reactions can balance,
   * n × k, M-orthonormal; nothing if there are none. Turning about the axis does
   * not count, whose moment the drive takes, nor do those that leave the gaps as they are.
   *
   * Throws SolverError if friction (@p mu > 0) acts on one of the latter.
   */
  std::optional<MultiVector> balanced_disc_motions(const Model             &model,
                                                   const ContactOperators  &contact,
                                                   const SecondOrderSystem &system,
                                                   const InertiaRelief     &response,
                                                   double                   mu);

  /**
   * A disc that floats between two loaded backplates is in balance wherever it
   * is along its axis, if the loads are: B y = 0 for a motion y of all. Then
   * one free motion of the disc, numbered from @p n_plates, is held instead of
   * balanced. Decided by the singular values of B with columns of unit norm, so that
   * the units of the motions play no part.
   *
   * Throws SolverError if the loads on such a disc are not in balance.
   */
  void hold_undetermined_motion(ContactProblem &problem, int n_plates);
} // namespace Squeal
