// SPDX-License-Identifier: GPL-3.0-or-later

#include "solutions.h"

#include <squeal/linear_algebra/sparse_matrix.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr double mu = 0.6;

  /// Damping of contact and bodies.
  struct Losses
  {
    RadialDissipation  contact;
    MaterialParameters bodies;
  };
  const std::vector<Losses> all_losses = {{RadialDissipation::none, mounted()},
                                          {RadialDissipation::consistent, mounted()},
                                          {RadialDissipation::consistent, damped(mounted())}};

  Scene scene(const Losses &losses)
  {
    return Scene(mesh_of(skewed_pins), losses.bodies, operating(losses.contact));
  }
} // namespace

TEST(ComplexModes, NormalisedSortedAndWithTheirResiduals)
{
  for (const Losses &losses : all_losses)
    {
      const Scene s = scene(losses);
      for (const ComplexModes &modes : {krylov(s.coupled, mu), iterated(s.coupled, mu, 1e-8)})
        {
          const int         k     = modes.lambda.size();
          const MultiVector X     = join({modes.real_part.get(), modes.imaginary_part.get()});
          const auto        times = [&](const SparseMatrix &A) { return from_halves(replicate(A * X)); };
          const auto        R     = force_residuals(s.coupled, s.coupled.at(mu), modes.lambda, *modes.real_part, *modes.imaginary_part);

          // Residual Q(λ)φ from the sparse matrices at this μ
          const SecondOrderSystem  matrices = with_friction(s.coupled, mu);
          const Eigen::VectorXcd   lambda = as_column(modes.lambda), squares = lambda.array().square();
          const ComplexDenseMatrix phi = from_halves(replicate(X)), M_phi = times(*s.coupled.mass), K_phi = times(*s.coupled.stiffness);
          ComplexDenseMatrix       Q = times(*matrices.stiffness) + times(*matrices.mass) * squares.asDiagonal();
          if (matrices.damping)
            Q += times(*matrices.damping) * lambda.asDiagonal();
          const ComplexDenseMatrix difference = Q - from_halves(replicate(R));
          for (int j = 0; j < k; ++j)
            {
              EXPECT_NEAR(phi.col(j).dot(M_phi.col(j)).real(), 1., 1e-12);
              EXPECT_LE(modes.lambda[j > 0 ? j - 1 : 0].imag(), modes.lambda[j].imag() * (1. + 1e-9));
              const double size = K_phi.col(j).norm();
              EXPECT_NEAR(Q.col(j).norm() / size, modes.residuals[j], 1e-12 + 0.01 * modes.residuals[j]);
              EXPECT_LT(difference.col(j).norm() / size, 1e-11);

              // Modes are normalised such that an entry of largest modulus is real and positive
              const double modulus = phi.col(j).cwiseAbs().maxCoeff();
              EXPECT_LT((phi.col(j).array() - modulus).abs().minCoeff(), 1e-12 * modulus);
              EXPECT_GE(modes.energy_residuals[j], 0.);
            }
          EXPECT_TRUE(modes.real_values.empty());
          EXPECT_EQ(modes.n_rigid_body, 0);
        }
    }
}

TEST(ComplexModes, ResidualIterationKeepsItsPromise)
{
  for (const Losses &losses : all_losses)
    {
      const Scene s         = scene(losses);
      const auto  reference = krylov(s.coupled, mu, 1e-11, ShiftInverse::sparse_lu);
      ASSERT_GT(n_unstable(reference), 0);
      EXPECT_LT(largest(distances(krylov(s.coupled, mu).lambda, reference.lambda)), 1e-10);
      for (const double tolerance : {1e-4, 1e-7})
        {
          const auto modes  = iterated(s.coupled, mu, tolerance);
          const auto errors = distances(modes.lambda, reference.lambda);
          ASSERT_EQ(errors.size(), modes.estimated_errors.size());
          EXPECT_LT(largest(errors), 2. * tolerance);
          // The estimate approximates the error, less accurately for a loose tolerance, for which the basis is small
          const double factor     = tolerance > 1e-6 ? 20. : 10.;
          int          n_compared = 0;
          for (std::size_t j = 0; j < errors.size(); ++j)
            {
              EXPECT_LE(modes.estimated_errors[j], tolerance);
              if (errors[j] > 1e-10)
                {
                  ++n_compared;
                  EXPECT_GT(modes.estimated_errors[j], errors[j] / factor) << "mode " << j;
                  EXPECT_LT(modes.estimated_errors[j], errors[j] * factor) << "mode " << j;
                }
            }
          EXPECT_GT(n_compared, 3);
        }
    }
}

TEST(ComplexModes, MirrorImageTurnsTheOtherWay)
{
  for (const RadialDissipation dissipation : {RadialDissipation::none, RadialDissipation::consistent})
    {
      const Mesh mesh    = mesh_of(skewed_pins);
      const auto turning = [&](const Mesh &scene, const Rotation rotation) {
        return krylov(Scene(scene, mounted(), operating(dissipation, rotation)).coupled, mu);
      };
      const auto modes = turning(mesh, Rotation::positive);
      ASSERT_GT(n_unstable(modes), 0);
      EXPECT_LT(largest(distances(modes.lambda, turning(mirrored(mesh), Rotation::negative).lambda)), 1e-9);
      EXPECT_GT(largest(distances(modes.lambda, turning(mesh, Rotation::negative).lambda)), 1e-3);
    }
}

TEST(ComplexModes, AllProcessesFindWhatOneFinds)
{
  for (const RadialDissipation dissipation : {RadialDissipation::none, RadialDissipation::consistent})
    {
      const Scene together(mesh_of(skewed_pins), mounted(), operating(dissipation));
      const Scene alone(together.mesh, mounted(), together.operation, Element::trilinear, MPI_COMM_SELF);
      EXPECT_LT(largest(distances(krylov(together.coupled, mu).lambda, krylov(alone.coupled, mu).lambda)), 1e-9);
      EXPECT_LT(largest(distances(iterated(together.coupled, mu, 1e-10).lambda, iterated(alone.coupled, mu, 1e-10).lambda)), 1e-9);
    }
}
