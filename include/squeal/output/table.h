// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

namespace Squeal
{
  /// A string as a field of comma-separated values, quoted if it contains a comma, quote or line break.
  std::string csv_field(const std::string &text);

  /// A table entry: empty, a string, a count, or a number.
  struct Entry : std::variant<std::monostate, std::string, long, double>
  {
    Entry() = default;

    /// Entry for a value of any type; types other than numbers and strings are converted by their to_string().
    template <typename Value>
    Entry(const Value &value)
    {
      if constexpr (std::is_floating_point_v<Value>)
        emplace<double>(value);
      else if constexpr (std::is_integral_v<Value>)
        emplace<long>(value);
      else if constexpr (std::is_convertible_v<Value, std::string>)
        emplace<std::string>(value);
      else
        emplace<std::string>(to_string(value));
    }

    template <typename Value>
    Entry(const std::optional<Value> &value)
    {
      if (value)
        *this = Entry(*value);
    }
  };

  /// A column of a table: a member or a function of the row.
  template <typename Row>
  struct Column
  {
    std::string                       name;
    std::string                       unit; ///< unit; "-" for a number without unit, "" for text
    std::function<Entry(const Row &)> value;
    int                               digits     = 3; ///< digits after the point on the screen
    bool                              scientific = false;
  };

  template <typename Row>
  using Columns = std::vector<Column<Row>>;

  /// A table of results: comma-separated values with 12 significant digits and a header "name [unit]" on disk, aligned columns on the
  /// screen.
  class Table
  {
  public:
    /// Builds a table of @p columns from @p rows, a range of Row; throws an Error that names the column if a number is not finite.
    template <typename Row, typename Rows>
    Table(const Columns<Row> &columns, const Rows &rows)
    {
      for (const Column<Row> &column : columns)
        {
          heads.push_back({column.unit.empty() ? column.name : column.name + " [" + column.unit + "]", column.digits, column.scientific});
          cells.emplace_back();
          for (const Row &row : rows)
            cells.back().push_back(checked(column.value(row)));
        }
    }

    void write_csv(std::ostream &stream) const;

    /// Prints aligned columns, with text to the left and numbers to the right.
    void print(std::ostream &stream) const;

  private:
    /// Properties of a column without its entries.
    struct Head
    {
      std::string name;
      int         digits;
      bool        scientific;
    };

    /// Returns @p cell after checking it as an entry of the last column.
    Entry checked(const Entry &cell) const;

    std::vector<Head>               heads;
    std::vector<std::vector<Entry>> cells;
  };
} // namespace Squeal
