// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "command_words.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

/// Text that roff takes as it is.
std::string plain(const std::string& text) {
  std::string result;
  for (const char one : text) {
    if (one == '\\') {
      result += "\\e";
    } else if (one == '-') {
      result += "\\-";
    } else if (one == '\'') {
      result += "\\(aq";
    } else {
      result += one;
    }
  }
  return result.starts_with('.') ? "\\&" + result : result;
}

/// Line by line, none of which roff takes for one of its own.
std::string plain_lines(const std::string& text) {
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) result += plain(line) + "\n";
  return result;
}

std::string joined_names(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + plain(name);
  return text;
}

std::string options_of(const CommandWords& command, bool arguments) {
  std::string text;
  for (const OptionWords& option : command.options) {
    if (option.is_argument != arguments) continue;
    text += fmt::format(".TP\n\\fB{}\\fR", joined_names(option.names));
    if (!arguments && !option.value.empty()) text += " " + plain(option.value);
    text += "\n" + plain_lines(option.description + "\n");
  }
  return text;
}

std::string sentence(std::string text) {
  while (text.ends_with('.')) text.pop_back();
  return text;
}

std::string page_of(const CommandWords& command, const std::string& words, const std::string& page,
                    const std::string& whole, const std::string& version) {
  std::string title = page;
  std::transform(title.begin(), title.end(), title.begin(),
                 [](unsigned char one) { return static_cast<char>(std::toupper(one)); });
  std::string text =
      fmt::format(".TH {} 1 \"\" \"trussmap {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n",
                  plain(title), version, plain(page), plain(sentence(command.description)));
  text += fmt::format(".SH SYNOPSIS\n.B {}\n{}\n", plain(words), plain(command.usage));
  if (!command.commands.empty()) {
    text += ".SH COMMANDS\n";
    for (const CommandWords& one : command.commands) {
      text += fmt::format(".TP\n.BR {}\\-{} (1)\n{}\n", plain(page), plain(one.name),
                          plain(sentence(one.description)));
    }
  }
  const std::string arguments = options_of(command, true);
  if (!arguments.empty()) text += ".SH ARGUMENTS\n" + arguments;
  text += ".SH OPTIONS\n" + options_of(command, false);
  if (!command.footer.empty()) {
    text += ".SH NOTES\n.nf\n" + plain_lines(command.footer) + ".fi\n";
  }
  text +=
      ".SH EXIT STATUS\n0: done. 1: the answer is no, or it failed. 2: something was wrong with "
      "the "
      "command or its input; nothing was written.\n";
  if (page != whole) text += fmt::format(".SH SEE ALSO\n.BR {} (1)\n", plain(whole));
  return text;
}

void add_pages(const CommandWords& command, const std::string& before, const std::string& whole,
               const std::string& version, std::vector<ManualPage>& pages) {
  const std::string words = before.empty() ? command.name : before + " " + command.name;
  std::string page = words;
  std::replace(page.begin(), page.end(), ' ', '-');
  pages.push_back({page + ".1", page_of(command, words, page, whole, version)});
  for (const CommandWords& one : command.commands) add_pages(one, words, whole, version, pages);
}

}  // namespace

std::vector<ManualPage> manual_pages(const CommandWords& whole, const std::string& version) {
  std::vector<ManualPage> pages;
  add_pages(whole, "", whole.name, version, pages);
  return pages;
}

}  // namespace trussmap::app
