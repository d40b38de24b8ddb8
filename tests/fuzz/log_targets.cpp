// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fuzz/targets.hpp"
#include "logs/message_log.hpp"
#include "trussmap/error.hpp"
#include "trussmap/log_files.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <unistd.h>

namespace trussmap::fuzz {
using namespace logs;
namespace {

namespace fs = std::filesystem;

/// The bytes as a file of this process alone.
class LogFile {
 public:
  LogFile(const std::string& ending, std::string_view bytes)
      : path_(fs::temp_directory_path() /
              ("trussmap_fuzz_log_" + std::to_string(::getpid()) + ending)) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  ~LogFile() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Touches all that the message holds; nothing in it may be longer than the file.
void look_at(FieldRef field, std::size_t most) {
  const Field& one = field.field();
  if (one.text.size() > most || one.length > most) throw std::logic_error("longer than the file");
  volatile double sum = one.number;
  for (const char c : one.text) sum = sum + static_cast<double>(c);
  for (const char c : one.name) sum = sum + static_cast<double>(c);
  for (const FieldRef& within : field.children()) look_at(within, most);
}

template <typename Reader>
void fuzz_log(const Reader& reader, const std::string& ending, std::string_view bytes) {
  const LogFile file(ending, bytes);
  std::size_t delivered = 0;
  LogVisit visit;
  visit.elements = 16;
  visit.wanted = [](const LogTopic& topic) { return topic.name != "unwanted"; };
  visit.message = [&](const LogMessage& message) {
    ++delivered;
    if (!message.topic.unread.empty()) throw std::logic_error("a message that cannot be read");
    look_at(message.fields, bytes.size());
  };
  try {
    const LogEnd end = reader(file.path(), visit);
    std::size_t counted = 0;
    for (const LogTopic& one : end.topics) counted += one.messages;
    if (delivered > counted) throw std::logic_error("more messages than are counted");
    if (end.cut_off.find('\n') != std::string::npos) throw std::logic_error("two lines");
  } catch (const InputError& error) {
    if (std::string(error.what()).find('\n') != std::string::npos) {
      throw std::logic_error("two lines");
    }
  }
}

void fuzz_wpilog(std::string_view bytes) {
  fuzz_log(read_wpilog, ".wpilog", bytes);
}

void fuzz_roadrunner(std::string_view bytes) {
  fuzz_log(read_roadrunner_log, ".log", bytes);
}

void fuzz_table(std::string_view bytes) {
  fuzz_log(read_csv_log, ".csv", bytes);
}

/// A map.toml, a line of "====", and a table.
void fuzz_logmap(std::string_view bytes) {
  constexpr std::string_view kBetween = "====\n";
  const std::size_t end = bytes.find(kBetween);
  const bool both = end != std::string_view::npos;
  const LogFile map(".toml", bytes.substr(0, end));
  const LogFile table(".csv", both ? bytes.substr(end + kBetween.size()) : "");
  try {
    static_cast<void>(read_log_recording(table.path(), map.path()));
  } catch (const InputError& error) {
    if (std::string(error.what()).find('\n') != std::string::npos) {
      throw std::logic_error("two lines");
    }
  }
  try {
    const LogInspection inspection = inspect_log(table.path());
    // Whatever columns are called, the map is one: what it lacks is said of the log.
    const LogFile first("_first.toml", inspection.map);
    static_cast<void>(read_log_recording(table.path(), first.path()));
  } catch (const InputError& error) {
    if (std::string(error.what()).find("no TOML") != std::string::npos) {
      throw std::logic_error("the first map is no TOML");
    }
  }
}

}  // namespace

const std::map<std::string, Target>& log_targets() {
  static const std::map<std::string, Target> kTargets = {{"logmap", &fuzz_logmap},
                                                         {"roadrunner", &fuzz_roadrunner},
                                                         {"table", &fuzz_table},
                                                         {"wpilog", &fuzz_wpilog}};
  return kTargets;
}

}  // namespace trussmap::fuzz
