// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/sensitivity/eigenvalue_derivatives.h>

#include <Eigen/LU>

#include <cmath>
#include <map>

namespace Squeal
{
  using Complex = std::complex<double>;

  Eigentriples on_bodies(const ContactOperators &contact, const double friction_coefficient, const Eigentriples &coupled)
  {
    const SparseMatrix &T_c = *contact.kernel;
    Eigentriples        result{coupled.lambda, T_c * coupled.right, T_c * coupled.left};
    result.left -= friction_coefficient * transpose_times(*contact.reaction, *contact.tangential * result.left);
    return result;
  }

  TermProducts::TermProducts(const std::vector<Term> &terms, const Eigentriples &modes)
    : lambda(modes.lambda)
  {
    std::map<const SparseMatrix *, ComplexDenseMatrix> of_matrices; // terms may share a matrix, for example stiffness and damping of a body
    for (const Term &term : terms)
      {
        Product product{{term.name, term.power, term.coefficient, {}, term.symmetry, {}, {}, term.weights}, {}, {}, {}};
        if (term.matrix)
          {
            auto found = of_matrices.find(term.matrix.get());
            if (found == of_matrices.end())
              found = of_matrices.emplace(term.matrix.get(), product_of_halves(gram(modes.left, *term.matrix * modes.right))).first;
            product.value = found->second;
          }
        else
          {
            product.left  = from_halves(term.left->transpose_times(modes.left));
            product.right = from_halves(term.right->transpose_times(modes.right));
            if (term.weights.empty())
              product.value = product.left.transpose() * product.right;
          }
        products.push_back(std::move(product));
      }
  }

  ComplexDenseMatrix TermProducts::matrix(const Product &product, const ParameterValues &weights) const
  {
    if (product.term.weights.empty())
      return product.value;
    return product.left.transpose() * from_halves(product.term.weighted(halves(product.right), weights));
  }

  ComplexDenseMatrix TermProducts::pencil(const ParameterValues &values) const
  {
    const auto         k      = static_cast<Eigen::Index>(lambda.size());
    ComplexDenseMatrix result = ComplexDenseMatrix::Zero(k, k);
    for (const Product &product : products)
      {
        const ComplexDenseMatrix A = matrix(product, values);
        for (Eigen::Index j = 0; j < k; ++j)
          result.col(j) += product.term.factor(lambda[j], values) * A.col(j);
      }
    return result;
  }

  ComplexDenseMatrix TermProducts::by_lambda(const ParameterValues &values) const
  {
    const auto         k      = static_cast<Eigen::Index>(lambda.size());
    ComplexDenseMatrix result = ComplexDenseMatrix::Zero(k, k);
    for (const Product &product : products)
      if (product.term.power > 0)
        {
          const double             theta = product.term.coefficient.at(values);
          const ComplexDenseMatrix A     = matrix(product, values);
          for (Eigen::Index i = 0; i < k; ++i)
            for (Eigen::Index j = 0; j < k; ++j)
              result(i, j) += theta * (product.term.power == 1 ? 1. : lambda[i] + lambda[j]) * A(i, j);
        }
    return result;
  }

  ComplexDenseMatrix TermProducts::along(const ParameterValues &values, const ParameterValues &rates) const
  {
    const auto         k      = static_cast<Eigen::Index>(lambda.size());
    ComplexDenseMatrix result = ComplexDenseMatrix::Zero(k, k);
    const auto         add    = [&](const Product &product, const double theta, const ParameterValues &weights) {
      const ComplexDenseMatrix A = matrix(product, weights);
      for (Eigen::Index j = 0; j < k; ++j)
        result.col(j) += theta * std::pow(lambda[j], product.term.power) * A.col(j);
    };
    for (const auto &[parameter, rate] : rates)
      for (const Product &product : products)
        {
          if (product.term.coefficient.contains(parameter))
            add(product, product.term.coefficient.derivative(parameter, values) * rate.front(), values);
          if (product.term.weights == parameter)
            add(product, product.term.coefficient.at(values), rates);
        }
    return result;
  }

  Complex eigenvalue_derivative(const ComplexDenseMatrix &N, const ComplexDenseMatrix &D, const int mode)
  {
    return -N(mode, mode) / D(mode, mode);
  }

  Complex mean_derivative(const ComplexDenseMatrix &N, const ComplexDenseMatrix &D, const std::vector<int> &modes)
  {
    const ComplexDenseMatrix N_m = N(modes, modes), D_m = D(modes, modes);
    return -D_m.partialPivLu().solve(N_m).trace() / static_cast<double>(modes.size());
  }

  Complex squared_difference_derivative(const ComplexDenseMatrix &N, const ComplexDenseMatrix &D, const std::vector<Complex> &lambda)
  {
    return 2. * (lambda[0] - lambda[1]) * (eigenvalue_derivative(N, D, 0) - eigenvalue_derivative(N, D, 1));
  }

  ValueAtCentre value_at_centre(const std::array<Complex, 3> &means)
  {
    // Richardson extrapolation to h = 0 with powers h² and h⁴
    const Complex of_two   = (4. * means[0] - means[1]) / 3.;
    const Complex of_three = 1.5 * means[0] - 0.6 * means[1] + 0.1 * means[2];
    return {of_three, std::abs(of_three - of_two)};
  }
} // namespace Squeal
