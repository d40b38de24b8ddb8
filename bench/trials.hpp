// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The trials of a bench, one after the other: all of them, those of a share, or all out of the
// files of shares (trussmap/tour_experiment.hpp). What a trial comes to is JSON; a part of the
// bench sums it up.
//
//   said   what --verbose tells of the trial, part of what it comes to
#pragma once

#include "trussmap/tour_experiment.hpp"
#include "trussmap/write_files.hpp"

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace trussmap::bench {

using Outcome = nlohmann::json;

class Trials {
 public:
  explicit Trials(const std::string& program) { results_.program = program; }

  /// Does the trials of a share alone.
  void take_share(const Shard& shard) {
    results_.shard = shard;
    sharing_ = true;
  }
  /// Does none: they are in these files. The settings with which they were made.
  std::string take_results(const std::vector<std::string>& files) {
    std::vector<std::pair<std::string, ShardResults>> shares;
    for (const std::string& file : files) {
      shares.emplace_back(file, parse_shard_results(read_file(file), file));
    }
    const std::string program = results_.program;
    results_ = merge_shards(shares);
    if (results_.program != program) {
      throw InputError(
          files.front(), 0,
          fmt::format("is a shard of {}, expected one of {}", results_.program, program));
    }
    known_ = true;
    return results_.settings;
  }

  /// What the next trial came to; none where another share has it.
  std::optional<Outcome> next(const std::function<Outcome()>& work) {
    const std::size_t trial = done_++;
    if (sharing_ && !results_.shard.has(trial)) return std::nullopt;
    Outcome outcome = known_ ? Outcome::parse(results_.results.at(trial)) : work();
    if (sharing_) {
      results_.results.emplace(trial, outcome.dump());
    } else {
      fmt::print("{}", outcome.value("said", ""));
    }
    return outcome;
  }

  /// False where sums would lack what other shares do.
  [[nodiscard]] bool whole() const { return !sharing_; }

  void write(const std::string& settings, const std::string& file) {
    results_.settings = settings;
    results_.trials = done_;
    write_file(file, format_shard(results_));
    fmt::print("shard {}/{}: {} of {} trials, in {}\n", results_.shard.number, results_.shard.of,
               results_.results.size(), done_, file);
  }

 private:
  ShardResults results_;
  std::size_t done_ = 0;
  bool sharing_ = false;
  bool known_ = false;
};

}  // namespace trussmap::bench
