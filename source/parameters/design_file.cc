#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/design_plan.h>
#include <squeal/parameters/number_list.h>

#include <deal.II/base/utilities.h>

#include <boost/tokenizer.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace Squeal
{
  std::string designs_file(const Parameters &parameters)
  {
    namespace fs            = std::filesystem;
    const std::string &name = parameters.designs.file;
    if (parameters.designs.choice != DesignChoice::file || name.empty())
      return "";
    const fs::path beside = fs::path(parameters.geometry.directory) / name;
    return fs::exists(beside) || !fs::exists(name) ? beside.string() : name;
  }

  namespace
  {
    using dealii::Utilities::trim;

    constexpr const char *as_csv_file = "save it as CSV, UTF-8, with commas between values and decimal points";

    std::string where_in(const std::string &file, const std::size_t line)
    {
      return text("file ", file, ", line ", line);
    }

    /// Path and content of the file, without the mark of UTF-8.
    std::pair<std::string, std::string> read_file(const Parameters &parameters)
    {
      const std::string file = designs_file(parameters);
      if (file.empty())
        throw ParameterError("no file of designs is named", "parameter Designs/File", "name a CSV file, or choose another Designs/Plan");
      std::ifstream     stream(file, std::ios::binary);
      const std::string content{std::istreambuf_iterator<char>(stream), {}};
      if (!stream.is_open() || stream.bad() || std::filesystem::is_directory(file))
        throw FileError("the file of designs cannot be read", "file " + file + ", parameter Designs/File",
                        "check its name and permissions");
      constexpr const char *utf8_mark = "\xEF\xBB\xBF";
      return {file, content.rfind(utf8_mark, 0) == 0 ? content.substr(3) : content};
    }

    /// Refuses encodings and line ends that hide the lines of a file.
    void check_encoding(const std::string &content, const std::string &file)
    {
      const bool is_marked = content.rfind("\xFF\xFE", 0) == 0 || content.rfind("\xFE\xFF", 0) == 0;
      if (is_marked || content.find('\0') != std::string::npos)
        throw ParameterError("the file of designs is not in UTF-8 but, it seems, in UTF-16", where_in(file, 1), as_csv_file);
      for (auto end = content.find('\r'); end != std::string::npos; end = content.find('\r', end + 1))
        if (end + 1 < content.size() && content[end + 1] != '\n')
          throw ParameterError("a line ends with a carriage return alone, as in old files of the Macintosh",
                               where_in(file, 1 + std::count(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(end), '\n')),
                               "end lines with a line feed; " + std::string(as_csv_file));
    }

    /// Refuses a first line that a spreadsheet with other separators has written.
    void check_separator(const std::string &names, const std::string &where)
    {
      if (names.rfind("sep=", 0) == 0)
        throw ParameterError("the first line, " + in_quotes(names) + ", names a separator, not the variables", where,
                             "remove this line; " + std::string(as_csv_file));
      for (const auto &[separator, name] : {std::pair(';', "semicolons"), std::pair('\t', "tabs")})
        if (names.find(separator) != std::string::npos)
          throw ParameterError(text("the names of the variables are separated by ", name, ", not by commas"), where, as_csv_file);
    }

    std::vector<std::string> fields_of(const std::string &line, const std::string &where)
    {
      if (std::count(line.begin(), line.end(), '"') % 2 != 0)
        throw ParameterError("a quotation mark is not closed in this line", where,
                             "write each design in one line, and quote the whole of a value that contains commas");
      using Separator = boost::escaped_list_separator<char>;
      std::vector<std::string> result;
      for (const std::string &field : boost::tokenizer<Separator>(line, Separator('\0', ',', '"')))
        result.push_back(trim(field));
      return result;
    }

    void check_names(const std::vector<std::string> &names, const std::string &where)
    {
      const auto nameless = std::find(names.begin(), names.end(), "");
      if (nameless == names.end())
        return;
      const bool is_last = nameless + 1 == names.end();
      throw ParameterError(text("column ", nameless - names.begin() + 1, " has no name", is_last ? ": the line ends with a comma" : ""),
                           where, is_last ? "remove the comma at the end of every line" : "name the parameter of each column");
    }

    void check_number_of_values(const std::vector<std::string> &values,
                                const std::size_t               n_names,
                                const std::string              &line,
                                const std::string              &where)
    {
      if (values.size() == n_names)
        return;
      const bool        is_comma_more = values.size() == n_names + 1 && values.back().empty();
      const std::string separator     = line.find(';') != std::string::npos  ? ", separated by semicolons" :
                                        line.find('\t') != std::string::npos ? ", separated by tabs" :
                                                                               "";
      throw ParameterError(
        text(values.size(), values.size() == 1 ? " value stands" : " values stand", " below ", n_names, n_names == 1 ? " name" : " names",
             is_comma_more ? ": the line ends with a comma" : separator),
        where, "give one value for each name, with decimal points; quote values that contain commas" + decimal_point_hint(line));
    }
  } // namespace

  DesignPlan read_design_file(const Parameters &parameters)
  {
    const auto [file, content] = read_file(parameters);
    check_encoding(content, file);
    DesignPlan         plan;
    std::istringstream stream(content);
    std::string        line;
    for (int number = 1; std::getline(stream, line); ++number)
      {
        line                    = trim(line);
        const std::string where = where_in(file, number);
        if (line.empty())
          continue;
        if (plan.names.empty())
          check_separator(line, where);
        const std::vector<std::string> fields = fields_of(line, where);
        if (plan.names.empty())
          {
            check_names(fields, where);
            plan.names       = fields;
            plan.where_names = where;
          }
        else
          {
            check_number_of_values(fields, plan.names.size(), line, where);
            plan.designs.push_back(fields);
            plan.where.push_back(where);
          }
      }
    if (plan.names.empty())
      throw ParameterError("the file of designs is empty", "file " + file, "write names in the first line, a design in each other one");
    if (plan.designs.empty())
      throw ParameterError("the file has names, but no design", plan.where_names, "write a design in each line below the names");
    return plan;
  }
} // namespace Squeal
