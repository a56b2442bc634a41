#include "anasazi_traits.h"
#include "shift_invert.h"

#include <squeal/base/exceptions.h>

#include <AnasaziBasicEigenproblem.hpp>
#include <AnasaziBlockKrylovSchurSolMgr.hpp>

#include <algorithm>

namespace Squeal
{
  std::optional<MultiVector> anasazi_vectors(const ShiftInvert &A, const KrylovRequest &request)
  {
    using Problem = Anasazi::BasicEigenproblem<double, MultiVector, LinearOperator>;
    using Teuchos::rcp;

    // The basis and one more block must be linearly independent.
    const int n          = A.n_free();
    const int block_size = std::max(1, std::min(request.block_size, n / 4));

    const auto start = rcp(new MultiVector(random_vectors(A.map(), block_size, request.seed)));
    A.project(*start);

    const Teuchos::RCP<const LinearOperator> inverse(&A, Teuchos::RCP_WEAK_NO_DEALLOC), mass(&A.mass(), Teuchos::RCP_WEAK_NO_DEALLOC);
    const auto                               problem = rcp(new Problem(inverse, start));
    problem->setM(mass);
    problem->setHermitian(true);
    problem->setNEV(request.n_wanted);
    if (!problem->setProblem())
      throw SolverError("Anasazi refused the eigenvalue problem", request.what, "try ARPACK as solver of the real modes");

    // Room for convergence without a restart: the memory is small beside the
    // time that a restart would lose.
    const int n_blocks =
      std::min(std::max(3, (5 * request.n_wanted / 2 + block_size - 1) / block_size + 10 * (1 + request.attempt)), n / block_size - 1);

    Teuchos::ParameterList parameters;
    parameters.set("Verbosity", static_cast<int>(Anasazi::Errors));
    parameters.set("Which", "LM");
    parameters.set("Block Size", block_size);
    parameters.set("Num Blocks", n_blocks);
    // Anasazi 13.2 writes past the end of its workspace when it restarts a
    // Hermitian problem whose projected matrix, symmetric but for rounding, has
    // a complex pair at the boundary, as multiple eigenvalues cause. What has
    // not converged is left to another start against the modes found.
    parameters.set("Maximum Restarts", 0);
    // Blocks between two looks at convergence, each a dense Schur form of all blocks so far.
    parameters.set("Step Size", std::max(4, n_blocks / 16));
    parameters.set("Convergence Tolerance", request.tolerance);
    parameters.set("Relative Convergence Tolerance", true);
    parameters.set("Orthogonalization", "DGKS");
    try
      {
        Anasazi::BlockKrylovSchurSolMgr<double, MultiVector, LinearOperator> solver(problem, parameters);
        // How many converged is seen below.
        solver.solve();
      }
    catch (const std::exception &error)
      {
        throw SolverError(std::string("Anasazi failed: ") + error.what(), request.what, "try ARPACK as solver of the real modes");
      }

    const auto &solution = problem->getSolution();
    if (solution.numVecs == 0)
      return {};
    return view(*solution.Evecs, 0, solution.numVecs);
  }
} // namespace Squeal
