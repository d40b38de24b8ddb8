// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/message_feed.hpp"

#include "logs/asked_paths.hpp"
#include "logs/calendar.hpp"
#include "logs/pose_fields.hpp"
#include "trussmap/error.hpp"
#include "trussmap/table.hpp"

#include <cmath>

#include <fmt/format.h>

namespace trussmap::logs {
namespace {

constexpr double kLargestTime = 4e18;  // ns

/// ns of a number, in units of so many; none where it is none.
std::optional<std::int64_t> number_time(FieldRef field, double unit) {
  const double in_ns = unit * static_cast<double>(kNanosecondsPerSecond);
  if (!field.is_number()) return std::nullopt;
  const bool whole_unit = in_ns >= 1.0;
  if (whole_unit && !field.field().text.empty()) {
    return decimal_time(field.field().text, std::llround(in_ns));
  }
  const double t = field.number() * in_ns;
  if (!(std::abs(t) < kLargestTime)) return std::nullopt;
  if (field.kind() == FieldKind::integer && whole_unit) {
    return field.field().integer * static_cast<std::int64_t>(std::llround(in_ns));
  }
  return static_cast<std::int64_t>(std::llround(t));
}

/// As it stands in the log, for a message.
std::string shown(FieldRef field) {
  constexpr std::size_t kMost = 40;
  const std::string text(field.field().text);
  return text.empty() ? "it is empty" : '"' + shortened(text, kMost) + '"';
}

}  // namespace

std::int64_t nanoseconds(double seconds) {
  // As it was written: 1748457035.65 in binary is 95 ns more.
  const auto exact = decimal_time(fmt::format("{}", seconds), kNanosecondsPerSecond);
  return exact.value_or(static_cast<std::int64_t>(
      std::llround(seconds * static_cast<double>(kNanosecondsPerSecond))));
}

std::string below_topic(const std::string& path, const LogTopic& topic) {
  return topic.table ? path : path.substr(std::min(topic.name.size() + 1, path.size()));
}

MessageFeeds::MessageFeeds(const LogMap& map, const JoinedLogs& logs) : map_(&map), logs_(&logs) {
  static const TimeMap kStamps;
  times_.assign(logs.size(), nullptr);
  for (std::size_t log = 0; log < logs.size(); ++log) {
    if (!logs.is_table(log)) times_[log] = &kStamps;
  }
  for (const TimeMap& time : map.times) {
    if (time.file.empty()) std::fill(times_.begin(), times_.end(), &time);
  }
  for (const TimeMap& time : map.times) {
    if (time.file.empty()) continue;
    const AskedField asked{time.field, time.file, time.line};
    times_[log_of(asked).value_or(0)] = &time;
  }
}

std::optional<std::size_t> MessageFeeds::log_of(const AskedField& asked) const {
  if (!asked.file.empty()) {
    try {
      return logs_->named(asked.file);
    } catch (const std::invalid_argument& error) {
      throw InputError(map_->file.string(), asked.line, error.what());
    }
  }
  if (logs_->size() == 1) return 0;
  for (std::size_t log = 0; log < logs_->size(); ++log) {
    if (!logs_->is_table(log)) return std::nullopt;
  }
  throw InputError(map_->file.string(), asked.line,
                   fmt::format("the table has no file, expected file = one of {}, whose column "
                               "\"{}\" is",
                               logs_->all_names(), asked.path));
}

void MessageFeeds::add(const AskedField& asked, Take take) {
  feeds_.push_back({asked.path, asked.line, log_of(asked), false, std::move(take)});
}

void MessageFeeds::add_message(const AskedField& asked, Take take) {
  feeds_.push_back({asked.path, asked.line, log_of(asked), true, std::move(take)});
}

bool MessageFeeds::is_of(const Feed& feed, const LogTopic& topic) const {
  const bool here = feed.log ? *feed.log == topic.input : !topic.table;
  return here && is_of_topic(feed.path, topic);
}

bool MessageFeeds::wants(const LogTopic& topic) const {
  return std::any_of(feeds_.begin(), feeds_.end(),
                     [&](const Feed& feed) { return is_of(feed, topic); });
}

bool MessageFeeds::wants_of(std::size_t log) const {
  return std::any_of(feeds_.begin(), feeds_.end(), [&](const Feed& feed) {
    return feed.log ? *feed.log == log : !logs_->is_table(log);
  });
}

std::string MessageFeeds::place_of(const LogMessage& message) const {
  const std::string& name = logs_->path(message.topic.input).string();
  if (message.line > 0) return fmt::format("{}:{}", name, message.line);
  return message.topic.name.empty() ? name : name + ", " + message.topic.name;
}

std::int64_t MessageFeeds::field_time(const LogMessage& message, const TimeMap& time) {
  auto known = time_paths_.find(message.number);
  if (known == time_paths_.end()) {
    const bool table = message.topic.table;
    known = time_paths_
                .emplace(message.number,
                         TimePaths{FieldPath(time.field, table), FieldPath(time.fraction, table)})
                .first;
  }
  const auto find = [&](const FieldPath& path, const std::string& name) {
    const auto field = path.find(message.fields);
    if (field) return *field;
    throw InputError(map_->file.string(), time.line,
                     fmt::format("[time]: field {} is not in a message of {}, expected in all; it "
                                 "has {}",
                                 name, logs_->path(message.topic.input).string(),
                                 listed_fields(message.fields)));
  };
  const auto value = [&](FieldRef field, const std::string& name, double unit) {
    if (const auto t = number_time(field, unit)) return *t;
    throw InputError(
        logs_->path(message.topic.input).string(), message.line,
        fmt::format("[time]: field {} is no time ({}), expected a number", name, shown(field)));
  };
  const FieldRef field = find(known->second.field, time.field);
  if (time.calendar) {
    const auto t = calendar_time(as_text(field));
    if (t) return *t;
    throw InputError(logs_->path(message.topic.input).string(), message.line,
                     fmt::format("[time]: field {} is no date and time ({}), expected "
                                 "2026-03-01T12:30:00.25",
                                 time.field, shown(field)));
  }
  const std::int64_t t = value(field, time.field, time.unit);
  if (time.fraction.empty()) return t;
  return t + value(find(known->second.fraction, time.fraction), time.fraction, time.fraction_unit);
}

std::int64_t MessageFeeds::time_of(const LogMessage& message, FieldRef timed) {
  const TimeMap* time = times_[message.topic.input];
  if (time != nullptr) {
    const std::int64_t clock = nanoseconds(time->clock);
    if (time->from == TimeMap::From::field) return clock + field_time(message, *time);
    if (time->from == TimeMap::From::publish && message.has_time) {
      return clock + message.publish_time;
    }
    if (time->from == TimeMap::From::stamp) {
      if (const auto stamp = stamp_of(timed)) return clock + *stamp;
    }
    if (message.has_time) return clock + message.log_time;
  }
  throw InputError(
      map_->file.string(), 0,
      fmt::format("the messages of {} have no times, expected {} with the field that "
                  "is one, of {}",
                  logs_->all_names() == logs_->path(0).string() ? "the log"
                                                                : logs_->name(message.topic.input),
                  logs_->size() > 1 ? "a [[time]] of this file" : "[time]",
                  listed_fields(message.fields)));
}

/// Which feeds are of its topic.
void MessageFeeds::meet(const LogMessage& message) {
  std::vector<Feed*>& known = by_topic_[message.number];
  for (Feed& feed : feeds_) {
    if (!is_of(feed, message.topic)) continue;
    try {
      feed.by_topic.emplace(message.number, feed.whole
                                                ? FieldPath()
                                                : FieldPath::below_topic(feed.path, message.topic));
    } catch (const std::invalid_argument& error) {
      throw InputError(map_->file.string(), feed.line, error.what());
    }
    known.push_back(&feed);
  }
}

void MessageFeeds::take(const LogMessage& message) {
  if (!by_topic_.contains(message.number)) meet(message);
  std::optional<std::int64_t> t;  // of whoever shares the beginning of a path it need not be there
  for (Feed* feed : by_topic_.at(message.number)) {
    const auto field = feed->by_topic.at(message.number).find(message.fields);
    if (feed->fields.empty()) feed->fields = listed_fields(message.fields);
    if (!field) continue;
    if (!t) t = time_of(message, message.fields);
    blamed_.clear();
    if (feed->take({message.topic, message.fields, *field, *t, message.row})) {
      ++feed->taken;
    } else {
      ++feed->refused;
      if (!first_refused_.empty()) continue;
      if (blamed_.empty()) blame(feed->path, *field);
      first_refused_ = place_of(message) + ", " + blamed_;
    }
  }
}

void MessageFeeds::blame(const std::string& path, FieldRef field) {
  const bool one = field.kind() != FieldKind::group && field.kind() != FieldKind::list;
  blamed_ = path + (one ? ": " + shown(field) : "");
}

std::size_t MessageFeeds::refused() const {
  std::size_t count = 0;
  for (const Feed& feed : feeds_) count += feed.refused;
  return count;
}

void MessageFeeds::check(const LogEnd& end) const {
  for (const Feed& feed : feeds_) {
    if (feed.taken == 0) fail(feed, end);
  }
}

void MessageFeeds::fail(const Feed& feed, const LogEnd& end) const {
  const std::string& file = map_->file.string();
  const std::string name = feed.log ? logs_->path(*feed.log).string() : logs_->all_names();
  std::string topics;
  std::size_t named = 0;
  for (const LogTopic& topic : end.topics) {
    if (is_of(feed, topic) && !topic.unread.empty()) {
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
    std::string elsewhere;
    for (const Feed& other : feeds_) {
      if (other.log && feed.log && *other.log != *feed.log && !other.fields.empty() &&
          ("," + other.fields + ",").find(" " + feed.path + ",") != std::string::npos) {
        elsewhere = "; " + logs_->name(*other.log) + " has it";
      }
    }
    throw InputError(file, feed.line,
                     fmt::format("{} has no field {}, expected one of {}{}", name, feed.path,
                                 feed.fields, elsewhere));
  }
  throw InputError(
      file, feed.line,
      fmt::format("{} has no messages of {}, expected a topic of {}", name, feed.path, topics));
}

}  // namespace trussmap::logs
