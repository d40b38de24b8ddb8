// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/message_log.hpp"

#include "files/present.hpp"
#include "logs/mat_file.hpp"
#include "trussmap/error.hpp"

#include <algorithm>

namespace trussmap::logs {
namespace {

namespace fs = std::filesystem;

struct Format {
  bool (*is)(const fs::path&);
  LogEnd (*read)(const fs::path&, const LogVisit&);
};

constexpr Format kFormats[] = {
    {&is_mcap, &read_mcap},       {&is_rosbag2, &read_rosbag2},
    {&is_wpilog, &read_wpilog},   {&is_roadrunner_log, &read_roadrunner_log},
    {&is_mat_log, &read_mat_log}, {&is_csv_log, &read_csv_log}};

}  // namespace

bool is_table_log(const fs::path& path) {
  return is_csv_log(path) || is_mat_log(path);
}

bool is_message_log(const fs::path& path) {
  for (const Format& one : kFormats) {
    if (one.is(path)) return true;
  }
  return false;
}

LogEnd read_message_log(const fs::path& path, const LogVisit& visit) {
  if (!files::is_present(path) && !is_mat_log(path)) {
    throw InputError(path.string(), 0, "does not exist, expected a log");
  }
  for (const Format& one : kFormats) {
    if (one.is(path)) return one.read(path, visit);
  }
  throw InputError(path.string(), 0,
                   "is no log that can be read, expected an MCAP file, a rosbag2 (.db3 or its "
                   "folder), a bag of ROS 1 (.bag), a .wpilog, a Road Runner .log, a table (.csv, "
                   ".tsv, .txt) or a MATLAB file (.mat)");
}

void require_messages(const fs::path& path, const LogEnd& end) {
  const bool any = std::any_of(end.topics.begin(), end.topics.end(),
                               [](const LogTopic& topic) { return topic.messages > 0; });
  if (any) return;
  std::string beside;
  for (const PassedOver& one : end.passed_over) {
    beside += ", but " + std::to_string(one.number) + " " + one.what;
  }
  throw InputError(path.string(), 0,
                   "holds no messages" + beside +
                       (end.cut_off.empty() ? "" : ": it is cut off " + end.cut_off) +
                       ", expected a log with some");
}

}  // namespace trussmap::logs
