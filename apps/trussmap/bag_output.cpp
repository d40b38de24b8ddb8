// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "bag_output.hpp"

#include <cmath>

#include <fmt/format.h>

namespace trussmap::app {

void add_epoch(const Command& command, std::optional<double>& epoch, const std::string& note) {
  command.add_option("--epoch", epoch, note + "Unix time of t = 0 [s], 0 if left out")
      .type_name("S");
}

std::optional<std::int64_t> epoch_of(const std::optional<double>& seconds) {
  if (!seconds) return std::nullopt;
  constexpr double kEndOfStamps = 2147483648.0;  // s: ROS counts them in 32 bits
  if (!(*seconds >= 0.0 && *seconds < kEndOfStamps)) {
    throw UsageError(fmt::format("--epoch: {} s is none of ROS, expected 1970 to 2038", *seconds));
  }
  const double whole = std::floor(*seconds);
  return static_cast<std::int64_t>(whole) * 1000000000 + std::llround((*seconds - whole) * 1e9);
}

void print_bag(const Bag& bag) {
  for (const Bag::Topic& one : bag.topics) {
    fmt::print("  {:>7} {} ({})\n", one.messages, one.name, one.type);
  }
  for (const Bag::LeftOut& one : bag.left_out) {
    fmt::print("  {:>7} {} left out: a bag has no message for them\n", one.count, one.what);
  }
  print_epoch(bag.epoch);
}

void print_epoch(std::int64_t epoch) {
  if (epoch == 0) return;
  constexpr std::int64_t kSecond = 1000000000;
  fmt::print("in the bag t = 0 is {}.{:09} s, Unix time\n", epoch / kSecond, epoch % kSecond);
}

}  // namespace trussmap::app
