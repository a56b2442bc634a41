#pragma once

#include <squeal/linear_algebra/communication.h>
#include <squeal/linear_algebra/factorization.h>

#include <AnasaziMultiVecTraits.hpp>
#include <AnasaziOperatorTraits.hpp>
#include <Teuchos_SerialDenseMatrix.hpp>

#include <stdexcept>

namespace Anasazi
{
  /// What Anasazi does with vectors, done with those of this program; names and meanings are Anasazi's.
  template <>
  class MultiVecTraits<double, Squeal::MultiVector>
  {
    using MV     = Squeal::MultiVector;
    using Range  = Teuchos::Range1D;
    using Matrix = Teuchos::SerialDenseMatrix<int, double>;
    template <typename T>
    using RCP = Teuchos::RCP<T>;

    static Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>> dense(const Matrix &B)
    {
      return {B.values(), B.numRows(), B.numCols(), Eigen::OuterStride<>(B.stride())};
    }

    /// A view that lives on the heap.
    static RCP<MV> view(const MV &X, const int first, const int n)
    {
      return Teuchos::rcp(new MV(Squeal::view(X, first, n)));
    }

    static bool is_range(const std::vector<int> &index)
    {
      for (std::size_t j = 1; j < index.size(); ++j)
        if (index[j] != index[0] + static_cast<int>(j))
          return false;
      return !index.empty();
    }

  public:
    static RCP<MV> Clone(const MV &X, const int n)
    {
      return Teuchos::rcp(new MV(X.map(), n));
    }
    static RCP<MV> CloneCopy(const MV &X)
    {
      return Teuchos::rcp(new MV(X));
    }
    static RCP<MV> CloneCopy(const MV &X, const std::vector<int> &index)
    {
      const auto copy = Teuchos::rcp(new MV(X.map(), static_cast<int>(index.size()), false));
      copy->local()   = X.local()(Eigen::all, index);
      return copy;
    }
    static RCP<MV> CloneCopy(const MV &X, const Range &range)
    {
      return CloneCopy(*view(X, range.lbound(), range.size()));
    }
    static RCP<MV> CloneViewNonConst(MV &X, const std::vector<int> &index)
    {
      if (!is_range(index))
        throw std::invalid_argument("a view of columns that are not side by side");
      return view(X, index[0], index.size());
    }
    static RCP<MV> CloneViewNonConst(MV &X, const Range &range)
    {
      return view(X, range.lbound(), range.size());
    }
    static RCP<const MV> CloneView(const MV &X, const std::vector<int> &index)
    {
      return is_range(index) ? view(X, index[0], index.size()) : CloneCopy(X, index);
    }
    static RCP<const MV> CloneView(const MV &X, const Range &range)
    {
      return view(X, range.lbound(), range.size());
    }

    static std::ptrdiff_t GetGlobalLength(const MV &X)
    {
      return X.map().n();
    }
    static int GetNumberVecs(const MV &X)
    {
      return X.n_columns();
    }

    static void MvTimesMatAddMv(const double alpha, const MV &X, const Matrix &B, const double beta, MV &Y)
    {
      Squeal::multiply_add(alpha, X, dense(B), beta, Y);
    }
    static void MvAddMv(const double alpha, const MV &X, const double beta, const MV &Y, MV &Z)
    {
      // A factor of zero takes what is not a number away.
      if (beta == 0.)
        Z.local() = alpha * X.local();
      else if (alpha == 0.)
        Z.local() = beta * Y.local();
      else
        Z.local() = alpha * X.local() + beta * Y.local();
    }
    static void MvScale(MV &X, const double alpha)
    {
      X *= alpha;
    }
    static void MvScale(MV &X, const std::vector<double> &alpha)
    {
      for (int j = 0; j < X.n_columns(); ++j)
        X.col(j) *= alpha[j];
    }
    static void MvTransMv(const double alpha, const MV &X, const MV &Y, Matrix &C)
    {
      dense(C) = alpha * Squeal::gram(X, Y);
    }
    static void MvDot(const MV &X, const MV &Y, std::vector<double> &products)
    {
      const std::vector<double> found = Squeal::column_products(X, Y);
      std::copy(found.begin(), found.end(), products.begin());
    }
    static void MvNorm(const MV &X, std::vector<double> &norms)
    {
      const std::vector<double> found = Squeal::column_norms(X);
      std::copy(found.begin(), found.end(), norms.begin());
    }

    static void SetBlock(const MV &X, const std::vector<int> &index, MV &Y)
    {
      for (std::size_t j = 0; j < index.size(); ++j)
        Y.col(index[j]) = X.col(j);
    }
    static void SetBlock(const MV &X, const Range &range, MV &Y)
    {
      Y.local().middleCols(range.lbound(), range.size()) = X.local().leftCols(range.size());
    }
    static void Assign(const MV &X, MV &Y)
    {
      Y.local().leftCols(X.n_columns()) = X.local();
    }
    static void MvRandom(MV &X)
    {
      X.local() = Squeal::random_vectors(X.map(), X.n_columns()).local();
    }
    static void MvInit(MV &X, const double value = 0.)
    {
      X.local().setConstant(value);
    }
    static void MvPrint(const MV &X, std::ostream &stream)
    {
      stream << X.local() << '\n';
    }

#ifdef HAVE_ANASAZI_TSQR
    using tsqr_adaptor_type = details::StubTsqrAdapter<MV>;
#endif
  };

  template <>
  class OperatorTraits<double, Squeal::MultiVector, Squeal::LinearOperator>
  {
  public:
    static void Apply(const Squeal::LinearOperator &A, const Squeal::MultiVector &X, Squeal::MultiVector &Y)
    {
      A.apply(X, Y);
    }
  };
} // namespace Anasazi
