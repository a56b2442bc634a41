#pragma once

#include <iosfwd>
#include <string>
#include <variant>
#include <vector>

namespace Squeal
{
  /// A column of a table: its name, unit and how many digits the screen shows.
  struct Column
  {
    std::string name;
    std::string unit;           ///< "-" for none; "" for text
    int         digits     = 3; ///< on the screen: after the point, or significant if scientific
    bool        scientific = false;

    /// "name [unit]", as the header has it.
    std::string header() const;
  };

  /// Nothing, a text, a count, or a number.
  using Cell = std::variant<std::monostate, std::string, long, double>;

  /**
   * A table of results with typed columns: comma-separated with 12 significant
   * digits on disk, aligned on the screen.
   */
  class Table
  {
  public:
    explicit Table(std::vector<Column> columns);

    /// Appends a row; throws Error if a number is not finite, naming its column.
    void add_row(std::vector<Cell> cells);

    unsigned int n_rows() const;

    /// Comma-separated values with a header line.
    void write_csv(std::ostream &stream) const;

    /// Aligned columns; texts to the left, numbers to the right.
    void print(std::ostream &stream) const;

  private:
    std::vector<Column>            columns;
    std::vector<std::vector<Cell>> rows;
  };
} // namespace Squeal
