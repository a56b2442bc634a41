// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <iomanip>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace Squeal
{
  /// Concatenates the parts; floating-point numbers have four significant digits.
  template <typename... Parts>
  std::string text(const Parts &...parts)
  {
    std::ostringstream stream;
    stream << std::setprecision(4);
    (stream << ... << parts);
    return stream.str();
  }

  /// Shortest decimal string from which exactly this number is read; zero has no sign.
  std::string exact_text(double value);

  /// Several numbers, separated by ", ".
  std::string exact_text(const std::vector<double> &values);

  /// A number without an exponent: all digits before the point, and at least @p n_digits significant digits.
  std::string decimal_text(double value, int n_digits = 4);

  /// A number of things: "1 node", "2 nodes". The plural is formed with s unless it is given.
  std::string counted(std::size_t n, const std::string &singular, const std::string &plural = "");

  /// A finite number with optional surrounding blanks; no value for any other string. Zero has no sign.
  std::optional<double> parse_number(const std::string &text);

  /// Words of a string, separated by single blanks.
  std::string single_spaced(const std::string &text);

  /// User input for a message: control characters are replaced by `?`, and long input is truncated.
  std::string legible(const std::string &text);

  /// Result of legible() in back-quotes.
  std::string in_quotes(const std::string &text);

  /// A command line in POSIX shell syntax, with words quoted if necessary.
  std::string shell_command(const std::vector<std::string> &words);

  /// First pair of lines in which two texts differ, for a message: "`a = 1` there, `a = 2` here", with "nothing" for a blank line or the
  /// end of a text.
  std::string first_difference(const std::string &there, const std::string &here);
} // namespace Squeal
