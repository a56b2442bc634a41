#pragma once

#include <squeal/base/element.h>
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
} // namespace Squeal
