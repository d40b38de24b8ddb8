// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/logs/message_feed.hpp"

#include "io/logs/asked_paths.hpp"
#include "io/logs/calendar.hpp"
#include "io/logs/pose_fields.hpp"
#include "trussmap/error.hpp"

#include <cmath>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr double kLargestTime = 4e18;  // ns

}  // namespace

std::int64_t nanoseconds(double seconds) {
  return static_cast<std::int64_t>(
      std::llround(seconds * static_cast<double>(kNanosecondsPerSecond)));
}

void MessageFeeds::add(const std::string& path, std::size_t line, Take take) {
  feeds_.push_back({path, line, false, std::move(take)});
}

void MessageFeeds::add_message(const std::string& path, std::size_t line, Take take) {
  feeds_.push_back({path, line, true, std::move(take)});
}

bool MessageFeeds::wants(const LogTopic& topic) const {
  return std::any_of(feeds_.begin(), feeds_.end(),
                     [&](const Feed& feed) { return is_of_topic(feed.path, topic); });
}

std::int64_t MessageFeeds::time_of(const LogMessage& message, FieldRef timed) {
  switch (map_->time.from) {
    case TimeMap::From::stamp:
      if (const auto stamp = stamp_of(timed)) return *stamp;
      break;
    case TimeMap::From::log:
      break;
    case TimeMap::From::publish:
      return message.publish_time;
    case TimeMap::From::field: {
      if (!times_.contains(message.number)) {
        times_.emplace(message.number, FieldPath(map_->time.field, message.topic.table));
      }
      const auto field = times_.at(message.number).find(message.fields);
      const auto fail = [this](const std::string& what) {
        throw InputError(map_->file.string(), 0, "[time]: field " + map_->time.field + what);
      };
      if (!field) fail(" is not in a message, expected in all");
      if (map_->time.calendar) {
        const auto t = calendar_time(as_text(*field));
        if (!t) fail(" is no date and time, expected 2026-03-01T12:30:00.25");
        return *t;
      }
      const double unit = map_->time.unit * static_cast<double>(kNanosecondsPerSecond);
      const double t = field->number() * unit;
      if (!(std::abs(t) < kLargestTime)) fail(" is no time, expected a number");
      const bool whole = field->kind() == FieldKind::integer && unit >= 1.0;
      return whole ? field->field().integer * static_cast<std::int64_t>(std::llround(unit))
                   : static_cast<std::int64_t>(std::llround(t));
    }
  }
  if (message.has_time) return message.log_time;
  throw InputError(map_->file.string(), 0,
                   "the log's messages have no times, expected [time] with the field that is one");
}

void MessageFeeds::take(const LogMessage& message) {
  auto known = by_topic_.find(message.number);
  if (known == by_topic_.end()) {
    known = by_topic_.emplace(message.number, std::vector<Feed*>()).first;
    for (Feed& feed : feeds_) {
      if (!is_of_topic(feed.path, message.topic)) continue;
      try {
        feed.by_topic.emplace(
            message.number,
            feed.whole ? FieldPath() : FieldPath::below_topic(feed.path, message.topic));
      } catch (const std::invalid_argument& error) {
        throw InputError(map_->file.string(), feed.line, error.what());
      }
      known->second.push_back(&feed);
    }
  }
  if (known->second.empty()) return;
  std::optional<std::int64_t> t;  // of whoever shares the beginning of a path it need not be there
  for (Feed* feed : known->second) {
    const auto field = feed->by_topic.at(message.number).find(message.fields);
    if (feed->fields.empty()) feed->fields = listed_fields(message.fields);
    if (!field) continue;
    if (!t) t = time_of(message, message.fields);
    if (feed->take({message.topic, message.fields, *field, *t})) {
      ++feed->taken;
    } else {
      ++feed->refused;
    }
  }
}

std::size_t MessageFeeds::refused() const {
  std::size_t count = 0;
  for (const Feed& feed : feeds_) count += feed.refused;
  return count;
}

void MessageFeeds::check(const std::filesystem::path& log, const LogEnd& end) const {
  for (const Feed& feed : feeds_) {
    if (feed.taken == 0) fail(feed, log, end);
  }
}

void MessageFeeds::fail(const Feed& feed, const std::filesystem::path& log,
                        const LogEnd& end) const {
  const std::string& file = map_->file.string();
  const std::string name = log.string();
  std::string topics;
  std::size_t named = 0;
  for (const LogTopic& topic : end.topics) {
    if (is_of_topic(feed.path, topic) && !topic.unread.empty()) {
      throw InputError(file, feed.line,
                       fmt::format("{} cannot be read from {}: {}", feed.path, name, topic.unread));
    }
    constexpr std::size_t kMost = 24;
    if (++named <= kMost) topics += (topics.empty() ? "" : ", ") + topic.name;
  }
  if (feed.refused > 0) {
    throw InputError(file, feed.line,
                     fmt::format("{} of {} holds nothing that can be used so (in {} messages), "
                                 "expected a number, or the pose or velocity that is asked for",
                                 feed.path, name, feed.refused));
  }
  if (!feed.fields.empty()) {
    throw InputError(
        file, feed.line,
        fmt::format("{} has no field {}, expected one of {}", name, feed.path, feed.fields));
  }
  throw InputError(
      file, feed.line,
      fmt::format("{} has no messages of {}, expected a topic of {}", name, feed.path, topics));
}

}  // namespace trussmap
