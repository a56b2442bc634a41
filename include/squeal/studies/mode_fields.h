#pragma once

#include <squeal/output/fields.h>
#include <squeal/studies/scene.h>

#include <complex>
#include <string>

namespace Squeal
{
  /**
   * Field of a complex mode, coupled displacements n × 1, on the uncoupled
   * bodies, with the normal reactions at all pairs of contact nodes, of which
   * those numbered in @p closed are coupled. All processes must call.
   */
  ModeField mode_field(const Scene                     &scene,
                       const CoupledSystem             &system,
                       const std::vector<unsigned int> &closed,
                       const std::string               &name,
                       const std::complex<double>      &lambda,
                       const MultiVector               &real_part,
                       const MultiVector               &imaginary_part);
} // namespace Squeal
