// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <string>
#include <vector>

namespace Squeal
{
  /// A statement of a parameter file: enters a section or sets a parameter.
  struct ParameterStatement
  {
    std::string path;  ///< "Section/Name"; a section ends with "/"
    std::string value; ///< value without surrounding blanks; empty for a section
    std::string where; ///< file and line, for messages

    bool is_section() const;
  };

  /**
   * Statements of a parameter file in deal.II's format, in file order: `subsection NAME`, `end`, `set NAME = VALUE`, `include FILE`,
   * comments after `#`, continuation of a line after a backslash at its end; VALUE and FILE may be in double quotes, see written_value().
   * An included file is searched for in the folder of the including file, then in the current directory. Text is UTF-8, with or without a
   * byte order mark.
   *
   * Throws FileError if a file cannot be read or is too large, and ParameterError if its text is invalid or it includes itself.
   */
  std::vector<ParameterStatement> read_parameter_file(const std::string &file);

  /// A value as written to a parameter file: in double quotes, with `\"`, `\\` and `\n`, if the value would be read back differently
  /// without quotes.
  std::string written_value(const std::string &value);

  /// Value of @p text: the quoted text, or the text without surrounding blanks. Throws a ParameterError that names @p where if quotes or
  /// escapes are invalid.
  std::string read_value(const std::string &text, const std::string &where);
} // namespace Squeal
