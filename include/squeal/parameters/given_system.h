// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/parameters/declarations.h>
#include <squeal/parameters/sweep.h>

#include <map>
#include <string>

namespace Squeal
{
  /// System of matrices from a file, which replaces the mesh (parameters `System` and `System values`).
  struct GivenSystemParameters
  {
    std::string                   file;      ///< path of system.json or of its folder; empty: the system comes from a mesh
    std::map<std::string, double> values;    ///< parameter values that replace the values in the file
    std::string                   directory; ///< folder of the parameter file

    explicit operator bool() const
    {
      return !file.empty();
    }

    /// Path of the file: in the folder of the parameter file if it exists there, otherwise as given.
    std::string path() const;

    void declare(Declarations &declarations);
  };

  /// Range of a parameter, parsed from "name, first, last, number". Throws a ParameterError that names @p where.
  NamedRange parsed_range(const std::string &text, const std::string &where);
} // namespace Squeal
