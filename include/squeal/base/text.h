// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <iomanip>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace Squeal
{
  /// One text from several parts; numbers with four digits.
  template <typename... Parts>
  std::string text(const Parts &...parts)
  {
    std::ostringstream stream;
    stream << std::setprecision(4);
    (stream << ... << parts);
    return stream.str();
  }

  /// The shortest text that reads back as exactly this number; zero has no sign.
  std::string exact_text(double value);

  /// The same for several numbers with ", " in between.
  std::string exact_text(const std::vector<double> &values);

  /// A number for a sentence: at least @p n_digits significant digits, all digits before the point, no exponent.
  std::string decimal_text(double value, int n_digits = 4);

  /// The finite number that a text is, blanks around it apart; nothing if it is anything else. Zero has no sign.
  std::optional<double> parse_number(const std::string &text);

  /// The words of a text with one blank between them.
  std::string single_spaced(const std::string &text);

  /// What a user wrote, in a form that fits a message: control characters as `?`, and only the beginning of a long text.
  std::string legible(const std::string &text);

  /// The same between back-quotes.
  std::string in_quotes(const std::string &text);

  /// Words of a command line as one text that a POSIX shell splits into the same words: quoted where they need it.
  std::string shell_command(const std::vector<std::string> &words);

  /// The first lines in which two texts differ, for a message: "`a = 1` there, `a = 2` here", or "nothing" where a text ends.
  std::string first_difference(const std::string &there, const std::string &here);
} // namespace Squeal
