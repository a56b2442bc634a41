// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/system/system_file.h>

#include <map>
#include <memory>
#include <string>

namespace Squeal
{
  /// Sensors, each at a point in one direction, and measured mode shapes.
  struct Sensors
  {
    DenseMatrix                             positions;  ///< x, y and z [m], n_s × 3
    DenseMatrix                             directions; ///< unit vectors, n_s × 3
    std::map<std::string, Eigen::VectorXcd> shapes;     ///< measured response of each sensor, by the label of the mode; any scale

    bool has(const std::string &label) const
    {
      return shapes.count(label) > 0;
    }

    /// Matrix from dofs to sensor responses, the displacements of the nearest points in the sensor directions. All rows are on process 0.
    std::shared_ptr<const SparseMatrix> rows(const ShapePoints &points) const;
  };

  /// Reads the file of Updating/Sensors; see doc/updating.md. Throws FileError, or ParameterError with the line number.
  Sensors read_sensors(const std::string &path);

  /// MAC = |xᴴ y|² / (xᴴx yᴴy) [-]; zero if x or y is zero.
  double modal_assurance_criterion(const Eigen::VectorXcd &x, const Eigen::VectorXcd &y);
} // namespace Squeal
