#include "aggregation.h"
#include "panels.h"

#include <squeal/base/exceptions.h>
#include <squeal/linear_algebra/communication.h>

#include <Eigen/Cholesky>

namespace Squeal
{
  PanelSmoother::PanelSmoother(const PanelMatrix<float> &A)
  {
    for (int i = 0; i < A.n_rows; ++i)
      {
        const auto begin = A.column.begin() + A.start[i], end = A.column.begin() + A.start[i + 1];
        diagonal.push_back(std::lower_bound(begin, end, i) - A.column.begin());
        float others = 0.;
        for (std::size_t k = std::lower_bound(begin, end, A.n_own_columns) - A.column.begin(); k < A.start[i + 1]; ++k)
          others += std::abs(A.value[k]);
        excess.push_back(others);
        inverse_diagonal.push_back(1.f / (A.value[diagonal.back()] + others));
      }
  }

  namespace
  {
    /// A level, with what the cycle keeps of it.
    struct CycleLevel
    {
      CycleLevel(const SparseMatrix &A, const SparseMatrix &P)
        : A(A)
        , P(P)
        , R(*transpose(P))
        , smoother(this->A)
      {}

      PanelMatrix<float> A, P, R;
      PanelSmoother      smoother;
    };

    /// The inverse of the coarsest matrix, the same on every process.
    struct CoarseSolver
    {
      CoarseSolver(const SparseMatrix &A, const std::string &what)
        : first_row(LocalRows(A).first_row)
        , n_local(A.rows().n_local())
        , n_processes(A.rows().n_processes())
        , communicator(A.communicator())
      {
        const DenseMatrix             dense = to_dense(A);
        const Eigen::LLT<DenseMatrix> cholesky(dense);
        if (cholesky.info() != Eigen::Success)
          throw SolverError("the coarsest matrix of multigrid is not positive definite", what,
                            "check the boundary conditions: a body that can move rigidly has a singular stiffness");
        inverse = cholesky.solve(DenseMatrix::Identity(dense.rows(), dense.rows())).cast<float>();
      }

      void apply(const Panel<float> &B, Panel<float> &X) const
      {
        using Rows = Eigen::Matrix<float, Eigen::Dynamic, panel_width, Eigen::RowMajor>;
        Rows all   = Rows::Zero(inverse.rows(), panel_width);
        if (n_local > 0)
          all.middleRows(first_row, n_local) = Eigen::Map<const Rows>(reinterpret_cast<const float *>(B.data()), n_local, panel_width);
        if (n_processes > 1)
          MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), MPI_FLOAT, MPI_SUM, communicator);
        if (n_local > 0)
          Eigen::Map<Rows>(reinterpret_cast<float *>(X.data()), n_local, panel_width).noalias() =
            inverse.middleRows(first_row, n_local) * all;
      }

      int             first_row, n_local, n_processes;
      MPI_Comm        communicator;
      Eigen::MatrixXf inverse;
    };
  } // namespace

  struct Multigrid::Implementation
  {
    Implementation(const SparseMatrix &A, const NearNullSpace &space, const std::string &what)
      : map(A.rows())
    {
      std::vector<Level> hierarchy = aggregate(A, space, what);
      double             n_local   = 0.;
      for (std::size_t l = 0; l + 1 < hierarchy.size(); ++l)
        {
          levels.push_back(std::make_unique<CycleLevel>(l == 0 ? A : *hierarchy[l].matrix, *hierarchy[l].prolongation));
          n_local += static_cast<double>(levels.back()->A.value.size() + 2 * levels.back()->P.value.size());
          hierarchy[l] = {};
        }
      coarse = std::make_unique<CoarseSolver>(hierarchy.size() > 1 ? *hierarchy.back().matrix : A, what);
      sum_over_processes(A.communicator(), &n_local, 1);
      n_entries = n_local + static_cast<double>(coarse->inverse.size());
    }

    /// X = the cycle from level l on, applied to B.
    void cycle(const std::size_t l, const Panel<float> &B, Panel<float> &X) const
    {
      if (l == levels.size())
        return coarse->apply(B, X);
      const CycleLevel &level = *levels[l];
      panel_first_sweep(level.A, level.smoother, B, X);
      level.A.update_ghosts(X);

      Panel<float> residual(level.R.n_columns());
      panel_first_residual(level.A, level.smoother, X, residual);
      level.R.update_ghosts(residual);
      Panel<float> coarse_B(level.R.n_rows), coarse_X(std::max(columns_of(l + 1), level.P.n_columns()));
      panel_product(level.R, residual, coarse_B);

      cycle(l + 1, coarse_B, coarse_X);

      level.P.update_ghosts(coarse_X);
      panel_add_product(level.P, coarse_X, X);
      level.A.update_ghosts(X);
      panel_backward_sweep(level.A, level.smoother, B, X);
    }

    /// Rows that a panel of a level needs.
    std::size_t columns_of(const std::size_t l) const
    {
      return l < levels.size() ? levels[l]->A.n_columns() : coarse->n_local;
    }

    RowMap                                   map;
    std::vector<std::unique_ptr<CycleLevel>> levels;
    std::unique_ptr<CoarseSolver>            coarse;
    double                                   n_entries = 0.;
  };

  Multigrid::Multigrid(const SparseMatrix &A, const NearNullSpace &space, const std::string &what)
    : implementation(std::make_unique<Implementation>(A, space, what))
  {}

  Multigrid::~Multigrid() = default;

  void Multigrid::apply(const MultiVector &X, MultiVector &Y) const
  {
    Panel<float> B(X.n_local_rows()), result(implementation->columns_of(0));
    for (int first = 0; first < X.n_columns(); first += panel_width)
      {
        to_panel(X, first, B);
        implementation->cycle(0, B, result);
        from_panel(result, first, Y);
      }
  }

  const RowMap &Multigrid::map() const
  {
    return implementation->map;
  }

  double Multigrid::n_entries() const
  {
    return implementation->n_entries;
  }

  int Multigrid::n_levels() const
  {
    return static_cast<int>(implementation->levels.size()) + 1;
  }
} // namespace Squeal
