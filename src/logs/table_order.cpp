// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a table's columns are like in order of time, where its rows are not, or stand twice: sums so
// far are told by their steps.
#include "logs/field_facts.hpp"
#include "logs/joined_logs.hpp"
#include "logs/log_map.hpp"
#include "logs/log_survey.hpp"
#include "logs/message_feed.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace trussmap::logs {
namespace {

struct TimedRows {
  std::vector<std::int64_t> t;  // ns
  std::map<std::string, std::vector<double>, std::less<>> numbers;
  std::map<std::string, std::vector<std::string>, std::less<>> texts;
  bool in_order = true;
};

/// Of the columns that are asked for; a cell that is none is NaN, or empty.
TimedRows rows_of(const JoinedLogs& log, const LogMap& map, const LogTopicFacts& facts) {
  TimedRows rows;
  MessageFeeds times(map, log);
  LogVisit visit;
  visit.wanted = [](const LogTopic&) { return true; };
  visit.message = [&](const LogMessage& message) {
    const std::int64_t t = times.time_of(message, message.fields);
    rows.in_order = rows.in_order && (rows.t.empty() || t > rows.t.back());
    rows.t.push_back(t);
    for (const LogFieldFacts& one : facts.fields) {
      const auto cell = message.fields.member(one.path);
      if (one.is_text) {
        const bool text = cell && cell->kind() == FieldKind::text;
        rows.texts[one.path].emplace_back(text ? cell->field().text : std::string_view());
      } else {
        rows.numbers[one.path].push_back(cell ? cell->number() : kAbsent);
      }
    }
  };
  static_cast<void>(log.read(visit, [](std::size_t) { return true; }));
  return rows;
}

}  // namespace

void put_in_order(LogSurvey& survey, const std::filesystem::path& table) {
  if (!survey.table || survey.topics.size() != 1) return;
  LogTopicFacts& topic = survey.topics.front();
  TimedRows rows;
  try {
    const LogMap map = parse_log_map(guessed_map(survey, table.string()), table);
    rows = rows_of(JoinedLogs({table}), map, topic);
  } catch (const InputError&) {  // no times that can be guessed
    return;
  }
  if (rows.in_order) return;
  std::vector<std::size_t> order(rows.t.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rows.t[a] < rows.t[b]; });
  for (LogFieldFacts& facts : topic.fields) {
    LogFieldFacts sorted;
    sorted.path = facts.path;
    std::string before;
    for (std::size_t k = 0; k < order.size(); ++k) {
      // Of rows at one time the last.
      if (k + 1 < order.size() && rows.t[order[k]] == rows.t[order[k + 1]]) continue;
      if (facts.is_text) {
        add_text(rows.texts[facts.path][order[k]], sorted, before);
      } else {
        add_number(rows.numbers[facts.path][order[k]], sorted);
      }
    }
    facts = std::move(sorted);
  }
}

}  // namespace trussmap::logs
