// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/command_line.h>
#include <squeal/base/exceptions.h>

#include <boost/algorithm/string/predicate.hpp>

#include <map>

namespace Squeal
{
  namespace
  {
    [[noreturn]] void refuse(const std::string &what,
                             const std::string &word,
                             const std::string &change = "squeal --help lists the options")
    {
      throw ParameterError(what, "command line, `" + word + "`", change);
    }
  } // namespace

  CommandLine parse_command_line(const std::vector<std::string> &words)
  {
    CommandLine                                             line;
    const std::map<std::string, bool *>                     switches = {{"--dry-run", &line.dry_run},
                                                                        {"--print-parameters", &line.print_parameters},
                                                                        {"--version", &line.version},
                                                                        {"--help", &line.help},
                                                                        {"-h", &line.help}};
    std::vector<std::string>                                outputs, designs, files;
    const std::map<std::string, std::vector<std::string> *> with_value = {{"--set", &line.overrides},
                                                                          {"--output", &outputs},
                                                                          {"--designs", &designs}};

    bool options_end = false;
    for (std::size_t i = 0; i < words.size(); ++i)
      {
        const std::string &word = words[i];
        if (options_end || !boost::starts_with(word, "-"))
          {
            files.push_back(word);
            continue;
          }
        if (word == "--")
          {
            options_end = true;
            continue;
          }
        const std::size_t equals = word.find('=');
        const std::string name   = word.substr(0, equals);
        if (const auto found = switches.find(name); found != switches.end())
          {
            if (equals != std::string::npos)
              refuse("this option takes no value", word, "write " + name);
            *found->second = true;
          }
        else if (const auto option = with_value.find(name); option != with_value.end())
          {
            if (equals != std::string::npos)
              option->second->push_back(word.substr(equals + 1));
            else if (i + 1 < words.size() && !boost::starts_with(words[i + 1], "--"))
              option->second->push_back(words[++i]);
            else
              refuse("this option requires a value", word, "write " + name + "=VALUE");
          }
        else
          refuse("unknown option", word, "squeal --help lists the options; write ./NAME for a file whose name begins with `-`");
      }
    if (files.size() > 1)
      refuse("more than one parameter file", files[1], "give only one; scripts/run.sh runs several files in sequence");
    if (outputs.size() > 1)
      refuse("more than one result folder", outputs[1], "give --output once");
    if (designs.size() > 1)
      refuse("more than one list of designs", designs[1], "give --designs once, for example --designs 3,7-9");
    if (!files.empty())
      line.parameter_file = files.front();
    if (!outputs.empty())
      line.output = outputs.front();
    if (!designs.empty())
      line.designs = designs.front();
    return line;
  }
} // namespace Squeal
