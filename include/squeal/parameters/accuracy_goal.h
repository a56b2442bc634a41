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
  /// Which meshes, elements and bases a study of accuracy compares (section `Accuracy study`).
  struct AccuracyStudyParameters
  {
    std::vector<double>      factors         = {0.5, 1., 1.5}; ///< how many times as fine as the mesh of the scene [-]
    std::vector<Element>     elements        = {Element::trilinear, Element::incompatible_modes, Element::quadratic};
    std::vector<Outlines>    outlines        = {Outlines::inscribed, Outlines::true_area}; ///< of elements with straight edges
    std::vector<std::string> bases           = {"real + 1st-ord. two-sided", "residual-grown"};
    double                   grown_tolerance = 1e-4;   ///< of residual-grown bases [-]
    double                   largest_dofs    = 150000; ///< of a mesh that is solved, clamped dofs included
    double                   margin          = 0.1;    ///< by which bands are longer, so that no mode lacks its partner [-]

    void declare(Declarations &declarations);

    /// Throws ParameterError.
    void check() const;
  };

  struct Parameters;

  /// How accurate the user wants frequencies to be (`set Accuracy`).
  enum class AccuracyGoal
  {
    as_given, ///< mesh, element and tolerances are those of the parameters
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

  /// Errors at which modes count as converged.
  struct AccuracyLimits
  {
    double frequency;  ///< relative [-]
    double divergence; ///< of the divergence rate [-]: a tenth of it
  };

  /// Those of a goal, which must be one.
  AccuracyLimits limits_of(AccuracyGoal goal);

  /// Error of a goal's mesh over its difference from the coarser one that goes with it [-], somewhat more than what the default scene shows
  /// (doc/accuracy.md): 2/3 for elements with eight nodes, 1/3 for quadratic ones. Without a goal 1: the difference itself.
  double error_by_difference(AccuracyGoal goal);

  /**
   * Parameters with the element, mesh, solver and tolerances that a goal asks for, in place of those that were given: from
   * doc/accuracy.md, where the default scene shows what each costs and reaches. Elements of the disc are a part of the shortest of
   * bending and shear waves at the end of the band, layers no thicker than that, and tall pins have as many layers more. Without a
   * goal nothing changes.
   */
  Parameters with_goal(const Parameters &given);

  /// The same scene on the coarser mesh of a goal or, without one, on the coarser mesh that is given, in a band that reaches somewhat
  /// further, since frequencies on coarse meshes are higher. One of the two must be there. Throws ParameterError.
  Parameters with_coarser_mesh(const Parameters &given);
} // namespace Squeal
