// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/exceptions.h>
#include <squeal/base/installation.h>
#include <squeal/base/text.h>
#include <squeal/parameters/geometry_file.h>

#include <boost/algorithm/string/predicate.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <boost/xpressive/xpressive_dynamic.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace Squeal
{
  namespace fs = std::filesystem;

  namespace
  {
    using Pattern = boost::xpressive::sregex; // std::regex would overflow the stack on long strings
    using Match   = boost::xpressive::smatch;
    using Matches = boost::xpressive::sregex_iterator;

    Pattern word(const std::string &text)
    {
      return Pattern::compile("\\b" + text + "\\b");
    }

    /// The text with comments replaced by blanks, so that line numbers do not change.
    std::string without_comments(const std::string &text)
    {
      const Pattern string_or_comment = Pattern::compile(R"re("[^"]*"?|//[^\n]*|/\*.*?\*/|/\*.*)re");
      return regex_replace(text, string_or_comment, [](const Match &match) {
        std::string part = match.str();
        if (part[0] == '/')
          std::replace_if(
            part.begin(), part.end(), [](const char c) { return c != '\n'; }, ' ');
        return part;
      });
    }

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

    /// Text between a bracket and its counterpart; empty if the bracket is not closed.
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

    /// Value of the option Name "..." of DefineNumber; empty if it is missing.
    std::string onelab_name(const std::vector<std::string> &options)
    {
      const Pattern name = Pattern::compile(R"re(Name\s*"([^"]*)".*)re");
      Match         match;
      for (const std::string &option : options)
        if (regex_match(option, match, name))
          return match[1];
      return "";
    }

    /// Variable from one item of DefineConstant[...]: name, name = value, or name = {value, options}; no value for strings and lists.
    std::optional<GeometryVariable> constant(const std::string &item)
    {
      const Pattern assignment = Pattern::compile(R"re(([A-Za-z_]\w*)\s*(?:=\s*(.*))?)re");
      Match         match;
      if (!regex_match(item, match, assignment))
        return {};
      std::string value = match[2].matched ? match[2].str() : "0";
      if (!value.empty() && value[0] == '{')
        value = items(inside_brackets(value, 0))[0];
      if (value.empty() || value[0] == '"' || value[0] == '{')
        return {};
      return GeometryVariable{match[1], value, ""};
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
    throw MeshError("there is no geometry '" + legible(name) + "'", searched, "set Geometry/File to an existing .geo or .msh file");
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
    for (const std::string statement : {"Include", "Merge"})
      {
        const Pattern named_file = Pattern::compile("\\b" + statement + R"re(\s*"([^"\n]*)")re");
        for (Matches match(here.begin(), here.end(), named_file), end; match != end; ++match)
          {
            const std::string name  = (*match)[1];
            const fs::path    other = (fs::path(file).parent_path() / name).lexically_normal();
            std::error_code   ignored;
            if (name.empty() || !fs::is_regular_file(other, ignored))
              continue;
            if (statement == "Include" || is_script(other.string()))
              read(other.string());
            else
              merged.push_back(other.string());
          }
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
        const std::string &text     = part.text;
        const auto         for_each = [&text](const Pattern &pattern, const auto &action) {
          for (Matches match(text.begin(), text.end(), pattern), end; match != end; ++match)
            action(*match, match->position() + match->length());
        };
        for_each(Pattern::compile(R"re(\bDefineConstant\b\s*)re"), [&](const Match &, const std::size_t end) {
          for (const std::string &item : items(inside_brackets(text, end)))
            if (const auto variable = constant(item))
              add(*variable);
        });
        for_each(Pattern::compile(R"re(\b([A-Za-z_]\w*)\s*=\s*DefineNumber\b)re"), [&](const Match &match, const std::size_t end) {
          const auto options = items(inside_brackets(text, text.find_first_of("[(", end)));
          if (const std::string onelab = onelab_name(options); !onelab.empty())
            add({match[1], options[0], onelab});
        });
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
          for (const std::string &sought : words)
            if (regex_search(single_spaced(line), word(sought)))
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
