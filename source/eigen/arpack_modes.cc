// SPDX-License-Identifier: GPL-3.0-or-later

#include "shift_invert.h"

#include <squeal/base/exceptions.h>

#include <mpi.h>

#include <arpack/parpack.h>

#include <algorithm>

namespace Squeal
{
  namespace
  {
    [[noreturn]] void throw_arpack(const char *routine, const int info, const std::string &what)
    {
      throw SolverError("ARPACK's " + std::string(routine) + " failed with info = " + std::to_string(info), what,
                        "choose another Real modes/Solver");
    }
  } // namespace

  std::optional<MultiVector> arpack_vectors(const ShiftInvert &A, const KrylovRequest &request)
  {
    const RowMap &map     = A.map();
    const int     comm    = MPI_Comm_c2f(map.communicator());
    const int     n_local = map.n_local();

    // ARPACK requires at least one row per process: add a row of zeros if necessary
    const int n   = std::max(1, n_local);
    const int nev = request.n_wanted;
    const int ncv = std::min(map.n(), std::max(2 * nev + 20, nev + 40));

    std::vector<double> resid(n), v(static_cast<std::size_t>(n) * ncv), workd(3 * static_cast<std::size_t>(n));
    const int           lworkl = ncv * (ncv + 8);
    std::vector<double> workl(lworkl);
    int                 iparam[11] = {}, ipntr[14] = {};
    iparam[0] = 1;    // exact shifts
    iparam[2] = 1000; // maximum number of restarts
    iparam[6] = 3;    // shift-invert

    MultiVector start = random_vectors(map, 1, request.seed);
    A.project(start);
    std::copy_n(start.col(0).begin(), n_local, resid.begin());

    const auto vector = [&](double *values) { return MultiVector(map, values, 1); };
    int        ido = 0, info = 1;
    while (true)
      {
        pdsaupd_c(comm, &ido, "G", n, "LM", nev, request.tolerance, resid.data(), ncv, v.data(), n, iparam, ipntr, workd.data(),
                  workl.data(), lworkl, &info);
        if (ido == 99)
          break;
        MultiVector x = vector(workd.data() + ipntr[0] - 1), y = vector(workd.data() + ipntr[1] - 1);
        if (n_local == 0)
          workd[ipntr[1] - 1] = 0.;
        switch (ido)
          {
            case -1:
              A.apply(x, y);
              break;
            case 1:
              A.apply_to_image(vector(workd.data() + ipntr[2] - 1), y);
              break;
            case 2:
              A.mass.apply(x, y);
              break;
            default:
              throw_arpack("pdsaupd (unknown reverse communication flag ido)", ido, request.what);
          }
      }
    // Accept info = 1, which means that not all values converged within the allowed restarts: return the converged values
    if (info < 0 || info > 1)
      throw_arpack("pdsaupd", info, request.what);
    if (iparam[4] == 0)
      return {};

    const int           want_vectors = 1;
    const double        sigma        = 0.; // shift of the eigenvalues, which are not used
    std::vector<int>    select(ncv);
    std::vector<double> values(nev);
    pdseupd_c(comm, want_vectors, "A", select.data(), values.data(), v.data(), n, sigma, "G", n, "LM", nev, request.tolerance, resid.data(),
              ncv, v.data(), n, iparam, ipntr, workd.data(), workl.data(), lworkl, &info);
    if (info != 0)
      throw_arpack("pdseupd", info, request.what);
    const int         n_converged = iparam[4];
    const MultiVector converged(map, v.data(), n_converged);
    return converged;
  }
} // namespace Squeal
