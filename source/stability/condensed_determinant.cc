#include <squeal/base/decision.h>
#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/replicate.h>
#include <squeal/stability/condensed_determinant.h>

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

    const Decision outside("square of a mode with damping of its own outside of the summed modes / whole", 1e-6);

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
      DenseMatrix         V      = add(A, transpose(A));
      std::vector<double> values = symmetric_eigenvalues(V);
      agree(comm, V, values);
      return values.empty() ? 0. : std::sqrt(std::max(0., 0.5 * values.back()));
    }

    double largest_modulus(const std::vector<double> &values)
    {
      double largest = 0.;
      for (const double value : values)
        largest = std::max(largest, std::abs(value));
      return largest;
    }

    bool vanish(const std::vector<double> &values)
    {
      return largest_modulus(values) == 0.;
    }

    /// Copies A into B, from @p first_row and @p first_column on.
    void insert(const DenseMatrix &A, const int first_row, const int first_column, DenseMatrix &B)
    {
      for (int j = 0; j < A.n_columns(); ++j)
        std::copy(A.column(j), A.column(j) + A.n_rows(), B.column(first_column + j) + first_row);
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



  // ------------------------------------------------------------------- blocks

  DenseMatrix CondensedDeterminant::Block::operator*(const MultiVector &X) const
  {
    return replicate(transposed ? transpose_times(*factor, X) : *factor * X);
  }

  MultiVector CondensedDeterminant::Block::transpose_times_units(const int first, const int n) const
  {
    const MultiVector units = unit_vectors(transposed ? factor->DomainMap() : factor->RangeMap());
    const MultiVector chosen(view(units, first, n));
    return transposed ? *factor * chosen : transpose_times(*factor, chosen);
  }

  Complex CondensedDeterminant::Block::scale(const Complex lambda, const double mu) const
  {
    return (friction ? -mu : 1.) * (power == 0 ? 1. : power == 1 ? lambda : lambda * lambda);
  }



  // -------------------------------------------------------------- preparation

  CondensedDeterminant::CondensedDeterminant(const CoupledSystem               &system,
                                             const SymmetricModes              &modes,
                                             const double                       deflation_end,
                                             const LinearOperator              &inverse,
                                             const double                       shift,
                                             const CondensedDeterminantRequest &request)
    : deflation_square(deflation_end * deflation_end)
    , shift(shift)
  {
    if (system.body_damping)
      throw SolverError("damping of the bodies is not confined to the contact",
                        "determinant condensed to the contact nodes",
                        "take sparse LU factors instead (small systems), or leave out the Rayleigh damping");
    for (const double eigenvalue : modes.eigenvalues)
      omega.push_back(std::sqrt(std::max(0., eigenvalue)));
    const MultiVector      *Phi = omega.empty() ? nullptr : modes.vectors.get();
    const SparseMatrix     &M   = *system.frictionless.mass;
    const ComplementInverse complement_inverse(M, Phi, inverse);

    // ------------------------------------------------------------------ blocks
    const auto               &c = system.contact_damping;
    const int                 n_contact = system.normal_stiffness->NumGlobalRows();
    const std::vector<double> ones(n_contact, 1.);
    const auto                block = [&](const auto &factor, const bool transposed, const auto &coefficients, const bool friction, const int power) {
      Block result;
      result.factor       = factor;
      result.transposed   = transposed;
      result.coefficients = coefficients;
      result.friction     = friction;
      result.power        = power;
      return result;
    };
    blocks = {block(system.normal_stiffness, false, ones, true, 0), block(system.normal_mass, false, ones, true, 2)};
    if (!vanish(c.sliding))
      blocks.push_back(block(system.friction_forces, true, c.sliding, false, 1));
    std::vector<Block> forces = {block(system.friction_forces, true, ones, false, 0)};
    if (!vanish(c.radial))
      {
        blocks.push_back(block(system.radial_motion, false, c.radial, false, 1));
        blocks.back().first_row = n_contact;
        forces.push_back(blocks.back());
      }
    n_columns = forces.size() * n_contact;

    // ------------------------------------------------------------ on the modes
    const int   n_modal = system.modal_damping ? system.modal_damping->coefficients.size() : 0;
    const int   n_modes = omega.size();
    DenseMatrix on_forces(n_modes, n_columns + n_modal);
    n_rows = n_columns + n_modal;
    if (n_modes > 0)
      {
        for (Block &part : blocks)
          part.on_modes = part * *Phi;
        for (const Block &part : forces)
          insert(transpose(part * *Phi), 0, part.first_row, on_forces);
      }
    modal = DenseMatrix(n_modal, n_modes);
    if (n_modal > 0)
      {
        if (n_modes > 0)
          modal = gram(system.modal_damping->mass_times_modes, *Phi);
        insert(transpose(modal), 0, n_columns, on_forces);
        for (int i = 0; i < n_modal; ++i)
          {
            double square = 0.;
            for (int j = 0; j < n_modes; ++j)
              square += modal(i, j) * modal(i, j);
            if (outside.exceeded_by(std::abs(square - 1.)))
              throw SolverError("a mode with damping of its own lies above the modes that are taken as they are",
                                "determinant condensed to the contact nodes",
                                "give such damping to modes of the band only, or take more real modes");
            for (int j = 0; j < n_modes; ++j)
              modal(i, j) *= system.modal_damping->coefficients[i];
          }
      }
    modes_forces = ComplexDenseMatrix(n_modes, n_rows);
    std::copy(on_forces.column(), on_forces.column() + static_cast<std::size_t>(n_modes) * n_rows, modes_forces.column());

    // ------------------------------------------- norms, and how many terms to take
    const auto for_chunks = [&](const std::function<void(int, int)> &action) {
      for (int first = 0; first < n_contact; first += chunk_size)
        action(first, std::min(chunk_size, n_contact - first));
    };
    for (Block &part : blocks)
      {
        DenseMatrix flexibility(n_contact, n_contact);
        for_chunks([&](const int first, const int n) { insert(part * (complement_inverse * part.transpose_times_units(first, n)), 0, first, flexibility); });
        part.norm = largest_modulus(part.coefficients) * root_of_largest(M.Comm(), flexibility);
      }
    DenseMatrix flexibility(n_columns, n_columns);
    for (const Block &part : forces)
      for_chunks([&](const int first, const int n) {
        const MultiVector X = complement_inverse * part.transpose_times_units(first, n);
        for (const Block &other : forces)
          insert(other * X, other.first_row, part.first_row + first, flexibility);
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
                          "determinant condensed to the contact nodes",
                          "take more real modes");

    // ----------------------------------------------------------------- moments
    for (Block &part : blocks)
      part.moments.assign(n_terms, DenseMatrix(n_contact, n_columns));
    const double w = deflation_square + shift;
    for (const Block &part : forces)
      for_chunks([&](const int first, const int n) {
        const auto keep = [&](const int k, const MultiVector &T) {
          for (Block &row : blocks)
            insert(row * T, 0, part.first_row + first, row.moments[k]);
        };
        // T_{k+1} = 2 (2 w H − I) T_k − T_{k−1}. H blows up what rounding leaves of the modes: it is taken out in every step.
        MultiVector T = complement_inverse * part.transpose_times_units(first, n), previous(T);
        keep(0, T);
        for (int k = 1; k < n_terms; ++k)
          {
            MultiVector  next   = complement_inverse * (M * T);
            const double factor = k == 1 ? 1. : 2.;
            next.Update(-factor, T, 2. * w * factor);
            if (k > 1)
              next.Update(-1., previous, 1.);
            previous = T;
            T        = next;
            keep(k, T);
          }
      });
  }



  // --------------------------------------------------------------- evaluation

  ComplexDenseMatrix CondensedDeterminant::complement(const Complex lambda, const double mu) const
  {
    ComplexDenseMatrix   N(n_rows, n_rows);
    const Ratio          ratio(lambda, deflation_square, shift);
    std::vector<Complex> series(n_terms);
    Complex              power = 1. / ratio.r;
    for (int k = 0; k < n_terms; ++k, power *= ratio.u)
      series[k] = (k == 0 ? 1. : 2.) * power;
    std::vector<double> real, imaginary;
    for (const Block &block : blocks)
      {
        const Complex scale     = block.scale(lambda, mu);
        const int     n_contact = block.coefficients.size();
        for (int j = 0; j < n_columns; ++j)
          {
            real.assign(n_contact, 0.);
            imaginary.assign(n_contact, 0.);
            for (int k = 0; k < n_terms; ++k)
              {
                const double *moment = block.moments[k].column(j), re = series[k].real(), im = series[k].imag();
                for (int i = 0; i < n_contact; ++i)
                  {
                    real[i] += re * moment[i];
                    imaginary[i] += im * moment[i];
                  }
              }
            for (int i = 0; i < n_contact; ++i)
              N(block.first_row + i, j) += scale * block.coefficients[i] * Complex(real[i], imaginary[i]);
          }
      }
    for (int i = 0; i < n_rows; ++i)
      N(i, i) += 1.;
    return N;
  }



  CondensedDeterminant::OnModes CondensedDeterminant::on_modes(const Complex lambda, const double mu) const
  {
    const int n_modes = omega.size();
    OnModes   result;
    for (const double frequency : omega)
      result.resonances.push_back(1. / (lambda + Complex(0., frequency)) / (lambda - Complex(0., frequency)));

    // N_⊥⁻¹ G Φ
    ComplexDenseMatrix X(n_rows, n_modes);
    for (const Block &block : blocks)
      {
        const Complex scale = block.scale(lambda, mu);
        for (int j = 0; j < n_modes; ++j)
          for (int i = 0; i < block.on_modes.n_rows(); ++i)
            X(block.first_row + i, j) += scale * block.coefficients[i] * block.on_modes(i, j);
      }
    for (int j = 0; j < n_modes; ++j)
      for (int i = 0; i < modal.n_rows(); ++i)
        X(n_columns + i, j) = lambda * modal(i, j);
    const ComplexDenseLU factors(complement(lambda, mu));
    factors.solve(X);

    result.complement_inverse = std::sqrt(n_rows) * factors.inverse_norm();
    result.gain               = frobenius_norm(X) * frobenius_norm(modes_forces) * result.complement_inverse;
    result.matrix             = multiply(modes_forces, X);
    for (int j = 0; j < n_modes; ++j)
      {
        for (int i = 0; i < n_modes; ++i)
          result.matrix(i, j) *= result.resonances[i];
        result.matrix(j, j) += 1.;
      }
    return result;
  }



  double CondensedDeterminant::truncation(const Complex lambda, const double mu, const int n) const
  {
    // Σ_{k ≥ n} 2 |u|ᵏ / |r|
    const Ratio  ratio(lambda, deflation_square, shift);
    const double u = std::abs(ratio.u), tail = 2. * std::pow(u, n) / (1. - u) / std::abs(ratio.r);
    double       rows = 0.;
    for (const Block &block : blocks)
      rows += std::abs(block.scale(lambda, mu)) * block.norm;
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
