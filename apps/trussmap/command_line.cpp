// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "command_line.hpp"

#include "path_checks.hpp"

#include <cmath>
#include <utility>

#include <CLI/CLI.hpp>

namespace trussmap::app {
namespace {

Check check_of(const CLI::Validator& validator) {
  return {[validator](std::string& text) { return validator(text); }, validator.get_description()};
}

/// No option means a number without a size, and comparisons with one are all false.
const CLI::Validator& finite() {
  static const CLI::Validator validator(
      [](std::string& text) {
        double value = 0.0;
        return CLI::detail::lexical_cast(text, value) && !std::isfinite(value)
                   ? "'" + text + "' is not a finite number"
                   : std::string();
      },
      "");
  return validator;
}

}  // namespace

Check between(double low, double high) {
  return check_of(CLI::Range(low, high));
}

Check one_of(const std::vector<std::string>& words) {
  return check_of(CLI::IsMember(words));
}

Option Option::required() const {
  option_->required();
  return *this;
}

Option Option::type_name(const std::string& name) const {
  option_->type_name(name);
  return *this;
}

Option Option::check(const Check& check) const {
  option_->check(CLI::Validator(check.fault, check.shown));
  return *this;
}

Option Option::capture_default_str() const {
  option_->capture_default_str();
  return *this;
}

Option Option::delimiter(char between) const {
  option_->delimiter(between);
  return *this;
}

Option Option::expected(int count) const {
  option_->expected(count);
  return *this;
}

Option Option::group(const std::string& name) const {
  option_->group(name);
  return *this;
}

Option Option::excludes(const std::string& other) const {
  option_->excludes(other);
  return *this;
}

Option Option::one_value_each() const {
  option_->allow_extra_args(false);
  return *this;
}

Command Command::add_subcommand(const std::string& name, const std::string& description) const {
  return Command(app_->add_subcommand(name, description));
}

Option Command::add_option(const std::string& name, std::string& value,
                           const std::string& description) const {
  return Option(app_->add_option(name, value, description));
}

Option Command::add_option(const std::string& name, double& value,
                           const std::string& description) const {
  return Option(app_->add_option(name, value, description)->check(finite()));
}

Option Command::add_option(const std::string& name, std::optional<double>& value,
                           const std::string& description) const {
  return Option(app_->add_option(name, value, description)->check(finite()));
}

Option Command::add_option(const std::string& name, std::optional<std::string>& value,
                           const std::string& description) const {
  return Option(app_->add_option(name, value, description));
}

Option Command::add_option(const std::string& name, int& value,
                           const std::string& description) const {
  return Option(app_->add_option(name, value, description));
}

Option Command::add_option(const std::string& name, std::uint64_t& value,
                           const std::string& description) const {
  return Option(app_->add_option(name, value, description));
}

Option Command::add_option(const std::string& name, std::vector<double>& values,
                           const std::string& description) const {
  return Option(app_->add_option(name, values, description)->check(finite()));
}

Option Command::add_option(const std::string& name, std::vector<std::string>& values,
                           const std::string& description) const {
  return Option(app_->add_option(name, values, description));
}

Option Command::add_flag(const std::string& name, bool& value,
                         const std::string& description) const {
  return Option(app_->add_flag(name, value, description));
}

void Command::footer(const std::string& text) const {
  app_->footer(text);
}

void Command::callback(std::function<void()> run) const {
  app_->callback([app = app_, run = std::move(run)] {
    check_paths(*app);
    run();
  });
}

std::size_t Command::count(const std::string& name) const {
  return app_->count(name);
}

std::string Command::given_of_group(const std::string& start) const {
  for (const CLI::Option* option : std::as_const(*app_).get_options()) {
    if (option->get_group().starts_with(start) && option->count() > 0) return option->get_name();
  }
  return "";
}

}  // namespace trussmap::app
