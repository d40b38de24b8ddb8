// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "convert_log.hpp"

#include "command_line.hpp"
#include "terminal.hpp"
#include "trussmap/log_files.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/table.hpp"
#include "trussmap/write_files.hpp"

#include <cmath>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kNameWidth = 60;  // of a name in a table

std::string number_text(double value) {
  return value == value ? fmt::format("{:.6g}", value) : "";
}

std::string rate_text(const LogTopicFacts& topic) {
  if (!(topic.step > 0.0)) return "";
  const double rate = 1.0 / topic.step;
  return rate < 10.0 ? fmt::format("{:.2g} Hz", rate) : fmt::format("{:.0f} Hz", rate);
}

std::string name_text(const std::string& name) {
  return shortened(escaped_controls(name), kNameWidth);
}

void print_topics(const LogInspection& log) {
  TextTable table{{Align::left, Align::left, Align::right, Align::right},
                  {{"topic", "type", "messages", "rate"}},
                  true,
                  2};
  for (const LogTopicFacts& one : log.topics) {
    const std::string unread = one.unread.empty() ? "" : " (unread: " + one.unread + ")";
    table.rows.push_back({one.name.empty() ? "(the table)" : name_text(one.name),
                          name_text(one.type + unread), std::to_string(one.messages),
                          rate_text(one)});
  }
  fmt::print("{}\n", table_text(table));
}

void print_frames(const LogInspection& log) {
  if (log.frames.empty()) return;
  TextTable table{
      {Align::left, Align::left, Align::right}, {{"frame", "in frame", "transforms"}}, true, 2};
  for (const LogFrameFacts& one : log.frames) {
    table.rows.push_back({name_text(one.child), name_text(one.parent),
                          one.is_static ? "static" : std::to_string(one.samples)});
  }
  fmt::print("{}\n", table_text(table));
}

/// Fields that change, and texts; the others are counted.
void print_fields(const LogInspection& log) {
  TextTable table{{Align::left, Align::right, Align::right, Align::right, Align::right},
                  {{"field", "values", "from", "to", "changes"}},
                  true,
                  2};
  std::size_t constant = 0;
  for (const LogTopicFacts& topic : log.topics) {
    constexpr std::size_t kMost = 60;  // fields of a topic that are shown
    std::size_t shown = 0;
    std::size_t more = 0;
    for (const LogFieldFacts& one : topic.fields) {
      const bool is_stamp = one.path.find("stamp.sec") != std::string::npos ||
                            one.path.find("stamp.nanosec") != std::string::npos;
      if (one.different == 0 || is_stamp) {
        ++constant;
        continue;
      }
      if (++shown > kMost) {
        ++more;
        continue;
      }
      const std::string path = topic.name.empty() ? one.path
                               : one.path.empty() ? topic.name
                                                  : topic.name + '/' + one.path;
      std::vector<std::string> row{name_text(path), std::to_string(one.values)};
      if (one.is_text) {
        row.push_back('"' + shortened(escaped_controls(one.example), 20) + '"');
        row.emplace_back();
      } else {
        row.push_back(number_text(one.least));
        row.push_back(number_text(one.largest));
      }
      row.push_back(std::to_string(one.different));
      table.rows.push_back(std::move(row));
    }
    if (more > 0) {
      table.rows.push_back({fmt::format("... and {} more of {}", more, name_text(topic.name))});
    }
  }
  fmt::print("{}", table_text(table));
  if (constant > 0) {
    fmt::print("\n  {} further fields never change, or are time stamps\n", constant);
  }
}

}  // namespace

void inspect_log_file(const fs::path& log, const fs::path& map) {
  std::error_code ignored;
  const bool is_there = fs::exists(map.empty() ? fs::path("map.toml") : map, ignored);
  if (is_there && !map.empty()) {
    throw UsageError(map.string() +
                     " is there already, expected another name for the map to write");
  }
  const fs::path to = map.empty() ? fs::path("map.toml") : map;
  const LogInspection inspection = inspect_log(log);
  if (!is_there) write_file(to, inspection.map);
  fmt::print("{}:\n\n", log.string());
  print_topics(inspection);
  print_frames(inspection);
  print_fields(inspection);
  if (!inspection.cut_off.empty()) {
    fmt::print("\n{}", warning_text("the log is cut off " + inspection.cut_off +
                                    "; what is before is read"));
  }
  if (is_there) {
    fmt::print("\nnot written: {} is there already; a first map: --map ANOTHER.toml\n",
               to.string());
    return;
  }
  fmt::print(
      "\nwritten: {}. Read it, mend what is wrong, and convert:\n"
      "  trussmap convert {} OUT --map {}\n",
      to.string(), log.string(), to.string());
}

void convert_log(const fs::path& log, const fs::path& out, const fs::path& map) {
  const LogRecording read = read_log_recording(log, map);
  write_recording(out, read.recording, log.filename().string() + "; " + read.epoch,
                  {{"model.toml", format_model(read.model)}});
  fmt::print("converted: {} to the recording {}\n\n", log.string(), out.string());
  for (const LogCount& one : read.counts) fmt::print("  {:>7} {}\n", one.number, one.what);
  if (!read.warnings.empty()) fmt::print("\n");
  for (const std::string& one : read.warnings) fmt::print("{}", warning_text(one));
  fmt::print(
      "\nnext:\n  trussmap check {0} --model {0}/model.toml\n"
      "  trussmap discover {0} --model {0}/model.toml --out fitted.toml\n",
      out.string());
}

}  // namespace trussmap::app
