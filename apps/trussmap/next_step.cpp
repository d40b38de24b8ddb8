// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "next_step.hpp"

#include "call_again.hpp"

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/ranges.h>

namespace trussmap::app {
namespace {

const std::map<std::string_view, std::string> kOutput{
    {"build", "map.graphml"}, {"discover", "found.toml"}, {"fit", "fitted.toml"}};

bool takes_parts_of_recordings(std::string_view command) {
  return command != "build" && command != "check";
}

}  // namespace

Page with_next(const Page& page, const std::optional<NextCommand>& next,
               const ModelRecordingsOptions& input, const std::string& model) {
  if (!next) return page;
  std::vector<std::string> words{std::string(next->command)};
  words.insert(words.end(), input.recordings.begin(), input.recordings.end());
  const auto add = [&words](const std::string& option, const std::string& value) {
    if (value.empty()) return;
    words.push_back(option);
    words.push_back(value);
  };
  add("--model", model);
  if (takes_parts_of_recordings(next->command)) {
    add("--without", fmt::format("{}", fmt::join(input.without, ",")));
    add("--exclude", fmt::format("{}", fmt::join(input.exclude, ",")));
  }
  if (!next->options.empty()) words.emplace_back(next->options);
  const auto output = kOutput.find(next->command);
  if (output != kOutput.end()) add("--out", output->second);
  return with_next_step(page, {call_of(words), std::string(next->what_for)});
}

}  // namespace trussmap::app
