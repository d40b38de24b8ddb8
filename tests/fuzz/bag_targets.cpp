// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fuzz/targets.hpp"
#include "logs/cdr.hpp"
#include "logs/message_log.hpp"
#include "trussmap/error.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <unistd.h>

namespace trussmap::fuzz {
using namespace logs;
namespace {

namespace fs = std::filesystem;

/// A folder of this process alone, gone when it ends.
class BagFolder {
 public:
  BagFolder()
      : path_(fs::temp_directory_path() / ("trussmap_fuzz_bags_" + std::to_string(::getpid()))) {
    fs::create_directories(path_);
  }
  ~BagFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  BagFolder(const BagFolder&) = delete;
  BagFolder& operator=(const BagFolder&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

fs::path written(const std::string& name, std::string_view bytes) {
  static const BagFolder kFolder;
  const fs::path file = kFolder.path() / name;
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

/// Goes through every field, as whoever converts would.
double sum_of(const FieldRef& field) {
  double sum = field.is_number() ? field.number() : static_cast<double>(field.field().text.size());
  for (const FieldRef& one : field.children()) sum += sum_of(one);
  return sum;
}

void one_line(const std::string& what) {
  if (what.find('\n') != std::string::npos) throw std::logic_error("two lines");
}

template <typename Read>
void read_all(const fs::path& path, const Read& read) {
  double sum = 0.0;
  LogVisit visit;
  visit.elements = 100;
  visit.wanted = [](const LogTopic& topic) { return topic.name.size() % 5 != 4; };
  visit.message = [&sum](const LogMessage& message) { sum += sum_of(message.fields); };
  try {
    const LogEnd end = read(path, visit);
    for (const LogTopic& topic : end.topics) one_line(topic.unread);
    one_line(end.cut_off);
  } catch (const InputError& error) {
    one_line(error.what());
  }
}

void fuzz_mcap(std::string_view bytes) {
  read_all(written("bag.mcap", bytes), &read_mcap);
}

void fuzz_ros1(std::string_view bytes) {
  read_all(written("bag.bag", bytes), &read_rosbag2);
}

/// A definition, a line of "%", and a message of it.
void fuzz_cdr(std::string_view bytes) {
  constexpr std::string_view kBetween = "%\n";
  const std::size_t end = bytes.find(kBetween);
  if (end == std::string_view::npos) return;
  try {
    const Ros2Layout layout = parse_ros2_definition("my_msgs/msg/A", bytes.substr(0, end));
    FieldTree tree;
    decode_cdr(bytes.substr(end + kBetween.size()), layout, 100, tree);
    static_cast<void>(sum_of(tree.root()));
  } catch (const DefinitionError& error) {
    one_line(error.what());
  } catch (const CdrError& error) {
    one_line(error.what());
  }
}

/// A database, or metadata and then, after "====", an MCAP file that they may name.
void fuzz_rosbag2(std::string_view bytes) {
  if (bytes.starts_with("SQLite")) {
    read_all(written("bag.db3", bytes), &read_rosbag2);
    return;
  }
  constexpr std::string_view kBetween = "====\n";
  const std::size_t end = bytes.find(kBetween);
  if (end != std::string_view::npos) {
    static_cast<void>(written("bag/bag.mcap", bytes.substr(end + kBetween.size())));
  }
  const fs::path file = written("bag/metadata.yaml", bytes.substr(0, end));
  read_all(file.parent_path(), &read_rosbag2);
}

}  // namespace

std::map<std::string, Target> bag_targets() {
  return {
      {"cdr", &fuzz_cdr}, {"mcap", &fuzz_mcap}, {"ros1", &fuzz_ros1}, {"rosbag2", &fuzz_rosbag2}};
}

}  // namespace trussmap::fuzz
