// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/text.h>
#include <squeal/parameters/parameter_file.h>

#include <boost/algorithm/string/predicate.hpp>
#include <boost/algorithm/string/replace.hpp>
#include <boost/algorithm/string/trim.hpp>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace Squeal
{
  namespace
  {
    namespace fs = std::filesystem;
    using boost::starts_with;
    using boost::trim_copy;

    constexpr const char *blanks = " \t\r\n\v\f";

    // Stop at endless device files and multiplying includes; the limits are far above the needs of a run
    constexpr std::streamsize largest_file       = 1 << 24; // [byte]
    constexpr unsigned int    most_files         = 1000;
    constexpr std::size_t     most_open_sections = 100;

    std::string place(const std::string &file, const unsigned int line)
    {
      return "file " + legible(file) + ", line " + std::to_string(line);
    }

    /// Text of a file without its byte order mark; @p where describes the file in messages.
    std::string read_text(const std::string &file, const std::string &where)
    {
      std::error_code ignored;
      if (fs::is_directory(file, ignored))
        throw FileError("the parameter file is a directory", where, "name a file in it");
      std::ifstream stream(file, std::ios::binary);
      if (!stream)
        throw FileError("the parameter file cannot be read", where, "check its name and permissions");
      std::string text(largest_file + 1, '\0');
      stream.read(text.data(), largest_file + 1);
      if (stream.bad())
        throw FileError("the parameter file cannot be read completely", where, "check the drive or network on which it is stored");
      if (stream.gcount() > largest_file)
        throw FileError("the parameter file is larger than " + std::to_string(largest_file) + " bytes", where,
                        "check its name; parameter files are much smaller");
      text.resize(stream.gcount());

      if (starts_with(text, "\xFF\xFE") || starts_with(text, "\xFE\xFF"))
        throw ParameterError("the parameter file is encoded as UTF-16", where, "save it as UTF-8");
      if (const auto zero = text.find('\0'); zero != std::string::npos)
        throw ParameterError("the parameter file is not a text file: it contains a zero byte",
                             place(file, 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(zero), '\n')),
                             "give a text file in UTF-8");
      constexpr const char *byte_order_mark = "\xEF\xBB\xBF";
      return starts_with(text, byte_order_mark) ? text.substr(3) : text;
    }

    constexpr const char *how_to_quote =
      R"(enclose it in double quotes; inside, write \" for a quote, \\ for a backslash and \n for a line break)";

    /// Position of the closing quote in a string that begins with a quote; the end of the string if the quote is not closed.
    std::size_t closing_quote(const std::string &text)
    {
      std::size_t i = 1;
      while (i < text.size() && text[i] != '"')
        i += text[i] == '\\' ? 2 : 1;
      return std::min(i, text.size());
    }

    /// Value on a line before the first `#` outside quotes.
    std::string value_before_comment(const std::string &text, const std::string &where)
    {
      const std::string whole   = trim_copy(text);
      const std::size_t comment = whole.find('#', starts_with(whole, "\"") ? closing_quote(whole) : 0);
      const auto        is_word = [&](const std::size_t i) { return i < whole.size() && std::strchr(blanks, whole[i]) == nullptr; };
      if (comment != std::string::npos && comment > 0 && whole[0] != '"' && is_word(comment - 1) && is_word(comment + 1))
        throw ParameterError("`#` begins a comment and truncates the value " + in_quotes(whole), where,
                             "enclose the value in double quotes, or insert a blank before the comment");
      return read_value(whole.substr(0, comment), where);
    }

    /// Reader of a parameter file and the files that it includes.
    class Reader
    {
    public:
      std::vector<ParameterStatement> statements;

      /// @p where names the file or the line that includes it.
      void read(const std::string &file, const std::string &where)
      {
        refuse_cycle(file, where);
        if (++n_files > most_files)
          throw ParameterError("more than " + std::to_string(most_files) + " parameter files are included", where,
                               "remove repeated includes");
        open_files.push_back(file);
        const std::size_t outer_depth = sections.size();

        std::istringstream stream(read_text(file, where));
        std::string        line, whole;
        unsigned int       number = 0, first = 0;
        while (std::getline(stream, line))
          {
            ++number;
            line = trim_copy(line);
            if (whole.empty())
              first = number;
            const bool goes_on = !line.empty() && line.back() == '\\';
            whole += goes_on ? line.substr(0, line.size() - 1) : line;
            if (goes_on)
              continue;
            read_line(whole, file, first, outer_depth);
            whole.clear();
          }
        read_line(whole, file, first, outer_depth);
        if (sections.size() > outer_depth)
          throw ParameterError("section " + in_quotes(sections.back().name) + " is not closed", sections.back().where, "add a line `end`");
        open_files.pop_back();
      }

    private:
      struct Section
      {
        std::string name, where;
      };

      /// Throws ParameterError if the file is already being read.
      void refuse_cycle(const std::string &file, const std::string &where) const
      {
        std::error_code ignored;
        const auto      is_same = [&](const std::string &other) { return fs::equivalent(file, other, ignored); };
        const auto      begin   = std::find_if(open_files.begin(), open_files.end(), is_same);
        if (begin == open_files.end())
          return;
        std::string chain;
        for (auto name = begin; name != open_files.end(); ++name)
          chain += legible(*name) + " -> ";
        throw ParameterError("a parameter file includes itself: " + chain + legible(*begin), where, "remove this include");
      }

      std::string path(const std::string &name) const
      {
        std::string result;
        for (const Section &section : sections)
          result += section.name + "/";
        return result + name;
      }

      void read_line(const std::string &line, const std::string &file, const unsigned int number, const std::size_t outer_depth)
      {
        const std::string where = place(file, number);
        const std::string text  = trim_copy(line.substr(0, line.find('#')));
        const std::string key   = text.substr(0, text.find_first_of(blanks));
        const std::string rest  = trim_copy(text.substr(key.size()));
        if (key.empty())
          return;
        if (key == "subsection" || key == "SUBSECTION")
          {
            if (sections.size() == most_open_sections)
              throw ParameterError("more than " + std::to_string(most_open_sections) + " sections are nested", where,
                                   "close each section with a line `end`");
            sections.push_back({single_spaced(rest), where});
            statements.push_back({path(""), "", where});
          }
        else if ((key == "end" || key == "END") && rest.empty())
          {
            if (sections.size() == outer_depth)
              throw ParameterError("`end` closes no section of this file", where, "remove this line, or add the matching `subsection`");
            sections.pop_back();
          }
        else if (key == "set" || key == "SET")
          {
            const auto equal = rest.find('=');
            if (equal == std::string::npos)
              throw ParameterError(in_quotes(text) + " has no `=`", where, "write `set NAME = VALUE`");
            const std::string value = value_before_comment(line.substr(line.find('=') + 1), where);
            statements.push_back({path(single_spaced(rest.substr(0, equal))), value, where});
          }
        else if ((key == "include" || key == "INCLUDE") && !rest.empty())
          {
            std::error_code   ignored;
            const std::string name   = value_before_comment(line.substr(line.find(key) + key.size()), where);
            const fs::path    beside = fs::path(file).parent_path() / name;
            read(fs::exists(beside, ignored) ? beside.string() : name, where + ", which includes " + in_quotes(name));
          }
        else
          throw ParameterError(in_quotes(text) + " is not a valid line of a parameter file", where,
                               "write `subsection NAME`, `end`, `set NAME = VALUE`, `include FILE`, or a comment after `#`");
      }

      unsigned int             n_files = 0;
      std::vector<std::string> open_files; ///< from the outermost file to the current one
      std::vector<Section>     sections;
    };
  } // namespace

  bool ParameterStatement::is_section() const
  {
    return !path.empty() && path.back() == '/';
  }

  std::vector<ParameterStatement> read_parameter_file(const std::string &file)
  {
    Reader reader;
    reader.read(file, "file " + legible(file));
    return std::move(reader.statements);
  }

  std::string written_value(const std::string &value)
  {
    const bool is_plain = value == trim_copy(value) && value.find_first_of("#\n") == std::string::npos && !starts_with(value, "\"") &&
                          !boost::ends_with(value, "\\");
    if (is_plain)
      return value;
    std::string result = value;
    for (const auto &[character, written] : {std::pair("\\", R"(\\)"), std::pair("\"", R"(\")"), std::pair("\n", R"(\n)")})
      boost::replace_all(result, character, written);
    return '"' + result + '"';
  }

  std::string read_value(const std::string &text, const std::string &where)
  {
    const std::string whole = trim_copy(text);
    if (!starts_with(whole, "\""))
      return whole;
    const std::size_t end = closing_quote(whole);
    if (end + 1 != whole.size())
      throw ParameterError("the value " + in_quotes(whole) +
                             (end == whole.size() ? " lacks its closing quote" : " continues after its closing quote"),
                           where, how_to_quote);
    std::string result;
    for (std::size_t i = 1; i < end; ++i)
      if (whole[i] != '\\')
        result += whole[i];
      else if (const char escaped = whole[++i]; std::strchr(R"("\n)", escaped) != nullptr)
        result += escaped == 'n' ? '\n' : escaped;
      else
        throw ParameterError("the value " + in_quotes(whole) + " contains the invalid escape " + in_quotes(whole.substr(i - 1, 2)), where,
                             how_to_quote);
    return result;
  }
} // namespace Squeal
