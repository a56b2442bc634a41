// What multigrid costs beside the Cholesky factor, on the coupled stiffness of a parameter file:
//   cmake --build --preset release --target benchmark_multigrid
//   OMP_NUM_THREADS=1 build/release/benchmark_multigrid prm/disc_pins.prm [--set "Section/Name=value"]...
// Prints processor seconds and memory of each part: what stays allocated after it, and the largest amount during it.

#include <squeal/base/command_line.h>
#include <squeal/base/conventions.h>
#include <squeal/base/exceptions.h>
#include <squeal/base/interruption.h>
#include <squeal/base/mpi_environment.h>
#include <squeal/bases/mode_count_estimate.h>
#include <squeal/bases/near_null_space.h>
#include <squeal/eigen/symmetric_modes.h>
#include <squeal/linear_algebra/blas_kernels.h>
#include <squeal/linear_algebra/iterative_inverse.h>
#include <squeal/studies/run.h>
#include <squeal/studies/scene.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <malloc.h>

using namespace Squeal;

namespace
{
  double status_of_process(const std::string &key)
  {
    std::ifstream file("/proc/self/status");
    std::string   word;
    while (file >> word)
      if (word == key)
        {
          double kibibyte;
          file >> kibibyte;
          return kibibyte / 1024.;
        }
    return 0.;
  }

  /// A part of the work, from its making to its end.
  class Part
  {
  public:
    explicit Part(const char *name)
      : name(name)
    {
      malloc_trim(0);
      std::ofstream("/proc/self/clear_refs") << 5; // the largest amount anew
      memory = status_of_process("VmRSS:");
      start  = std::clock();
    }

    ~Part()
    {
      const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, peak = status_of_process("VmHWM:");
      malloc_trim(0);
      std::printf("  %-44s %9.2f s CPU %8.0f MiB kept %8.0f MiB at most\n", name, seconds, status_of_process("VmRSS:") - memory,
                  peak - memory);
      std::fflush(stdout);
    }

  private:
    const char  *name;
    double       memory;
    std::clock_t start;
  };

  /// Residuals of A X = B as the factor leaves them, and as conjugate gradients do.
  void print_accuracy(const SparseMatrix &A, const MultiVector &X, const MultiVector &B)
  {
    const std::vector<double> left = column_norms(B - A * X), norm = column_norms(B), size = column_norms(X);
    double                    relative = 0., backward = 0.;
    for (std::size_t j = 0; j < left.size(); ++j)
      {
        relative = std::max(relative, left[j] / norm[j]);
        backward = std::max(backward, left[j] / (row_sum_norm(A) * size[j]));
      }
    std::printf("    largest |b - A x| / |b| %.1e, / (|A| |x|) %.1e\n", relative, backward);
  }

  SymmetricModes print_modes(const CoupledSystem &coupled, const double limit, const SymmetricModesOptions &options)
  {
    SymmetricModes modes = symmetric_modes(*coupled.stiffness, *coupled.mass, limit, options);
    std::printf("    %zu modes, largest residual %.1e\n", modes.eigenvalues.size(),
                modes.residuals.empty() ? 0. : *std::max_element(modes.residuals.begin(), modes.residuals.end()));
    return modes;
  }

  void compare(Run &run)
  {
    Scene                scene   = mesh_scene(run);
    const CoupledSystem  coupled = linearised_scene(scene, run).coupled;
    const SparseMatrix  &K       = *coupled.stiffness;
    const double         omega   = circular_frequency(run.parameters.discretization.maximum_frequency), limit = omega * omega;
    const MultiVector    B = coupled.friction_forces->columns(0, coupled.n_contact());
    MultiVector          X(B.map(), B.n_columns());
    X.local().setConstant(1.); // takes its memory now
    std::printf("\n%d coupled dofs, %lld entries, %d right-hand sides\n", K.n_rows(), K.n_entries(), B.n_columns());

    std::vector<double> by_multigrid, by_factor;
    {
      const NearNullSpace               space = near_null_space(*scene.model, *coupled.kernel);
      std::unique_ptr<IterativeInverse> inverse;
      {
        const Part part("multigrid: set-up");
        inverse = iterative_inverse(K, space, "benchmark");
      }
      std::printf("    %.3e entries\n", inverse->n_factor_entries());
      {
        const Part part("multigrid: block conjugate gradients");
        inverse->apply(B, X);
      }
      std::printf("    %lld steps of blocks\n", inverse->n_steps());
      print_accuracy(K, X, B);
      SymmetricModesOptions options;
      options.solver         = RealSolver::lobpcg;
      options.preconditioner = &inverse->preconditioner();
      options.counting       = ModeCounting::none;
      options.n_expected     = static_cast<int>(expected_number_of_modes(scene.mesh, run.parameters.materials, omega));
      const Part part("multigrid: modes by LOBPCG, not counted");
      by_multigrid = print_modes(coupled, limit, options).eigenvalues;
    }
    {
      const Part part("factor: count by inertia");
      std::printf("    %d modes\n", count_modes(K, *coupled.mass, limit, "benchmark"));
    }
    {
      std::unique_ptr<Factorization> factor;
      {
        const Part part("factor: factorisation");
        factor = factorize_positive_definite(K, FactorizationLibrary::automatic, "benchmark");
      }
      std::printf("    %.3e entries\n", factor->n_factor_entries());
      {
        const Part part("factor: solution");
        factor->apply(B, X);
      }
      print_accuracy(K, X, B);
      SymmetricModesOptions options;
      options.inverse = factor.get();
      const Part part("factor: modes with their count");
      by_factor = print_modes(coupled, limit, options).eigenvalues;
    }
    double difference = by_factor.size() == by_multigrid.size() ? 0. : HUGE_VAL;
    for (std::size_t j = 0; j < std::min(by_factor.size(), by_multigrid.size()); ++j)
      difference = std::max(difference, std::abs(by_multigrid[j] / by_factor[j] - 1.));
    std::printf("  largest relative difference of the eigenvalues %.1e\n", difference);
  }
} // namespace

int main(int argc, char **argv)
{
  use_native_blas_kernels(argv);
  prepare_mpi_environment();
  Interruption interruption;
  char         without_handler[]   = "-no_signal_handler";
  char        *library_arguments[] = {argv[0], without_handler, nullptr};
  char       **library_argv        = library_arguments;
  int          library_argc        = 2;

  dealii::Utilities::MPI::MPI_InitFinalize mpi(library_argc, library_argv, 1);
  try
    {
      Progress          progress(std::cout, false);
      const CommandLine line       = parse_command_line({argv + 1, argv + argc});
      const Parameters  parameters = Parameters::read(line.parameter_file, line.overrides);
      RunOptions        options;
      options.dry_run = true;
      Run run(parameters, options, MPI_COMM_WORLD, progress, std::cout, interruption);
      compare(run);
      return 0;
    }
  catch (const std::exception &error)
    {
      std::cerr << error.what() << std::endl;
      return 1;
    }
}
