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
  /// A named parameter of a system file.
  struct FileParameter
  {
    std::string name;
    double      value = 0.;
    double      lower = 0., upper = 0.; ///< range in which the coefficients are valid; both equal the value where none is given
    std::string unit = "-", description = {};
  };

  /// Some dofs with a name.
  struct DofGroup
  {
    std::string                      name;
    std::vector<std::pair<int, int>> ranges; ///< first and last dof of each, counted from 0
  };

  /// Points in space on which shapes are shown.
  struct ShapePoints
  {
    DenseMatrix                         positions;     ///< x, y and z [m], n_points × 3, the same on every process
    std::shared_ptr<const SparseMatrix> displacements; ///< by the dofs: 3 n_points × n, rows x, y and z of point after point

    /// Distribution of three rows for each point, no point shared by processes.
    static RowMap rows_of(int n_points, MPI_Comm communicator);
  };

  /// Q(λ; p) = Σ_k θ_k(p) λ^(p_k) A_k in a folder: `system.json` with parameters and terms, and a Matrix Market file of each matrix.
  struct SystemFile
  {
    std::string                path; ///< of system.json
    std::string                description;
    std::vector<FileParameter> parameters;

    /// Symmetric, skew or of low rank: an unsymmetric matrix makes two terms, its symmetric and its skew part.
    std::vector<Term>          terms;
    ParameterValues            weights; ///< of terms of low rank
    std::vector<DofGroup>      groups;
    std::optional<ShapePoints> points;
    std::string                measured_modes; ///< CSV file for a fit; empty: none
    RowMap                     map;            ///< of the dofs

    const FileParameter *find(const std::string &parameter) const;

    /// `mu` if there is such a parameter, else the first; empty: there is none.
    std::string default_varied() const;

    /// Values of all parameters and weights, with @p others in place of those of the file. Throws ParameterError if there is no such
    /// parameter or its value is out of range.
    ParameterValues values(const std::map<std::string, double> &others = {}) const;
  };

  /**
   * Reads a system; all processes must call.
   *
   * Throws FileError or ParameterError, naming the file and the entry: what cannot be read or parsed, sizes that differ, entries that are not
   * finite, symmetries that do not hold, unknown parameters, coefficients that are not finite in the range of their parameters, no mass,
   * dofs that no matrix has, and displacements that are all zero.
   */
  SystemFile read_system(const std::string &path, MPI_Comm communicator);

  /// Writes files of a folder: name and content.
  using WriteFile = std::function<void(const std::string &name, const std::function<void(std::ostream &)> &content)>;

  /// What a reduced model rests on: its basis, n × r, the tolerance of its estimated errors, and a table of them.
  struct Reduction
  {
    std::string basis, points; ///< files
    double      tolerance;
  };

  /// What a system file says besides its terms.
  struct SystemNotes
  {
    std::vector<FileParameter> parameters;
    std::string                description;
    std::vector<DofGroup>      groups    = {};
    std::optional<ShapePoints> points    = {};
    std::optional<Reduction>   reduction = {};
  };

  /// Writes the terms at these values of the weights as a system file. All processes must call.
  void write_system(const std::vector<Term> &terms, const ParameterValues &weights, const SystemNotes &notes, const WriteFile &write);
} // namespace Squeal
