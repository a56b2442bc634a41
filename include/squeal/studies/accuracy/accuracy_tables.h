#pragma once

#include <squeal/output/table.h>
#include <squeal/studies/accuracy/accuracy_errors.h>

#include <vector>

namespace Squeal
{
  /// Every mesh, element and method with its size, costs and largest errors.
  Table accuracy_table(const std::vector<ComparedMethod> &methods);

  /// The same of those that none beats in both time and error, the fastest first: what a user chooses among.
  Table pareto_table(const std::vector<ComparedMethod> &methods);

  /// Every mode by every mesh and method beside the reference.
  Table accuracy_mode_table(const std::vector<ComparedMethod> &methods);

  /// Orders of convergence and limits of every mode up to a frequency [Hz], for every family of meshes, beside those of the reference.
  Table accuracy_order_table(const std::vector<ConvergedFamily> &families, const ConvergedFamily &reference, double maximum_frequency);

  /// Meshes and elements without a solution: element, outlines, mesh factor, reason.
  Table left_out_table(const std::vector<LeftOut> &meshes);
} // namespace Squeal
