// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/enum_table.h>
#include <squeal/base/choices.h>
#include <squeal/base/conventions.h>
#include <squeal/parameters/declarations.h>

#include <string>

namespace Squeal
{
  /// Elements and band (sections `Discretization` and `Band`).
  struct DiscretizationParameters
  {
    Element element           = Element::trilinear;
    double  maximum_frequency = 5000.; ///< upper end of the band [Hz]
    double  maximum_rate      = 0.;    ///< largest |Re λ| of counted modes [1/s]; 0: default of Band

    /// Coarser mesh: values of `Geometry` parameters, "disc_size = 0.012, ...", or the name of a geometry or mesh file; empty: no coarser
    /// mesh.
    std::string coarser_mesh;

    Band band() const
    {
      return {circular_frequency(maximum_frequency), maximum_rate};
    }

    bool coarser_mesh_is_file() const
    {
      return !coarser_mesh.empty() && coarser_mesh.find('=') == std::string::npos;
    }

    void declare(Declarations &declarations);

    /// Throws ParameterError.
    void check() const;
  };

  /// Solvers for complex modes.
  enum class ComplexSolver
  {
    krylov,            ///< shift-invert block Krylov on the quadratic pencil: the reference
    residual_iteration ///< basis of real modes, extended by right and left residuals
  };

  template <>
  inline constexpr EnumName<ComplexSolver> enum_table<ComplexSolver>[] = {{ComplexSolver::krylov, "Krylov"},
                                                                          {ComplexSolver::residual_iteration, "residual iteration"}};

  /// Inverse of the shifted pencil in the Krylov solver.
  enum class ShiftInverse
  {
    updated_cholesky, ///< one Cholesky factor of K_c and a correction of rank n_c
    sparse_lu         ///< LU factors of the nonsymmetric matrix
  };

  template <>
  inline constexpr EnumName<ShiftInverse> enum_table<ShiftInverse>[] = {{ShiftInverse::updated_cholesky, "updated Cholesky"},
                                                                        {ShiftInverse::sparse_lu, "sparse LU"}};

  /// Eigensolvers and factorisations (sections `Real modes`, `Complex modes`, `Linear algebra`).
  struct SolverParameters
  {
    RealSolver           real_solver         = RealSolver::lanczos;
    double               real_tolerance      = 1e-10; ///< limit of ‖Kφ - ω²Mφ‖ / ‖Kφ‖ [-]
    unsigned int         maximum_modes       = 500;   ///< limit on the number of modes in the band
    ComplexSolver        complex_solver      = ComplexSolver::krylov;
    ShiftInverse         shift_inverse       = ShiftInverse::updated_cholesky;
    double               complex_tolerance   = 1e-9; ///< limit of the residual ‖Q(λ)φ‖ / ‖Kφ‖ [-]
    double               iteration_tolerance = 1e-7; ///< limit of the estimated |δλ| / |λ| [-]
    unsigned int         maximum_basis       = 1500; ///< maximum basis size of the residual iteration [vectors]
    FactorizationLibrary library             = FactorizationLibrary::automatic;
    unsigned int         n_threads           = 0; ///< 0: usable_threads()
    unsigned int         blas_threads        = 1;

    void declare(Declarations &declarations);
  };

  /// Complex modes to be written as fields.
  enum class FieldSelection
  {
    none,
    unstable,
    all
  };

  template <>
  inline constexpr EnumName<FieldSelection> enum_table<FieldSelection>[] = {{FieldSelection::none, "none"},
                                                                            {FieldSelection::unstable, "unstable"},
                                                                            {FieldSelection::all, "all"}};

  /// Form of the system that is written to the results, as input for the parameter `System`.
  enum class SystemOutput
  {
    none,
    full,   ///< all terms of the system
    reduced ///< the reduced model of a sweep or of samples; one system for each basis of Study = reduction
  };

  template <>
  inline constexpr EnumName<SystemOutput> enum_table<SystemOutput>[] = {{SystemOutput::none, "none"},
                                                                        {SystemOutput::full, "full"},
                                                                        {SystemOutput::reduced, "reduced"}};

  /// Output of a run (section `Output`).
  struct OutputParameters
  {
    FieldSelection fields            = FieldSelection::all;
    bool           component_fields  = false; ///< also write modes of disc and pins alone
    bool           real_fields       = false; ///< also write coupled modes without friction
    unsigned int   animation_frames  = 16;    ///< frames per period of an unstable mode; 0: no animation
    unsigned int   animation_periods = 1;
    bool           animation_growth  = false; ///< scale the animation by e^{Rt}
    bool           write_matrices    = false;
    SystemOutput   write_system      = SystemOutput::none;

    void declare(Declarations &declarations);
  };
} // namespace Squeal
