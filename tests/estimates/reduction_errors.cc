// SPDX-License-Identifier: GPL-3.0-or-later

#include "solutions.h"

#include <squeal/base/exceptions.h>
#include <squeal/estimates/reduction_errors.h>

#include <set>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr double large_friction = 0.6;

  /// A model with its real modes and complex reference modes.
  struct Reference
  {
    Reference()
      : s(mesh_of(skewed_pins), damped(mounted()), operating(RadialDissipation::consistent))
      , inverse(s.coupled, 0., FactorizationLibrary::automatic)
      , real(real_modes(s.coupled))
      , complex(krylov(s.coupled, large_friction))
    {}

    ReducedModel reduced(const MultiVector &T) const
    {
      ReducedModel model(s.coupled);
      model.extend(T);
      return model;
    }

    std::vector<ModeError> errors(const MultiVector &T) const
    {
      const ReducedModel model = reduced(T);
      return reduction_errors(s.coupled, inverse, model, reduced_modes(model, large_friction, omega_max, BandEnd::open), complex);
    }

    Scene          s;
    UpdatedInverse inverse;
    SymmetricModes real;
    ComplexModes   complex;
  };

  double largest(const std::vector<ModeError> &errors, double ModeError::*const what)
  {
    double result = 0.;
    for (const ModeError &error : errors)
      result = std::max(result, error.*what);
    return result;
  }

  /// Two-dof flutter, K = [k11 k12 − μ k_c; k12 k22], with a stiff third dof, whose omission increases k11.
  struct StiffenedFlutter
  {
    double damping = 0., k11 = 3., k22 = 2., k12 = 0.7, k_c = 1.3, c = 0.3, k33 = 100.;

    /// Friction coefficient at which the modes coalesce for k11 = k.
    double threshold(const double k) const
    {
      return ((k - k22) * (k - k22) / (4. * k12) + k12) / k_c;
    }

    double reduced_k11() const
    {
      return k11 + c * c / k33;
    }

    CoupledSystem system() const
    {
      const DenseMatrix K{{reduced_k11(), k12, c}, {k12, k22, 0.}, {c, 0., k33}}, M{{1., 0., 0.}, {0., 1., 0.}, {0., 0., 1e-6}},
        C{{damping, 0., 0.}, {0., damping, 0.}, {0., 0., 0.}};
      return system_of({sparse(M), damping != 0. ? sparse(C) : nullptr, sparse(K)}, sparse(DenseMatrix{{1., 0., 0.}}),
                       sparse(DenseMatrix{{0., k_c, 0.}}));
    }
  };

  /// Uncoupled oscillators of unit mass without contact.
  struct Masses
  {
    explicit Masses(const std::vector<double> &k)
      : system(system_of({sparse(DenseMatrix::Identity(k.size(), k.size())), nullptr, sparse(as_column(k).asDiagonal())}))
      , inverse(system, 0., FactorizationLibrary::automatic)
      , I(unit_vectors(system.map()))
      , model(system)
    {}

    static ComplexModes reference(const std::vector<double> &k, const MultiVector &vectors)
    {
      SymmetricModes modes;
      modes.eigenvalues = k;
      modes.residuals.assign(k.size(), 0.);
      modes.vectors = std::make_shared<MultiVector>(vectors);
      return undamped_modes(modes);
    }

    CoupledSystem  system;
    UpdatedInverse inverse;
    MultiVector    I;
    ReducedModel   model;
  };
} // namespace

TEST(ReductionErrors, AreTheFormulasOfThePaper)
{
  const Reference    r;
  const ReducedModel model  = r.reduced(*r.real.vectors);
  const ReducedModes modes  = reduced_modes(model, large_friction, omega_max, BandEnd::open);
  const auto         errors = reduction_errors(r.s.coupled, r.inverse, model, modes, r.complex);
  EXPECT_GT(largest(errors, &ModeError::shape), 1e-6);
  EXPECT_THROW(r.errors(view(*r.real.vectors, 0, r.real.vectors->n_columns() - 3)), SolverError); // too few modes

  // Compare with full-order vectors of the reduced modes and with ε_res from full_order_modes()
  std::set<int> matches;
  for (const ModeError &error : errors)
    {
      EXPECT_TRUE(matches.insert(error.match).second);
      const ComplexModes found = full_order_modes(r.s.coupled, r.inverse, model, selected(modes, {error.match}), nullptr);
      EXPECT_EQ(found.lambda.front(), error.reduced);
      EXPECT_NEAR(found.energy_residuals.front(), error.residual, 1e-6 * error.residual + 1e-14);

      const int         j  = &error - errors.data();
      const MultiVector X  = join({&*found.real_part, &*found.imaginary_part});
      const MultiVector re = view(*r.complex.real_part, j, 1), im = view(*r.complex.imaginary_part, j, 1);
      const DenseMatrix G = gram(join({&re, &im}), *r.s.coupled.mass * X);
      EXPECT_NEAR(error.shape, 1. - std::norm(Complex(G(0, 0) + G(1, 1), G(0, 1) - G(1, 0))), 1e-10);
      EXPECT_NEAR(error.cluster_size == 1 ? error.subspace : error.shape, error.shape, 1e-10);
      const auto rate = [](const Complex &l) { return l.real() / l.imag(); };
      EXPECT_NEAR(error.frequency, std::abs(error.reduced.imag() - error.reference.imag()) / error.reference.imag(), 1e-15);
      EXPECT_NEAR(error.divergence, std::abs(rate(error.reduced) - rate(error.reference)), 1e-15);
    }
}

TEST(ModeMatching, ClustersAreComparedAsSubspaces)
{
  // Rotated vectors of a double mode and a third mode nearby have no individual counterparts, but their span has one
  Masses masses({1., 1., 1.0005, 4., 9., 16.});
  masses.model.extend(masses.I);
  const MultiVector &I     = masses.I;
  const auto         modes = reduced_real_modes(masses.model, 10., BandEnd::open);
  MultiVector        turned(I.map(), 4);
  turned.col(0)        = 0.6 * I.col(0) + 0.8 * I.col(1);
  turned.col(1)        = -0.8 * I.col(0) + 0.6 * I.col(1);
  turned.col(2)        = I.col(2);
  turned.col(3)        = I.col(3);
  const auto errors_of = [&](const auto &...width) {
    return reduction_errors(masses.system, masses.inverse, masses.model, modes, Masses::reference({1., 1., 1.0005, 4.}, turned), width...);
  };
  const auto errors = errors_of();
  ASSERT_EQ(errors.size(), 4u);
  EXPECT_GT(std::max(errors[0].shape, errors[1].shape), 0.1);
  EXPECT_LT(largest(errors, &ModeError::subspace), 1e-14);
  EXPECT_LT(largest(errors, &ModeError::eigenvalue), 1e-14);
  for (int j = 0; j < 4; ++j)
    EXPECT_EQ(errors[j].cluster_size, j < 3 ? 3 : 1);
  EXPECT_EQ(errors_of(1e-6)[2].cluster_size, 1);

  // Tilt one vector out of the cluster by an angle with sine 0.28
  turned.col(1) = 0.28 * I.col(4) + 0.96 * turned.col(1);
  for (const ModeError &error : errors_of())
    EXPECT_NEAR(error.subspace, error.cluster_size == 3 ? 0.28 * 0.28 : 0., 1e-12);
}

TEST(ModeMatching, ByEquation17OneReducedModeMayServeTwice)
{
  // One reduced mode is closest to e_0 and to e_2 and, by eq. (17), the counterpart of both; one-to-one matching assigns the other
  // reduced mode to e_2
  Masses             masses({1., 4., 1.2, 9.});
  const MultiVector &I = masses.I;
  MultiVector        T(I.map(), 2), exact(I.map(), 2);
  exact.col(0) = I.col(0);
  exact.col(1) = I.col(2);
  T.col(0)     = 0.8 * I.col(0) + 0.6 * I.col(2);
  T.col(1)     = 0.28 * (0.6 * I.col(0) - 0.8 * I.col(2)) + 0.96 * I.col(3);
  masses.model.extend(T);
  // Set frequencies such that matching depends only on shapes
  ReducedModes modes = reduced_real_modes(masses.model, 10., BandEnd::open);
  modes.lambda       = {{0., 1.}, {0., std::sqrt(1.2)}};

  const auto errors = reduction_errors(masses.system, masses.inverse, masses.model, modes, Masses::reference({1., 1.2}, exact));
  ASSERT_EQ(errors.size(), 2u);
  for (const int j : {0, 1})
    {
      EXPECT_EQ(errors[j].match, j);
      EXPECT_EQ(errors[j].closest, 0);
    }
  EXPECT_EQ(errors[0].closest_shape, errors[0].shape);
  EXPECT_NEAR(errors[1].closest_shape, 1. - 0.36, 0.05);
  EXPECT_GT(errors[1].shape, errors[1].closest_shape + 0.2);
  EXPECT_EQ(errors[1].closest_frequency, std::abs(1. - std::sqrt(1.2)) / std::sqrt(1.2));
  EXPECT_EQ(errors[1].frequency, 0.);

  const auto groups = largest_errors(errors, {"disc", "F1"}, {{"disc", "F1"}, {"disc", "T1"}});
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(groups[1].n_other, 1);
  EXPECT_EQ(groups[2].group, "disc and F1");
  EXPECT_EQ(groups[2].n_modes, 2);
  EXPECT_EQ(groups[2].n_other, 1);
  EXPECT_EQ(groups[2].shape, errors[1].shape);
  EXPECT_EQ(groups[2].closest_shape, errors[1].closest_shape);
}

TEST(EigenvalueEstimates, FindTheErrorAndMendIt)
{
  // For a model without the third dof, the estimate equals the error to first order if modes are not close to coalescence
  for (const double damping : {0., 0.02})
    {
      const StiffenedFlutter flutter{damping};
      const CoupledSystem    system = flutter.system();
      const UpdatedInverse   inverse(system, 0., FactorizationLibrary::automatic);
      const MultiVector      units = unit_vectors(system.map());
      ReducedModel           model(system), full(system);
      model.extend(view(units, 0, 2));
      full.extend(units);
      const auto estimated = [&](const ReducedModes &modes) {
        return estimate_eigenvalues(modes, residual_vectors(system, inverse, model, modes).products());
      };
      for (const double factor : {0., 0.5, 0.9, 1.1, 1.5})
        {
          const double friction = factor * flutter.threshold(flutter.k11);
          const auto   modes = reduced_modes(model, friction, 10.), exact = reduced_modes(full, friction, 10.);
          const auto   estimates = estimated(modes);
          ASSERT_EQ(modes.lambda.size(), 2u);
          ASSERT_EQ(exact.lambda.size(), 2u);
          for (int j = 0; j < 2; ++j)
            {
              SCOPED_TRACE("factor " + std::to_string(factor) + ", mode " + std::to_string(j));
              // The order of an unstable pair is arbitrary, because both modes have the same frequency
              const Complex same = exact.lambda[j], other = exact.lambda[1 - j];
              const Complex nearest = std::abs(same - modes.lambda[j]) < std::abs(other - modes.lambda[j]) ? same : other;
              const Complex error   = nearest - modes.lambda[j];
              EXPECT_TRUE(estimates.claimed[j]);
              EXPECT_LT(std::abs(estimates.corrections[j] - error), 0.05 * std::abs(error));
              EXPECT_EQ(estimates.errors[j], std::abs(estimates.corrections[j]) / std::abs(modes.lambda[j]));
              EXPECT_GE(estimates.conditions[j], 1. - 1e-10);
              const Verdict moving = nearest.real() > 0. ? Verdict::unstable : Verdict::stable;
              EXPECT_EQ(estimates.verdicts[j], damping == 0. && factor < 1. ? Verdict::neutral : moving);
            }
        }
      if (damping > 0.)
        continue;
      // No error is estimated close to coalescence of the reduced modes
      double condition = 1.;
      for (const double distance : {0.3, 1e-2, 1e-4, 1e-7})
        for (const double side : {-1., 1.})
          {
            const auto modes     = reduced_modes(model, flutter.threshold(flutter.reduced_k11()) * (1. + side * distance), 10.);
            const auto estimates = estimated(modes);
            for (std::size_t j = 0; j < modes.lambda.size(); ++j)
              {
                EXPECT_EQ(estimates.claimed[j], distance > 1e-3) << distance;
                EXPECT_EQ(estimates.verdicts[j] == Verdict::undecided, distance < 1e-3) << distance << ", " << side;
                EXPECT_GT(estimates.conditions[j], side > 0. ? condition : 1.);
              }
            if (side > 0.)
              condition = estimates.conditions.front();
          }
      EXPECT_GT(condition, 1e3);
    }
}
