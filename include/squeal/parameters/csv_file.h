// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <string>
#include <vector>

namespace Squeal
{
  /// A table of texts as a spreadsheet exports it.
  struct CsvFile
  {
    std::vector<std::string>              names;       ///< of the columns
    std::string                           where_names; ///< file and line, for messages
    std::vector<std::vector<std::string>> rows;        ///< a text for each name, without blanks around it
    std::vector<std::string>              where;       ///< of each row
  };

  /// Path of a file that a parameter names: in the folder of the parameter file or, if it is not there, in the current one.
  std::string input_path(const std::string &name, const std::string &parameter_directory);

  /**
   * Reads comma-separated values: names of the columns in the first line, a row in each of the others. Empty lines are skipped.
   *
   * @param parameter that names the file, "Section/Name", for messages
   * @param row       what a row is, for messages: "design"
   *
   * Throws FileError if the file cannot be read, ParameterError with the line if it is no comma-separated text in UTF-8.
   */
  CsvFile read_csv(const std::string &path, const std::string &parameter, const std::string &row);
} // namespace Squeal
