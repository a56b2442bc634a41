// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <string>
#include <vector>

namespace Squeal
{
  /// What one line of a parameter file says: a section is entered or a parameter set.
  struct ParameterStatement
  {
    std::string path;  ///< "Section/Name"; that of a section ends in "/"
    std::string value; ///< without blanks around it; empty for a section
    std::string where; ///< file and line, for messages

    bool is_section() const;
  };

  /**
   * Statements of a parameter file in deal.II's format, in their order: `subsection NAME`, `end`, `set NAME = VALUE`,
   * `include FILE`, comments after `#`, lines continued by a backslash; VALUE and FILE may stand between double quotes, see written_value(). An included file
   * is looked for beside the one that includes it, then in the current directory. Text is UTF-8, with or without a byte
   * order mark.
   *
   * Throws FileError where a file cannot be read, ParameterError where it is not such a text or includes itself.
   */
  std::vector<ParameterStatement> read_parameter_file(const std::string &file);

  /// A value as a parameter file holds it: between double quotes, with `\"`, `\\` and `\n`, where it would not read back as it is.
  std::string written_value(const std::string &value);

  /// The value that @p text stands for: what quotes enclose, else the text without blanks around it. Throws ParameterError naming @p where.
  std::string read_value(const std::string &text, const std::string &where);
} // namespace Squeal
