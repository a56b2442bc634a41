#include "solutions.h"

#include <squeal/base/exceptions.h>
#include <squeal/bases/reduced_basis.h>
#include <squeal/estimates/reduction_errors.h>
#include <squeal/linear_algebra/mass_orthonormal.h>

#include <gtest/gtest.h>

#include <map>

using namespace Squeal;
using namespace Squeal::Testing;

namespace
{
  constexpr double mu = 0.6;

  /// A scene with its real modes and complex reference modes.
  struct Reference
  {
    explicit Reference(const RadialDissipation dissipation = RadialDissipation::none, const MaterialParameters &materials = mounted())
      : s(mesh_of(skewed_pins), materials, operating(dissipation))
      , inverse(s.coupled, 0., FactorizationLibrary::automatic)
      , real(real_modes(s.coupled))
      , complex(krylov(s.coupled, mu))
    {}

    std::shared_ptr<MultiVector> basis(const std::string &kind) const
    {
      BasisIngredients in;
      in.sets[BasisSource::real] = real.vectors.get();
      in.coupled                 = &s.coupled;
      in.inverse                 = &inverse;
      return reduced_basis(*find_recipe(kind), in).vectors;
    }

    std::vector<ModeError> errors(const MultiVector &T) const
    {
      ReducedModel model(s.coupled);
      model.extend(T);
      return reduction_errors(s.coupled, inverse, model, reduced_modes(model, mu, omega_max, BandEnd::open), complex);
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

  /// A basis that holds the complex modes exactly, and some other directions.
  MultiVector exact_basis(const Reference &r)
  {
    const MultiVector noise = random_vectors(r.s.coupled.map(), 5);
    return orthonormalize(*r.s.coupled.mass, nullptr, join({r.complex.real_part.get(), r.complex.imaginary_part.get(), &noise}), 1e-10);
  }

  /**
   * Three degrees of freedom with one contact: the two of flutter, K = [k11 k12 - μ k_c; k12 k22],
   * and a stiff third one by which each of the others is known too stiff: eliminated
   * statically, it takes c²/k33 from the diagonal.
   */
  CoupledSystem flutter(const double k11,
                        const double k22,
                        const double k12,
                        const double k_c,
                        const double c,
                        const double k33,
                        const double damping)
  {
    const RowMap map = rows(3), contact = rows(1);
    const auto   M = Testing::diagonal(map, [](const int i) { return i == 2 ? 1e-6 : 1.; });
    const auto   K = sparse(map, map, [=](const int i) {
      return i == 0 ? Row{{0, k11 + c * c / k33}, {1, k12}, {2, c}} : i == 1 ? Row{{0, k12}, {1, k22}} : Row{{0, c}, {2, k33}};
    });
    const auto   C = damping != 0. ? Testing::diagonal(map, [damping](const int i) { return i == 2 ? 0. : damping; }) : nullptr;
    return system_of({M, C, K},
                     sparse(contact, map,
                            [](int) {
                              return Row{{0, 1.}};
                            }),
                     sparse(contact, map, [k_c](int) {
                       return Row{{1, k_c}};
                     }));
  }

  /// Masses of one on springs of their own, without contact.
  CoupledSystem uncoupled(const std::vector<double> &k)
  {
    const RowMap map     = rows(static_cast<int>(k.size()));
    const auto   nothing = sparse(rows(1), map, [](int) { return Row{}; });
    return system_of({Testing::diagonal(map, [](int) { return 1.; }), nullptr, Testing::diagonal(map, [&k](const int i) { return k[i]; })},
                     nothing, nothing);
  }

  /// The basis without the third degree of freedom.
  MultiVector first_two(const CoupledSystem &system)
  {
    const MultiVector units = unit_vectors(system.map()), two = view(units, 0, 2);
    return MultiVector(two);
  }
} // namespace

TEST(ReductionErrors, VanishIfTheBasisHoldsTheModes)
{
  for (const RadialDissipation dissipation : {RadialDissipation::none, RadialDissipation::consistent})
    {
      const Reference r(dissipation);
      const auto      errors = r.errors(exact_basis(r));
      ASSERT_EQ(errors.size(), r.complex.lambda.size());
      for (const auto what : {&ModeError::residual, &ModeError::frequency, &ModeError::divergence, &ModeError::eigenvalue,
                              &ModeError::subspace, &ModeError::corrected_error})
        EXPECT_LT(largest(errors, what), 1e-10);
      for (std::size_t j = 0; j < errors.size(); ++j)
        {
          EXPECT_EQ(errors[j].reference, r.complex.lambda[j]);
          EXPECT_LT(errors[j].cluster_size == 1 ? errors[j].shape : 0., 1e-10);
        }
    }
}

TEST(ReductionErrors, AreTheFormulasOfThePaper)
{
  const Reference r(RadialDissipation::consistent);
  const auto      T = r.basis("real");
  ReducedModel    model(r.s.coupled);
  model.extend(*T);
  const ReducedModes modes  = reduced_modes(model, mu, omega_max, BandEnd::open);
  const auto         errors = reduction_errors(r.s.coupled, r.inverse, model, modes, r.complex);
  EXPECT_GT(largest(errors, &ModeError::shape), 1e-6);
  EXPECT_THROW(r.errors(view(*r.real.vectors, 0, r.real.vectors->n_columns() - 3)), SolverError); // fewer than the reference

  // The full vectors of the reduced modes, with ε_res computed where modes are finished
  std::vector<int> match;
  for (const ModeError &error : errors)
    match.push_back(error.match);
  std::sort(match.begin(), match.end());
  EXPECT_EQ(std::adjacent_find(match.begin(), match.end()), match.end());
  for (const ModeError &error : errors)
    {
      const ComplexModes found = full_order_modes(r.s.coupled, r.inverse, model, selected(modes, {error.match}), nullptr);
      EXPECT_EQ(found.lambda.front(), error.reduced);
      EXPECT_NEAR(found.energy_residuals.front(), error.residual, 1e-6 * error.residual + 1e-14);

      const int         j  = &error - errors.data();
      const auto       &M  = *r.s.coupled.mass;
      const MultiVector X  = join({&*found.real_part, &*found.imaginary_part});
      const MultiVector re = view(*r.complex.real_part, j, 1), im = view(*r.complex.imaginary_part, j, 1), Y = join({&re, &im});
      const DenseMatrix G   = gram(Y, M * X);
      const double      mac = std::norm(Complex(G(0, 0) + G(1, 1), G(0, 1) - G(1, 0)));
      EXPECT_NEAR(error.shape, 1. - mac, 1e-10);
      if (error.cluster_size == 1)
        {
          EXPECT_NEAR(error.subspace, error.shape, 1e-10);
        }
      EXPECT_NEAR(error.frequency, std::abs(error.reduced.imag() - error.reference.imag()) / error.reference.imag(), 1e-15);
      EXPECT_NEAR(error.divergence, std::abs(error.reduced.real() / error.reduced.imag() - error.reference.real() / error.reference.imag()),
                  1e-15);
    }
}

TEST(ReductionErrors, EnrichmentPays)
{
  for (const RadialDissipation dissipation : {RadialDissipation::none, RadialDissipation::consistent})
    {
      const Reference r(dissipation);
      const double    real = largest(r.errors(*r.basis("real")), &ModeError::eigenvalue),
                   first   = largest(r.errors(*r.basis("real + 1st-ord.")), &ModeError::eigenvalue),
                   both    = largest(r.errors(*r.basis("real + 1st-ord. two-sided")), &ModeError::eigenvalue);
      EXPECT_LT(first, real);
      EXPECT_LT(both, 0.9 * first);
    }
}

TEST(ReductionErrors, OfFrictionlessModes)
{
  const Reference    r(RadialDissipation::consistent);
  const auto         system    = undamped(r.s.coupled);
  const ComplexModes reference = undamped_modes(r.real);
  ASSERT_EQ(reference.lambda.size(), r.real.eigenvalues.size());
  const auto errors = [&](const MultiVector &T) {
    ReducedModel model(r.s.coupled);
    model.extend(T);
    return reduction_errors(system, r.inverse, model, reduced_real_modes(model, omega_max, BandEnd::open), reference);
  };
  const auto exact = errors(*r.basis("real"));
  for (const auto what : {&ModeError::residual, &ModeError::frequency, &ModeError::subspace, &ModeError::divergence})
    EXPECT_LT(largest(exact, what), 1e-10);

  // Real modes disturbed: frequencies are known to the square of the error of the vectors, and from above
  MultiVector T = *r.real.vectors;
  T.local() += 1e-3 * orthonormalize(*r.s.coupled.mass, &T, random_vectors(r.s.coupled.map(), T.n_columns()), 1e-8).local();
  for (const ModeError &error : errors(orthonormalize(*r.s.coupled.mass, nullptr, T, 1e-8)))
    {
      EXPECT_GE(error.reduced.imag(), error.reference.imag() * (1. - 1e-10));
      EXPECT_LT(error.corrected.imag(), error.reduced.imag());
      EXPECT_EQ(error.divergence, 0.);
      EXPECT_NEAR(error.condition, 1., 1e-9);
    }
}

TEST(ReductionErrors, ClustersAreComparedAsSubspaces)
{
  // The same mode twice, a third nearby, one apart: turned vectors have no counterpart of their own, their span has.
  const std::vector<double> k      = {1., 1., 1.0005, 4., 9., 16.};
  const CoupledSystem       system = uncoupled(k);
  const UpdatedInverse      inverse(system, 0., FactorizationLibrary::automatic);

  SymmetricModes turned;
  turned.eigenvalues     = {k[0], k[1], k[2], k[3]};
  turned.residuals       = {0., 0., 0., 0.};
  const MultiVector I    = unit_vectors(system.map());
  turned.vectors         = std::make_shared<MultiVector>(system.map(), 4);
  turned.vectors->col(0) = 0.6 * I.col(0) + 0.8 * I.col(1);
  turned.vectors->col(1) = -0.8 * I.col(0) + 0.6 * I.col(1);
  turned.vectors->col(2) = I.col(2);
  turned.vectors->col(3) = I.col(3);
  ReducedModel model(system);
  model.extend(I);
  const auto modes  = reduced_real_modes(model, 10., BandEnd::open);
  const auto errors = reduction_errors(system, inverse, model, modes, undamped_modes(turned));
  ASSERT_EQ(errors.size(), 4u);
  EXPECT_GT(std::max(errors[0].shape, errors[1].shape), 0.1);
  EXPECT_LT(largest(errors, &ModeError::subspace), 1e-14);
  EXPECT_LT(largest(errors, &ModeError::eigenvalue), 1e-14);
  for (const int j : {0, 1, 2})
    EXPECT_EQ(errors[j].cluster_size, 3);
  EXPECT_EQ(errors[3].cluster_size, 1);
  EXPECT_EQ(reduction_errors(system, inverse, model, modes, undamped_modes(turned), 1e-6)[2].cluster_size, 1);

  // A vector of the cluster tilted out of it by an angle whose sine is 0.28
  turned.vectors->col(1) = 0.28 * I.col(4) + 0.96 * turned.vectors->col(1);
  for (const ModeError &error : reduction_errors(system, inverse, model, modes, undamped_modes(turned)))
    EXPECT_NEAR(error.subspace, error.cluster_size == 3 ? 0.28 * 0.28 : 0., 1e-12);
}

TEST(ReductionErrors, ByEquation17OneReducedModeMayServeTwice)
{
  // Modes 0 and 2 are far apart. The reduced mode near e_0 holds most of what the reduced space has of e_2, too: by eq. (17)
  // it is the counterpart of both, one-to-one mode 2 gets the other one.
  const std::vector<double> k      = {1., 4., 1.2, 9.};
  const CoupledSystem       system = uncoupled(k);
  const UpdatedInverse      inverse(system, 0., FactorizationLibrary::automatic);
  const MultiVector         I = unit_vectors(system.map());

  // Two reduced modes: 0.8 e_0 + 0.6 e_2 and 0.28 e_2 + 0.96 e_3, not orthogonal on purpose; the pencil tells them apart
  SymmetricModes exact;
  exact.eigenvalues     = {k[0], k[2]};
  exact.residuals       = {0., 0.};
  exact.vectors         = std::make_shared<MultiVector>(system.map(), 2);
  exact.vectors->col(0) = I.col(0);
  exact.vectors->col(1) = I.col(2);

  MultiVector T(system.map(), 2);
  T.col(0) = 0.8 * I.col(0) + 0.6 * I.col(2);
  T.col(1) = 0.28 * (0.6 * I.col(0) - 0.8 * I.col(2)) + 0.96 * I.col(3);
  ReducedModel model(system);
  model.extend(T);
  ReducedModes modes = reduced_real_modes(model, 10., BandEnd::open);
  // Frequencies within reach of the matching: it is about shapes here
  modes.lambda = {{0., std::sqrt(k[0])}, {0., std::sqrt(k[2])}};

  const auto errors = reduction_errors(system, inverse, model, modes, undamped_modes(exact));
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_EQ(errors[0].match, 0);
  EXPECT_EQ(errors[1].match, 1);
  EXPECT_EQ(errors[0].closest, 0);
  EXPECT_EQ(errors[1].closest, 0);
  EXPECT_EQ(errors[0].closest_shape, errors[0].shape);
  EXPECT_NEAR(errors[1].closest_shape, 1. - 0.36, 0.05);
  EXPECT_GT(errors[1].shape, errors[1].closest_shape + 0.2);
  EXPECT_EQ(errors[1].closest_frequency, std::abs(std::sqrt(k[0]) - std::sqrt(k[2])) / std::sqrt(k[2]));
  EXPECT_EQ(errors[1].frequency, 0.);

  const auto groups = largest_errors(errors, {"disc", "F1"}, {{"disc", "F1"}, {"disc", "T1"}});
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(groups[0].n_other, 0);
  EXPECT_EQ(groups[1].n_other, 1);
  EXPECT_EQ(groups[2].group, "disc and F1");
  EXPECT_EQ(groups[2].n_modes, 2);
  EXPECT_EQ(groups[2].n_other, 1);
  EXPECT_EQ(groups[2].shape, errors[1].shape);
  EXPECT_EQ(groups[2].closest_shape, errors[1].closest_shape);
  const auto one = largest_errors(errors, {"disc", "disc"});
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].group, "disc");
  EXPECT_EQ(one[0].n_modes, 2);
  EXPECT_EQ(one[0].residual, std::max(errors[0].residual, errors[1].residual));
}

TEST(EigenvalueEstimates, FindTheErrorAndMendIt)
{
  // Flutter with a degree of freedom left out: the estimate is the error to first order, away from the coalescence.
  const double k11 = 3., k22 = 2., k12 = 0.7, k_c = 1.3;
  const double threshold = ((k11 - k22) * (k11 - k22) / (4. * k12) + k12) / k_c;
  for (const double damping : {0., 0.02})
    for (const double factor : {0., 0.5, 0.9, 1.1, 1.5})
      {
        const CoupledSystem  system = flutter(k11, k22, k12, k_c, 0.3, 100., damping);
        const UpdatedInverse inverse(system, 0., FactorizationLibrary::automatic);
        ReducedModel         model(system), full(system);
        model.extend(first_two(system));
        full.extend(unit_vectors(system.map()));
        const double friction = factor * threshold;
        const auto   modes = reduced_modes(model, friction, 10.), exact = reduced_modes(full, friction, 10.);
        const auto   estimates = estimate_eigenvalues(modes, residual_vectors(system, inverse, model, modes).products());
        ASSERT_EQ(modes.lambda.size(), 2u);
        ASSERT_EQ(exact.lambda.size(), 2u);
        for (int j = 0; j < 2; ++j)
          {
            // Members of an unstable pair have one frequency: either may come first.
            const Complex same = exact.lambda[j], other = exact.lambda[1 - j];
            const Complex nearest = std::abs(same - modes.lambda[j]) < std::abs(other - modes.lambda[j]) ? same : other;
            const Complex error   = nearest - modes.lambda[j];
            EXPECT_TRUE(estimates.claimed[j]);
            EXPECT_LT(std::abs(estimates.corrections[j] - error), 0.05 * std::abs(error)) << "factor " << factor << ", mode " << j;
            EXPECT_EQ(estimates.errors[j], std::abs(estimates.corrections[j]) / std::abs(modes.lambda[j]));
            EXPECT_GE(estimates.conditions[j], 1. - 1e-10);
            const Verdict expected = damping == 0. && factor < 1. ? Verdict::neutral :
                                     nearest.real() > 0.          ? Verdict::unstable :
                                                                    Verdict::stable;
            EXPECT_EQ(estimates.verdicts[j], expected) << "factor " << factor << ", mode " << j;
          }
      }
}

TEST(EigenvalueEstimates, AreNotClaimedAtACoalescence)
{
  const double k11 = 3., k22 = 2., k12 = 0.7, k_c = 1.3;
  // Where the reduced model coalesces
  const CoupledSystem  system = flutter(k11, k22, k12, k_c, 0.3, 100., 0.);
  const UpdatedInverse inverse(system, 0., FactorizationLibrary::automatic);
  ReducedModel         model(system);
  model.extend(first_two(system));
  const double stiff     = k11 + 0.3 * 0.3 / 100.;
  const double threshold = ((stiff - k22) * (stiff - k22) / (4. * k12) + k12) / k_c;
  double       condition = 1.;
  for (const double distance : {0.3, 1e-2, 1e-4, 1e-7})
    for (const double side : {-1., 1.})
      {
        const auto modes     = reduced_modes(model, threshold * (1. + side * distance), 10.);
        const auto estimates = estimate_eigenvalues(modes, residual_vectors(system, inverse, model, modes).products());
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

TEST(EigenvalueEstimates, OfReducedScenes)
{
  // Near the error, and better once corrected, for most modes; verdicts are never wrong.
  for (const auto &[dissipation, materials] : {std::make_pair(RadialDissipation::none, mounted()),
                                               {RadialDissipation::consistent, mounted()},
                                               {RadialDissipation::consistent, damped(mounted())}})
    {
      const Reference r(dissipation, materials);
      for (const std::string kind : {"real", "real + 1st-ord.", "real + 1st-ord. two-sided"})
        {
          int n_near = 0, n_better = 0, n_errors = 0, n_decided = 0;
          for (const ModeError &error : r.errors(*r.basis(kind)))
            {
              if (error.verdict != Verdict::undecided)
                {
                  ++n_decided;
                  EXPECT_EQ(error.verdict == Verdict::unstable, error.reference.real() > 1e-8 * error.reference.imag())
                    << kind << ", " << error.reference;
                }
              if (!error.claimed || error.eigenvalue < 1e-9)
                continue;
              ++n_errors;
              n_near += error.estimate_ratio > 0.2 && error.estimate_ratio < 5.;
              n_better += error.corrected_error < error.eigenvalue;
            }
          EXPECT_GE(n_near, 0.7 * n_errors) << kind;
          EXPECT_GE(n_better, 0.7 * n_errors) << kind;
          EXPECT_GT(n_errors, 3) << kind;
          EXPECT_GT(n_decided, 3) << kind;
        }
    }
}

TEST(GrownBasis, IsAccurateAtAllItsFrictionCoefficients)
{
  const Reference          r(RadialDissipation::consistent);
  ResidualIterationOptions options;
  options.largest_circular_frequency = omega_max;
  options.tolerance                  = 1e-6;
  Progress                  progress;
  const std::vector<double> coefficients = {0., 0.3, 0.6};
  const GrownBasis          grown        = grow_residual_basis(r.s.coupled, r.inverse, *r.real.vectors, coefficients, options, progress);
  EXPECT_LT(orthonormality_defect(*r.s.coupled.mass, grown.model.basis()), 1e-12);
  EXPECT_LE(grown.worst_error, options.tolerance);
  for (const double friction : coefficients)
    EXPECT_LT(Testing::largest(distances(reduced_modes(grown.model, friction, omega_max).lambda, krylov(r.s.coupled, friction).lambda)),
              3e-6);

  // As a basis like the others
  BasisIngredients in;
  in.coupled                      = &r.s.coupled;
  in.sets[BasisSource::residuals] = &grown.model.basis();
  const auto basis                = reduced_basis(*find_recipe("residual-grown"), in);
  EXPECT_EQ(basis.size(), grown.model.size());
  EXPECT_NEAR(basis.condition, 1., 1e-10);
  EXPECT_LT(largest(r.errors(*basis.vectors), &ModeError::eigenvalue), 3e-6);
  EXPECT_THROW(grow_residual_basis(r.s.coupled, r.inverse, *r.real.vectors, {}, options, progress), SolverError);
}

TEST(GrownBasis, LeftModesAreThoseOfTheTransposedProblem)
{
  for (const RadialDissipation dissipation : {RadialDissipation::none, RadialDissipation::consistent})
    {
      const Scene s(mesh_of(skewed_pins), mounted(), operating(dissipation));
      const auto  modes = iterated(s.coupled, mu, 1e-10);
      const auto &M     = *s.coupled.mass;
      ASSERT_NE(modes.left_real_part, nullptr);
      const MultiVector L  = force_residuals(s.coupled, s.coupled.at(mu), modes.lambda, *modes.left_real_part, *modes.left_imaginary_part,
                                             true),
                        KX = *s.coupled.stiffness * *modes.left_real_part, KY = *s.coupled.stiffness * *modes.left_imaginary_part;
      const auto        residual = column_norms(L), re = column_norms(KX), im = column_norms(KY);
      const int         k    = modes.lambda.size();
      const DenseMatrix m_re = gram(*modes.left_real_part, M * *modes.left_real_part),
                        m_im = gram(*modes.left_imaginary_part, M * *modes.left_imaginary_part);
      for (int j = 0; j < k; ++j)
        {
          EXPECT_NEAR(m_re(j, j) + m_im(j, j), 1., 1e-12);
          EXPECT_LT(std::hypot(residual[j], residual[k + j]) / std::hypot(re[j], im[j]), 1e-3) << "mode " << j;
        }
    }
}

TEST(PrincipalAxesOfModes, ServeBetweenTheirFrictionCoefficients)
{
  // Right and left modes at three μ: exact there, close in between
  const Reference                  r(RadialDissipation::consistent);
  std::vector<ComplexModes>        modes;
  std::vector<const MultiVector *> parts;
  for (const double friction : {0.2, 0.4, 0.6})
    modes.push_back(iterated(r.s.coupled, friction, 1e-9));
  for (const ComplexModes &m : modes)
    for (const auto &part : {m.real_part, m.imaginary_part, m.left_real_part, m.left_imaginary_part})
      parts.push_back(part.get());
  const MultiVector snapshots = join(parts);
  BasisIngredients  in;
  in.coupled                      = &r.s.coupled;
  in.sets[BasisSource::snapshots] = &snapshots;
  const auto basis                = reduced_basis(*find_recipe("POD"), in);
  EXPECT_LT(basis.size(), snapshots.n_columns());
  EXPECT_EQ(basis.size() + basis.n_dropped, snapshots.n_columns());
  EXPECT_LT(largest(r.errors(*basis.vectors), &ModeError::eigenvalue), 1e-7);

  ReducedModel model(r.s.coupled);
  model.extend(*basis.vectors);
  EXPECT_LT(Testing::largest(distances(reduced_modes(model, 0.5, omega_max).lambda, krylov(r.s.coupled, 0.5).lambda)), 1e-4);
}
