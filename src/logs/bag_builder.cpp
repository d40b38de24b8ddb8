// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/bag_builder.hpp"

#include "logs/calendar.hpp"
#include "logs/mcap_write.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace trussmap::logs {
namespace {

// Seconds of a ROS time are an int32.
constexpr std::int64_t kLastSecond = std::numeric_limits<std::int32_t>::max();

/// ns, to the nearest; whole seconds apart, so that nothing of a Unix time is lost.
std::int64_t ros_nanoseconds(double t) {
  const double whole = std::floor(t);
  return static_cast<std::int64_t>(whole) * kNanosecondsPerSecond + std::llround((t - whole) * 1e9);
}

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

}  // namespace

std::string topic_token(const std::string& name) {
  std::string token;
  for (const char c : name) {
    if (is_letter_or_digit(c)) {
      token += c;
    } else if (!token.empty() && token.back() != '_') {
      token += '_';
    }
  }
  while (!token.empty() && token.back() == '_') token.pop_back();
  if (token.empty()) return "landmark";
  return token.front() >= '0' && token.front() <= '9' ? "landmark_" + token : token;
}

BagBuilder::BagBuilder(const std::string& name, const BagOptions& options, double first)
    : name_(name) {
  bag_.epoch = options.epoch.value_or(0);
  const bool usable = std::abs(first) < static_cast<double>(kLastSecond);
  if (!options.epoch && usable && first < 0.0) {
    bag_.epoch = static_cast<std::int64_t>(std::ceil(-first)) * kNanosecondsPerSecond;
  }
}

std::int64_t BagBuilder::stamp(double t) const {
  const auto refuse = [&] {
    throw InputError(name_, 0,
                     "the time " + std::to_string(t) + " s, with " +
                         std::to_string(bag_.epoch / kNanosecondsPerSecond) +
                         " s as t = 0, is none of ROS, expected 1970 to 2038");
  };
  if (!(std::abs(t) <= static_cast<double>(kLastSecond) + 1.0)) refuse();
  const std::int64_t ns = ros_nanoseconds(t);
  const std::int64_t last = (kLastSecond + 1) * kNanosecondsPerSecond - 1;
  if (ns < -bag_.epoch || ns > last - bag_.epoch) refuse();
  return ns + bag_.epoch;
}

void BagBuilder::add(const std::string& topic, const char* type, double t, std::string data) {
  const auto [at, added] = numbers_.try_emplace(topic, bag_.topics.size());
  if (added) {
    if (at->second > std::numeric_limits<std::uint16_t>::max()) {
      throw InputError(name_, 0, "has more than 65536 topics for a bag, such as " + topic);
    }
    bag_.topics.push_back({topic, type});
  }
  ++bag_.topics[at->second].messages;
  messages_.push_back({stamp(t), at->second, std::move(data)});
}

std::string BagBuilder::topic_below(const std::string& folder, const std::string& name) {
  const std::string plain = folder + "/" + topic_token(name);
  std::string topic = plain;
  for (int number = 2;; ++number) {
    const auto [at, added] = below_.try_emplace(topic, name);
    if (added || at->second == name) return topic;
    topic = plain + "_" + std::to_string(number);
  }
}

void BagBuilder::leave_out(std::size_t count, const std::string& what) {
  if (count > 0) bag_.left_out.push_back({count, what});
}

Bag BagBuilder::finish() {
  std::stable_sort(messages_.begin(), messages_.end(),
                   [](const Message& a, const Message& b) { return a.time < b.time; });
  McapWriter writer;
  for (const Bag::Topic& one : bag_.topics) {
    static_cast<void>(writer.add_channel(one.name, one.type, ros_definition(one.type)));
  }
  for (const Message& one : messages_) {
    writer.add(static_cast<std::uint16_t>(one.topic), static_cast<std::uint64_t>(one.time),
               one.data);
  }
  messages_.clear();
  bag_.bytes = writer.finish();
  return std::move(bag_);
}

}  // namespace trussmap::logs
