#include "pivoted_qr.h"

#include <squeal/linear_algebra/communication.h>

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace Squeal
{
  DenseMatrix pivoted_qr(MultiVector &X, std::vector<double> smallest)
  {
    const int        b = X.n_columns();
    DenseMatrix      R = DenseMatrix::Zero(b, b);
    std::vector<int> permutation(b);
    std::iota(permutation.begin(), permutation.end(), 0);

    int k = 0;
    for (; k < b; ++k)
      {
        const MultiVector   remaining = view(X, k, b - k);
        std::vector<double> norms     = column_norms(remaining);
        agree(X.communicator(), norms.data(), norms.size());
        int pivot = 0;
        for (int j = 1; j < b - k; ++j)
          if (norms[j] > norms[pivot])
            pivot = j;

        // ------------------------------------------------- the largest one next
        const double largest = norms[pivot];
        if (pivot > 0)
          {
            pivot += k;
            MultiVector       first = view(X, k, 1), second = view(X, pivot, 1);
            const MultiVector copy = first;
            first                  = second;
            second                 = copy;
            R.col(k).head(k).swap(R.col(pivot).head(k));
            std::swap(permutation[k], permutation[pivot]);
            std::swap(smallest[k], smallest[pivot]);
          }
        if (!(largest > smallest[k]))
          break;

        // ------------------------------------------------- removed from the others
        MultiVector q = view(X, k, 1);
        q *= 1. / largest;
        R(k, k) = largest;
        if (k + 1 < b)
          {
            MultiVector       others       = view(X, k + 1, b - k - 1);
            const DenseMatrix coefficients = gram(q, others);
            multiply_add(-1., q, coefficients, 1., others);
            R.row(k).tail(b - k - 1) = coefficients;
          }
      }

    DenseMatrix result(k, b);
    for (int j = 0; j < b; ++j)
      result.col(permutation[j]) = R.col(j).head(k);
    return result;
  }

  double smallest_share(const DenseMatrix &R)
  {
    double result = 1.;
    for (Eigen::Index k = 0; k < R.rows(); ++k)
      {
        Eigen::Index pivot;
        const double largest = R.row(k).cwiseAbs().maxCoeff(&pivot);
        result               = std::min(result, largest / R.col(pivot).norm());
      }
    return result;
  }

  DenseMatrix pivoted_qr(DenseMatrix &X, const double smallest)
  {
    const DenseMatrix::Index b = X.cols();
    if (X.size() == 0)
      {
        X.resize(Eigen::NoChange, 0);
        return DenseMatrix(0, b);
      }
    const Eigen::ColPivHouseholderQR<DenseMatrix> qr(X);
    Eigen::Index                                  k = 0;
    while (k < std::min(X.rows(), b) && std::abs(qr.matrixR()(k, k)) > smallest)
      ++k;
    X                   = qr.householderQ() * DenseMatrix::Identity(X.rows(), k);
    const DenseMatrix R = qr.matrixR().topRows(k).triangularView<Eigen::Upper>();
    return R * qr.colsPermutation().transpose();
  }
} // namespace Squeal
