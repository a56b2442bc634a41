// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/csv_file.h>
#include <squeal/parameters/number_list.h>

#include <boost/algorithm/string/trim.hpp>
#include <boost/tokenizer.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace Squeal
{
  namespace
  {
    constexpr const char *as_csv_file = "save the file as CSV in UTF-8, with commas between values and with decimal points";

    std::string where_in(const std::string &file, const std::size_t line)
    {
      return text("file ", file, ", line ", line);
    }

    /// Content of the file, without the byte order mark of UTF-8.
    std::string content_of(const std::string &path, const std::string &parameter, const std::string &row)
    {
      if (path.empty())
        throw ParameterError("no file of " + row + "s is given", "parameter " + parameter, "name a CSV file");
      std::ifstream stream(path, std::ios::binary);
      std::string   content;
      const bool    is_file = stream.is_open() && !std::filesystem::is_directory(path);
      if (is_file)
        content.assign(std::istreambuf_iterator<char>(stream), {});
      if (!is_file || stream.bad())
        throw FileError("the file of " + row + "s cannot be read", "file " + path + ", parameter " + parameter,
                        "check its name and permissions");
      constexpr const char *utf8_mark = "\xEF\xBB\xBF";
      return content.rfind(utf8_mark, 0) == 0 ? content.substr(3) : content;
    }

    /// Rejects encodings and line endings that prevent reading line by line.
    void check_encoding(const std::string &content, const std::string &file)
    {
      const bool is_marked = content.rfind("\xFF\xFE", 0) == 0 || content.rfind("\xFE\xFF", 0) == 0;
      if (is_marked || content.find('\0') != std::string::npos)
        throw ParameterError("the file is not in UTF-8, but apparently in UTF-16", where_in(file, 1), as_csv_file);
      for (auto end = content.find('\r'); end != std::string::npos; end = content.find('\r', end + 1))
        if (end + 1 < content.size() && content[end + 1] != '\n')
          throw ParameterError("the file contains a carriage return without a line feed, as in files of the classic Mac OS",
                               where_in(file, 1 + std::count(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(end), '\n')),
                               "end each line with a line feed; " + std::string(as_csv_file));
    }

    /// Rejects a header line with separators other than commas.
    void check_separator(const std::string &names, const std::string &where)
    {
      if (names.rfind("sep=", 0) == 0)
        throw ParameterError("the first line, " + in_quotes(names) + ", defines a separator instead of naming the columns", where,
                             "remove this line; " + std::string(as_csv_file));
      for (const auto &[separator, name] : {std::pair(';', "semicolons"), std::pair('\t', "tabs")})
        if (names.find(separator) != std::string::npos)
          throw ParameterError(text("the line of column names contains ", name, ", but columns are separated by commas"), where,
                               as_csv_file);
    }

    std::vector<std::string> fields_of(const std::string &line, const std::string &where, const std::string &row)
    {
      if (std::count(line.begin(), line.end(), '"') % 2 != 0)
        throw ParameterError("a quotation mark is not closed in this line", where,
                             "write each " + row + " on one line, and enclose every value that contains commas in quotation marks");
      using Separator = boost::escaped_list_separator<char>;
      std::vector<std::string> result;
      for (const std::string &field : boost::tokenizer<Separator>(line, Separator('\0', ',', '"')))
        result.push_back(boost::trim_copy(field));
      return result;
    }

    void check_names(const std::vector<std::string> &names, const std::string &where)
    {
      const auto nameless = std::find(names.begin(), names.end(), "");
      if (nameless == names.end())
        return;
      const bool is_last = nameless + 1 == names.end();
      throw ParameterError(text("column ", nameless - names.begin() + 1, " has no name", is_last ? ": the line ends with a comma" : ""),
                           where, is_last ? "remove the comma at the end of each line" : "name each column");
    }

    void check_number_of_values(const std::vector<std::string> &values,
                                const std::size_t               n_names,
                                const std::string              &line,
                                const std::string              &where)
    {
      if (values.size() == n_names)
        return;
      const bool        is_comma_more = values.size() == n_names + 1 && values.back().empty();
      const std::string separator     = line.find(';') != std::string::npos  ? "; the line contains semicolons" :
                                        line.find('\t') != std::string::npos ? "; the line contains tabs" :
                                                                               "";
      throw ParameterError(
        text("the line has ", counted(values.size(), "value"), ", but the table has ", counted(n_names, "column"),
             is_comma_more ? "; the line ends with a comma" : separator),
        where,
        "give one value for each column, with decimal points and without a comma at the end; quote values that contain commas" +
          decimal_point_hint(line));
    }
  } // namespace

  std::size_t CsvFile::column(const std::string &name) const
  {
    return std::find(names.begin(), names.end(), name) - names.begin();
  }

  double CsvFile::number(const std::size_t row, const std::size_t column) const
  {
    const std::string &cell  = rows[row][column];
    const auto         value = parse_number(cell);
    if (!value)
      throw ParameterError(in_quotes(cell) + " in column " + in_quotes(names[column]) + " is not a finite number", where[row],
                           "write a finite number, with a decimal point if necessary" + decimal_point_hint(cell));
    return *value;
  }

  void CsvFile::check_repeated_columns() const
  {
    for (std::size_t i = 0; i < names.size(); ++i)
      if (column(names[i]) < i)
        throw ParameterError("column " + in_quotes(names[i]) + " occurs twice", where_names, "rename or remove one of these columns");
  }

  std::string input_path(const std::string &name, const std::string &parameter_directory)
  {
    namespace fs          = std::filesystem;
    const fs::path beside = fs::path(parameter_directory) / name;
    return fs::exists(beside) || !fs::exists(name) ? beside.string() : name;
  }

  CsvFile read_csv(const std::string &path, const std::string &parameter, const std::string &row)
  {
    const std::string content = content_of(path, parameter, row);
    check_encoding(content, path);
    CsvFile            result;
    std::istringstream stream(content);
    std::string        line;
    for (int number = 1; std::getline(stream, line); ++number)
      {
        boost::trim(line);
        const std::string where = where_in(path, number);
        if (line.empty())
          continue;
        if (result.names.empty())
          check_separator(line, where);
        const std::vector<std::string> fields = fields_of(line, where, row);
        if (result.names.empty())
          {
            check_names(fields, where);
            result.names       = fields;
            result.where_names = where;
          }
        else
          {
            check_number_of_values(fields, result.names.size(), line, where);
            result.rows.push_back(fields);
            result.where.push_back(where);
          }
      }
    if (result.names.empty())
      throw ParameterError("the file of " + row + "s is empty", "file " + path,
                           "write column names in the first line, then one " + row + " per line");
    if (result.rows.empty())
      throw ParameterError("the file has column names, but no " + row, result.where_names,
                           "write one " + row + " per line below the column names");
    return result;
  }
} // namespace Squeal
