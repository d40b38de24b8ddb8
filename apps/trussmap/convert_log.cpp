// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "convert_log.hpp"

#include "command_line.hpp"
#include "terminal.hpp"
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

/// "the table" is its column of topics, where there is but one log.
std::string topic_text(const LogTopicFacts& topic) {
  std::string name = topic.name.empty() ? "(the table)" : name_text(topic.name);
  if (topic.file.empty()) return name;
  return name_text(topic.file) + (topic.name.empty() ? "" : " " + name);
}

void print_topics(const LogInspection& log) {
  TextTable table{{Align::left, Align::left, Align::right, Align::right},
                  {{log.clocks.empty() ? "topic" : "file", "type", "messages", "rate"}},
                  true,
                  2};
  for (const LogTopicFacts& one : log.topics) {
    const std::string unread = one.unread.empty() ? "" : " (unread: " + one.unread + ")";
    table.rows.push_back({topic_text(one), name_text(one.type + unread),
                          std::to_string(one.messages), rate_text(one)});
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
      const std::string file = topic.file.empty() ? "" : topic.file + ": ";
      const std::string path = file + (topic.name.empty() ? one.path
                                       : one.path.empty() ? topic.name
                                                          : topic.name + '/' + one.path);
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

/// Which clock is which, and in how far that is measured.
void print_clocks(const LogInspection& log) {
  if (log.clocks.empty()) return;
  TextTable table{{Align::left, Align::right, Align::right, Align::right},
                  {{"clock of", "from (s)", "to (s)", "set on by (s)"}},
                  true,
                  2};
  const auto seconds = [](double value) {
    return value == value ? fmt::format("{:.3f}", value) : std::string();
  };
  for (const LogClockFacts& one : log.clocks) {
    table.rows.push_back({name_text(one.file), seconds(one.first), seconds(one.last),
                          one.certain ? fmt::format("{}", one.clock) : "?"});
  }
  fmt::print("{}\n", table_text(table));
  for (const LogClockFacts& one : log.clocks) {
    fmt::print("  {}: {}\n", name_text(one.file), escaped_controls(one.why));
  }
  fmt::print("\n");
}

/// As they stand in a command.
std::string given_text(const LogOptions& options) {
  std::string text;
  for (const fs::path& one : options.definitions) text += " --definitions " + one.string();
  return text;
}

/// What could be read if somebody had its definition: the table has no room for it.
void print_undefined(const LogInspection& log) {
  bool any = false;
  for (const LogTopicFacts& one : log.topics) {
    if (one.unread.find("--definitions") == std::string::npos) continue;
    fmt::print("  {}: {}\n", topic_text(one), escaped_controls(one.unread));
    any = true;
  }
  if (any) fmt::print("\n");
}

std::string names_of(const std::vector<fs::path>& logs) {
  std::string text;
  for (const fs::path& one : logs) text += (text.empty() ? "" : " ") + one.string();
  return text;
}

}  // namespace

void inspect_log_files(const std::vector<fs::path>& logs, const fs::path& map,
                       const LogOptions& options) {
  std::error_code ignored;
  const bool is_there = fs::exists(map.empty() ? fs::path("map.toml") : map, ignored);
  if (is_there && !map.empty()) {
    throw UsageError(map.string() +
                     " is there already, expected another name for the map to write");
  }
  const fs::path to = map.empty() ? fs::path("map.toml") : map;
  const bool one = logs.size() == 1 && (is_log(logs.front()) || !fs::is_directory(logs.front()));
  const LogInspection inspection =
      one ? inspect_log(logs.front(), options) : inspect_logs(logs, options);
  if (!is_there) write_file(to, inspection.map);
  fmt::print("{}:\n\n", names_of(logs));
  print_topics(inspection);
  print_undefined(inspection);
  print_clocks(inspection);
  print_frames(inspection);
  print_fields(inspection);
  for (const LogCount& one : inspection.passed_over) {
    fmt::print("\n  {} {}\n", one.number, escaped_controls(one.what));
  }
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
      "  trussmap convert {} OUT --map {}{}\n",
      to.string(), names_of(logs), to.string(), given_text(options));
}

void convert_logs(const std::vector<fs::path>& logs, const fs::path& out, const fs::path& map,
                  const LogOptions& options) {
  const LogRecording read = read_log_recording(logs, map, options);
  std::string names;
  for (const fs::path& one : logs) {
    names += (names.empty() ? "" : ", ") + one.filename().string();
  }
  write_recording(out, read.recording, names + "; " + read.epoch,
                  {{"model.toml", format_model(read.model)}});
  fmt::print("converted: {} to the recording {}\n\n", names_of(logs), out.string());
  for (const LogCount& one : read.counts) fmt::print("  {:>7} {}\n", one.number, one.what);
  if (!read.warnings.empty()) fmt::print("\n");
  for (const std::string& one : read.warnings) fmt::print("{}", warning_text(one));
  const Recording& made = read.recording;
  if (made.sightings.empty() && made.fixes.empty() && made.truth.empty()) {
    fmt::print("\nnext:\n  trussmap apply {0} --model {0}/model.toml --out poses.csv\n",
               out.string());
    return;
  }
  fmt::print(
      "\nnext:\n  trussmap check {0} --model {0}/model.toml\n"
      "  trussmap discover {0} --model {0}/model.toml --out fitted.toml\n",
      out.string());
}

}  // namespace trussmap::app
