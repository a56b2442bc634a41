// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/output/table.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <sstream>

namespace Squeal
{
  namespace
  {
    constexpr int significant_digits = 12;

    /// An entry as a string; @p shown formats numbers.
    template <typename Shown>
    std::string text_of(const Entry &cell, const Shown &shown)
    {
      if (const auto *word = std::get_if<std::string>(&cell))
        return *word;
      if (const auto *count = std::get_if<long>(&cell))
        return std::to_string(*count);
      const auto *number = std::get_if<double>(&cell);
      if (number == nullptr)
        return "";
      // Remove the minus sign of zeros
      const std::string text = shown(*number);
      return text[0] == '-' && text.find_first_not_of("-0.") == std::string::npos ? text.substr(1) : text;
    }

    std::string csv_text(const Entry &cell)
    {
      const std::string text = text_of(cell, [](const double number) {
        char       digits[significant_digits + 8]; // with space for sign, point and exponent
        const auto end = std::to_chars(digits, digits + sizeof(digits), number, std::chars_format::general, significant_digits);
        return std::string(digits, end.ptr);
      });
      return csv_field(text);
    }
  } // namespace

  std::string csv_field(const std::string &text)
  {
    if (text.find_first_of(",\"\n\r") == std::string::npos)
      return text;
    std::ostringstream quoted;
    quoted << std::quoted(text, '"', '"');
    return quoted.str();
  }

  Entry Table::checked(const Entry &cell) const
  {
    if (const auto *number = std::get_if<double>(&cell); number != nullptr && !std::isfinite(*number))
      throw Error("a result is not a finite number", "table column `" + heads.back().name + "`",
                  "check material values and units; if they are correct, report this defect of the program");
    return cell;
  }

  void Table::write_csv(std::ostream &stream) const
  {
    const auto write_row = [&](const auto &text) {
      for (std::size_t c = 0; c < heads.size(); ++c)
        stream << (c > 0 ? "," : "") << text(c);
      stream << '\n';
    };
    write_row([&](const std::size_t c) { return heads[c].name; });
    for (std::size_t row = 0; row < cells[0].size(); ++row)
      write_row([&](const std::size_t c) { return csv_text(cells[c][row]); });
  }

  void Table::print(std::ostream &stream) const
  {
    // Pad every column, including its header, to its width
    std::vector<std::vector<std::string>> texts;
    for (std::size_t c = 0; c < heads.size(); ++c)
      {
        const auto format = [&](const double number) {
          std::ostringstream text;
          text << (heads[c].scientific ? std::scientific : std::fixed) << std::setprecision(heads[c].digits) << number;
          return text.str();
        };
        std::vector<std::string> column = {heads[c].name};
        for (const Entry &cell : cells[c])
          column.push_back(text_of(cell, format));
        std::size_t width = 0;
        for (const std::string &text : column)
          width = std::max(width, text.size());
        const bool is_text =
          std::any_of(cells[c].begin(), cells[c].end(), [](const Entry &cell) { return std::holds_alternative<std::string>(cell); });
        for (std::string &text : column)
          text.insert(is_text ? text.size() : 0, width - text.size(), ' ');
        texts.push_back(std::move(column));
      }
    for (std::size_t row = 0; row <= cells[0].size(); ++row)
      {
        stream << "   ";
        for (const auto &column : texts)
          stream << ' ' << column[row] << ' ';
        stream << '\n';
      }
    stream << std::flush;
  }
} // namespace Squeal
