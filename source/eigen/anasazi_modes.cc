#include "shift_invert.h"

#include <squeal/base/exceptions.h>

#include <AnasaziBasicEigenproblem.hpp>
#include <AnasaziBlockKrylovSchurSolMgr.hpp>
#include <AnasaziEpetraAdapter.hpp>
#include <Epetra_Comm.h>
#include <Epetra_Map.h>
#include <Epetra_Operator.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace Squeal
{
  namespace
  {
    /**
     * The rows as Anasazi sees them: processes without rows get one whose
     * entries our operators keep at zero. Anasazi's vectors corrupt the memory
     * where a process has none.
     */
    Epetra_Map padded(const Epetra_Map &map)
    {
      std::vector<int> elements(map.MyGlobalElements(), map.MyGlobalElements() + map.NumMyElements());
      if (elements.empty())
        elements.push_back(map.MaxAllGID() + 1 + map.Comm().MyPID());
      return Epetra_Map(-1, elements.size(), elements.data(), map.IndexBase(), map.Comm());
    }

    /// A linear map on vectors of @p map as Anasazi sees it.
    class PaddedOperator : public Epetra_Operator
    {
    public:
      using Action = std::function<void(const MultiVector &, MultiVector &)>;

      PaddedOperator(const Epetra_Map &map, const Epetra_Map &padded_map, const Action &action)
        : map(map)
        , padded_map(padded_map)
        , action(action)
      {}

      int Apply(const Epetra_MultiVector &X, Epetra_MultiVector &Y) const override
      {
        if (map.NumMyElements() == 0)
          Y.PutScalar(0.);
        const MultiVector x(View, map, X.Pointers(), X.NumVectors());
        MultiVector       y(View, map, Y.Pointers(), Y.NumVectors());
        action(x, y);
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
        return padded_map.Comm();
      }
      const Epetra_Map &OperatorDomainMap() const override
      {
        return padded_map;
      }
      const Epetra_Map &OperatorRangeMap() const override
      {
        return padded_map;
      }

    private:
      const Epetra_Map map, padded_map;
      const Action     action;
    };
  } // namespace



  std::optional<MultiVector> anasazi_vectors(const ShiftInvert &A, const KrylovRequest &request)
  {
    using Vectors  = Epetra_MultiVector;
    using Operator = Epetra_Operator;
    using Problem  = Anasazi::BasicEigenproblem<double, Vectors, Operator>;

    const int n          = A.mass().NumGlobalRows();
    const int block_size = std::min(request.block_size, n);

    const Epetra_Map &map        = A.mass().DomainMap();
    const Epetra_Map  padded_map = padded(map);
    const auto        wrapped    = [&](const PaddedOperator::Action &action) {
      return Teuchos::RCP<Operator>(Teuchos::rcp(new PaddedOperator(map, padded_map, action)));
    };

    MultiVector start = random_vectors(map, block_size, request.seed);
    A.project(start);
    const Teuchos::RCP<Vectors> padded_start = Teuchos::rcp(new Vectors(padded_map, block_size));
    for (int j = 0; j < block_size; ++j)
      std::copy(start[j], start[j] + start.MyLength(), (*padded_start)[j]);

    const Teuchos::RCP<Problem> problem = Teuchos::rcp(
      new Problem(wrapped([&](const MultiVector &X, MultiVector &Y) { A.apply(X, Y); }), padded_start));
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
    return MultiVector(Copy, map, solution.Evecs->Pointers(), solution.numVecs);
  }
} // namespace Squeal
