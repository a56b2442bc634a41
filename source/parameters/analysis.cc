// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/analysis.h>

namespace Squeal
{
  namespace
  {
    /// Rates of a band over the circular frequency of its end: counts resolve the least, and eigenvalues up to the greatest are found [-].
    constexpr double least_rate = 1e-6, greatest_rate = 10.;
  } // namespace

  void DiscretizationParameters::declare(Declarations &declarations)
  {
    declarations.enter("Discretization");
    declarations.add("Element", element,
                     "Hexahedra. trilinear: 8 nodes; too stiff in bending. incompatible modes: 8 nodes and quadratic displacements inside "
                     "each element (Wilson, Taylor), which bend: a system of the same size. quadratic: 27 nodes, on curved boundaries.");
    declarations.add(
      "Coarser mesh", coarser_mesh,
      "A second mesh that shows the error of the mesh, mode by mode, as the difference between both: parameters of the "
      "section Geometry with the values of the coarser mesh, such as disc_size = 0.019, pad_size = 0.012; or a file "
      "(.geo, .msh). The difference covers the error if elements are about twice as large. Accuracy chooses a coarser mesh of its own. Empty: no error is estimated.");

    declarations.enter("Band");
    declarations.add("Maximum frequency", maximum_frequency, "Hz",
                     "Upper end of the band in which all modes are found. Coulomb friction is ill-posed in the limit of fine meshes: "
                     "results hold in a stated band.",
                     {0.});
    declarations.add(
      "Maximum rate", maximum_rate, "1/s",
      "Largest |Re lambda| of the modes in the band. Modes that decay faster are not listed; modes that grow faster are. The argument "
      "principle (Sweep/Count modes at; stability run on a system file, on one process) counts the modes up to this rate; the stability "
      "run fails if the count differs from the number of modes found. 0: all modes with |lambda| up to 1.005 times the circular "
      "frequency of the band end are listed, and counts use 0.1 times that frequency.",
      {0.});
  }

  void DiscretizationParameters::check() const
  {
    if (!(maximum_frequency > 0.))
      throw ParameterError("the band ends at " + exact_text(maximum_frequency) + " Hz", "parameter Band/Maximum frequency",
                           "give a positive frequency");
    const double end = circular_frequency(maximum_frequency), least = least_rate * end, greatest = greatest_rate * end;
    if (maximum_rate != 0. && !(maximum_rate >= least && maximum_rate <= greatest))
      throw ParameterError("the rate " + exact_text(maximum_rate) + " 1/s does not fit the end of the band, " + exact_text(end) + " rad/s",
                           "parameter Band/Maximum rate", text("give 0, or a rate from ", least, " to ", greatest, " 1/s"));
  }

  void SolverParameters::declare(Declarations &declarations)
  {
    declarations.enter("Real modes");
    declarations.add("Solver", real_solver,
                     "Shift-invert eigensolver of the symmetric problem: block Lanczos; block Krylov-Schur (Anasazi) and implicitly "
                     "restarted Lanczos (ARPACK) as independent checks.");
    declarations.add("Tolerance", real_tolerance, "none", "Largest relative residual of a real mode.", {1e-14, 1e-4});
    declarations.add("Maximum number of modes", maximum_modes, "none",
                     "Modes of the coupled system in the band above which a run ends before any is computed: 500 take minutes and "
                     "gigabytes, twice as many up to eight times the time.",
                     {1});

    declarations.enter("Complex modes");
    declarations.add("Solver", complex_solver,
                     "Krylov: shift-invert block Krylov on the quadratic pencil of full order (the reference). residual iteration: "
                     "a basis of real modes grown by right and left residuals, one Cholesky factor for every friction coefficient.");
    declarations.add("Shift inverse", shift_inverse,
                     "How the Krylov solver inverts the nonsymmetric stiffness: Cholesky factor of the frictionless system with a "
                     "correction of rank n_c, or LU factors of the nonsymmetric sparse matrix.");
    declarations.add("Tolerance", complex_tolerance, "none", "Largest relative residual of a complex mode found by Krylov.", {1e-13, 1e-4});
    declarations.add("Iteration tolerance", iteration_tolerance, "none",
                     "Largest estimated relative error of lambda at which the residual iteration ends.", {1e-12, 1e-2});
    declarations.add("Maximum basis", maximum_basis, "vectors", "Largest basis of the residual iteration.", {1});

    declarations.enter("Linear algebra");
    declarations.add("Factorization", library,
                     "Sparse direct solver for symmetric matrices; automatic: CHOLMOD on one process, MUMPS on several.");
    declarations.add("Threads", n_threads, "none",
                     "Threads of a process: for values of the friction coefficient that are evaluated at a time, products, solves and "
                     "large factors. 0: as many as OMP_NUM_THREADS says, or as the process has cores. Results do not depend on it.",
                     {0, 1024});
    declarations.add("BLAS threads", blas_threads, "none",
                     "Threads of the dense kernels per process; more than one only pays on idle cores.", {1, 256});
  }

  void OutputParameters::declare(Declarations &declarations)
  {
    declarations.enter("Output");
    declarations.add("Mode shapes", fields, "Complex modes whose shapes are written.");
    declarations.add("Component mode shapes", component_fields,
                     "Writes the shapes of the modes of the disc alone and of the pins alone, free and sliding, too.");
    declarations.add("Real mode shapes", real_fields, "Writes the shapes of the coupled modes without friction, too.");
    declarations.add("Animation frames", animation_frames, "none", "Pictures per period in the animation of an unstable mode; 0: none.",
                     {0, 1000});
    declarations.add("Animation periods", animation_periods, "none", "Periods that an animation shows.", {1, 1000});
    declarations.add("Animation growth", animation_growth,
                     "Shows the mode with its growth e^(R t): by a factor of e in 1 / (2 pi divergence rate) periods, 16 of them at 1 %.");
    declarations.add(
      "Write matrices", write_matrices,
      "Writes M, C (damping of the materials), K, C_b (of the contact), P_n, P_t, P_b, K_n, T_c of the closed contact nodes in "
      "Matrix Market form and the node coordinates.");
    declarations.add("Write system", write_system,
                     "Writes the coupled system to the folder system of the results, which System reads. full: all terms. reduced: the "
                     "reduced model of a sweep, valid from the first to the last value within Sweep/Tolerance.");
  }
} // namespace Squeal
