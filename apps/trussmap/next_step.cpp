// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "next_step.hpp"

#include "call_again.hpp"

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace trussmap::app {
namespace {

const std::map<std::string_view, std::string> kOutput{
    {"build", "map.graphml"}, {"discover", "found.toml"}, {"fit", "fitted.toml"}};

class Words {
 public:
  explicit Words(std::string_view command) : words_{std::string(command)} {}

  void add(const std::string& word) {
    if (!word.empty()) words_.push_back(word);
  }
  void add(const char* option, const std::string& value) {
    if (value.empty()) return;
    words_.insert(words_.end(), {option, value});
  }
  /// Where it is not as it is without being given.
  void add(const char* option, double value, double usual) {
    if (value != usual) add(option, fmt::format("{}", value));
  }
  [[nodiscard]] std::string line() const { return call_of(words_); }

 private:
  std::vector<std::string> words_;
};

/// How the recordings are used, as far as it was said.
void add_use(Words& words, std::string_view command, const ModelRecordingsOptions& input) {
  if (command == "build" || command == "check") return;
  const LegOptions usual;
  words.add("--without", fmt::format("{}", fmt::join(input.without, ",")));
  words.add("--exclude", fmt::format("{}", fmt::join(input.exclude, ",")));
  words.add("--gate", input.gate, kModelGate);
  if (input.every) words.add("--every", fmt::format("{}", *input.every));
  words.add("--level", input.level, kSignificance);
  words.add("--holdout", input.legs.share, usual.share);
  words.add("--min-drive", input.legs.min_drive, usual.min_drive);
  words.add("--leg", input.legs.leg, usual.leg);
  if (input.stated_noise && command != "fit") words.add("--stated-noise");
}

}  // namespace

std::optional<NextStep> next_step(const std::optional<NextCommand>& next,
                                  const ModelRecordingsOptions& input, const std::string& model) {
  if (!next) return std::nullopt;
  Words words(next->command);
  for (const std::string& one : input.recordings) words.add(one);
  words.add("--model", model);
  add_use(words, next->command, input);
  words.add(std::string(next->options));
  const auto output = kOutput.find(next->command);
  if (output != kOutput.end()) words.add("--out", output->second);
  return NextStep{words.line(), std::string(next->what_for)};
}

Page with_next(const Page& page, const std::optional<NextStep>& next) {
  return next ? with_next_step(page, *next) : page;
}

std::string next_text(const std::optional<NextStep>& next) {
  return next ? fmt::format("\nNext ({}):\n  {}\n", next->what_for, next->line) : "";
}

}  // namespace trussmap::app
