#pragma once

#include <boost/serialization/complex.hpp>
#include <boost/serialization/vector.hpp>

#include <complex>
#include <cstddef>
#include <vector>

namespace Squeal
{
  /**
   * A small dense matrix in LAPACK's column-major order, the same on every
   * process. Only reduced quantities are stored like this: never n × n.
   */
  template <typename Number>
  class DenseMatrixOf
  {
  public:
    DenseMatrixOf() = default;

    /// A zero matrix of @p n_rows × @p n_columns.
    DenseMatrixOf(const int n_rows, const int n_columns)
      : rows(n_rows)
      , columns(n_columns)
      , values(static_cast<std::size_t>(n_rows) * n_columns)
    {}

    int n_rows() const
    {
      return rows;
    }
    int n_columns() const
    {
      return columns;
    }

    Number &operator()(const int i, const int j)
    {
      return values[i + static_cast<std::size_t>(rows) * j];
    }
    const Number &operator()(const int i, const int j) const
    {
      return values[i + static_cast<std::size_t>(rows) * j];
    }

    /// First entry of column @p j.
    Number *column(const int j = 0)
    {
      return values.data() + static_cast<std::size_t>(rows) * j;
    }
    const Number *column(const int j = 0) const
    {
      return values.data() + static_cast<std::size_t>(rows) * j;
    }

    /// For boost's archives.
    template <class Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &rows &columns &values;
    }

  private:
    int                 rows = 0, columns = 0;
    std::vector<Number> values;
  };

  using DenseMatrix        = DenseMatrixOf<double>;
  using ComplexDenseMatrix = DenseMatrixOf<std::complex<double>>;

  /// alpha op(A) op(B), op = transpose where asked.
  DenseMatrix multiply(const DenseMatrix &A, const DenseMatrix &B, bool transpose_A = false, bool transpose_B = false, double alpha = 1.);

  ComplexDenseMatrix multiply(const ComplexDenseMatrix &A, const ComplexDenseMatrix &B, bool conjugate_transpose_A = false);

  /// A X of a real and a complex matrix.
  ComplexDenseMatrix multiply(const DenseMatrix &A, const ComplexDenseMatrix &X);

  /// Xᵀ Y, no conjugate.
  ComplexDenseMatrix transpose_multiply(const ComplexDenseMatrix &X, const ComplexDenseMatrix &Y);

  /// Real and imaginary parts of the entries.
  DenseMatrix real_part(const ComplexDenseMatrix &X);
  DenseMatrix imaginary_part(const ComplexDenseMatrix &X);

  /// A + factor B.
  DenseMatrix add(const DenseMatrix &A, const DenseMatrix &B, double factor = 1.);

  DenseMatrix transpose(const DenseMatrix &A);

  DenseMatrix identity(int n);

  /// [X Y]; X may be empty.
  DenseMatrix append_columns(const DenseMatrix &X, const DenseMatrix &Y);

  /// Extends a matrix with Aᵀ = sign A, symmetric or skew, to the size of its new last columns, r × k.
  void border(DenseMatrix &matrix, const DenseMatrix &new_columns, double sign = 1.);

  /**
   * XᵀY, no conjugate, of complex matrices X, Y with real and imaginary halves
   * side by side from the products of all halves, 2k × 2k.
   */
  ComplexDenseMatrix from_halves(const DenseMatrix &products);

  /// Columns [first, first + n) of A.
  DenseMatrix columns(const DenseMatrix &A, int first, int n);

  /// Largest absolute entry; 0 for an empty matrix.
  double max_norm(const DenseMatrix &A);

  /// LU factors of a small square matrix.
  class DenseLU
  {
  public:
    /// Throws SolverError naming @p what if A is singular to working precision.
    DenseLU(DenseMatrix A, const char *what);

    /// Solves A X = B (or Aᵀ X = B) in place.
    void solve(DenseMatrix &B, bool transpose = false) const;

    /// Estimated reciprocal condition number in the 1-norm.
    double reciprocal_condition() const;

  private:
    DenseMatrix      factors;
    std::vector<int> pivots;
    double           rcond = 0.;
  };

  /// LU factors of a small square complex matrix, singular ones included.
  class ComplexDenseLU
  {
  public:
    explicit ComplexDenseLU(ComplexDenseMatrix A);

    /// Solves A X = B in place; only if the reciprocal condition is not zero.
    void solve(ComplexDenseMatrix &B) const;

    /// A logarithm of det A: the sum of those of the pivots, its imaginary part in (−π, π]; −∞ for a zero pivot.
    std::complex<double> log_determinant() const;

    /// Estimate of ‖A⁻¹‖₁; infinite if A is singular to working precision.
    double inverse_norm() const;

  private:
    ComplexDenseMatrix factors;
    std::vector<int>   pivots;
    double             norm_of_inverse = 0.;
  };

  /// S⁻¹ A S with a positive diagonal S that brings its norm down: row and column of an index of the same norm (Osborne).
  ComplexDenseMatrix balanced(ComplexDenseMatrix A);

  /// Root of the sum of the squares of all moduli.
  double frobenius_norm(const ComplexDenseMatrix &A);

  /// Eigenpairs of a symmetric matrix, ascending: A is replaced by its eigenvectors.
  std::vector<double> symmetric_eigenvalues(DenseMatrix &A);

  /**
   * Eigenvalues of A x = λ B x, ascending, A symmetric and B symmetric positive
   * definite: A is replaced by the B-orthonormal eigenvectors.
   */
  std::vector<double> symmetric_eigenvalues(DenseMatrix &A, DenseMatrix B);

  /// Singular values and right singular vectors of an m × n matrix.
  struct SingularValues
  {
    std::vector<double> values; ///< min(m, n) of them, descending
    DenseMatrix         right;  ///< V, n × n: its last n − rank columns span the kernel
  };
  SingularValues singular_values(DenseMatrix A);

  /**
   * Eigenvalues of a real square matrix with right and, where asked, left
   * eigenvectors (LAPACK's dgeev: left vectors satisfy yᴴ A = λ yᴴ).
   */
  struct DenseEigenpairs
  {
    std::vector<std::complex<double>> values;
    ComplexDenseMatrix                right; ///< one column per value
    ComplexDenseMatrix                left;  ///< empty unless asked for
  };
  DenseEigenpairs eigenpairs(DenseMatrix A, bool left_vectors = false);
} // namespace Squeal
