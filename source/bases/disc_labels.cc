// SPDX-License-Identifier: GPL-3.0-or-later

#include "nodal_projection.h"

#include <squeal/bases/mode_labels.h>

#include <cmath>
#include <complex>

namespace Squeal
{
  namespace
  {
    /// Families of disc modes in the order of the displacement components of DiscHarmonics::cylindrical().
    constexpr std::array<ModeFamily, 3> disc_families = {{ModeFamily::axial, ModeFamily::radial, ModeFamily::circumferential}};

    constexpr int n_radial_functions = 5;
    constexpr int largest_harmonic   = 16;

    /// Projections of disc fields on harmonics 0 ... largest_harmonic.
    struct DiscHarmonics
    {
      Nodes                   disc;
      Eigen::VectorXd         cosines, sines;
      DenseMatrix             radial; ///< powers of the radius, scaled to [-1, 1], at the nodes
      std::vector<Projection> harmonics;

      DiscHarmonics(const Model &model, const std::vector<double> &nodal_masses)
        : disc(model, nodal_masses, 0)
      {
        const Eigen::VectorXd radii = disc.positions.leftCols(2).rowwise().norm();
        const Eigen::VectorXd theta =
          disc.positions.col(1).binaryExpr(disc.positions.col(0), [](const double y, const double x) { return std::atan2(y, x); });
        cosines = theta.array().cos();
        sines   = theta.array().sin();

        // Columns: powers of the radius times cosine, then powers times sine
        const double inner = -disc.largest(-radii), outer = disc.largest(radii);
        radial = powers((2. * radii.array() - inner - outer) / (outer - inner), n_radial_functions);
        for (int n = 0; n <= largest_harmonic; ++n)
          {
            DenseMatrix functions(radii.size(), (n == 0 ? 1 : 2) * n_radial_functions);
            functions.leftCols(n_radial_functions) = (n * theta).array().cos().matrix().asDiagonal() * radial;
            if (n > 0)
              functions.rightCols(n_radial_functions) = (n * theta).array().sin().matrix().asDiagonal() * radial;
            harmonics.emplace_back(disc.communicator, functions, disc.masses);
          }
      }

      /// Axial, radial and circumferential displacement of the nodes.
      Eigen::MatrixX3d cylindrical(const MultiVector &modes, const int j) const
      {
        const Eigen::MatrixX3d u = disc.displacements(modes, j);
        Eigen::MatrixX3d       fields(u.rows(), 3);
        fields << u.col(2), cosines.cwiseProduct(u.col(0)) + sines.cwiseProduct(u.col(1)),
          cosines.cwiseProduct(u.col(1)) - sines.cwiseProduct(u.col(0));
        return fields;
      }

      /// Number of sign changes of the radial profile of harmonic n: the component of its cosine and sine amplitudes along their dominant
      /// direction, because the nodal diameters may be rotated.
      int nodal_circles(const Eigen::VectorXd &coefficients, const int n) const
      {
        // Profile a(r) cos nθ + b(r) sin nθ
        constexpr int         n_samples = 41;
        const DenseMatrix     radial    = powers(Eigen::VectorXd::LinSpaced(n_samples, -1., 1.), n_radial_functions);
        const Eigen::VectorXd factors   = harmonics[n].factors(coefficients);
        const Eigen::VectorXd a         = radial * factors.head(n_radial_functions);
        const Eigen::VectorXd b = n > 0 ? Eigen::VectorXd(radial * factors.tail(n_radial_functions)) : Eigen::VectorXd::Zero(n_samples);

        // Common direction: dominant axis of Σ (a, b)ᵀ(a, b)
        const double          angle     = 0.5 * std::atan2(2. * a.dot(b), a.squaredNorm() - b.squaredNorm());
        const Eigen::VectorXd amplitude = std::cos(angle) * a + std::sin(angle) * b;

        // Count sign changes between values that clearly differ from zero
        constexpr double clear   = 0.1;
        const double     largest = max_norm(amplitude);
        int              changes = 0;
        double           last    = 0.;
        for (const double value : amplitude)
          if (std::abs(value) > clear * largest)
            {
              changes += last * value < 0.;
              last = value;
            }
        return changes;
      }

      /// Energy fractions of the two travelling waves of harmonic n > 0 in a field; empty if the field has no energy in this harmonic.
      std::optional<WaveShares> wave_shares(const Eigen::VectorXd &real_part, const Eigen::VectorXd &imaginary_part, const int n) const
      {
        constexpr std::complex<double> i(0., 1.);
        DenseMatrix                    fields(real_part.size(), 2);
        fields << real_part, imaginary_part;
        const DenseMatrix      coefficients = harmonics[n].coefficients(fields);
        const Eigen::VectorXcd factors      = harmonics[n].factors(coefficients.col(0)) + i * harmonics[n].factors(coefficients.col(1));
        const Eigen::VectorXcd a = radial * factors.head(n_radial_functions), b = radial * factors.tail(n_radial_functions);
        const DenseMatrix      parts =
          summed(disc.communicator,
                 (DenseMatrix(2, 1) << disc.masses.dot((a + i * b).cwiseAbs2()), disc.masses.dot((a - i * b).cwiseAbs2())).finished());
        const double both = parts.sum();
        return both > 0. ? std::make_optional(WaveShares{parts(0, 0) / both, parts(1, 0) / both}) : std::nullopt;
      }
    };
  } // namespace

  std::vector<ModeLabel> disc_labels(const Model &model, const std::vector<double> &nodal_masses, const MultiVector &modes)
  {
    const DiscHarmonics    disc(model, nodal_masses);
    std::vector<ModeLabel> labels;
    for (int j = 0; j < modes.n_columns(); ++j)
      {
        const Eigen::MatrixX3d   fields = disc.cylindrical(modes, j);
        std::vector<DenseMatrix> coefficients;
        for (const Projection &harmonic : disc.harmonics)
          coefficients.push_back(harmonic.coefficients(fields));

        // Find the harmonic with the largest energy over all three directions
        DenseMatrix energies(3, largest_harmonic + 1);
        for (int n = 0; n <= largest_harmonic; ++n)
          energies.col(n) = coefficients[n].colwise().squaredNorm();
        Eigen::Index diameters, family;
        energies.colwise().sum().maxCoeff(&diameters);
        energies.col(diameters).maxCoeff(&family);
        labels.push_back({disc_families[family], disc.nodal_circles(coefficients[diameters].col(family), static_cast<int>(diameters)),
                          static_cast<int>(diameters)});
      }
    return labels;
  }

  std::vector<std::optional<WaveShares>> wave_shares(const Model                  &model,
                                                     const std::vector<double>    &nodal_masses,
                                                     const std::vector<ModeLabel> &labels,
                                                     const MultiVector            &real_part,
                                                     const MultiVector            &imaginary_part)
  {
    const DiscHarmonics                    disc(model, nodal_masses);
    std::vector<std::optional<WaveShares>> shares(labels.size());
    for (std::size_t j = 0; j < labels.size(); ++j)
      for (std::size_t component = 0; component < disc_families.size(); ++component)
        if (labels[j].family == disc_families[component] && labels[j].nodal_diameters > 0)
          shares[j] = disc.wave_shares(disc.cylindrical(real_part, static_cast<int>(j)).col(component),
                                       disc.cylindrical(imaginary_part, static_cast<int>(j)).col(component), labels[j].nodal_diameters);
    return shares;
  }
} // namespace Squeal
