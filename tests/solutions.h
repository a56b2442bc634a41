// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include "matrices.h"
#include "scenes.h"

#include <squeal/base/conventions.h>
#include <squeal/bases/rigid_body.h>
#include <squeal/eigen/dense_quadratic.h>
#include <squeal/eigen/symmetric_modes.h>
#include <squeal/estimates/residual_iteration.h>
#include <squeal/linear_algebra/multivector.h>
#include <squeal/linear_algebra/sparse_matrix.h>
#include <squeal/modes/system_modes.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <vector>

namespace Squeal::Testing
{
  // ------------------------------------------------------------------ scenes

  /// Upper end of the band [rad/s].
  inline const double omega_max = circular_frequency(6000.);

  // Layouts of the pins: symmetric about the x axis, and skewed
  inline const std::vector<PolarPin> symmetric_pins = {{Plan::Side::top, -1, 2, 1, 1},
                                                       {Plan::Side::top, 4, 2, 0, 1},
                                                       {Plan::Side::top, -6, 2, 0, 1},
                                                       {Plan::Side::bottom, -1, 2, 1, 1}};
  inline const std::vector<PolarPin> skewed_pins    = {{Plan::Side::top, -1, 2, 1, 1},
                                                       {Plan::Side::top, 3, 2, 0, 1},
                                                       {Plan::Side::bottom, 0, 2, 1, 1}};

  inline Mesh mesh_of(const std::vector<PolarPin> &pins)
  {
    return extrude(polar_plan(0.1505, 0.3155, 3, 18, pins), layers(1, 2));
  }

  // --------------------------------------------------------------- solutions

  inline SymmetricModes real_modes(const CoupledSystem &system, const RealSolver solver = RealSolver::lanczos)
  {
    SymmetricModesOptions options;
    options.solver    = solver;
    options.tolerance = 1e-12;
    return symmetric_modes(*system.stiffness, *system.mass, omega_max * omega_max, options);
  }

  /// A free disc with in-plane rigid-body motions, λ = 0, whose frictionless modes require a shift.
  struct FreeDisc
  {
    explicit FreeDisc(const MaterialParameters &materials = mounted({}))
      : s(mesh_of(skewed_pins), materials, operating())
      , shift(stabilizing_shift(s.model, s.coupled, omega_max))
    {
      EXPECT_GT(shift, 0.);
      SymmetricModesOptions options;
      options.shift = shift * shift;
      real          = symmetric_modes(*s.coupled.stiffness, *s.coupled.mass, omega_max * omega_max, options);
      EXPECT_EQ(real.n_rigid_body, 3);
    }

    Scene          s;
    double         shift; ///< [rad/s]
    SymmetricModes real;
  };

  inline ComplexModes krylov(const CoupledSystem &system,
                             const double         friction,
                             const double         tolerance = 1e-11,
                             const ShiftInverse   how       = ShiftInverse::updated_cholesky)
  {
    SolverParameters solvers;
    solvers.complex_tolerance = tolerance;
    solvers.shift_inverse     = how;
    UpdatedInverse inverse(system, 0., FactorizationLibrary::automatic);
    Progress       progress;
    return krylov_modes(system, inverse, 0., friction, omega_max, 20, solvers, progress);
  }

  inline ComplexModes iterated(const CoupledSystem &system, const double friction, const double tolerance)
  {
    UpdatedInverse           inverse(system, 0., FactorizationLibrary::automatic);
    ResidualIterationOptions options;
    options.band      = omega_max;
    options.tolerance = tolerance;
    Progress progress;
    return residual_iteration(system, inverse, *real_modes(system).vectors, friction, options, progress);
  }

  /// λ of a small system with all frequencies below 10 rad/s, computed by each of the three solvers.
  inline std::vector<std::vector<Complex>> solutions(const CoupledSystem &system, const double mu)
  {
    const int        n = system.map().n();
    Progress         progress;
    UpdatedInverse   inverse(system, 0., FactorizationLibrary::automatic);
    SolverParameters solvers;
    solvers.complex_tolerance = 1e-13;
    const auto krylov         = krylov_modes(system, inverse, 0., mu, 10., n, solvers, progress);

    ResidualIterationOptions options;
    options.band        = 10.;
    options.tolerance   = 1e-12;
    const auto iterated = residual_iteration(system, inverse, unit_vectors(system.map()), mu, options, progress);

    const SecondOrderSystem matrices = with_friction(system, mu);
    DenseMatrix             C;
    if (matrices.damping)
      C = to_dense(*matrices.damping);
    const auto dense = dense_quadratic_modes(to_dense(*matrices.mass), matrices.damping ? &C : nullptr, to_dense(*matrices.stiffness));
    return {krylov.lambda, iterated.lambda, dense.values};
  }

  /**
   * A system with friction at some contact nodes, given by its matrices; damping may be null.
   *
   * @param tangential Aᵀ, n_c × n
   * @param V_K, V_C reactions to stiffness and damping forces, n_c × n; reactions to inertia are zero
   */
  inline CoupledSystem system_of(const SecondOrderSystem                   &matrices,
                                 const std::shared_ptr<const SparseMatrix> &tangential,
                                 const std::shared_ptr<const SparseMatrix> &V_K,
                                 const std::shared_ptr<const SparseMatrix> &V_C = nullptr)
  {
    const RowMap            &map    = matrices.mass->rows();
    std::vector<CoupledTerm> bodies = {{sparse_term("stiffness", 0, {}, matrices.stiffness), V_K},
                                       {sparse_term("mass", 2, {}, matrices.mass), nullptr}};
    if (matrices.damping)
      bodies.push_back({sparse_term("damping of the bodies", 1, {}, matrices.damping), V_C});
    CoupledSystem result = coupled_system(bodies, tangential, sparse(tangential->rows(), map, [](int) { return Row{}; }));
    result.kernel        = diagonal(map, [](int) { return 1.; });
    return result;
  }

  /// A system without contact.
  inline CoupledSystem system_of(const SecondOrderSystem &matrices)
  {
    return system_of(matrices, sparse(rows(1), matrices.mass->rows(), [](int) { return Row{}; }), nullptr);
  }

  // --------------------------------------------------------------- stability

  inline int n_unstable(const ComplexModes &modes)
  {
    return std::count_if(modes.lambda.begin(), modes.lambda.end(), [](const Complex &l) { return l.real() > 1e-8 * l.imag(); });
  }
} // namespace Squeal::Testing
