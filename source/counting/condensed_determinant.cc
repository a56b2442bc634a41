#include <squeal/base/exceptions.h>
#include <squeal/counting/condensed_determinant.h>
#include <squeal/linear_algebra/dense_lu.h>
#include <squeal/linear_algebra/replicate.h>

#include <Epetra_Comm.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace Squeal
{
  namespace
  {
    using Complex = std::complex<double>;

    /// Columns that are solved for together: enough for the kernels, few enough for the memory.
    constexpr int chunk_size = 64;

    /// More terms than this mean that the series does not converge.
    constexpr int most_terms = 400;

    /// (1 − r) / (1 + r) and r of the series at λ.
    struct Ratio
    {
      Ratio(const Complex lambda, const double deflation_square, const double shift)
        : r(std::sqrt((deflation_square + lambda * lambda) / (deflation_square + shift)))
        , u((1. - r) / (1. + r))
      {}

      Complex r, u;
    };

    /// Root of the largest eigenvalue of a symmetric positive semidefinite matrix, the same on all processes.
    double root_of_largest(const Epetra_Comm &comm, const DenseMatrix &A)
    {
      const std::vector<double> values = agreed(comm, symmetric_eigenpairs(A + A.transpose())).values;
      return values.empty() ? 0. : std::sqrt(std::max(0., 0.5 * values.back()));
    }

    /// The diagonal of diag(d); ones without weights.
    DenseMatrix weights_of(const Term &term, const ParameterValues &values)
    {
      return term.weighted(DenseMatrix(DenseMatrix::Ones(term.right->rank(), 1)), values);
    }

    /// Largest modulus of diag(d); 1 without weights.
    double largest_weight(const Term &term, const ParameterValues &values)
    {
      return max_norm(weights_of(term, values));
    }

    /// Calls @p action with each factor and its first column in E.
    void for_columns(const std::vector<const LowRankFactor *> &factors, const std::function<void(const LowRankFactor &, int)> &action)
    {
      int first = 0;
      for (const LowRankFactor *factor : factors)
        {
          action(*factor, first);
          first += factor->rank();
        }
    }

    /// P (K + s M)⁻¹ on sets of vectors, P the M-orthogonal projection onto the complement of the modes.
    class ComplementInverse
    {
    public:
      ComplementInverse(const SparseMatrix &M, const MultiVector *modes, const LinearOperator &inverse)
        : modes(modes)
        , inverse(inverse)
      {
        if (modes != nullptr)
          mass_times_modes = std::make_unique<MultiVector>(M * *modes);
      }

      MultiVector operator*(const MultiVector &F) const
      {
        MultiVector X(F.Map(), F.NumVectors(), false);
        inverse.apply(F, X);
        if (modes != nullptr)
          multiply_add(-1., *modes, gram(*mass_times_modes, X), 1., X);
        return X;
      }

    private:
      const MultiVector           *modes;
      const LinearOperator        &inverse;
      std::unique_ptr<MultiVector> mass_times_modes;
    };
  } // namespace



  // -------------------------------------------------------------- preparation

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
      omega.push_back(std::sqrt(std::max(0., eigenvalue)));
    const MultiVector      *Phi     = omega.empty() ? nullptr : modes.vectors.get();
    const int               n_modes = omega.size();
    const SparseMatrix     &M       = *system.mass;
    const ComplementInverse complement_inverse(M, Phi, inverse);

    // ---------------------------------------- terms of low rank, and their factors
    std::vector<const LowRankFactor *> factors;
    for (const Term &term : system.terms)
      if (term.matrix == system.mass || term.matrix == system.stiffness || term.vanishes(system.at(1.)))
        continue;
      else if (term.matrix)
        throw SolverError("the term `" + term.name + "` is not confined to the contact", "determinant condensed to the contact nodes",
                          "take sparse LU factors instead (small systems), or leave the term out: Rayleigh damping, say");
      else
        {
          auto known = std::find(factors.begin(), factors.end(), term.left.get());
          if (known == factors.end())
            known = factors.insert(known, term.left.get());
          int first_row = 0;
          for (auto factor = factors.begin(); factor != known; ++factor)
            first_row += (*factor)->rank();
          blocks.push_back(
            {&term, first_row, n_modes > 0 ? term.right->transpose_times(*Phi) : DenseMatrix(term.right->rank(), 0), {}, 0.});
        }
    for (const LowRankFactor *factor : factors)
      n_rows += factor->rank();
    modes_forces = ComplexDenseMatrix(n_modes, n_rows);
    if (n_modes > 0)
      for_columns(factors, [&](const LowRankFactor &factor, const int first) {
        modes_forces.middleCols(first, factor.rank()) = factor.transpose_times(*Phi).transpose().cast<Complex>();
      });

    // ------------------------------------------- norms, and how many terms to take
    const auto for_chunks = [](const LowRankFactor &factor, const std::function<void(int, int)> &action) {
      for (int first = 0; first < factor.rank(); first += chunk_size)
        action(first, std::min(chunk_size, factor.rank() - first));
    };
    for (Block &block : blocks)
      {
        const LowRankFactor &R = *block.term->right;
        DenseMatrix          flexibility(R.rank(), R.rank());
        for_chunks(R, [&](const int first, const int n) {
          flexibility.middleCols(first, n) = R.transpose_times(complement_inverse * R.columns(first, n));
        });
        block.norm = largest_weight(*block.term, system.values) * root_of_largest(M.Comm(), flexibility);
      }
    DenseMatrix flexibility(n_rows, n_rows);
    for_columns(factors, [&](const LowRankFactor &factor, const int first_column) {
      for_chunks(factor, [&](const int first, const int n) {
        const MultiVector X = complement_inverse * factor.columns(first, n);
        for_columns(factors, [&](const LowRankFactor &other, const int first_row) {
          flexibility.block(first_row, first_column + first, other.rank(), n) = other.transpose_times(X);
        });
      });
    });
    forces_norm = root_of_largest(M.Comm(), flexibility);

    const auto sufficient = [&](const int n) {
      return std::all_of(request.lambda.begin(), request.lambda.end(), [&](const Complex lambda) {
        return truncation(lambda, request.largest_friction_coefficient, n) <= request.tolerance;
      });
    };
    for (n_terms = 1; !sufficient(n_terms); ++n_terms)
      if (n_terms == most_terms)
        throw SolverError("a series of " + std::to_string(most_terms) + " terms does not reach the tolerance",
                          "determinant condensed to the contact nodes", "take more real modes");

    // ----------------------------------------------------------------- moments
    for (Block &block : blocks)
      block.moments.assign(n_terms, DenseMatrix(block.term->right->rank(), n_rows));
    const double w = deflation_square + shift;
    for_columns(factors, [&](const LowRankFactor &factor, const int first_column) {
      for_chunks(factor, [&](const int first, const int n) {
        const auto keep = [&](const int k, const MultiVector &T) {
          for (Block &block : blocks)
            block.moments[k].middleCols(first_column + first, n) = block.term->right->transpose_times(T);
        };
        // T_{k+1} = 2 (2 w H − I) T_k − T_{k−1}. H blows up what rounding leaves of the modes: it is taken out in every step.
        MultiVector T = complement_inverse * factor.columns(first, n), previous(T);
        keep(0, T);
        for (int k = 1; k < n_terms; ++k)
          {
            MultiVector  next = complement_inverse * (M * T);
            const double two  = k == 1 ? 1. : 2.;
            next.Update(-two, T, 2. * w * two);
            if (k > 1)
              next.Update(-1., previous, 1.);
            previous = T;
            T        = next;
            keep(k, T);
          }
      });
    });
  }



  // --------------------------------------------------------------- evaluation

  ComplexDenseMatrix CondensedDeterminant::complement(const Complex lambda, const double mu) const
  {
    const ParameterValues values = system.at(mu);
    ComplexDenseMatrix    N      = ComplexDenseMatrix::Identity(n_rows, n_rows);
    const Ratio           ratio(lambda, deflation_square, shift);
    std::vector<Complex>  series(n_terms);
    Complex               power = 1. / ratio.r;
    for (int k = 0; k < n_terms; ++k, power *= ratio.u)
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
            for (int k = 0; k < n_terms; ++k)
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
    const int             n_modes = omega.size();
    OnModes               result;
    for (const double frequency : omega)
      result.resonances.push_back(1. / (lambda + Complex(0., frequency)) / (lambda - Complex(0., frequency)));

    // N_⊥⁻¹ G Φ
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



  double CondensedDeterminant::truncation(const Complex lambda, const double mu, const int n) const
  {
    const ParameterValues values = system.at(mu);
    // Σ_{k ≥ n} 2 |u|ᵏ / |r|
    const Ratio  ratio(lambda, deflation_square, shift);
    const double u = std::abs(ratio.u), tail = 2. * std::pow(u, n) / (1. - u) / std::abs(ratio.r);
    double       rows = 0.;
    for (const Block &block : blocks)
      rows += std::abs(block.term->factor(lambda, values)) * block.norm;
    return rows * tail * forces_norm;
  }



  double CondensedDeterminant::truncation(const Complex lambda, const double mu) const
  {
    return truncation(lambda, mu, n_terms);
  }



  const std::vector<double> &CondensedDeterminant::frequencies() const
  {
    return omega;
  }



  int CondensedDeterminant::n_moments() const
  {
    return n_terms;
  }
} // namespace Squeal
