#include <squeal/base/exceptions.h>
#include <squeal/base/installation.h>
#include <squeal/base/text.h>
#include <squeal/parameters/geometry_file.h>

#include <boost/algorithm/string/predicate.hpp>
#include <boost/algorithm/string/trim.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace Squeal
{
  namespace fs = std::filesystem;

  namespace
  {
    /// The text with blanks for comments, so that lines keep their numbers.
    std::string without_comments(std::string text)
    {
      bool in_string = false;
      for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] == '"')
          in_string = !in_string;
        else if (!in_string && text[i] == '/' && i + 1 < text.size() && (text[i + 1] == '/' || text[i + 1] == '*'))
          {
            const bool        is_line = text[i + 1] == '/';
            const std::size_t end     = is_line ? text.find('\n', i) : text.find("*/", i + 2);
            const std::size_t last    = end == std::string::npos ? text.size() : end + (is_line ? 0 : 2);
            for (; i < last; ++i)
              if (text[i] != '\n')
                text[i] = ' ';
            --i;
          }
      return text;
    }

    /// How deep in brackets a text is where it has been read to, and whether in a string.
    struct Nesting
    {
      int  depth     = 0;
      bool in_string = false;

      void read(const char c)
      {
        in_string = in_string != (c == '"');
        if (!in_string)
          depth += (c == '[' || c == '{' || c == '(') - (c == ']' || c == '}' || c == ')');
      }
    };

    /// The text between a bracket and its counterpart; empty where there is none.
    std::string inside_brackets(const std::string &text, const std::size_t open)
    {
      Nesting nesting;
      for (std::size_t i = open; i < text.size(); ++i)
        {
          nesting.read(text[i]);
          if (nesting.depth == 0)
            return i == open ? "" : text.substr(open + 1, i - open - 1);
        }
      return "";
    }

    /// Items separated by commas outside all brackets and strings.
    std::vector<std::string> items(const std::string &text)
    {
      std::vector<std::string> result(1);
      Nesting                  nesting;
      for (const char c : text)
        {
          nesting.read(c);
          if (c == ',' && nesting.depth == 0 && !nesting.in_string)
            result.emplace_back();
          else
            result.back() += c;
        }
      for (std::string &item : result)
        boost::trim(item);
      return result;
    }

    bool is_word_character(const char c)
    {
      return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    }

    /// Where a whole word begins at or after a position; npos where it does not.
    std::size_t find_word(const std::string &text, const std::string &word, std::size_t from = 0)
    {
      for (; (from = text.find(word, from)) != std::string::npos; ++from)
        if ((from == 0 || !is_word_character(text[from - 1])) &&
            (from + word.size() == text.size() || !is_word_character(text[from + word.size()])))
          break;
      return from;
    }

    /// What follows each occurrence of a word, blanks left out: the position of its first character.
    std::vector<std::size_t> positions_after(const std::string &text, const std::string &word)
    {
      std::vector<std::size_t> result;
      for (std::size_t at = 0; (at = find_word(text, word, at)) != std::string::npos;)
        {
          at = text.find_first_not_of(" \t\r\n", at + word.size());
          if (at == std::string::npos)
            break;
          result.push_back(at);
        }
      return result;
    }

    /// The name at the beginning of a text; empty where it does not begin with one.
    std::string leading_name(const std::string &text)
    {
      const std::size_t end = std::find_if_not(text.begin(), text.end(), is_word_character) - text.begin();
      return end > 0 && std::isdigit(static_cast<unsigned char>(text[0])) ? "" : text.substr(0, end);
    }

    /// The text between the quotes with which a text begins; empty where it does not.
    std::string leading_string(const std::string &text)
    {
      const std::size_t end = text.empty() || text[0] != '"' ? std::string::npos : text.find('"', 1);
      return end == std::string::npos ? "" : text.substr(1, end - 1);
    }

    /// The text of option Name "..." among the options of a number.
    std::string onelab_name(const std::vector<std::string> &options)
    {
      for (const std::string &option : options)
        if (leading_name(option) == "Name")
          return leading_string(boost::trim_copy(option.substr(std::string("Name").size())));
      return "";
    }

    /// One item of DefineConstant[...]: name, name = value, or name = {value, options}.
    std::optional<GeometryVariable> constant(const std::string &item)
    {
      const std::string name = leading_name(item), rest = boost::trim_copy(item.substr(name.size()));
      if (name.empty() || (!rest.empty() && rest[0] != '='))
        return {};
      std::string value = rest.empty() ? "0" : boost::trim_copy(rest.substr(1));
      if (!value.empty() && value[0] == '{')
        value = items(inside_brackets(value, 0))[0];
      if (value.empty() || value[0] == '"' || value[0] == '{')
        return {};
      return GeometryVariable{name, value, ""};
    }

    /// The name to which the expression at a position is assigned; empty where it is not.
    std::string assigned_name(const std::string &text, const std::size_t position)
    {
      const auto blank_before = [&](std::size_t at) {
        while (at > 0 && std::isspace(static_cast<unsigned char>(text[at - 1])))
          --at;
        return at;
      };
      const std::size_t equal = blank_before(position);
      if (equal == 0 || text[equal - 1] != '=')
        return "";
      const std::size_t end   = blank_before(equal - 1);
      std::size_t       begin = end;
      while (begin > 0 && is_word_character(text[begin - 1]))
        --begin;
      return leading_name(text.substr(begin, end - begin));
    }
  } // namespace

  std::string find_geometry(const std::string &name, const std::string &parameter_directory)
  {
    const fs::path        given(name);
    const fs::path        beside      = fs::absolute(parameter_directory.empty() ? "." : parameter_directory);
    std::vector<fs::path> directories = {beside};
    if (given.is_relative() && !fs::equivalent(beside, fs::current_path()))
      directories.push_back(fs::current_path());
    if (!given.has_parent_path())
      directories.push_back(installation().geometries.string());
    std::string searched;
    for (const fs::path &directory : directories)
      {
        const fs::path  candidate = directory / given;
        std::error_code ignored;
        if (fs::is_regular_file(candidate, ignored))
          return candidate.lexically_normal().string();
        searched += (searched.empty() ? "" : ", ") + candidate.lexically_normal().parent_path().string();
      }
    throw MeshError("There is no geometry '" + legible(name) + "'", searched, "set Geometry/File to an existing .geo or .msh");
  }

  bool is_supplied(const std::string &geometry)
  {
    std::error_code ignored;
    return fs::equivalent(fs::path(geometry).parent_path(), installation().geometries, ignored);
  }

  bool is_script(const std::string &geometry)
  {
    return boost::iequals(fs::path(geometry).extension().string(), ".geo");
  }

  GeometryScript::GeometryScript(const std::string &file)
  {
    read(file);
  }

  void GeometryScript::read(const std::string &file)
  {
    for (const Part &part : parts)
      if (part.file == file)
        return;
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    parts.push_back({file, without_comments(text.str())});

    const std::string here = parts.back().text;
    for (const char *statement : {"Include", "Merge"})
      for (const std::size_t at : positions_after(here, statement))
        {
          const std::string name  = leading_string(here.substr(at, here.find('\n', at) - at));
          const fs::path    other = (fs::path(file).parent_path() / name).lexically_normal();
          std::error_code   ignored;
          if (name.empty() || !fs::is_regular_file(other, ignored))
            continue;
          if (statement == std::string("Include") || is_script(other.string()))
            read(other.string());
          else
            merged.push_back(other.string());
        }
  }

  std::vector<GeometryVariable> GeometryScript::variables() const
  {
    std::vector<GeometryVariable> result;
    const auto                    add = [&](const GeometryVariable &variable) {
      if (std::none_of(result.begin(), result.end(), [&](const GeometryVariable &other) { return other.name == variable.name; }))
        result.push_back(variable);
    };
    for (const Part &part : parts)
      {
        const std::string &text = part.text;
        for (const std::size_t at : positions_after(text, "DefineConstant"))
          for (const std::string &item : items(inside_brackets(text, at)))
            if (const auto variable = constant(item))
              add(*variable);
        for (std::size_t at = 0; (at = find_word(text, "DefineNumber", at)) != std::string::npos; ++at)
          {
            const auto        options = items(inside_brackets(text, text.find_first_of("[(", at)));
            const std::string name = assigned_name(text, at), onelab = onelab_name(options);
            if (!name.empty() && !onelab.empty())
              add({name, options[0], onelab});
          }
      }
    return result;
  }

  std::vector<std::string> GeometryScript::files() const
  {
    std::vector<std::string> result;
    for (const Part &part : parts)
      result.push_back(part.file);
    result.insert(result.end(), merged.begin(), merged.end());
    return result;
  }

  std::optional<std::string> GeometryScript::find(const std::vector<std::string> &words) const
  {
    for (const Part &part : parts)
      {
        std::istringstream lines(part.text);
        std::string        line;
        for (unsigned int number = 1; std::getline(lines, line); ++number)
          for (const std::string &word : words)
            if (find_word(single_spaced(line), word) != std::string::npos)
              return part.file + ", line " + std::to_string(number) + ": " + boost::trim_copy(line);
      }
    return {};
  }

  GeometryCopy copy_of(const std::string &geometry)
  {
    const fs::path original(geometry), folder("geometry");
    if (is_supplied(geometry))
      return {{}, original.filename().string()};
    const std::vector<std::string> files = is_script(geometry) ? GeometryScript(geometry).files() : std::vector<std::string>{geometry};
    GeometryCopy                   copy{{}, (folder / original.filename()).string()};
    for (const std::string &file : files)
      {
        const fs::path relative = fs::path(file).lexically_relative(original.parent_path());
        if (*relative.begin() == "..")
          copy.name = geometry;
        else
          copy.files.push_back({file, (folder / relative).string()});
      }
    return copy;
  }
} // namespace Squeal
