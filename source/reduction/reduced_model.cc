#include <squeal/linear_algebra/replicate.h>
#include <squeal/reduction/reduced_model.h>

namespace Squeal
{
  namespace
  {
    /// [X Y] for matrices with the same number of rows; X may be empty.
    DenseMatrix append_columns(const DenseMatrix &X, const DenseMatrix &Y)
    {
      DenseMatrix result(Y.n_rows(), X.n_columns() + Y.n_columns());
      std::copy(X.column(), X.column(X.n_columns()), result.column());
      std::copy(Y.column(), Y.column(Y.n_columns()), result.column(X.n_columns()));
      return result;
    }

    /// Borders a symmetric projection by its new rows and columns, given Tᵀ A T_new for the whole T.
    void border(DenseMatrix &matrix, const DenseMatrix &new_columns)
    {
      const int   r = new_columns.n_rows(), old = matrix.n_rows();
      DenseMatrix result(r, r);
      for (int j = 0; j < old; ++j)
        std::copy(matrix.column(j), matrix.column(j) + old, result.column(j));
      for (int j = old; j < r; ++j)
        for (int i = 0; i < r; ++i)
          {
            result(i, j) = new_columns(i, j - old);
            result(j, i) = result(i, j);
          }
      matrix = std::move(result);
    }
  } // namespace

  ReducedModel::ReducedModel(const CoupledSystem &system)
    : system(system)
  {}

  void ReducedModel::extend(const MultiVector &vectors)
  {
    T = std::make_unique<MultiVector>(T ? join({T.get(), &vectors}) : vectors);

    const SecondOrderSystem &matrices = system.frictionless;
    border(M, gram(*T, *matrices.mass * vectors));
    border(K, gram(*T, *matrices.stiffness * vectors));
    if (system.has_damping())
      border(C, gram(*T, system.damping_times(vectors)));

    A          = append_columns(A, replicate(transpose_times(*system.friction_forces, vectors)));
    V_K        = append_columns(V_K, replicate(*system.normal_stiffness * vectors));
    V_M        = append_columns(V_M, replicate(*system.normal_mass * vectors));
    friction_K = multiply(A, V_K, true);
    friction_M = multiply(A, V_M, true);
    if (system.normal_damping)
      {
        V_C        = append_columns(V_C, replicate(*system.normal_damping * vectors));
        friction_C = multiply(A, V_C, true);
      }
  }

  int ReducedModel::size() const
  {
    return M.n_rows();
  }

  const MultiVector &ReducedModel::basis() const
  {
    return *T;
  }

  ReducedPencil ReducedModel::at(const double mu) const
  {
    return {add(M, friction_M, -mu), system.normal_damping ? add(C, friction_C, -mu) : C, add(K, friction_K, -mu), C.n_rows() > 0};
  }
} // namespace Squeal
