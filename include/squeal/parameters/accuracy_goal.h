// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/base/choices.h>
#include <squeal/base/enum_table.h>
#include <squeal/parameters/declarations.h>
#include <squeal/parameters/geometry.h>

#include <string>
#include <vector>

namespace Squeal
{
  /// Meshes, elements and bases that an accuracy study compares (section `Accuracy study`).
  struct AccuracyStudyParameters
  {
    std::vector<double>      factors         = {0.5, 1., 1.5}; ///< mesh refinement factors relative to the given mesh [-]
    std::vector<Element>     elements        = {Element::trilinear, Element::incompatible_modes, Element::quadratic};
    std::vector<Outlines>    outlines        = {Outlines::inscribed, Outlines::true_area}; ///< outlines of elements with straight edges
    std::vector<std::string> bases           = {"real + 1st-ord. two-sided", "residual-grown"};
    double                   grown_tolerance = 1e-4;   ///< tolerance of residual-grown bases [-]
    double                   largest_dofs    = 150000; ///< maximum number of dofs of a mesh, including clamped dofs
    double                   margin          = 0.1;    ///< relative extension of the band, so that modes near its end have counterparts [-]

    void declare(Declarations &declarations);

    /// Throws ParameterError.
    void check() const;
  };

  struct Parameters;

  /// Requested accuracy of frequencies (`set Accuracy`).
  enum class AccuracyGoal
  {
    as_given, ///< mesh, element and tolerances from the parameters
    five_percent,
    one_percent,
    a_tenth_percent,
    a_hundredth_percent
  };

  template <>
  inline constexpr EnumName<AccuracyGoal> enum_table<AccuracyGoal>[] = {{AccuracyGoal::as_given, "as given"},
                                                                        {AccuracyGoal::five_percent, "5 %"},
                                                                        {AccuracyGoal::one_percent, "1 %"},
                                                                        {AccuracyGoal::a_tenth_percent, "0.1 %"},
                                                                        {AccuracyGoal::a_hundredth_percent, "0.01 %"}};

  /// Error limits below which modes count as converged.
  struct AccuracyLimits
  {
    double frequency;  ///< relative error of the frequency [-]
    double divergence; ///< absolute error of the divergence rate [-]: a tenth of the frequency limit
  };

  /// Limits of a goal other than as_given.
  AccuracyLimits limits_of(AccuracyGoal goal);

  /// Ratio of the estimated error on the mesh of a goal to the difference from the coarser mesh of the goal [-]: 2/3 for elements with
  /// eight nodes, 1/3 for quadratic elements, 1 without a goal. The ratios are slightly larger than observed for the default model
  /// (doc/accuracy.md).
  double error_by_difference(AccuracyGoal goal);

  /**
   * Parameters with the element, mesh, solver and tolerances of the accuracy goal; unchanged without a goal. doc/accuracy.md lists cost and
   * accuracy for the default model. The element size of the disc is at most a fraction of the shorter of the bending and Rayleigh
   * wavelengths at the end of the band. Layers of the disc have about this thickness or less, and tall pins have proportionally more
   * layers.
   */
  Parameters with_goal(const Parameters &given);

  /// The same model on the coarser mesh of a goal or, without a goal, on the coarser mesh from the parameters. The band is slightly wider,
  /// because frequencies are higher on coarse meshes. Throws ParameterError if Discretization/Coarser mesh is invalid.
  Parameters with_coarser_mesh(const Parameters &given);
} // namespace Squeal
