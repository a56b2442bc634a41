// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <string>
#include <vector>

namespace Squeal
{
  /// Content of a CSV file as strings.
  struct CsvFile
  {
    std::vector<std::string>              names;       ///< column names
    std::string                           where_names; ///< file and line of the column names, for messages
    std::vector<std::vector<std::string>> rows;        ///< one string for each column, without surrounding blanks
    std::vector<std::string>              where;       ///< file and line of each row, for messages

    /// Index of a column; names.size() if it is missing.
    std::size_t column(const std::string &name) const;

    /// Number in a cell. Throws a ParameterError that names the line if the cell is not a finite number.
    double number(std::size_t row, std::size_t column) const;

    /// Throws ParameterError if two columns have the same name.
    void check_repeated_columns() const;
  };

  /// Path of an input file: in the folder of the parameter file, unless the file exists only in the current directory.
  std::string input_path(const std::string &name, const std::string &parameter_directory);

  /**
   * Reads comma-separated values: column names in the first line, then one row per line. Empty lines are skipped.
   *
   * @param parameter "Section/Name" of the parameter that names the file, for messages
   * @param row       meaning of a row, for messages: "design"
   *
   * Throws FileError if the file cannot be read, and ParameterError if @p path is empty or the file is not comma-separated UTF-8 text.
   */
  CsvFile read_csv(const std::string &path, const std::string &parameter, const std::string &row);
} // namespace Squeal
