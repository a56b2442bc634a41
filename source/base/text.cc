// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/text.h>

#include <boost/algorithm/string/replace.hpp>
#include <boost/algorithm/string/trim_all.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace Squeal
{
  namespace
  {
    /// Maximum length of user input quoted in a message; longer input is truncated [characters].
    constexpr std::size_t largest_length = 80;

    /// Characters that require no quotes, as in Python's shlex.quote(). Words with other characters are quoted.
    constexpr const char *plain_characters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789@%+=:,./_-";
  } // namespace

  std::string exact_text(const double value)
  {
    std::array<char, 32> text;
    // Adding zero removes the sign of negative zero
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value + 0.).ptr;
    return {text.data(), end};
  }

  std::string exact_text(const std::vector<double> &values)
  {
    std::string text;
    for (const double value : values)
      text += (text.empty() ? "" : ", ") + exact_text(value);
    return text;
  }

  std::string decimal_text(const double value, const int n_digits)
  {
    const int          n_before = value == 0. ? 1 : static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
    std::ostringstream text;
    text << std::fixed << std::setprecision(std::max(0, n_digits - n_before)) << value + 0.;
    return text.str();
  }

  std::string counted(const std::size_t n, const std::string &singular, const std::string &plural)
  {
    return text(n, ' ', n == 1 ? singular : plural.empty() ? singular + 's' : plural);
  }

  std::optional<double> parse_number(const std::string &text)
  {
    std::istringstream stream(text);
    double             number;
    if (!(stream >> number) || !std::isfinite(number) || !(stream >> std::ws).eof())
      return {};
    return number + 0.;
  }

  std::string single_spaced(const std::string &text)
  {
    return boost::trim_fill_copy(text, " ");
  }

  std::string legible(const std::string &text)
  {
    std::size_t length = std::min(text.size(), largest_length);
    // Do not truncate within a multi-byte character
    while (length < text.size() && length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80)
      --length;
    std::string result = text.substr(0, length);
    std::replace_if(
      result.begin(), result.end(), [](const unsigned char c) { return c < 0x20 || c == 0x7F; }, '?');
    return length == text.size() ? result : result + "... (" + std::to_string(text.size()) + " characters)";
  }

  std::string in_quotes(const std::string &text)
  {
    return "`" + legible(text) + "`";
  }

  std::string shell_command(const std::vector<std::string> &words)
  {
    std::string result;
    for (const std::string &word : words)
      {
        const bool is_plain = !word.empty() && word.find_first_not_of(plain_characters) == std::string::npos;
        // Everything is literal between single quotes, except the quote itself
        result += (result.empty() ? "" : " ") + (is_plain ? word : "'" + boost::replace_all_copy(word, "'", R"('\'')") + "'");
      }
    return result;
  }

  std::string first_difference(const std::string &there, const std::string &here)
  {
    std::istringstream old_text(there), new_text(here);
    std::string        old_line, new_line;
    const auto         quoted = [](const std::istream &stream, std::string line) {
      boost::trim_left(line);
      return stream && !line.empty() ? in_quotes(line) : "nothing";
    };
    while (std::getline(old_text, old_line) && std::getline(new_text, new_line) && old_line == new_line)
      ;
    if (!old_text)
      std::getline(new_text, new_line);
    return quoted(old_text, old_line) + " there, " + quoted(new_text, new_line) + " here";
  }
} // namespace Squeal
