// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "command_words.hpp"

#include "help.hpp"

#include <CLI/CLI.hpp>

namespace trussmap::app {
namespace {

/// a and b of "{a,b}" and "{a,b},...".
std::vector<std::string> choices_in(const std::string& value) {
  std::vector<std::string> choices;
  const std::size_t end = value.find('}');
  if (!value.starts_with('{') || end == std::string::npos) return choices;
  std::string word;
  for (const char one : value.substr(1, end - 1)) {
    if (one == ',') {
      choices.push_back(std::move(word));
      word.clear();
    } else {
      word += one;
    }
  }
  choices.push_back(std::move(word));
  return choices;
}

OptionWords words_of(const CLI::Option& option) {
  OptionWords words;
  words.is_argument = option.get_positional();
  if (words.is_argument) {
    words.names.push_back(option.get_name(true));
  } else {
    for (const std::string& name : option.get_snames()) words.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) words.names.push_back("--" + name);
  }
  if (option.get_type_size() != 0) {
    words.value = spelled_value(option);
    words.choices = choices_in(words.value);
  }
  words.description = option.get_description();
  return words;
}

std::string usage_of(const CLI::App& app, bool commands) {
  std::string text;
  const auto add = [&text](const std::string& word) { text += (text.empty() ? "" : " ") + word; };
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional()) continue;
    const bool many = option->get_expected_max() == CLI::detail::expected_max_vector_size;
    const std::string name = option->get_name(true) + (many ? "..." : "");
    add(option->get_required() ? name : "[" + name + "]");
  }
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional() || !option->get_required()) continue;
    add(option->get_name() + " " + spelled_value(*option));
  }
  if (commands) add("COMMAND");
  add("[OPTIONS]");
  return text;
}

}  // namespace

CommandWords words_of(const CLI::App& app) {
  CommandWords words;
  words.name = app.get_name();
  words.description = app.get_description();
  words.footer = app.get_footer();
  for (const CLI::Option* option : app.get_options()) words.options.push_back(words_of(*option));
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    words.commands.push_back(words_of(*command));
  }
  words.usage = usage_of(app, !words.commands.empty());
  return words;
}

}  // namespace trussmap::app
