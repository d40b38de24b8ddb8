// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Several logs inspected as one: what each has, which clock each has, and a first map for all.
#include "io/recording_streams.hpp"
#include "logs/calendar.hpp"
#include "logs/joined_logs.hpp"
#include "logs/log_motion.hpp"
#include "logs/log_survey.hpp"
#include "logs/message_feed.hpp"
#include "trussmap/error.hpp"
#include "trussmap/recording_files.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace trussmap {
using namespace logs;

namespace {

namespace fs = std::filesystem;

/// One of the logs by itself.
struct InspectedLog {
  fs::path path;
  std::string name;
  LogSurvey survey;
  double first = kAbsent;  ///< s, by its own clock
  double last = kAbsent;
  std::vector<LoggedMotion> motions;

  [[nodiscard]] bool is_timed() const { return first == first; }
  [[nodiscard]] double step() const {
    const double rows = static_cast<double>(survey.topics.front().messages);
    return motions.empty() ? (last - first) / std::max(1.0, rows - 1.0) : motions.front().step();
  }
};

void read_times(const JoinedLogs& log, const LogMap& map, InspectedLog& into) {
  MessageFeeds times(map, log);
  LogVisit visit;
  visit.wanted = [](const LogTopic&) { return true; };
  visit.message = [&](const LogMessage& message) {
    const double t = static_cast<double>(times.time_of(message, message.fields)) /
                     static_cast<double>(kNanosecondsPerSecond);
    into.first = into.is_timed() ? std::min(into.first, t) : t;
    into.last = into.last == into.last ? std::max(into.last, t) : t;
  };
  static_cast<void>(log.read(visit, [](std::size_t) { return true; }));
}

/// Times and motion of a log, by what a map for it alone would be.
void read_alone(const JoinedLogs& alone, InspectedLog& found) {
  const fs::path& path = alone.path(0);
  found.first = found.last = kAbsent;
  try {
    LogClockFacts clock;
    clock.file = path.filename().string();
    const LogMap map = parse_log_map(guessed_joined_map({found.survey}, {clock}, ""), path);
    read_times(alone, map, found);
    found.motions = motions_of(alone, map);
  } catch (const InputError&) {  // no times that can be guessed, which the map asks for
    found.first = found.last = kAbsent;
  }
}

InspectedLog inspected(const JoinedLogs& logs, std::size_t number) {
  const fs::path& path = logs.path(number);
  InspectedLog found;
  found.path = path;
  found.name = logs.name(number);
  const JoinedLogs alone({path}, logs.definitions());
  found.survey = survey_log(path, logs.definitions());
  put_in_order(found.survey, path);
  found.survey.wheels = wheel_topics(found.survey);
  found.survey.wheels.constants = wheel_constants(alone, found.survey.wheels);
  read_alone(alone, found);
  return found;
}

/// Rows that are far apart do not tell the unit of their times by their steps: the one by which
/// they lie within those of the wheels' log does.
void find_time_unit(const InspectedLog& reference, InspectedLog& log) {
  constexpr double kBeside = 1.0;  // s
  const auto lies_within = [&](const InspectedLog& one) {
    return one.is_timed() && one.first >= reference.first - kBeside &&
           one.last <= reference.last + kBeside;
  };
  if (!log.survey.table || !log.motions.empty() || !log.is_timed() || !reference.is_timed()) return;
  const double span = log.last - log.first;
  constexpr double kLeast = 0.05;  // of the reference's time
  if (lies_within(log) && span > kLeast * (reference.last - reference.first)) return;
  for (const char* unit : {"s", "ms", "us", "ns"}) {
    InspectedLog other;
    other.survey = log.survey;
    other.survey.time_unit = unit;
    read_alone(JoinedLogs({log.path}), other);
    const bool same = other.first == log.first && other.last == log.last;
    if (same || !lies_within(other) || other.last - other.first <= span) continue;
    log.survey.time_unit = unit;
    log.first = other.first;
    log.last = other.last;
    return;
  }
}

bool is_survey(const fs::path& path) {
  try {
    return !io::read_survey(path).empty();
  } catch (const InputError&) {
    return false;
  }
}

bool has_motion(const InspectedLog& log, const char* what) {
  return std::any_of(log.motions.begin(), log.motions.end(),
                     [what](const LoggedMotion& one) { return one.what == what; });
}

/// The log of the wheels; else one that has motion.
std::size_t reference_of(const std::vector<InspectedLog>& logs) {
  for (const char* what : {"wheels", "odometry"}) {
    for (std::size_t k = 0; k < logs.size(); ++k) {
      if (has_motion(logs[k], what)) return k;
    }
  }
  for (std::size_t k = 0; k < logs.size(); ++k) {
    if (!logs[k].motions.empty()) return k;
  }
  return 0;
}

/// Share of b's time that is within a's, b's being set on by `clock`.
double share_within(const InspectedLog& a, const InspectedLog& b, double clock) {
  if (!a.is_timed() || !b.is_timed()) return 0.0;
  const double both = std::min(a.last, b.last + clock) - std::max(a.first, b.first + clock);
  if (b.last <= b.first) return both >= 0.0 ? 1.0 : 0.0;
  return std::max(0.0, both) / std::min(b.last - b.first, std::max(a.last - a.first, 1e-9));
}

LogClockFacts measured_clock(const InspectedLog& reference, const InspectedLog& log,
                             const ClockOffset& found) {
  LogClockFacts clock;
  clock.likeness = found.likeness;
  clock.sd = found.sd;
  clock.offset = found.offset;
  clock.drift = found.drift;
  const double rows = 0.5 * std::max(reference.step(), log.step());
  constexpr double kLeast = 0.01;  // s
  const bool same = std::abs(found.offset) <= std::max({3.0 * found.sd, rows, kLeast});
  const std::string likeness = fmt::format("by the {} and the {} (correlation {:.2f})", found.by,
                                           found.with, found.likeness);
  if (same) {
    clock.why = fmt::format("the clock of {}: {:.3f} +- {:.3f} s apart, {}", reference.name,
                            found.offset, found.sd, likeness);
    clock.clock = 0.0;
  } else {
    constexpr double kDigits = 1e3;
    clock.clock = std::round(kDigits * found.offset) / kDigits;
    clock.why = fmt::format("a clock of its own: {:.3f} +- {:.3f} s to that of {}, {}", clock.clock,
                            found.sd, reference.name, likeness);
  }
  if (found.likeness < 0.0) clock.why += "; one of them turns the other way: sign = -1";
  if (found.drift != 0.0) {
    clock.why += fmt::format("; the clocks run apart by {:.2g} ms a minute: no one offset is right",
                             60e3 * found.drift);
  }
  return clock;
}

/// Of a log without motion that can be compared: by the times that it has.
LogClockFacts supposed_clock(const std::vector<InspectedLog>& logs,
                             const std::vector<LogClockFacts>& known, std::size_t reference,
                             const InspectedLog& log) {
  LogClockFacts clock;
  const std::string none = "no motion to compare";
  constexpr double kMost = 0.5;
  std::size_t best = logs.size();
  std::string others;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    if (known[k].file.empty() || &logs[k] == &log) continue;
    if (share_within(logs[k], log, 0.0) < kMost) continue;
    if (best == logs.size() || k == reference) best = k;
  }
  for (std::size_t k = 0; k < logs.size() && best < logs.size(); ++k) {
    if (known[k].file.empty() || known[k].clock == known[best].clock || &logs[k] == &log) continue;
    if (share_within(logs[k], log, 0.0) < kMost) continue;
    others += fmt::format("; if it is that of {}: clock = {}", logs[k].name, known[k].clock);
  }
  if (best == logs.size()) {
    clock.certain = false;
    clock.why = none + (log.is_timed() ? ", and no other log has such times" : ", and no times") +
                ": state its clock";
    return clock;
  }
  clock.clock = known[best].clock;
  clock.why = fmt::format("taken for the clock of {}, whose times it shares: {}{}", logs[best].name,
                          none, others);
  return clock;
}

std::vector<LogClockFacts> clocks_of(const std::vector<InspectedLog>& logs) {
  const std::size_t reference = reference_of(logs);
  std::vector<LogClockFacts> clocks(logs.size());
  clocks[reference].why = "the clock that the others are set to";
  clocks[reference].file = logs[reference].name;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    if (k == reference) continue;
    const auto found = clock_offset(logs[reference].motions, logs[k].motions);
    if (!found) continue;
    clocks[k] = measured_clock(logs[reference], logs[k], *found);
    clocks[k].file = logs[k].name;
  }
  const std::vector<LogClockFacts> measured = clocks;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    if (measured[k].file.empty()) clocks[k] = supposed_clock(logs, measured, reference, logs[k]);
    clocks[k].file = logs[k].name;
    clocks[k].first = logs[k].first;
    clocks[k].last = logs[k].last;
  }
  return clocks;
}

}  // namespace

LogInspection inspect_logs(const std::vector<fs::path>& paths, const LogOptions& options) {
  const JoinedLogs logs(paths, given_definitions(options));
  if (logs.size() == 1) return inspect_one_log(logs.path(0), logs.definitions());
  std::vector<InspectedLog> each;
  std::string landmarks;
  LogInspection result;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    if (logs.is_table(k) && is_survey(logs.path(k))) {
      landmarks = fs::absolute(logs.path(k)).lexically_normal().string();
      continue;
    }
    each.push_back(inspected(logs, k));
  }
  if (each.empty()) {
    throw InputError(logs.path(0).string(), 0, "is a survey alone, expected a log beside it");
  }
  const std::size_t reference = reference_of(each);
  for (InspectedLog& one : each) find_time_unit(each[reference], one);
  result.clocks = clocks_of(each);
  std::vector<LogSurvey> surveys;
  for (InspectedLog& one : each) {
    for (const FrameFacts& frame : one.survey.frames) {
      result.frames.push_back({frame.parent, frame.child, frame.is_static, frame.samples});
    }
    if (!one.survey.cut_off.empty()) {
      result.cut_off +=
          (result.cut_off.empty() ? "" : "; ") + one.survey.cut_off + " (" + one.name + ")";
    }
    for (const LogCount& some : one.survey.passed_over) {
      result.passed_over.push_back({some.number, some.what + " (" + one.name + ")"});
    }
    surveys.push_back(std::move(one.survey));
  }
  result.map = guessed_joined_map(surveys, result.clocks, landmarks);
  for (std::size_t k = 0; k < surveys.size(); ++k) {
    for (LogTopicFacts& topic : surveys[k].topics) {
      topic.file = each[k].name;
      result.topics.push_back(std::move(topic));
    }
  }
  return result;
}

}  // namespace trussmap
