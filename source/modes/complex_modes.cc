#include <squeal/linear_algebra/replicate.h>
#include <squeal/modes/complex_modes.h>

#include <Epetra_Vector.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace Squeal
{
  namespace
  {
    /// Y_j += c_j (x_j + i y_j) for the columns of complex vectors kept as real and imaginary halves.
    void add_scaled(MultiVector &Y, const std::vector<std::complex<double>> &c, const MultiVector &X)
    {
      const int k = X.NumVectors() / 2;
      for (int j = 0; j < k; ++j)
        {
          Y(j)->Update(c[j].real(), *X(j), -c[j].imag(), *X(k + j), 1.);
          Y(k + j)->Update(c[j].real(), *X(k + j), c[j].imag(), *X(j), 1.);
        }
    }

    /// Dot products of corresponding columns.
    std::vector<double> column_products(const MultiVector &X, const MultiVector &Y)
    {
      std::vector<double> result(X.NumVectors());
      if (!result.empty())
        X.Dot(Y, result.data());
      return result;
    }

    /// Turns each vector so that its entry of largest modulus is real and positive.
    void fix_phase(MultiVector &real_part, MultiVector &imaginary_part)
    {
      for (int j = 0; j < real_part.NumVectors(); ++j)
        {
          // The largest entry of all processes; ties go to the lowest process
          double largest  = -1.;
          double entry[2] = {1., 0.};
          for (int i = 0; i < real_part.MyLength(); ++i)
            if (const double modulus = std::hypot(real_part[j][i], imaginary_part[j][i]); modulus > largest)
              {
                largest  = modulus;
                entry[0] = real_part[j][i];
                entry[1] = imaginary_part[j][i];
              }
          const Epetra_Comm &comm = real_part.Comm();
          double             global;
          comm.MaxAll(&largest, &global, 1);
          int owner = largest == global ? comm.MyPID() : comm.NumProc(), root;
          comm.MinAll(&owner, &root, 1);
          comm.Broadcast(entry, 2, root);

          const double modulus = std::hypot(entry[0], entry[1]);
          const double c = entry[0] / modulus, s = -entry[1] / modulus;
          for (int i = 0; i < real_part.MyLength(); ++i)
            {
              const double re = real_part[j][i], im = imaginary_part[j][i];
              real_part[j][i]      = c * re - s * im;
              imaginary_part[j][i] = s * re + c * im;
            }
        }
    }

    /// φᴴ M φ = 1 for every vector, its entry of largest modulus real and positive.
    void normalize(const SparseMatrix &M, MultiVector &real_part, MultiVector &imaginary_part)
    {
      fix_phase(real_part, imaginary_part);
      const auto re = column_products(real_part, M * real_part), im = column_products(imaginary_part, M * imaginary_part);
      for (std::size_t j = 0; j < re.size(); ++j)
        {
          const double factor = 1. / std::sqrt(re[j] + im[j]);
          real_part(j)->Scale(factor);
          imaginary_part(j)->Scale(factor);
        }
    }

    MultiVector permuted(const MultiVector &X, const std::vector<int> &order)
    {
      MultiVector result(X.Map(), X.NumVectors());
      for (int j = 0; j < X.NumVectors(); ++j)
        *result(j) = *X(order[j]);
      return result;
    }
  } // namespace

  MultiVector force_residuals(const CoupledSystem                     &system,
                              const ParameterValues                   &values,
                              const std::vector<std::complex<double>> &lambda,
                              const MultiVector                       &real_part,
                              const MultiVector                       &imaginary_part,
                              const bool                               left)
  {
    const MultiVector                 X = join({&real_part, &imaginary_part});
    MultiVector                       R = times(system.terms, values, 0, X, left);
    std::vector<std::complex<double>> factors(lambda.size(), 1.);
    for (const int power : {1, 2})
      {
        std::transform(factors.begin(), factors.end(), lambda.begin(), factors.begin(), std::multiplies<>());
        if (!terms_of(system.terms, values, power).empty())
          add_scaled(R, factors, times(system.terms, values, power, X, left));
      }
    return R;
  }

  void finish_modes(const CoupledSystem &system, const ParameterValues &values, const UpdatedInverse &inverse, ComplexModes &modes)
  {
    const int k = modes.lambda.size();
    if (k == 0)
      return;

    // Ascending frequency; of a pair with equal frequencies the stable mode first
    std::vector<int> order(k);
    std::iota(order.begin(), order.end(), 0);
    constexpr double equal = 1e-9;
    std::sort(order.begin(), order.end(), [&](const int a, const int b) {
      return std::make_pair(modes.lambda[a].imag(), modes.lambda[a].real()) <
             std::make_pair(modes.lambda[b].imag(), modes.lambda[b].real());
    });
    for (int j = 0; j + 1 < k; ++j)
      {
        const auto &a = modes.lambda[order[j]], &b = modes.lambda[order[j + 1]];
        if (b.imag() - a.imag() < equal * b.imag() && a.real() > b.real())
          std::swap(order[j], order[j + 1]);
      }
    std::vector<std::complex<double>> sorted(k);
    for (int j = 0; j < k; ++j)
      sorted[j] = modes.lambda[order[j]];
    modes.lambda = sorted;
    for (const auto part : {&modes.real_part, &modes.imaginary_part, &modes.left_real_part, &modes.left_imaginary_part})
      if (*part)
        *part = std::make_shared<MultiVector>(permuted(**part, order));
    if (!modes.estimated_errors.empty())
      {
        const auto errors = modes.estimated_errors;
        for (int j = 0; j < k; ++j)
          modes.estimated_errors[j] = errors[order[j]];
      }

    normalize(*system.mass, *modes.real_part, *modes.imaginary_part);
    if (modes.left_real_part)
      normalize(*system.mass, *modes.left_real_part, *modes.left_imaginary_part);

    // Residuals
    const MultiVector X  = join({modes.real_part.get(), modes.imaginary_part.get()});
    const MultiVector KX = *system.stiffness * X;
    const MultiVector R  = force_residuals(system, values, modes.lambda, *modes.real_part, *modes.imaginary_part);
    const MultiVector U  = inverse.solve_frictionless(R);
    const auto R_R = column_products(R, R), KX_KX = column_products(KX, KX), U_R = column_products(U, R), X_KX = column_products(X, KX);
    modes.residuals.resize(k);
    modes.energy_residuals.resize(k);
    for (int j = 0; j < k; ++j)
      {
        modes.residuals[j]        = std::sqrt((R_R[j] + R_R[k + j]) / (KX_KX[j] + KX_KX[k + j]));
        modes.energy_residuals[j] = (U_R[j] + U_R[k + j]) / (X_KX[j] + X_KX[k + j]);
      }
  }
} // namespace Squeal
