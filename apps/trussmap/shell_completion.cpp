// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Scripts that complete commands, options and the words that options take; paths otherwise. Every
// level of commands is one place in the command line.
#include "command_words.hpp"

#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace trussmap::app {
namespace {

/// Every command with the words before its own: "fleet add".
using Visit = std::function<void(const std::string& words, const CommandWords& command)>;

void visit_commands(const CommandWords& command, const std::string& words, const Visit& visit) {
  visit(words, command);
  for (const CommandWords& one : command.commands) {
    visit_commands(one, words.empty() ? one.name : words + " " + one.name, visit);
  }
}

std::vector<std::string> command_names(const CommandWords& command) {
  std::vector<std::string> names;
  for (const CommandWords& one : command.commands) names.push_back(one.name);
  return names;
}

std::vector<std::string> option_names(const CommandWords& command) {
  std::vector<std::string> names;
  for (const OptionWords& option : command.options) {
    if (!option.is_argument) names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return names;
}

/// Between single quotes.
std::string in_quotes(const std::string& text) {
  std::string result = "'";
  for (const char one : text) result += one == '\'' ? std::string("'\\''") : std::string(1, one);
  return result + "'";
}

/// As zsh's _arguments takes a description.
std::string described(const std::string& text) {
  std::string result;
  for (const char one : text) {
    if (one == '[' || one == ']' || one == ':' || one == '\\') result += '\\';
    result += one == '\n' ? ' ' : one;
  }
  return result;
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

}  // namespace

std::string bash_completion(const CommandWords& whole) {
  std::string choices, words, names;
  visit_commands(whole, "", [&](const std::string& path, const CommandWords& command) {
    std::vector<std::string> next = command_names(command);  // or the words of an argument
    for (const OptionWords& option : command.options) {
      if (option.choices.empty()) continue;
      if (option.is_argument) next.insert(next.end(), option.choices.begin(), option.choices.end());
      if (option.is_argument) continue;
      for (const std::string& name : option.names) {
        choices += fmt::format("    {}) words={} ;;\n", in_quotes(fmt::format("{} {}", path, name)),
                               in_quotes(fmt::format("{}", fmt::join(option.choices, " "))));
      }
    }
    words += fmt::format("    {}) options={} commands={} ;;\n", in_quotes(path),
                         in_quotes(fmt::format("{}", fmt::join(option_names(command), " "))),
                         in_quotes(fmt::format("{}", fmt::join(next, " "))));
    if (!path.empty()) names += (names.empty() ? "" : "|") + in_quotes(path);
  });
  return fmt::format(
      "# Completion of {0} for bash: source it, or put it where bash-completion looks.\n"
      "_{0}() {{\n"
      "  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}}\n"
      "  local path='' place=1 further words='' options='' commands=''\n"
      "  while [ \"$place\" -lt \"$COMP_CWORD\" ]; do\n"
      "    further=\"${{path:+$path }}${{COMP_WORDS[place]}}\"\n"
      "    case \"$further\" in\n"
      "    {1}) path=$further ;;\n"
      "    *) break ;;\n"
      "    esac\n"
      "    place=$((place + 1))\n"
      "  done\n"
      "  case \"$path $before\" in\n{2}  esac\n"
      "  case \"$path\" in\n{3}  esac\n"
      "  if [ -n \"$words\" ]; then\n"
      "    COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
      "  elif [ \"${{current#-}}\" != \"$current\" ]; then\n"
      "    COMPREPLY=($(compgen -W \"$options\" -- \"$current\"))\n"
      "  elif [ -n \"$commands\" ] && [ \"$place\" -eq \"$COMP_CWORD\" ]; then\n"
      "    COMPREPLY=($(compgen -W \"$commands\" -- \"$current\"))\n"
      "  else\n"
      "    COMPREPLY=($(compgen -f -- \"$current\"))\n"
      "  fi\n"
      "}}\n"
      "complete -o filenames -F _{0} {0}\n",
      whole.name, names, choices, words);
}

std::string zsh_completion(const CommandWords& whole) {
  std::string functions;
  visit_commands(whole, "", [&](const std::string& path, const CommandWords& command) {
    std::string function = "_" + whole.name;
    for (const char one : path.empty() ? path : " " + path) function += one == ' ' ? '_' : one;
    std::string arguments, last = ":file:_files";
    for (const OptionWords& option : command.options) {
      if (option.is_argument && !option.choices.empty()) {
        last = fmt::format(":word:({})", fmt::join(option.choices, " "));
      }
      if (option.is_argument) continue;
      const std::string value = option.value.empty() ? std::string()
                                : option.choices.empty()
                                    ? ":" + described(option.value) + ":_files"
                                    : fmt::format(":word:({})", fmt::join(option.choices, " "));
      for (const std::string& name : option.names) {
        arguments += " \\\n    " + in_quotes(fmt::format("*{}[{}]{}", name,
                                                         described(option.description), value));
      }
    }
    if (command.commands.empty()) {
      functions +=
          fmt::format("{}() {{\n  _arguments{} \\\n    '*{}'\n}}\n\n", function, arguments, last);
      return;
    }
    std::string names, calls;
    for (const CommandWords& one : command.commands) {
      names += " " + in_quotes(one.name + ":" + first_line(one.description));
      calls += fmt::format("      {0}) {1}_{0} ;;\n", one.name, function);
    }
    functions += fmt::format(
        "{}() {{\n  local state line\n  _arguments -C{} \\\n    '1:command:->command' '*::argument:"
        "->argument'\n"
        "  case $state in\n"
        "    command) local -a names; names=({} ); _describe command names ;;\n"
        "    argument) case $line[1] in\n{}      esac ;;\n  esac\n}}\n\n",
        function, arguments, names, calls);
  });
  return fmt::format("#compdef {0}\n# Completion of {0} for zsh.\n\n{1}_{0} \"$@\"\n", whole.name,
                     functions);
}

std::string fish_completion(const CommandWords& whole) {
  std::string text = fmt::format("# Completion of {} for fish.\n", whole.name);
  visit_commands(whole, "", [&](const std::string& path, const CommandWords& command) {
    const std::string names = fmt::format("{}", fmt::join(command_names(command), " "));
    std::string seen;  // where in the command line one is
    std::size_t begin = 0;
    while (begin < path.size()) {
      const std::size_t end = std::min(path.find(' ', begin), path.size());
      seen += (seen.empty() ? "" : "; and ") +
              fmt::format("__fish_seen_subcommand_from {}", path.substr(begin, end - begin));
      begin = end + 1;
    }
    const std::string here = seen.empty() ? std::string() : " -n " + in_quotes(seen);
    for (const CommandWords& one : command.commands) {
      const std::string open = fmt::format("{}{}not __fish_seen_subcommand_from {}", seen,
                                           seen.empty() ? "" : "; and ", names);
      text += fmt::format("complete -c {} -f -n {} -a {} -d {}\n", whole.name, in_quotes(open),
                          one.name, in_quotes(first_line(one.description)));
    }
    for (const OptionWords& option : command.options) {
      std::string line = "complete -c " + whole.name + here;
      if (option.is_argument) {
        if (option.choices.empty()) continue;
        text +=
            line + " -f -a " + in_quotes(fmt::format("{}", fmt::join(option.choices, " "))) + "\n";
        continue;
      }
      for (const std::string& name : option.names) {
        line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      }
      if (!option.choices.empty()) {
        line += " -x -a " + in_quotes(fmt::format("{}", fmt::join(option.choices, " ")));
      } else if (!option.value.empty()) {
        line += " -r";
      }
      text += line + " -d " + in_quotes(first_line(option.description)) + "\n";
    }
  });
  return text;
}

}  // namespace trussmap::app
