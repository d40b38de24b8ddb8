// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A quantity over time out of a log, on its own clock, and what it comes to over any interval: so
// two streams get onto the same rows without a row that is repeated.
//
//   level        interpolated between samples
//   sums, rates  over (a, b]: cumulative sums are interpolated; what came per message, and rates,
//                are spread evenly over the time since the message before
//
// Times are in ns, exact; at the samples' own times the values are the samples' own.
#pragma once

#include "logs/log_map.hpp"

#include <cstdint>
#include <vector>

namespace trussmap::logs {

class Signal {
 public:
  explicit Signal(const SignalMap& map) : map_(map) {}

  /// In the order of the log. `row`: LogMessage::row.
  void add(std::int64_t t, double field, std::uint64_t row = 0) {
    t_.push_back(t);
    value_.push_back(field);
    if (map_.kind == SignalMap::Kind::per_row) row_.push_back(row);
  }

  /// After the last add: in order of time, unwrapped, in SI. Of equal times the last counts; of
  /// what comes per message their sum, without rows of a table that are there twice.
  void finish();

  [[nodiscard]] bool empty() const { return t_.empty(); }
  [[nodiscard]] std::size_t size() const { return t_.size(); }
  [[nodiscard]] const std::vector<std::int64_t>& times() const { return t_; }
  [[nodiscard]] const std::vector<double>& values() const { return value_; }
  [[nodiscard]] std::size_t unordered() const { return unordered_; }
  [[nodiscard]] std::size_t repeated() const { return repeated_; }
  [[nodiscard]] double typical_step() const;  ///< s, median; 0 of fewer than two

  /// What is added over (from, to], of kinds other than level: with both within the samples'
  /// times. Intervals must be asked for in order of time.
  [[nodiscard]] double sum(std::int64_t from, std::int64_t to);
  /// The level (or the sum so far) at a time within the samples', interpolated.
  [[nodiscard]] double level(std::int64_t t) const;
  /// The last value at or before a time; the first before the first.
  [[nodiscard]] double held(std::int64_t t) const;
  /// Whether there is a sample in (from, to].
  [[nodiscard]] bool has_sample(std::int64_t from, std::int64_t to) const;

 private:
  void sort();
  void join_equal_times();
  [[nodiscard]] bool repeats_rows() const;
  void hold_until_changes();
  void unwrap();

  SignalMap map_;
  std::vector<std::int64_t> t_;
  std::vector<double> value_;
  std::vector<std::uint64_t> row_;  ///< of what comes per message
  std::size_t unordered_ = 0;
  std::size_t repeated_ = 0;
  std::size_t at_ = 0;  ///< of sum: the first sample after the last interval's start
};

/// Median time between entries, s; 0 of fewer than two.
[[nodiscard]] double median_step(const std::vector<std::int64_t>& times);

}  // namespace trussmap::logs
