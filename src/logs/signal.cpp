// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/signal.hpp"

#include "logs/message_feed.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace trussmap::logs {
namespace {

constexpr double kNanosecond = 1e-9;  // s

double seconds(std::int64_t from, std::int64_t to) {
  return static_cast<double>(to - from) * kNanosecond;
}

}  // namespace

double median_step(const std::vector<std::int64_t>& times) {
  if (times.size() < 2) return 0.0;
  std::vector<std::int64_t> steps;
  steps.reserve(times.size());
  for (std::size_t k = 1; k < times.size(); ++k) steps.push_back(times[k] - times[k - 1]);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return static_cast<double>(*middle) * kNanosecond;
}

double Signal::typical_step() const {
  return median_step(t_);
}

void Signal::finish() {
  const std::int64_t clock = nanoseconds(map_.clock);
  for (std::int64_t& t : t_) t += clock;
  sort();
  join_equal_times();
  if (map_.on_change > 0.0) hold_until_changes();
  if (map_.wraps > 0.0 && map_.kind == SignalMap::Kind::cumulative) unwrap();
  for (double& one : value_) one = map_.scale * one + map_.offset;
}

void Signal::sort() {
  for (std::size_t k = 1; k < t_.size(); ++k) unordered_ += t_[k] < t_[k - 1] ? 1U : 0U;
  if (unordered_ == 0) return;
  std::vector<std::size_t> order(t_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [this](std::size_t a, std::size_t b) { return t_[a] < t_[b]; });
  const auto sorted = [&order](const auto& values) {
    auto result = values;
    for (std::size_t k = 0; k < values.size(); ++k) result[k] = values[order[k]];
    return result;
  };
  t_ = sorted(t_);
  value_ = sorted(value_);
  row_ = sorted(row_);
}

/// Whether rows that are the same, time and all, are one row written twice: not where the clock is
/// so coarse that different rows have the same time as often.
bool Signal::repeats_rows() const {
  std::size_t same = 0;
  std::size_t others = 0;
  for (std::size_t k = 1; k < row_.size(); ++k) {
    if (t_[k] != t_[k - 1] || row_[k] == 0) continue;
    ++(row_[k] == row_[k - 1] ? same : others);
  }
  return same > others;
}

void Signal::join_equal_times() {
  const bool adds = map_.kind == SignalMap::Kind::per_row;
  const bool once = adds && repeats_rows();
  std::size_t kept = 0;
  for (std::size_t k = 0; k < t_.size(); ++k) {
    if (kept > 0 && t_[k] == t_[kept - 1]) {
      ++repeated_;
      if (once && row_[k] == row_[k - 1]) continue;
      value_[kept - 1] = adds ? value_[kept - 1] + value_[k] : value_[k];
      continue;
    }
    t_[kept] = t_[k];
    value_[kept++] = value_[k];
  }
  t_.resize(kept);
  value_.resize(kept);
}

/// What is written only when it changes had its old value until a cycle before.
void Signal::hold_until_changes() {
  const auto cycle = static_cast<std::int64_t>(std::llround(map_.on_change / kNanosecond));
  const bool lasts =
      map_.kind == SignalMap::Kind::level || map_.kind == SignalMap::Kind::cumulative;
  std::vector<std::int64_t> t;
  std::vector<double> value;
  for (std::size_t k = 0; k < t_.size(); ++k) {
    if (k > 0 && t_[k] - t_[k - 1] > cycle + cycle / 2) {
      t.push_back(t_[k] - cycle);
      value.push_back(lasts || map_.kind == SignalMap::Kind::rate ? value_[k - 1] : 0.0);
    }
    t.push_back(t_[k]);
    value.push_back(value_[k]);
  }
  t_ = std::move(t);
  value_ = std::move(value);
}

void Signal::unwrap() {
  double begins = 0.0;
  for (std::size_t k = 1; k < value_.size(); ++k) {
    const double step = value_[k] + begins - value_[k - 1];
    begins -= map_.wraps * std::round(step / map_.wraps);
    value_[k] += begins;
  }
}

double Signal::level(std::int64_t t) const {
  const auto after = std::lower_bound(t_.begin(), t_.end(), t);
  if (after == t_.end()) return value_.back();
  const auto k = static_cast<std::size_t>(after - t_.begin());
  if (t_[k] == t || k == 0) return value_[k];
  const double share = seconds(t_[k - 1], t) / seconds(t_[k - 1], t_[k]);
  return value_[k - 1] + share * (value_[k] - value_[k - 1]);
}

double Signal::held(std::int64_t t) const {
  const auto after = std::upper_bound(t_.begin(), t_.end(), t);
  return after == t_.begin() ? value_.front()
                             : value_[static_cast<std::size_t>(after - t_.begin()) - 1];
}

bool Signal::has_sample(std::int64_t from, std::int64_t to) const {
  const auto after = std::upper_bound(t_.begin(), t_.end(), from);
  return after != t_.end() && *after <= to;
}

double Signal::sum(std::int64_t from, std::int64_t to) {
  if (map_.kind == SignalMap::Kind::cumulative) return level(to) - level(from);
  while (at_ > 0 && t_[at_ - 1] > from) --at_;
  while (at_ < t_.size() && t_[at_] <= from) ++at_;
  double total = 0.0;
  for (std::size_t k = std::max<std::size_t>(at_, 1); k < t_.size(); ++k) {
    const std::int64_t begin = std::max(from, t_[k - 1]);
    const std::int64_t end = std::min(to, t_[k]);
    if (end > begin) {
      const bool whole = begin == t_[k - 1] && end == t_[k];
      if (map_.kind == SignalMap::Kind::rate) {
        total += value_[k] * seconds(begin, end);
      } else {
        total += whole ? value_[k] : value_[k] * seconds(begin, end) / seconds(t_[k - 1], t_[k]);
      }
    }
    if (t_[k] >= to) break;
  }
  return total;
}

}  // namespace trussmap::logs
