// SPDX-License-Identifier: GPL-3.0-or-later

#include "inverse_at_shift.h"

#include <squeal/linear_algebra/communication.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Residual vectors Q(λ_j) φ_j of some modes.
    struct PencilImage
    {
      MultiVector         real, imaginary;
      std::vector<double> stiffness_norms; ///< ‖Kφ‖₂

      /// ‖Q(λ)φ‖₂ / ‖Kφ‖₂
      std::vector<double> residuals() const
      {
        const std::vector<double> real_norms = column_norms(real), imaginary_norms = column_norms(imaginary);
        std::vector<double>       result;
        for (std::size_t j = 0; j < stiffness_norms.size(); ++j)
          result.push_back(std::hypot(real_norms[j], imaginary_norms[j]) /
                           std::max(stiffness_norms[j], std::numeric_limits<double>::min()));
        return result;
      }
    };

    PencilImage apply_pencil(const QuadraticPencil      &pencil,
                             const std::vector<Complex> &values,
                             const MultiVector          &real_part,
                             const MultiVector          &imaginary_part)
    {
      const int   width = static_cast<int>(values.size());
      PencilImage image{MultiVector(real_part.map(), width), MultiVector(real_part.map(), width), std::vector<double>(width, 0.)};
      MultiVector product(real_part.map(), width, false);
      const std::vector<double> norms   = column_norms(imaginary_part);
      const bool                is_real = std::all_of(norms.begin(), norms.end(), [](const double x) { return x == 0.; });
      for (const bool imaginary_input : {false, true})
        {
          if (imaginary_input && is_real)
            continue;
          const MultiVector &input    = imaginary_input ? imaginary_part : real_part;
          const auto         add_term = [&](const LinearOperator *matrix, const int power) {
            if (matrix == nullptr)
              return;
            matrix->apply(input, product);
            if (power == 0)
              {
                const std::vector<double> product_norms = column_norms(product);
                for (int j = 0; j < width; ++j)
                  image.stiffness_norms[j] = std::hypot(image.stiffness_norms[j], product_norms[j]);
              }
            for (int j = 0; j < width; ++j)
              {
                Complex factor = power == 2 ? values[j] * values[j] : power == 1 ? values[j] : Complex(1.);
                if (imaginary_input)
                  factor *= Complex(0., 1.);
                image.real.col(j) += factor.real() * product.col(j);
                image.imaginary.col(j) += factor.imag() * product.col(j);
              }
          };
          add_term(pencil.stiffness, 0);
          add_term(pencil.damping, 1);
          add_term(pencil.mass, 2);
        }
      return image;
    }

    // ------------------------------------------------------------ correction

    constexpr int most_correction_steps = 12;

    struct ComplexVector
    {
      MultiVector re, im; ///< n × 1

      double norm() const
      {
        return std::hypot(column_norms(re)[0], column_norms(im)[0]);
      }

      void scale(const double factor)
      {
        re *= factor;
        im *= factor;
      }

      /// this += c x
      void add(const Complex c, const ComplexVector &x)
      {
        re += c.real() * x.re - c.imag() * x.im;
        im += c.real() * x.im + c.imag() * x.re;
      }
    };

    /// xᴴ y
    Complex product(const ComplexVector &x, const ComplexVector &y)
    {
      return {column_products(x.re, y.re)[0] + column_products(x.im, y.im)[0],
              column_products(x.re, y.im)[0] - column_products(x.im, y.re)[0]};
    }

    /// Improves a mode φ, ‖φ‖ = 1, by generalised conjugate residuals (S. C. Eisenstat, H. C. Elman, M. H. Schultz, SIAM Journal on
    /// Numerical Analysis 20 (1983) 345–357): corrections are orthogonal to φ, lie in the space of Q(s)⁻¹ r of successive residuals r and
    /// minimise ‖Q(λ)φ‖, until ‖Q(λ)φ‖ ≤ @p tolerance ‖Kφ‖ or after most_correction_steps steps.
    ComplexVector corrected(const QuadraticPencil &pencil,
                            const LinearOperator  &inverse,
                            const Complex          lambda,
                            const ComplexVector   &phi,
                            const double           tolerance)
    {
      const PencilImage          before   = apply_pencil(pencil, {lambda}, phi.re, phi.im);
      const double               accepted = tolerance * before.stiffness_norms[0];
      ComplexVector              r{before.real, before.imaginary}, result = phi;
      std::vector<ComplexVector> directions, images;
      for (int step = 0; step < most_correction_steps && r.norm() > accepted; ++step)
        {
          ComplexVector z{MultiVector(phi.re.map(), 1), MultiVector(phi.re.map(), 1)};
          inverse.apply(r.re, z.re);
          inverse.apply(r.im, z.im);
          z.add(-product(phi, z), phi);
          const PencilImage image = apply_pencil(pencil, {lambda}, z.re, z.im);
          ComplexVector     y{image.real, image.imaginary};
          for (std::size_t i = 0; i < images.size(); ++i)
            {
              const Complex c = product(images[i], y);
              y.add(-c, images[i]);
              z.add(-c, directions[i]);
            }
          const double size = y.norm();
          if (!(size > 0.))
            break;
          y.scale(1. / size);
          z.scale(1. / size);
          const Complex c = product(y, r);
          r.add(-c, y);
          result.add(-c, z);
          directions.push_back(std::move(z));
          images.push_back(std::move(y));
        }
      result.scale(1. / result.norm());
      return result;
    }
  } // namespace

  std::vector<double> residuals(const QuadraticPencil      &pencil,
                                const std::vector<Complex> &values,
                                const MultiVector          &real_part,
                                const MultiVector          &imaginary_part)
  {
    constexpr int       chunk = 16;
    const int           k     = static_cast<int>(values.size());
    std::vector<double> result(k);
    for (int first = 0; first < k; first += chunk)
      {
        const int                 width  = std::min(chunk, k - first);
        const PencilImage         image  = apply_pencil(pencil, {values.begin() + first, values.begin() + first + width},
                                                        view(real_part, first, width), view(imaginary_part, first, width));
        const std::vector<double> ratios = image.residuals();
        std::copy(ratios.begin(), ratios.end(), result.begin() + first);
      }
    return result;
  }

  void correct(const QuadraticPencil &pencil, const LinearOperator &inverse, QuadraticModes &modes, const double tolerance)
  {
    for (std::size_t j = 0; j < modes.values.size(); ++j)
      {
        if (modes.residuals[j] <= tolerance)
          continue;
        const int     column = static_cast<int>(j);
        MultiVector   re = view(*modes.real_part, column, 1), im = view(*modes.imaginary_part, column, 1);
        ComplexVector x        = corrected(pencil, inverse, modes.values[j], {re, im}, 0.1 * tolerance);
        const double  residual = apply_pencil(pencil, {modes.values[j]}, x.re, x.im).residuals()[0];
        if (residual < modes.residuals[j])
          {
            re                 = x.re;
            im                 = x.im;
            modes.residuals[j] = residual;
          }
      }
  }

  double excess(const QuadraticPencil &pencil, const QuadraticModes &modes, const QuadraticModesOptions &options)
  {
    if (modes.residuals.empty())
      return 0.;
    const double worst = *std::max_element(modes.residuals.begin(), modes.residuals.end());
    if (worst <= options.tolerance)
      return worst / options.tolerance;

    // Since ‖φ‖ = 1, rounding errors of Kφ are proportional to the norm of K
    constexpr double ten_roundings = 10. * std::numeric_limits<double>::epsilon();
    MultiVector      product(*modes.real_part);
    pencil.stiffness->apply(*modes.real_part, product);
    const std::vector<double> real_norms = column_norms(product);
    pencil.stiffness->apply(*modes.imaginary_part, product);
    const std::vector<double> imaginary_norms = column_norms(product);
    double                    largest         = 0.;
    for (std::size_t j = 0; j < modes.residuals.size(); ++j)
      {
        const double rounding = ten_roundings * (options.stiffness_norm + std::abs(modes.values[j]) * options.damping_norm) /
                                std::hypot(real_norms[j], imaginary_norms[j]);
        largest = std::max(largest, modes.residuals[j] / std::max(options.tolerance, rounding));
      }
    return largest;
  }

  void fix_phase(MultiVector &real_part, MultiVector &imaginary_part)
  {
    const RowMap  &map       = real_part.map();
    const MPI_Comm processes = map.communicator();
    for (int j = 0; j < real_part.n_columns(); ++j)
      {
        const Eigen::ArrayXd moduli  = (real_part.col(j).array().square() + imaginary_part.col(j).array().square()).sqrt();
        const double         largest = largest_of_processes(processes, moduli.size() > 0 ? moduli.maxCoeff() : 0.);
        if (!(largest > 0.))
          continue;
        int row = std::numeric_limits<int>::max();
        for (int i = 0; i < moduli.size(); ++i)
          if (moduli[i] >= (1. - 1e-13) * largest)
            row = std::min(row, map.number(i));
        smallest_of_processes(processes, &row, 1);

        double entry[2] = {0., 0.};
        if (const int i = map.place(row); i >= 0)
          {
            entry[0] = real_part(i, j);
            entry[1] = imaginary_part(i, j);
          }
        sum_over_processes(processes, entry, 2);
        const double          modulus = std::hypot(entry[0], entry[1]);
        const double          c = entry[0] / modulus, s = -entry[1] / modulus;
        const Eigen::VectorXd re = real_part.col(j);
        real_part.col(j)         = c * re - s * imaginary_part.col(j);
        imaginary_part.col(j)    = s * re + c * imaginary_part.col(j);
      }
  }
} // namespace Squeal
