// SPDX-License-Identifier: GPL-3.0-or-later

#include "shift_invert.h"

#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/communication.h>

#include <AnasaziBasicEigenproblem.hpp>
#include <AnasaziBlockKrylovSchurSolMgr.hpp>

#include <algorithm>
#include <stdexcept>

namespace Anasazi
{
  /// Vector operations that Anasazi requires for MultiVector; the names are Anasazi's.
  template <>
  class MultiVecTraits<double, Squeal::MultiVector>
  {
    using MV     = Squeal::MultiVector;
    using Matrix = Teuchos::SerialDenseMatrix<int, double>;
    template <typename T>
    using RCP = Teuchos::RCP<T>;

    static Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>> dense(const Matrix &B)
    {
      return {B.values(), B.numRows(), B.numCols(), Eigen::OuterStride<>(B.stride())};
    }

    /// View of columns of X, allocated on the heap as Anasazi requires.
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
      copy->local()   = X.local()(Eigen::placeholders::all, index);
      return copy;
    }
    static RCP<MV> CloneViewNonConst(MV &X, const std::vector<int> &index)
    {
      if (!is_range(index))
        throw std::invalid_argument("the columns of a view must be adjacent");
      return view(X, index[0], index.size());
    }
    static RCP<const MV> CloneView(const MV &X, const std::vector<int> &index)
    {
      return is_range(index) ? view(X, index[0], index.size()) : CloneCopy(X, index);
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
      // A factor of zero must also clear NaN
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
      X.local() *= Squeal::as_column(alpha).asDiagonal();
    }
    static void MvInit(MV &X, const double value)
    {
      X.local().setConstant(value);
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
    static void MvRandom(MV &X)
    {
      X.local() = Squeal::random_vectors(X.map(), X.n_columns()).local();
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

namespace Squeal
{
  std::optional<MultiVector> anasazi_vectors(const ShiftInvert &A, const KrylovRequest &request)
  {
    using Problem = Anasazi::BasicEigenproblem<double, MultiVector, LinearOperator>;
    using Teuchos::rcp;

    // Limit the block size: the basis and one more block must be linearly independent
    const int n          = A.n_free();
    const int block_size = std::max(1, std::min(request.block_size, n / 4));

    const auto start = rcp(new MultiVector(random_vectors(A.map(), block_size, request.seed)));
    A.project(*start);

    const Teuchos::RCP<const LinearOperator> inverse(&A, Teuchos::RCP_WEAK_NO_DEALLOC), mass(&A.mass, Teuchos::RCP_WEAK_NO_DEALLOC);
    const auto                               problem = rcp(new Problem(inverse, start));
    problem->setM(mass);
    problem->setHermitian(true);
    problem->setNEV(request.n_wanted);
    if (!problem->setProblem())
      throw SolverError("Anasazi rejected the eigenvalue problem", request.what, "choose another Real modes/Solver");

    // Use enough blocks for convergence in one start in most cases
    const int n_blocks =
      std::min(std::max(3, (5 * request.n_wanted / 2 + block_size - 1) / block_size + 10 * (1 + request.attempt)), n / block_size - 1);

    Teuchos::ParameterList parameters;
    parameters.set("Verbosity", static_cast<int>(Anasazi::Errors));
    parameters.set("Which", "LM");
    parameters.set("Block Size", block_size);
    parameters.set("Num Blocks", n_blocks);
    // Do not restart: Anasazi 13.2 writes beyond its workspace if it restarts a Hermitian problem and rounding errors turn a multiple
    // eigenvalue of the projected matrix into a complex pair at the boundary. Missing modes are found by another start with the converged
    // modes deflated
    parameters.set("Maximum Restarts", 0);
    // Limit the number of convergence checks, because each computes a dense Schur form of all previous blocks
    parameters.set("Step Size", std::max(4, n_blocks / 16));
    parameters.set("Convergence Tolerance", request.tolerance);
    parameters.set("Relative Convergence Tolerance", true);
    parameters.set("Orthogonalization", "DGKS");
    try
      {
        Anasazi::BlockKrylovSchurSolMgr<double, MultiVector, LinearOperator> solver(problem, parameters);
        // Ignore the return value: the number of converged modes is checked below
        solver.solve();
      }
    catch (const std::exception &error)
      {
        throw SolverError(std::string("Anasazi failed: ") + error.what(), request.what, "choose another Real modes/Solver");
      }

    const auto &solution = problem->getSolution();
    if (solution.numVecs == 0)
      return {};
    return view(*solution.Evecs, 0, solution.numVecs);
  }
} // namespace Squeal
