#include "shift_invert.h"

#include <squeal/base/exceptions.h>

#include <AnasaziBasicEigenproblem.hpp>
#include <AnasaziBlockKrylovSchurSolMgr.hpp>
#include <AnasaziEpetraAdapter.hpp>
#include <Epetra_Comm.h>
#include <Epetra_Import.h>
#include <Epetra_Map.h>
#include <Epetra_Operator.h>

#include <algorithm>
#include <functional>

namespace Squeal
{
  namespace
  {
    /**
     * The distribution in which Anasazi works: that of the matrices, or an even
     * one if a process has no rows. Every process repeats Anasazi's dense work;
     * with very unequal memory layouts it was seen to round, and so decide,
     * differently, which ends in a crash.
     */
    Epetra_Map working_map(const Epetra_Map &map)
    {
      int n_mine = map.NumMyElements(), fewest = 0;
      map.Comm().MinAll(&n_mine, &fewest, 1);
      if (fewest > 0)
        return map;
      return Epetra_Map(map.NumGlobalElements(), map.IndexBase(), map.Comm());
    }

    /// A linear map on vectors of @p map as Anasazi sees it, on vectors of @p working_map.
    class RedistributedOperator : public Epetra_Operator
    {
    public:
      using Action = std::function<void(const MultiVector &, MultiVector &)>;

      RedistributedOperator(const Epetra_Map &map, const Epetra_Map &working_map, const Action &action)
        : map(map)
        , working_map(working_map)
        , same(map.SameAs(working_map))
        , to_matrices(map, working_map)
        , to_anasazi(working_map, map)
        , action(action)
      {}

      int Apply(const Epetra_MultiVector &X, Epetra_MultiVector &Y) const override
      {
        if (same)
          action(X, Y);
        else
          {
            MultiVector x(map, X.NumVectors()), y(map, X.NumVectors());
            x.Import(X, to_matrices, Insert);
            action(x, y);
            Y.Import(y, to_anasazi, Insert);
          }
        return 0;
      }

      int ApplyInverse(const Epetra_MultiVector &, Epetra_MultiVector &) const override
      {
        return -1;
      }
      int SetUseTranspose(bool) override
      {
        return -1;
      }
      double NormInf() const override
      {
        return -1.;
      }
      bool HasNormInf() const override
      {
        return false;
      }
      bool UseTranspose() const override
      {
        return false;
      }
      const char *Label() const override
      {
        return "operator of a symmetric eigenvalue problem";
      }
      const Epetra_Comm &Comm() const override
      {
        return working_map.Comm();
      }
      const Epetra_Map &OperatorDomainMap() const override
      {
        return working_map;
      }
      const Epetra_Map &OperatorRangeMap() const override
      {
        return working_map;
      }

    private:
      const Epetra_Map    map, working_map;
      const bool          same;
      const Epetra_Import to_matrices, to_anasazi;
      const Action        action;
    };
  } // namespace



  std::optional<MultiVector> anasazi_vectors(const ShiftInvert &A, const KrylovRequest &request)
  {
    using Vectors  = Epetra_MultiVector;
    using Operator = Epetra_Operator;
    using Problem  = Anasazi::BasicEigenproblem<double, Vectors, Operator>;

    const int n          = A.mass().NumGlobalRows();
    const int block_size = std::min(request.block_size, n);

    const Epetra_Map &map         = A.mass().DomainMap();
    const Epetra_Map  anasazi_map = working_map(map);
    const auto        wrapped     = [&](const RedistributedOperator::Action &action) {
      return Teuchos::RCP<Operator>(Teuchos::rcp(new RedistributedOperator(map, anasazi_map, action)));
    };

    MultiVector start = random_vectors(map, block_size, request.seed);
    A.project(start);
    const Teuchos::RCP<Vectors> start_block = Teuchos::rcp(new Vectors(anasazi_map, block_size));
    start_block->Import(start, Epetra_Import(anasazi_map, map), Insert);

    const Teuchos::RCP<Problem> problem = Teuchos::rcp(
      new Problem(wrapped([&](const MultiVector &X, MultiVector &Y) { A.apply(X, Y); }), start_block));
    problem->setM(wrapped([&](const MultiVector &X, MultiVector &Y) { A.mass().Multiply(false, X, Y); }));
    problem->setHermitian(true);
    problem->setNEV(request.n_wanted);
    if (!problem->setProblem())
      throw SolverError("Anasazi refused the eigenvalue problem", request.what, "try ARPACK as solver of the real modes");

    // Room for convergence without a restart: the memory is small beside the
    // time that a restart would lose.
    const int n_blocks =
      std::min(std::max(3, (5 * request.n_wanted / 2 + block_size - 1) / block_size + 10), (n - 1) / block_size);

    Teuchos::ParameterList parameters;
    parameters.set("Verbosity", static_cast<int>(Anasazi::Errors));
    parameters.set("Which", "LM");
    parameters.set("Block Size", block_size);
    parameters.set("Num Blocks", n_blocks);
    parameters.set("Maximum Restarts", 50);
    // Blocks between two looks at convergence, each a dense Schur form of all blocks so far.
    parameters.set("Step Size", 4);
    parameters.set("Convergence Tolerance", request.tolerance);
    parameters.set("Relative Convergence Tolerance", true);
    parameters.set("Orthogonalization", "DGKS");
    try
      {
        Anasazi::BlockKrylovSchurSolMgr<double, Vectors, Operator> solver(problem, parameters);
        // Whether all converged is seen by counting what was found.
        solver.solve();
      }
    catch (const std::exception &error)
      {
        throw SolverError(std::string("Anasazi failed: ") + error.what(), request.what, "try ARPACK as solver of the real modes");
      }

    const auto &solution = problem->getSolution();
    if (solution.numVecs == 0)
      return {};
    const MultiVector found(View, *solution.Evecs, 0, solution.numVecs);
    MultiVector       vectors(map, solution.numVecs);
    vectors.Import(found, Epetra_Import(map, anasazi_map), Insert);
    return vectors;
  }
} // namespace Squeal
