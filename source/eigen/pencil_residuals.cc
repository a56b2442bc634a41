#include "pencil_residuals.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Q(λ_j) φ_j for some modes.
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
        const int         column = static_cast<int>(j);
        MultiVector       re = view(*modes.real_part, column, 1), im = view(*modes.imaginary_part, column, 1);
        const PencilImage before = apply_pencil(pencil, {modes.values[j]}, re, im);
        MultiVector       new_re(re.map(), 1), new_im(re.map(), 1);
        inverse.apply(before.real, new_re);
        inverse.apply(before.imaginary, new_im);
        new_re            = re - new_re;
        new_im            = im - new_im;
        const double norm = std::hypot(column_norms(new_re)[0], column_norms(new_im)[0]);
        new_re *= 1. / norm;
        new_im *= 1. / norm;
        const double residual = apply_pencil(pencil, {modes.values[j]}, new_re, new_im).residuals()[0];
        if (residual < modes.residuals[j])
          {
            re                 = new_re;
            im                 = new_im;
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

    // ‖φ‖ is one.
    const double rounding = 10. * std::numeric_limits<double>::epsilon() * options.stiffness_norm;
    MultiVector  product(*modes.real_part);
    pencil.stiffness->apply(*modes.real_part, product);
    const std::vector<double> real_norms = column_norms(product);
    pencil.stiffness->apply(*modes.imaginary_part, product);
    const std::vector<double> imaginary_norms = column_norms(product);
    double                    largest         = 0.;
    for (std::size_t j = 0; j < modes.residuals.size(); ++j)
      largest =
        std::max(largest, modes.residuals[j] / std::max(options.tolerance, rounding / std::hypot(real_norms[j], imaginary_norms[j])));
    return largest;
  }
} // namespace Squeal
