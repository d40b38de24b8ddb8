// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/tour_experiment.hpp"

#include <charconv>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace trussmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kKind = "trussmap_shard";
constexpr int kVersion = 1;

int whole_number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : 0;
}

ShardResults results_of(const Json& file) {
  ShardResults found;
  found.program = file.at("program").get<std::string>();
  found.settings = file.at("settings").dump();
  found.shard = parse_shard(file.at("shard").get<std::string>());
  found.trials = file.at("trials").get<std::size_t>();
  for (const auto& [trial, result] : file.at("results").items()) {
    const int number = whole_number(trial);
    if (number < 0 || (number == 0 && trial != "0")) {
      throw std::invalid_argument(fmt::format("\"{}\" is no trial's number", trial));
    }
    found.results.emplace(static_cast<std::size_t>(number), result.dump());
  }
  return found;
}

/// Exactly the trials of the share.
void require_its_trials(const ShardResults& one, const std::string& name) {
  std::size_t expected = 0;
  for (std::size_t trial = 0; trial < one.trials; ++trial) {
    if (!one.shard.has(trial)) continue;
    ++expected;
    if (!one.results.contains(trial)) {
      throw InputError(name, 0,
                       fmt::format("lacks trial {}, expected all trials of shard {}/{}", trial,
                                   one.shard.number, one.shard.of));
    }
  }
  if (one.results.size() != expected) {
    throw InputError(name, 0, "has trials of other shards, expected its own alone");
  }
}

void require_same_run(const std::pair<std::string, ShardResults>& first,
                      const std::pair<std::string, ShardResults>& other) {
  const auto differ = [&](const std::string& what) {
    throw InputError(other.first, 0,
                     fmt::format("is of another run than {}: {} differ, expected shards of one run",
                                 first.first, what));
  };
  if (other.second.program != first.second.program) differ("the programs");
  if (other.second.shard.of != first.second.shard.of) differ("the numbers of shards");
  if (other.second.settings != first.second.settings) differ("the settings");
  if (other.second.trials != first.second.trials) differ("the numbers of trials");
}

}  // namespace

Shard parse_shard(std::string_view text) {
  const std::size_t slash = text.find('/');
  Shard shard{0, 0};
  if (slash != std::string_view::npos) {
    shard = {whole_number(text.substr(0, slash)), whole_number(text.substr(slash + 1))};
  }
  if (shard.number < 1 || shard.number > shard.of) {
    throw std::invalid_argument(
        fmt::format("\"{}\" is no share, expected one like 3/16: the third of sixteen", text));
  }
  return shard;
}

std::string format_shard(const ShardResults& results) {
  Json trials = Json::object();
  for (const auto& [trial, result] : results.results) {
    trials[std::to_string(trial)] = Json::parse(result);
  }
  const Json file{{kKind, kVersion},
                  {"program", results.program},
                  {"settings", Json::parse(results.settings)},
                  {"shard", fmt::format("{}/{}", results.shard.number, results.shard.of)},
                  {"trials", results.trials},
                  {"results", trials}};
  return file.dump(1) + "\n";
}

ShardResults parse_shard_results(std::string_view text, const std::string& name) {
  const Json file = Json::parse(text, nullptr, false);
  if (!file.is_object() || !file.contains(kKind)) {
    throw InputError(name, 0, "is no shard, expected a file that --shard has written");
  }
  try {
    if (file.at(kKind) != kVersion) throw std::invalid_argument("it is of another version");
    ShardResults found = results_of(file);
    require_its_trials(found, name);
    return found;
  } catch (const nlohmann::json::exception&) {
    throw InputError(name, 0, "is a damaged shard: a value is missing or of a wrong kind");
  } catch (const std::invalid_argument& error) {
    throw InputError(name, 0, fmt::format("is a damaged shard: {}", error.what()));
  }
}

ShardResults merge_shards(const std::vector<std::pair<std::string, ShardResults>>& shares) {
  if (shares.empty()) throw std::invalid_argument("there is nothing to merge");
  std::map<int, std::string> seen;
  std::vector<std::string> doubled;
  ShardResults whole = shares.front().second;
  for (const auto& share : shares) {
    require_same_run(shares.front(), share);
    const auto [place, fresh] = seen.emplace(share.second.shard.number, share.first);
    if (!fresh) {
      doubled.push_back(
          fmt::format("shard {} ({} and {})", place->first, place->second, share.first));
    }
    whole.results.insert(share.second.results.begin(), share.second.results.end());
  }
  if (!doubled.empty()) {
    throw InputError(shares.front().first, 0,
                     fmt::format("there twice: {}, expected each of the {} once",
                                 fmt::join(doubled, ", "), whole.shard.of));
  }
  std::vector<int> missing;
  for (int number = 1; number <= whole.shard.of; ++number) {
    if (!seen.contains(number)) missing.push_back(number);
  }
  if (!missing.empty()) {
    throw InputError(shares.front().first, 0,
                     fmt::format("the run has {} shards, missing: {}", whole.shard.of,
                                 fmt::join(missing, ", ")));
  }
  whole.shard = {};
  return whole;
}

}  // namespace trussmap
