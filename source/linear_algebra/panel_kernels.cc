#include "panel_matrix.h"
#include "processors.h"

namespace Squeal
{
  namespace
  {
    template <typename Real>
    using Lanes = typename PanelRow<Real>::Lanes;

    /// Σ A_ik X_k over some entries of a row.
    template <typename Real>
    SQUEAL_INLINE Lanes<Real> sum_of(const PanelMatrix<Real> &A, const std::size_t begin, const std::size_t end, const Panel<Real> &X)
    {
      const int  *column = A.column.data();
      const Real *value  = A.value.data();
      Lanes<Real> sum    = {};
      for (std::size_t k = begin; k < end; ++k)
        sum += value[k] * X[column[k]].lanes;
      return sum;
    }

    template <typename Real>
    SQUEAL_INLINE void product(const PanelMatrix<Real> &A, const Panel<Real> &X, Panel<Real> &Y)
    {
      for (int i = 0; i < A.n_rows; ++i)
        Y[i].lanes = sum_of(A, A.start[i], A.start[i + 1], X);
    }
  } // namespace

  SQUEAL_PROCESSORS void panel_product(const PanelMatrix<float> &A, const Panel<float> &X, Panel<float> &Y)
  {
    product(A, X, Y);
  }

  SQUEAL_PROCESSORS void panel_product(const PanelMatrix<double> &A, const Panel<double> &X, Panel<double> &Y)
  {
    product(A, X, Y);
  }

  SQUEAL_PROCESSORS void panel_add_product(const PanelMatrix<float> &A, const Panel<float> &Y, Panel<float> &X)
  {
    for (int i = 0; i < A.n_rows; ++i)
      X[i].lanes += sum_of(A, A.start[i], A.start[i + 1], Y);
  }

  SQUEAL_PROCESSORS void panel_first_sweep(const PanelMatrix<float> &A,
                                           const PanelSmoother      &smoother,
                                           const Panel<float>       &B,
                                           Panel<float>             &X)
  {
    for (int i = 0; i < A.n_rows; ++i)
      X[i].lanes = smoother.inverse_diagonal[i] * (B[i].lanes - sum_of(A, A.start[i], smoother.diagonal[i], X));
  }

  SQUEAL_PROCESSORS void panel_first_residual(const PanelMatrix<float> &A,
                                              const PanelSmoother      &smoother,
                                              const Panel<float>       &X,
                                              Panel<float>             &R)
  {
    for (int i = 0; i < A.n_rows; ++i)
      R[i].lanes = smoother.excess[i] * X[i].lanes - sum_of(A, smoother.diagonal[i] + 1, A.start[i + 1], X);
  }

  SQUEAL_PROCESSORS void panel_backward_sweep(const PanelMatrix<float> &A,
                                              const PanelSmoother      &smoother,
                                              const Panel<float>       &B,
                                              Panel<float>             &X)
  {
    for (int i = A.n_rows - 1; i >= 0; --i)
      X[i].lanes += smoother.inverse_diagonal[i] * (B[i].lanes - sum_of(A, A.start[i], A.start[i + 1], X));
  }
} // namespace Squeal
