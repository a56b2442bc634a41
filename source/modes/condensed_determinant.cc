// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/modes/condensed_determinant.h>
#include <squeal/linear_algebra/dense_lu.h>
#include <squeal/linear_algebra/multivector.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Number of columns solved together: a compromise between speed and memory.
    constexpr int chunk_size = 64;

    /// Number of terms above which the series counts as divergent.
    constexpr int most_terms = 400;

    /// u = (1 − r) / (1 + r) and r of the series at λ.
    struct Ratio
    {
      Ratio(const Complex lambda, const double deflation_square, const double shift)
        : r(std::sqrt((deflation_square + lambda * lambda) / (deflation_square + shift)))
        , u((1. - r) / (1. + r))
      {}

      Complex r, u;
    };

    /// d of a term; ones if the term has no weights.
    DenseMatrix weights_of(const Term &term, const ParameterValues &values)
    {
      return term.weighted(DenseMatrix(DenseMatrix::Ones(term.right->rank(), 1)), values);
    }

    /// The matrix E, with the columns of several factors.
    using Factors = std::vector<const LowRankFactor *>;

    int total_rank(const Factors &factors)
    {
      return std::accumulate(factors.begin(), factors.end(), 0,
                             [](const int n, const LowRankFactor *factor) { return n + factor->rank(); });
    }

    /// Calls @p action for blocks of columns of E, with the index of their first column.
    void for_chunks(const Factors &factors, const std::function<void(const MultiVector &, int)> &action)
    {
      int offset = 0;
      for (const LowRankFactor *factor : factors)
        {
          for (int first = 0; first < factor->rank(); first += chunk_size)
            action(factor->columns(first, std::min(chunk_size, factor->rank() - first)), offset + first);
          offset += factor->rank();
        }
    }

    /// EᵀX.
    DenseMatrix transpose_times(const Factors &factors, const MultiVector &X)
    {
      DenseMatrix result;
      for (const LowRankFactor *factor : factors)
        {
          const DenseMatrix rows = factor->transpose_times(X);
          result.conservativeResize(result.rows() + rows.rows(), rows.cols());
          result.bottomRows(rows.rows()) = rows;
        }
      return result;
    }

    /// The operator P (K + s M)⁻¹, where P is the M-orthogonal projection onto the complement of the modes Φ.
    struct ComplementInverse
    {
      const LinearOperator      &inverse;
      const MultiVector         *modes;            ///< Φ; null if there are no modes
      std::optional<MultiVector> mass_times_modes; ///< M Φ

      MultiVector operator*(const MultiVector &F) const
      {
        MultiVector X(F.map(), F.n_columns(), false);
        inverse.apply(F, X);
        if (modes != nullptr)
          multiply_add(-1., *modes, gram(*mass_times_modes, X), 1., X);
        return X;
      }
    };

    /// ‖(K + s M)^−½ E‖ on the complement, identical on all processes.
    double norm_on_complement(const Factors &factors, const ComplementInverse &complement_inverse, const MPI_Comm communicator)
    {
      DenseMatrix flexibility(total_rank(factors), total_rank(factors));
      for_chunks(factors, [&](const MultiVector &F, const int first) {
        flexibility.middleCols(first, F.n_columns()) = transpose_times(factors, complement_inverse * F);
      });
      const std::vector<double> values = agreed(communicator, symmetric_eigenpairs(flexibility + flexibility.transpose())).values;
      return values.empty() ? 0. : std::sqrt(std::max(0., 0.5 * values.back()));
    }
  } // namespace

  CondensedDeterminant::CondensedDeterminant(const CoupledSystem               &system,
                                             const SymmetricModes              &modes,
                                             const double                       deflation_end,
                                             const LinearOperator              &inverse,
                                             const double                       shift,
                                             const CondensedDeterminantRequest &request)
    : system(system)
    , deflation_square(deflation_end * deflation_end)
    , shift(shift)
  {
    for (const double eigenvalue : modes.eigenvalues)
      frequencies.push_back(std::sqrt(std::max(0., eigenvalue)));
    const SparseMatrix     &M   = *system.mass;
    const MultiVector      *Phi = frequencies.empty() ? nullptr : modes.vectors.get();
    const ComplementInverse complement_inverse{inverse, Phi, Phi ? std::optional(M * *Phi) : std::nullopt};

    Factors factors;
    for (const Term &term : system.terms)
      {
        if (term.matrix == system.mass || term.matrix == system.stiffness || term.vanishes(system.at(1.)))
          continue;
        if (term.matrix)
          throw SolverError("the term `" + term.name + "` is not confined to the contact", "determinant condensed to the contact nodes",
                            "remove this term, for example Rayleigh damping, or remove Sweep/Count modes at");
        const auto known     = std::find(factors.begin(), factors.end(), term.left.get());
        const int  first_row = total_rank({factors.begin(), known});
        if (known == factors.end())
          factors.push_back(term.left.get());
        blocks.push_back({&term, first_row, Phi ? term.right->transpose_times(*Phi) : DenseMatrix(term.right->rank(), 0), {}, 0.});
      }
    n_rows       = total_rank(factors);
    modes_forces = ComplexDenseMatrix(frequencies.size(), n_rows);
    if (Phi != nullptr && n_rows > 0)
      modes_forces = transpose_times(factors, *Phi).transpose().cast<Complex>();

    for (Block &block : blocks)
      block.norm = max_norm(weights_of(*block.term, system.values)) *
                   norm_on_complement({block.term->right.get()}, complement_inverse, M.communicator());
    forces_norm          = norm_on_complement(factors, complement_inverse, M.communicator());
    const auto is_coarse = [&](const Complex lambda) {
      return !(truncation(lambda, request.largest_friction_coefficient) <= request.tolerance);
    };
    for (n_moments = 1; std::any_of(request.lambda.begin(), request.lambda.end(), is_coarse); ++n_moments)
      if (n_moments == most_terms)
        throw SolverError("a series of " + std::to_string(most_terms) + " terms does not reach the tolerance",
                          "determinant condensed to the contact nodes",
                          "change Band/Maximum frequency or Band/Maximum rate, or remove Sweep/Count modes at");

    // Moments: T_{k+1} = 2 (2 w H − I) T_k − T_{k−1}. Project in every step, because H amplifies rounding errors in the modes
    for (Block &block : blocks)
      block.moments.assign(n_moments, DenseMatrix(block.term->right->rank(), n_rows));
    const double w = deflation_square + shift;
    for_chunks(factors, [&](const MultiVector &F, const int first) {
      MultiVector T = complement_inverse * F, previous(T);
      for (int k = 0; k < n_moments; ++k)
        {
          if (k > 0)
            {
              MultiVector  next = complement_inverse * (M * T);
              const double two  = k == 1 ? 1. : 2.;
              next.local()      = two * (2. * w * next.local() - T.local());
              if (k > 1)
                next -= previous;
              previous = std::move(T);
              T        = std::move(next);
            }
          for (Block &block : blocks)
            block.moments[k].middleCols(first, F.n_columns()) = block.term->right->transpose_times(T);
        }
    });
  }

  ComplexDenseMatrix CondensedDeterminant::complement(const Complex lambda, const double mu) const
  {
    const ParameterValues values = system.at(mu);
    ComplexDenseMatrix    N      = ComplexDenseMatrix::Identity(n_rows, n_rows);
    const Ratio           ratio(lambda, deflation_square, shift);
    std::vector<Complex>  series(n_moments);
    Complex               power = 1. / ratio.r;
    for (int k = 0; k < n_moments; ++k, power *= ratio.u)
      series[k] = (k == 0 ? 1. : 2.) * power;
    for (const Block &block : blocks)
      {
        const int              n_here  = block.term->right->rank();
        const Eigen::VectorXcd weights = block.term->factor(lambda, values) * weights_of(*block.term, system.values).col(0);
        Eigen::VectorXd        real(n_here), imaginary(n_here);
        for (int j = 0; j < n_rows; ++j)
          {
            real.setZero();
            imaginary.setZero();
            for (int k = 0; k < n_moments; ++k)
              {
                real += series[k].real() * block.moments[k].col(j);
                imaginary += series[k].imag() * block.moments[k].col(j);
              }
            N.col(j).segment(block.first_row, n_here) += weights.cwiseProduct(real + Complex(0., 1.) * imaginary);
          }
      }
    return N;
  }

  CondensedDeterminant::OnModes CondensedDeterminant::on_modes(const Complex lambda, const double mu) const
  {
    const ParameterValues values  = system.at(mu);
    const int             n_modes = frequencies.size();
    OnModes               result;
    for (const double frequency : frequencies)
      result.resonances.push_back(1. / (lambda + Complex(0., frequency)) / (lambda - Complex(0., frequency)));

    // X = N_⊥⁻¹ G Φ
    ComplexDenseMatrix X = ComplexDenseMatrix::Zero(n_rows, n_modes);
    for (const Block &block : blocks)
      X.middleRows(block.first_row, block.on_modes.rows()) +=
        block.term->factor(lambda, values) * block.term->weighted(block.on_modes, system.values);
    const ComplexLU factors(complement(lambda, mu));
    X = factors.solve(X);

    result.complement_inverse = std::sqrt(n_rows) * factors.inverse_norm();
    result.gain               = X.norm() * modes_forces.norm() * result.complement_inverse;
    result.matrix             = as_column(result.resonances).asDiagonal() * (modes_forces * X);
    result.matrix.diagonal().array() += 1.;
    return result;
  }

  double CondensedDeterminant::truncation(const Complex lambda, const double mu) const
  {
    const ParameterValues values = system.at(mu);
    // Sum of the omitted terms, Σ_{k ≥ n} 2 |u|ᵏ / |r|
    const Ratio  ratio(lambda, deflation_square, shift);
    const double u = std::abs(ratio.u), tail = 2. * std::pow(u, n_moments) / (1. - u) / std::abs(ratio.r);
    double       rows = 0.;
    for (const Block &block : blocks)
      rows += std::abs(block.term->factor(lambda, values)) * block.norm;
    return rows * tail * forces_norm;
  }
} // namespace Squeal
