// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// CLI11, compiled once: whatever includes it costs five seconds of a build. Commands describe their
// options by these handles, whose calls are CLI11's of the same names.
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace trussmap::app {

/// Thrown by a command that has done its work, and has to say no by exit status 1.
class AnswerIsNo : public std::exception {};

/// Thrown in each process of several, when one of them has said what went wrong: the exit status
/// alone.
class AlreadySaid : public std::exception {
 public:
  explicit AlreadySaid(int status) : status_(status) {}
  [[nodiscard]] int status() const { return status_; }

 private:
  int status_;
};

/// Options that fit each other badly, or a value out of range: one line, status 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What is wrong with an option's value, in plain words, "" where nothing is.
struct Check {
  std::function<std::string(std::string&)> fault;
  std::string shown;  ///< in help: "{exact,formulas}"
};

/// A number from `low` to `high`.
[[nodiscard]] Check between(double low, double high);
/// One of these words.
[[nodiscard]] Check one_of(const std::vector<std::string>& words);

class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  // What an option of a command is; each returns it.
  Option required() const;
  Option type_name(const std::string& name) const;
  Option check(const Check& check) const;
  Option capture_default_str() const;  ///< help shows the value as it is now
  Option delimiter(char between) const;
  Option expected(int count) const;
  Option group(const std::string& name) const;
  Option excludes(const std::string& other) const;
  Option one_value_each() const;  ///< repeated for more, so that arguments may follow

 private:
  CLI::Option* option_;
};

class Command {
 public:
  explicit Command(CLI::App* app) : app_(app) {}

  [[nodiscard]] Command add_subcommand(const std::string& name,
                                       const std::string& description) const;
  Option add_option(const std::string& name, std::string& value,
                    const std::string& description) const;
  Option add_option(const std::string& name, double& value, const std::string& description) const;
  Option add_option(const std::string& name, std::optional<double>& value,
                    const std::string& description) const;
  Option add_option(const std::string& name, std::optional<std::string>& value,
                    const std::string& description) const;
  Option add_option(const std::string& name, int& value, const std::string& description) const;
  Option add_option(const std::string& name, std::uint64_t& value,
                    const std::string& description) const;
  Option add_option(const std::string& name, std::vector<double>& values,
                    const std::string& description) const;
  Option add_option(const std::string& name, std::vector<std::string>& values,
                    const std::string& description) const;
  Option add_flag(const std::string& name, bool& value, const std::string& description) const;
  void footer(const std::string& text) const;
  void callback(std::function<void()> run) const;

  /// How often it was given.
  [[nodiscard]] std::size_t count(const std::string& name) const;
  /// The first option that was given of the groups whose names begin so, "" if none was.
  [[nodiscard]] std::string given_of_group(const std::string& start) const;

 private:
  CLI::App* app_;
};

}  // namespace trussmap::app
