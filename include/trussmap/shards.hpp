// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A run of many independent trials, done in shares: by the tasks of a job array, each of which
// leaves a file with what its trials came to, and by a last one that merges the files.
//
// A share keeps every trial's result by the trial's number, and nothing that is summed up: sums are
// taken when all results are there, in the order of the numbers. So the whole run's figures are the
// same, bit for bit, whatever the number of shares.
#pragma once

#include "trussmap/error.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace trussmap {

/// Share `number` of `of`, from 1.
struct Shard {
  int number = 1;
  int of = 1;

  /// Trials, numbered from 0, are dealt out one after the other.
  [[nodiscard]] bool has(std::size_t trial) const {
    return trial % static_cast<std::size_t>(of) == static_cast<std::size_t>(number - 1);
  }
};

/// Of "3/16". Throws std::invalid_argument on anything else.
[[nodiscard]] Shard parse_shard(std::string_view text);

struct ShardResults {
  std::string program;   ///< who made it and can merge it
  std::string settings;  ///< JSON: all that the results depend on
  Shard shard;
  std::size_t trials = 0;                      ///< of the whole run
  std::map<std::size_t, std::string> results;  ///< JSON, by the trial's number
};

/// As a file (JSON).
[[nodiscard]] std::string format_shard(const ShardResults& results);

/// The file again. Throws InputError where it is none, or lacks trials of its share.
[[nodiscard]] ShardResults parse_shard_results(std::string_view text, const std::string& name);

/// The whole run, as shard 1/1, of all its shares, by the names of their files, in any order.
/// Throws InputError where they are not of one run, and where shares are missing or there twice,
/// all of which it names.
[[nodiscard]] ShardResults merge_shards(
    const std::vector<std::pair<std::string, ShardResults>>& shares);

}  // namespace trussmap
