// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/analysis.h>

namespace Squeal
{
  namespace
  {
    /// Smallest and largest rate, relative to the circular frequency at the end of the band, for which modes can be counted and searched
    /// [-].
    constexpr double least_rate = 1e-6, greatest_rate = 10.;
  } // namespace

  void DiscretizationParameters::declare(Declarations &declarations)
  {
    declarations.enter("Discretization");
    declarations.add(
      "Element", element,
      "Element type, described here for hexahedra. `trilinear`: 8 nodes, too stiff in bending. `incompatible modes`: 8 nodes and "
      "additional quadratic displacements inside each element (Wilson, Taylor), accurate in bending with the same number of unknowns. "
      "`quadratic`: 27 nodes; the elements follow the cylinders disc_bore, disc_rim and pin_side.");
    declarations.add(
      "Coarser mesh", coarser_mesh,
      "Second mesh, from which the discretisation error of each mode is estimated. Give parameters of the section Geometry with their "
      "values for the coarser mesh, for example disc_size = 0.019, pad_size = 0.012, or a file (.geo, .msh). The elements of the coarser "
      "mesh should be about twice as large; with smaller elements, the estimate may be too small. If Accuracy is set, the program chooses "
      "the coarser mesh. Empty: no error estimate.");

    declarations.enter("Band");
    declarations.add(
      "Maximum frequency", maximum_frequency, "Hz",
      "Upper end of the frequency band in which all modes are computed. Results are valid only in a finite band, because the problem with "
      "Coulomb friction is ill-posed in the limit of fine meshes.",
      {0.});
    declarations.add(
      "Maximum rate", maximum_rate, "1/s",
      "Largest |Re lambda| of the modes that are counted by the argument principle (Sweep/Count modes at; stability run on a system file, "
      "on one process). The stability run fails if the count differs from the number of modes found. Modes that decay faster than this "
      "rate are not listed. 0: counts use a rate of 0.1 times the circular frequency at the end of the band, and the listed modes are all "
      "modes with |lambda| up to 1.005 times this frequency.",
      {0.});
  }

  void DiscretizationParameters::check() const
  {
    if (!(maximum_frequency > 0.))
      throw ParameterError("the end of the band, " + exact_text(maximum_frequency) + " Hz, is not positive",
                           "parameter Band/Maximum frequency", "give a positive frequency");
    const double end = circular_frequency(maximum_frequency), least = least_rate * end, greatest = greatest_rate * end;
    if (maximum_rate != 0. && !(maximum_rate >= least && maximum_rate <= greatest))
      throw ParameterError("the rate " + exact_text(maximum_rate) + " 1/s is out of range for a band that ends at " + exact_text(end) +
                             " rad/s",
                           "parameter Band/Maximum rate", text("give 0, or a rate from ", least, " to ", greatest, " 1/s"));
  }

  void SolverParameters::declare(Declarations &declarations)
  {
    declarations.enter("Real modes");
    declarations.add("Solver", real_solver,
                     "Shift-invert eigensolver for the symmetric problem. `block Lanczos`: the recommended method. `Anasazi` (block "
                     "Krylov-Schur) and `ARPACK` (implicitly restarted Lanczos): for independent checks.");
    declarations.add("Tolerance", real_tolerance, "none", "Maximum relative residual of a real mode.", {1e-14, 1e-4});
    declarations.add(
      "Maximum number of modes", maximum_modes, "none",
      "Maximum number of coupled modes in the band. If the band contains more modes, the run stops before computing any. 500 modes "
      "require minutes and gigabytes; twice as many modes take up to eight times as long.",
      {1});

    declarations.enter("Complex modes");
    declarations.add(
      "Solver", complex_solver,
      "Eigensolver for the quadratic problem. `Krylov`: shift-invert block Krylov method for the quadratic pencil at full order (the "
      "reference). `residual iteration`: a basis of real modes enriched by right and left residuals, with the same Cholesky factor for "
      "all friction coefficients.");
    declarations.add(
      "Shift inverse", shift_inverse,
      "Inverse of the nonsymmetric stiffness in the Krylov solver. `updated Cholesky`: Cholesky factor of the frictionless system with a "
      "correction of rank n_c. `sparse LU`: LU factors of the nonsymmetric sparse matrix.");
    declarations.add("Tolerance", complex_tolerance, "none", "Maximum relative residual of a complex mode from the Krylov solver.",
                     {1e-13, 1e-4});
    declarations.add("Iteration tolerance", iteration_tolerance, "none",
                     "Estimated relative error of lambda at which the residual iteration ends.", {1e-12, 1e-2});
    declarations.add("Maximum basis", maximum_basis, "vectors", "Maximum basis size of the residual iteration.", {1});

    declarations.enter("Linear algebra");
    declarations.add("Factorization", library,
                     "Sparse direct solver for positive definite matrices. `automatic`: CHOLMOD on one process, MUMPS on several.");
    declarations.add(
      "Threads", n_threads, "none",
      "Number of threads per process, used for concurrent friction coefficients, matrix products, solves and large factorisations. 0: the "
      "(first) number in OMP_NUM_THREADS; if it is not set, the number of cores of the machine divided by the number of MPI processes on "
      "it, or the number of cores to which the process is bound, whichever is smaller. The number of threads affects results only through "
      "rounding errors.",
      {0, 1024});
    declarations.add("BLAS threads", blas_threads, "none",
                     "Number of threads of dense kernels per process; more than one thread is useful only on idle cores.", {1, 256});
  }

  void OutputParameters::declare(Declarations &declarations)
  {
    declarations.enter("Output");
    declarations.add("Mode shapes", fields, "Complex modes that are written as fields.");
    declarations.add("Component mode shapes", component_fields,
                     "Also writes the mode shapes of the free disc, and of the pins with free and with sliding contact nodes.");
    declarations.add("Real mode shapes", real_fields, "Also writes the shapes of coupled modes without friction.");
    declarations.add("Animation frames", animation_frames, "none",
                     "Number of frames per period in the animation of an unstable mode; 0: no animation.", {0, 1000});
    declarations.add("Animation periods", animation_periods, "none", "Number of periods in an animation.", {1, 1000});
    declarations.add(
      "Animation growth", animation_growth,
      "Scales the mode by e^(R t). The amplitude grows by a factor of e in 1 / (2 pi divergence rate) periods, that is, in 16 periods at a "
      "divergence rate of 1 %.");
    declarations.add(
      "Write matrices", write_matrices,
      "Writes the node coordinates and, in Matrix Market format, M, C (damping of materials and dashpots), K and, if present, G "
      "(gyroscopic forces), and for the closed contact nodes C_b (contact damping), P_n, P_t, P_b, K_n and T_c.");
    declarations.add(
      "Write system", write_system,
      "Writes the coupled system to the folder system of the results, as input for the parameter System. `full`: all terms. `reduced`: one "
      "reduced model. For a sweep, it is accurate to Sweep/Tolerance between the first and the last value; for a robustness study, it is "
      "accurate to Robustness/Tolerance within the ranges of the samples. Study = reduction writes one model for each basis, in separate "
      "folders.");
  }
} // namespace Squeal
