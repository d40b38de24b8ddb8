// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/calendar.hpp"
#include "logs/named_fields.hpp"

#include <algorithm>

namespace trussmap::logs {
namespace {

const std::vector<std::string> kTimeWords{"time", "stamp", "millis", "micros", "clock",
                                          "=t",   "=ts",   "=sec",   "=secs",  "seconds"};

std::string unit_of_times(const NamedFacts& column) {
  std::optional<Unit> named = unit_named(column.path);
  if (!named) named = unit_in(column.path);
  if (is_of(named, {Quantity::time})) return std::string(named->name);
  const LogFieldFacts& facts = *column.facts;
  // Since 1970, or by the step: no robot writes a row an hour or 100 000 a second.
  if (facts.least > 1e17) return "ns";
  if (facts.least > 1e14) return "us";
  if (facts.least > 1e11) return "ms";
  if (facts.least > 1e8) return "s";
  if (!column.time_unit.empty()) return column.time_unit;
  // By the range: rows need not be in order.
  const double rows = std::max(1.0, static_cast<double>(facts.values - 1));
  const double step = (facts.largest - facts.least) / rows;
  if (step >= 1e6) return "ns";
  if (step >= 2e3) return "us";
  return step >= 2.0 ? "ms" : "s";
}

bool is_called_time(const std::string& path) {
  return has_word(path, kTimeWords);
}

/// The name up to its last word: "header.stamp." of "header.stamp.sec".
std::string before_last_word(const std::string& path) {
  const std::size_t last =
      path.find_last_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
  return last == std::string::npos ? "" : path.substr(0, last + 1);
}

struct SplitTime {
  const NamedFacts* seconds = nullptr;
  const NamedFacts* fraction = nullptr;
};

/// Whole seconds in one column, nanoseconds of them in another beside it.
std::optional<SplitTime> split_time(const FreeFields& fields) {
  constexpr double kSecond = 1e9;
  for (const NamedFacts& fraction : fields.all()) {
    if (!fields.is_free(fraction) || fraction.facts->is_text || !fraction.facts->is_whole) continue;
    if (!has_word(fraction.path,
                  {"=nanosec", "=nanosecs", "=nsec", "=nsecs", "=nanoseconds", "=nanos", "=ns"})) {
      continue;
    }
    if (fraction.facts->least < 0.0 || fraction.facts->largest >= kSecond) continue;
    for (const NamedFacts& seconds : fields.all()) {
      const bool beside = fields.is_free(seconds) && seconds.file == fraction.file &&
                          !seconds.facts->is_text && seconds.facts->is_whole &&
                          before_last_word(seconds.path) == before_last_word(fraction.path);
      if (beside && has_word(seconds.path, {"=sec", "=secs", "=s", "=seconds"})) {
        return SplitTime{&seconds, &fraction};
      }
    }
  }
  return std::nullopt;
}

/// A message's own stamp before the time at which it was written; what never goes back; rows that
/// are not in order, if it is called so.
const NamedFacts* time_column(const FreeFields& fields) {
  const NamedFacts* best = nullptr;
  int best_rank = 0;
  for (const NamedFacts& one : fields.all()) {
    if (!fields.is_free(one) || one.facts->is_text) continue;
    const bool named = is_called_time(one.path) && !has_word(one.path, {"seq", "delta", "dt"});
    const bool grows = one.facts->decreases == 0;
    int rank = grows ? 1 : 0;
    if (named) rank = grows ? 3 : 2;
    if (named && has_word(one.path, {"stamp"}) && has_word(one.path, {"header"})) rank = 4;
    if (!named && has_word(one.path, {"=seq"})) rank = 0;
    if (rank <= best_rank) continue;
    best = &one;
    best_rank = rank;
  }
  return best;
}

const NamedFacts* calendar_column(const FreeFields& fields) {
  for (const NamedFacts& one : fields.all()) {
    const bool date = one.facts->is_text && fields.is_free(one);
    if (date && calendar_time(one.facts->example)) return &one;
  }
  for (const NamedFacts& one : fields.all()) {
    const bool named = one.facts->is_text && has_word(one.path, {"time", "date", "stamp"});
    if (named && fields.is_free(one)) return &one;
  }
  return nullptr;
}

/// How many figures are left to state.
int guess_column_time(FreeFields& fields, MapText& text) {
  if (const auto split = split_time(fields)) {
    fields.mark_taken(*split->seconds);
    fields.mark_taken(*split->fraction);
    text.text("field", split->seconds->path);
    text.text("unit", "s");
    text.text("fraction", split->fraction->path, "added to it");
    text.text("fraction_unit", "ns");
    return 0;
  }
  const NamedFacts* column = time_column(fields);
  const NamedFacts* calendar = calendar_column(fields);
  if (column != nullptr && (calendar == nullptr || is_called_time(column->path))) {
    fields.mark_taken(*column);
    text.text("field", column->path);
    text.text("unit", unit_of_times(*column));
    return 0;
  }
  if (calendar != nullptr) {
    fields.mark_taken(*calendar);
    text.text("field", calendar->path);
    text.text("unit", "calendar", "date and time, UTC");
    return 0;
  }
  text.line("field = \"\"", kState);
  return 1;
}

/// Times of other clocks and counts of rows are no measurements.
void mark_other_times(FreeFields& fields) {
  for (const NamedFacts& one : fields.all()) {
    const bool count = has_word(one.path, {"=seq"});
    const bool time = has_word(one.path, {"stamp", "time"}) && one.facts->decreases == 0;
    if (fields.is_free(one) && !one.facts->is_text && (count || time)) fields.mark_taken(one);
  }
}

}  // namespace

void guess_log_time(const FreeFields& fields, MapText& text) {
  // A Road Runner's messages have no times of their own.
  const NamedFacts* stamp = nullptr;
  for (const NamedFacts& one : fields.all()) {
    if (has_word(one.path, {"/timestamp"}) && one.facts->decreases == 0) stamp = &one;
  }
  const bool untimed = std::all_of(fields.all().begin(), fields.all().end(),
                                   [](const NamedFacts& one) { return one.step != one.step; });
  if (untimed && stamp != nullptr) {
    text.text("field", stamp->path.substr(stamp->path.rfind('/') + 1));
    text.text("unit", unit_of_times(*stamp));
  } else {
    text.text("from", "log", "when it was written");
  }
}

int guess_times(FreeFields& fields, const std::vector<LogClockFacts>& clocks, MapText& text) {
  int to_state = 0;
  if (clocks.empty()) {
    text.table("time");
    to_state = guess_column_time(fields, text);
  }
  for (const LogClockFacts& one : clocks) {
    fields.look_at(one.file);
    if (&one != &clocks.front()) text.blank();
    text.list("time");
    text.text("file", one.file);
    const bool any = std::any_of(fields.all().begin(), fields.all().end(),
                                 [&](const NamedFacts& field) { return field.file == one.file; });
    if (any) {
      to_state += guess_column_time(fields, text);
    } else {  // a bag
      text.text("from", "stamp",
                "header.stamp, and where there is none when it was recorded (log)");
    }
    if (!one.why.empty()) text.comment(one.why);
    if (one.certain && one.clock == 0.0) continue;
    text.number("clock", one.clock,
                one.certain ? "s, added to its times" : "s, added to its times; STATE IT");
    to_state += one.certain ? 0 : 1;
  }
  fields.look_at(std::nullopt);
  mark_other_times(fields);
  return to_state;
}

}  // namespace trussmap::logs
