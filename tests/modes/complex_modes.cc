#include "solutions.h"

#include <squeal/geometry/generate_mesh.h>
#include <squeal/linear_algebra/sparse_matrix.h>

#include <gtest/gtest.h>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr double mu = 0.6;

  Scene scene(const RadialDissipation      dissipation  = RadialDissipation::none,
              const std::vector<PolarPin> &pins         = skewed_pins,
              const Rotation               rotation     = Rotation::positive,
              const MPI_Comm               communicator = MPI_COMM_WORLD)
  {
    return Scene(mesh_of(pins), mounted(), operating(dissipation, rotation), Element::trilinear, communicator);
  }

  /// Where energy is lost: in the contact, in the bodies.
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

TEST(ComplexModes, WithoutFrictionTheyAreTheRealOnes)
{
  const Scene s    = scene();
  const auto  real = real_modes(s.coupled);
  ASSERT_GT(real.eigenvalues.size(), 8u);
  for (const ComplexModes &modes : {krylov(s.coupled, 0.), iterated(s.coupled, 0., 1e-10)})
    {
      ASSERT_EQ(modes.lambda.size(), real.eigenvalues.size());
      for (std::size_t j = 0; j < modes.lambda.size(); ++j)
        {
          const double omega = std::sqrt(real.eigenvalues[j]);
          EXPECT_NEAR(modes.lambda[j].imag() / omega, 1., 1e-9);
          EXPECT_LT(std::abs(modes.lambda[j].real()), 1e-9 * omega);
        }
    }
}

TEST(ComplexModes, DampingAloneOnlyDampens)
{
  const Scene s        = scene(RadialDissipation::consistent);
  const auto  modes    = krylov(s.coupled, 0.);
  int         n_damped = 0;
  for (const Complex &l : modes.lambda)
    {
      EXPECT_LT(l.real(), 1e-9 * l.imag());
      n_damped += l.real() < -1e-6 * l.imag();
    }
  EXPECT_GT(n_damped, 5);
}

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

          // Q(λ)φ with the sparse matrices at this μ
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

              // An entry of largest modulus (there may be several) is real and positive.
              const double modulus = phi.col(j).cwiseAbs().maxCoeff();
              EXPECT_LT((phi.col(j).array() - modulus).abs().minCoeff(), 1e-12 * modulus);
              EXPECT_GE(modes.energy_residuals[j], 0.);
            }
          EXPECT_TRUE(modes.real_values.empty());
          EXPECT_EQ(modes.n_rigid_body, 0);
        }
    }
}

TEST(ComplexModes, BothInversesGiveTheSame)
{
  for (const Losses &losses : all_losses)
    {
      const Scene s = scene(losses);
      EXPECT_LT(largest(distances(krylov(s.coupled, mu).lambda, krylov(s.coupled, mu, 1e-11, ShiftInverse::sparse_lu).lambda)), 1e-10);
    }
}

TEST(ComplexModes, ResidualIterationKeepsItsPromise)
{
  for (const Losses &losses : all_losses)
    {
      const Scene s         = scene(losses);
      const auto  reference = krylov(s.coupled, mu);
      ASSERT_GT(n_unstable(reference), 0);
      for (const double tolerance : {1e-4, 1e-7})
        {
          const auto modes  = iterated(s.coupled, mu, tolerance);
          const auto errors = distances(modes.lambda, reference.lambda);
          ASSERT_EQ(errors.size(), modes.estimated_errors.size());
          EXPECT_LT(largest(errors), 2. * tolerance);
          // The estimate is one of the error, not a bound far above or below it; on the small basis the next
          // Galerkin step, which it looks at, need not be the last.
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

TEST(ComplexModes, UndampedSpectrumIsSymmetric)
{
  // λ → -λ; with a damping matrix of zeros, so that the solver cannot know
  Scene      s       = scene();
  const auto without = krylov(s.coupled, mu);
  const auto zero    = scale_rows(*s.coupled.mass, [](int) { return 0.; });
  s.coupled.terms.push_back(sparse_term("zeros", 1, {}, zero));
  const auto modes = krylov(s.coupled, mu);
  ASSERT_GT(n_unstable(modes), 0);
  std::vector<Complex> reflected;
  for (const Complex &l : modes.lambda)
    reflected.push_back(-std::conj(l));
  EXPECT_LT(largest(distances(reflected, modes.lambda)), 1e-9);
  EXPECT_LT(largest(distances(without.lambda, modes.lambda)), 1e-9);
}

TEST(ComplexModes, MirrorImageTurnsTheOtherWay)
{
  for (const RadialDissipation dissipation : {RadialDissipation::none, RadialDissipation::consistent})
    {
      const HexMesh mesh = mesh_of(skewed_pins);
      const Scene   original(mesh, mounted(), operating(dissipation, Rotation::positive));
      const Scene   image(mirrored(mesh), mounted(), operating(dissipation, Rotation::negative));
      const auto    modes = krylov(original.coupled, mu);
      ASSERT_GT(n_unstable(modes), 0);
      EXPECT_LT(largest(distances(modes.lambda, krylov(image.coupled, mu).lambda)), 1e-9);
    }
}

TEST(ComplexModes, SenseOfRotation)
{
  const auto spectra_distance = [](const std::vector<PolarPin> &pins) {
    const auto positive = krylov(scene(RadialDissipation::none, pins, Rotation::positive).coupled, mu);
    const auto negative = krylov(scene(RadialDissipation::none, pins, Rotation::negative).coupled, mu);
    EXPECT_GT(n_unstable(positive), 0);
    return largest(distances(positive.lambda, negative.lambda));
  };
  EXPECT_LT(spectra_distance(symmetric_pins), 1e-9);
  EXPECT_GT(spectra_distance(skewed_pins), 1e-3);
}

TEST(ComplexModes, GrowthIsThePowerBalance)
{
  // φᴴ Q(λ) φ = 0: m λ² + c λ + k = p, p = μ φᴴ A r_n; its imaginary part over ω: 2 R m + c = Im p / ω
  for (const Losses &losses : all_losses)
    {
      const Scene       s         = scene(losses);
      const auto        modes     = krylov(s.coupled, mu);
      const auto        r         = normal_reactions(s.coupled, modes.lambda, *modes.real_part, *modes.imaginary_part);
      const DenseMatrix a_re      = s.coupled.friction_forces->transpose_times(*modes.real_part);
      const DenseMatrix a_im      = s.coupled.friction_forces->transpose_times(*modes.imaginary_part);
      int               n_checked = 0;
      for (std::size_t j = 0; j < modes.lambda.size(); ++j)
        if (const Complex l = modes.lambda[j]; std::abs(l.real()) > 1e-4 * l.imag())
          {
            ++n_checked;
            Complex p = 0.;
            for (int c = 0; c < a_re.rows(); ++c)
              p += mu * std::conj(Complex(a_re(c, j), a_im(c, j))) * r(c, j);
            const MultiVector re = view(*modes.real_part, j, 1), im = view(*modes.imaginary_part, j, 1);
            double            c = 0.;
            if (const auto &C = with_friction(s.coupled, 0.).damping)
              c = product(re, *C, re) + product(im, *C, im);
            EXPECT_NEAR((p.imag() / l.imag() - c) / (2. * l.real()), 1., 1e-6) << "mode " << j;
          }
      EXPECT_GT(n_checked, 0);
      ASSERT_GT(n_unstable(modes), 0);
    }
}

TEST(ComplexModes, AllProcessesFindWhatOneFinds)
{
  for (const RadialDissipation dissipation : {RadialDissipation::none, RadialDissipation::consistent})
    {
      const Scene together = scene(dissipation);
      const Scene alone    = scene(dissipation, skewed_pins, Rotation::positive, MPI_COMM_SELF);
      EXPECT_LT(largest(distances(krylov(together.coupled, mu).lambda, krylov(alone.coupled, mu).lambda)), 1e-9);
      EXPECT_LT(largest(distances(iterated(together.coupled, mu, 1e-10).lambda, iterated(alone.coupled, mu, 1e-10).lambda)), 1e-9);
      for (const RealSolver solver : {RealSolver::lanczos, RealSolver::anasazi, RealSolver::arpack})
        {
          const auto real = real_modes(together.coupled, solver), real_alone = real_modes(alone.coupled, solver);
          ASSERT_EQ(real.eigenvalues.size(), real_alone.eigenvalues.size());
          for (std::size_t j = 0; j < real.eigenvalues.size(); ++j)
            EXPECT_NEAR(real.eigenvalues[j] / real_alone.eigenvalues[j], 1., 1e-9);
        }
    }
}

TEST(ComplexModes, RoundPinsOfAMeshFromGmsh)
{
  // Pins that are not opposite, curved if quadratic: both solvers agree, and all modes fulfil the power balance.
  GeometryParameters geometry = layers(1, 1);
  geometry.element_size       = 0.04;
  geometry.nodes_per_pin_face = 7;
  geometry.top                = {{0.2}, {-10.}};
  geometry.bottom             = {{0.25}, {25.}};
  const HexMesh mesh          = generate_mesh(geometry, {"disc_bore"});
  for (const Element element : {Element::trilinear, Element::quadratic})
    {
      const Scene s(mesh, mounted(), operating(RadialDissipation::consistent), element);
      EXPECT_EQ(s.interface.size(), element == Element::trilinear ? 14u : 38u);
      const auto modes = krylov(s.coupled, mu, 1e-9);
      EXPECT_GT(modes.lambda.size(), 10u);
      EXPECT_LT(largest(distances(iterated(s.coupled, mu, 1e-7).lambda, modes.lambda)), 2e-7);
    }
}

TEST(ComplexModes, ADiscThatMovesFreely)
{
  // Besides λ = 0 everything is found alike.
  const FreeDisc disc;
  const auto &[s, shift, real] = disc;
  SolverParameters solvers;
  solvers.complex_tolerance = 1e-10;
  UpdatedInverse inverse(s.coupled, shift, FactorizationLibrary::automatic);
  Progress       progress;
  const auto     reference = krylov_modes(s.coupled, inverse, shift, mu, omega_max, real.eigenvalues.size(), solvers, progress);
  EXPECT_EQ(reference.n_rigid_body, 3);

  ResidualIterationOptions options;
  options.largest_circular_frequency = omega_max;
  options.tolerance                  = 1e-7;
  const auto modes                   = residual_iteration(s.coupled, inverse, *real.vectors, mu, options, progress);
  EXPECT_LT(largest(distances(modes.lambda, reference.lambda)), 2e-7);
  EXPECT_EQ(modes.n_rigid_body, 3);
}
