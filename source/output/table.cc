#include <squeal/base/exceptions.h>
#include <squeal/output/table.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <sstream>

namespace Squeal
{
  namespace
  {
    constexpr int significant_digits = 12;

    std::string csv_text(const Cell &cell)
    {
      std::ostringstream text;
      if (const auto *word = std::get_if<std::string>(&cell))
        {
          // Quotes only where the comma or a quote would end the cell
          if (word->find_first_of(",\"\n") == std::string::npos)
            return *word;
          text << std::quoted(*word, '"', '"');
        }
      else if (const auto *count = std::get_if<long>(&cell))
        text << *count;
      else if (const auto *number = std::get_if<double>(&cell))
        // Adding zero takes the sign of a negative one
        text << std::setprecision(significant_digits) << *number + 0.;
      return text.str();
    }

    std::string screen_text(const Cell &cell, const Column &column)
    {
      std::ostringstream text;
      if (const auto *word = std::get_if<std::string>(&cell))
        text << *word;
      else if (const auto *count = std::get_if<long>(&cell))
        text << *count;
      else if (const auto *number = std::get_if<double>(&cell))
        {
          text << (column.scientific ? std::scientific : std::fixed) << std::setprecision(column.digits) << *number;
          // A rounded minus zero says nothing.
          if (text.str().find_first_not_of("-0.") == std::string::npos && text.str()[0] == '-')
            return text.str().substr(1);
        }
      return text.str();
    }
  } // namespace

  std::string Column::header() const
  {
    return unit.empty() ? name : name + " [" + unit + "]";
  }

  Table::Table(std::vector<Column> columns)
    : columns(std::move(columns))
  {}

  void Table::add_row(std::vector<Cell> cells)
  {
    for (std::size_t c = 0; c < cells.size(); ++c)
      if (const auto *number = std::get_if<double>(&cells[c]); number != nullptr && !std::isfinite(*number))
        throw Error("a result is not a finite number", "table column `" + columns[c].header() + "`",
                    "this is a defect of the program or of an extreme model; check material values and units");
    rows.push_back(std::move(cells));
  }

  unsigned int Table::n_rows() const
  {
    return rows.size();
  }

  void Table::write_csv(std::ostream &stream) const
  {
    for (std::size_t c = 0; c < columns.size(); ++c)
      stream << (c > 0 ? "," : "") << columns[c].header();
    stream << '\n';
    for (const auto &row : rows)
      {
        for (std::size_t c = 0; c < row.size(); ++c)
          stream << (c > 0 ? "," : "") << csv_text(row[c]);
        stream << '\n';
      }
  }

  void Table::print(std::ostream &stream) const
  {
    std::vector<std::vector<std::string>> texts;
    std::vector<std::size_t>              widths;
    std::vector<bool>                     is_text(columns.size(), false);
    for (const Column &column : columns)
      widths.push_back(column.header().size());
    for (const auto &row : rows)
      {
        texts.emplace_back();
        for (std::size_t c = 0; c < row.size(); ++c)
          {
            texts.back().push_back(screen_text(row[c], columns[c]));
            widths[c]  = std::max(widths[c], texts.back().back().size());
            is_text[c] = is_text[c] || std::holds_alternative<std::string>(row[c]);
          }
      }
    const auto print_row = [&](const auto &text_of) {
      stream << "   ";
      for (std::size_t c = 0; c < columns.size(); ++c)
        stream << ' ' << (is_text[c] ? std::left : std::right) << std::setw(widths[c]) << text_of(c) << ' ';
      stream << std::right << '\n';
    };
    print_row([&](const std::size_t c) { return columns[c].header(); });
    for (const auto &row : texts)
      print_row([&](const std::size_t c) { return row[c]; });
    stream << std::flush;
  }
} // namespace Squeal
