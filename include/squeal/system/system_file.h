// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/linear_algebra/dense.h>
#include <squeal/system/terms.h>

#include <functional>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace Squeal
{
  struct FileParameter
  {
    std::string name;
    double      value = 0.;
    double      lower = 0., upper = 0.; ///< range of validity of the coefficients; equal to the value if not given
    std::string unit = "-", description = {};
  };

  struct DofGroup
  {
    std::string                      name;
    std::vector<std::pair<int, int>> ranges; ///< first and last dof of each range, counted from 0
  };

  /// Points in space at which mode shapes are evaluated.
  struct ShapePoints
  {
    DenseMatrix                         positions;     ///< x, y and z [m], n_points × 3, the same on every process
    std::shared_ptr<const SparseMatrix> displacements; ///< from dofs to displacements, 3 n_points × n: rows x, y, z of each point in turn

    /// Distribution that keeps the three rows of each point on one process.
    static RowMap rows_of(int n_points, MPI_Comm communicator);
  };

  /// Q(λ; p) = Σ_k θ_k(p) λ^(p_k) A_k in a folder: `system.json` with parameters and terms, and Matrix Market files with the matrices.
  struct SystemFile
  {
    std::string                path; ///< path of system.json
    std::string                description;
    std::vector<FileParameter> parameters;

    /// Symmetric, skew or low-rank terms; an unsymmetric matrix is split into its symmetric and its skew part.
    std::vector<Term>          terms;
    ParameterValues            weights;
    std::vector<DofGroup>      groups;
    std::optional<ShapePoints> points;
    std::string                measured_modes; ///< CSV file of measured modes for a fit; empty: none
    RowMap                     map;            ///< distribution of the dofs

    const FileParameter *find(const std::string &parameter) const;

    /// `mu` if the system has this parameter, otherwise its first parameter; empty if there are no parameters.
    std::string default_varied() const;

    /// Values of all parameters and weights; @p others replace values of the file. Throws ParameterError if a parameter does not exist, its
    /// value is out of range, or a coefficient is not finite.
    ParameterValues values(const std::map<std::string, double> &others = {}) const;
  };

  /**
   * Reads a system. Collective.
   *
   * Throws a FileError or ParameterError that names file and entry for unreadable files, syntax errors, inconsistent sizes, non-finite
   * entries, violated symmetries, unknown parameters, coefficients that are not finite at sampled parameter values, a missing mass, dofs
   * that occur in no matrix, and zero displacements.
   */
  SystemFile read_system(const std::string &path, MPI_Comm communicator);

  /// Function that writes a file of the folder.
  using WriteFile = std::function<void(const std::string &name, const std::function<void(std::ostream &)> &content)>;

  /// Files of a reduced model: its basis, n × r, and a table of estimated errors at parameter points, with the tolerance of these errors.
  struct Reduction
  {
    std::string basis, points; ///< file names
    double      tolerance;
  };

  /// Information in a system file other than its terms.
  struct SystemNotes
  {
    std::vector<FileParameter> parameters;
    std::string                description;
    std::vector<DofGroup>      groups    = {};
    std::optional<ShapePoints> points    = {};
    std::optional<Reduction>   reduction = {};
  };

  /// Writes the terms at these values of the weights as a system file. Collective.
  void write_system(const std::vector<Term> &terms, const ParameterValues &weights, const SystemNotes &notes, const WriteFile &write);
} // namespace Squeal
