// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A rosbag2: a folder with metadata.yaml and the files that it names, in their order.
//
//   rosbag2_bagfile_information:
//     version: 5
//     storage_identifier: sqlite3            or mcap
//     relative_file_paths: [bag_0.db3]       .db3 or .mcap, and .zstd after it where compressed
//     compression_format: zstd
//     compression_mode: FILE                 or MESSAGE, or none
//
// Without metadata.yaml, as after a power cut, the folder's files are read in the order of their
// numbers; so are bags of ROS 1 (.bag), which have none. A file may be given alone as well.
//
// Source: rosbag2_storage of ROS 2.
#include "logs/byte_reader.hpp"
#include "logs/mcap.hpp"
#include "logs/ros1_bag.hpp"
#include "logs/rosbag2_sqlite.hpp"
#include "trussmap/error.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <fstream>
#include <system_error>
#include <yaml-cpp/yaml.h>

namespace trussmap::logs {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestMetadata = std::uintmax_t{16} << 20U;  // bytes

/// .db3, .mcap, those with .zstd, and .bag.
bool is_bag_name(const fs::path& file) {
  if (file.extension() == ".bag") return true;
  const fs::path name = file.extension() == ".zstd" ? file.stem() : file.filename();
  return name.extension() == ".db3" || name.extension() == ".mcap";
}

/// Names in the order of their numbers: bag_2 before bag_10.
bool comes_before(const fs::path& left, const fs::path& right) {
  const std::string a = left.filename().string();
  const std::string b = right.filename().string();
  std::size_t i = 0;
  std::size_t j = 0;
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto number = [&digit](const std::string& text, std::size_t& at) {
    while (at < text.size() && text[at] == '0') ++at;
    const std::size_t begin = at;
    while (at < text.size() && digit(text[at])) ++at;
    return text.substr(begin, at - begin);
  };
  while (i < a.size() && j < b.size()) {
    if (digit(a[i]) && digit(b[j])) {
      const std::string m = number(a, i);
      const std::string n = number(b, j);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
    } else if (a[i] != b[j]) {
      return a[i] < b[j];
    } else {
      ++i;
      ++j;
    }
  }
  return a.size() - i != b.size() - j ? a.size() - i < b.size() - j : a < b;
}

std::vector<fs::path> bag_files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    if (is_bag_name(entry->path()) && entry->is_regular_file(ignored)) {
      files.push_back(entry->path());
    }
  }
  std::sort(files.begin(), files.end(), comes_before);
  return files;
}

/// The path that metadata name: within the folder, or refused. The system would read a name with a
/// zero byte as far as that.
fs::path named_file(const fs::path& folder, const fs::path& metadata, const std::string& name) {
  const fs::path path(name);
  const bool leaves =
      path.empty() || path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end();
  if (leaves) {
    throw InputError(metadata.string(), 0,
                     "names the file \"" + in_a_line(name) + "\", expected one within the folder");
  }
  if (in_a_line(name) != name) {
    throw InputError(
        metadata.string(), 0,
        "names the file \"" + in_a_line(name) + "\", expected a name without control characters");
  }
  std::error_code ignored;
  // Before version 4 paths began with the folder's name.
  for (const fs::path& one : {folder / path, folder / path.filename()}) {
    if (fs::is_regular_file(one, ignored)) return one;
  }
  throw InputError(metadata.string(), 0,
                   "names the file \"" + in_a_line(name) + "\", which is not in the folder");
}

std::string text_of(const YAML::Node& node, const char* name) {
  const YAML::Node found = node[name];
  return found.IsDefined() && found.IsScalar() ? found.Scalar() : std::string();
}

std::vector<fs::path> files_of(const fs::path& folder, const YAML::Node& root,
                               const fs::path& metadata) {
  const auto fail = [&metadata](const std::string& what) {
    throw InputError(metadata.string(), 0, in_a_line(what));
  };
  const YAML::Node information =
      root.IsMap() ? root["rosbag2_bagfile_information"] : YAML::Node(YAML::NodeType::Undefined);
  if (!information.IsDefined() || !information.IsMap()) {
    fail("has no rosbag2_bagfile_information, expected the metadata of a rosbag2");
  }
  const std::string storage = text_of(information, "storage_identifier");
  if (storage != "sqlite3" && storage != "mcap") {
    fail("storage_identifier is \"" + storage + "\", expected sqlite3 or mcap");
  }
  const std::string compression = text_of(information, "compression_format");
  if (!compression.empty() && compression != "zstd") {
    fail("compression_format is \"" + compression + "\", expected zstd");
  }
  const YAML::Node names = information["relative_file_paths"];
  if (!names.IsDefined() || !names.IsSequence()) fail("has no relative_file_paths");
  std::vector<fs::path> files;
  for (const YAML::Node& one : names) {
    if (!one.IsScalar()) fail("relative_file_paths has an entry that is no name");
    files.push_back(named_file(folder, metadata, one.Scalar()));
  }
  return files;
}

std::vector<fs::path> files_of(const fs::path& folder) {
  const fs::path metadata = folder / "metadata.yaml";
  std::error_code ignored;
  if (!fs::exists(metadata, ignored)) return bag_files_in(folder);
  if (fs::file_size(metadata, ignored) > kLargestMetadata) {
    throw InputError(metadata.string(), 0,
                     "has more than " + std::to_string(kLargestMetadata) + " bytes");
  }
  try {
    return files_of(folder, YAML::Load(read_file(metadata)), metadata);
  } catch (const YAML::Exception& error) {
    const std::size_t line =
        error.mark.is_null() ? 0 : static_cast<std::size_t>(error.mark.line) + 1;
    throw InputError(metadata.string(), line, in_a_line(error.msg) + ", expected YAML");
  }
}

/// One file of a bag; what it lacks at its end.
std::string read_bag_file(const fs::path& file, BagTopics& topics) {
  if (is_ros1_bag(file) || file.extension() == ".bag") {
    return read_ros1_bag(file, file.string(), topics);
  }
  if (file.extension() == ".zstd") {
    DecompressedFile plain(file);
    std::string cut_off;
    const bool sqlite = file.stem().extension() == ".db3";
    if (!plain.cut_off().empty() && (sqlite || fs::file_size(plain.path()) == 0)) {
      throw InputError(file.string(), 0, plain.cut_off());
    }
    if (sqlite) {
      cut_off =
          read_rosbag2_sqlite(plain.path(), file.string(), topics, [&plain] { plain.remove(); });
    } else {
      cut_off = read_mcap_file(plain.path(), file.string(), topics);
    }
    return cut_off.empty() ? plain.cut_off() : cut_off;
  }
  if (is_mcap(file)) return read_mcap_file(file, file.string(), topics);
  return read_rosbag2_sqlite(file, file.string(), topics, [] {});
}

}  // namespace

bool is_rosbag2(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    const bool named = fs::exists(path / "metadata.yaml", ignored);
    return named || !bag_files_in(path).empty();
  }
  return (is_bag_name(path) && path.extension() != ".mcap" && fs::exists(path, ignored)) ||
         is_ros1_bag(path);
}

LogEnd read_rosbag2(const fs::path& path, const LogVisit& visit) {
  BagTopics topics(visit);
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) {
    std::string cut_off = read_bag_file(path, topics);
    return {topics.all(), std::move(cut_off)};
  }
  const std::vector<fs::path> files = files_of(path);
  if (files.empty()) {
    throw InputError(path.string(), 0, "has no files of a rosbag2 (.db3, .mcap)");
  }
  std::string cut_off;
  for (const fs::path& file : files) {
    const std::string one = read_bag_file(file, topics);
    if (one.empty()) continue;
    cut_off += (cut_off.empty() ? "" : "; ") + file.filename().string() + ": " + one;
  }
  return {topics.all(), std::move(cut_off)};
}

}  // namespace trussmap::logs
