// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a reader finds in a log as lines, as tests/logs/bags writes what it has put there:
//
//   TOPIC LOG_TIME PUBLISH_TIME
//    FIELD KIND VALUE            numbers by their bits, texts by their bytes
#pragma once

#include "logs/message_log.hpp"
#include "trussmap/error.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace trussmap::testing {

inline void add_lines(std::string& text, const logs::FieldRef& field, const std::string& path) {
  const logs::Field& one = field.field();
  switch (field.kind()) {
    case logs::FieldKind::number:
      text += fmt::format(" {} number {:016x}\n", path, std::bit_cast<std::uint64_t>(one.number));
      break;
    case logs::FieldKind::integer:
      text += fmt::format(" {} integer {}\n", path, one.integer);
      break;
    case logs::FieldKind::text:
      text += " " + path + " text ";
      for (const char c : one.text) text += fmt::format("{:02x}", static_cast<unsigned char>(c));
      text += "\n";
      break;
    case logs::FieldKind::list: {
      text += fmt::format(" {} list {}\n", path, one.length);
      std::size_t k = 0;
      for (const logs::FieldRef& child : field.children()) {
        add_lines(text, child, fmt::format("{}[{}]", path, k++));
      }
      break;
    }
    case logs::FieldKind::group:
      for (const logs::FieldRef& child : field.children()) {
        const std::string name(child.name());
        add_lines(text, child, path.empty() ? name : path + "." + name);
      }
      break;
  }
}

struct ReadLog {
  std::string lines;
  std::string error;  ///< of an InputError
  logs::LogEnd end;
};

template <typename Read>
ReadLog read_lines(const Read& read) {
  ReadLog result;
  logs::LogVisit visit;
  visit.wanted = [](const logs::LogTopic&) { return true; };
  visit.message = [&result](const logs::LogMessage& message) {
    result.lines +=
        fmt::format("{} {} {}\n", message.topic.name, message.log_time, message.publish_time);
    add_lines(result.lines, message.fields, "");
  };
  try {
    result.end = read(visit);
  } catch (const InputError& error) {
    result.error = error.what();
  }
  return result;
}

inline ReadLog read_lines(const std::filesystem::path& path) {
  return read_lines(
      [&path](const logs::LogVisit& visit) { return logs::read_message_log(path, visit); });
}

inline std::string content_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

struct TestBag {
  std::filesystem::path path;
  std::string expected;  ///< lines
};

/// Has tests/logs/bags write one into the folder; without a path where that failed.
inline TestBag write_test_bag(const std::filesystem::path& folder, const std::string& variant) {
  // Where Debian's packages for Python are; another Python may come first in the search path.
  const bool debian = std::filesystem::exists("/usr/bin/python3");
  const std::string command = fmt::format("{} -B '{}/tests/logs/bags/write_test_bags.py' '{}' '{}'",
                                          debian ? "/usr/bin/python3" : "python3",
                                          TRUSSMAP_SOURCE_DIR, folder.string(), variant);
  TestBag bag;
  FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return bag;
  std::array<char, 4096> buffer{};
  std::string path;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    path.append(buffer.data(), count);
  }
  if (::pclose(pipe) != 0 || path.empty()) return bag;
  path.pop_back();
  bag.path = path;
  bag.expected = content_of(folder / "expected.txt");
  return bag;
}

/// Every number to the bit, every time to the nanosecond, in the order of the file: at least so
/// many bytes of lines.
inline void expect_read_as_written(const TestBag& bag, std::size_t least) {
  const ReadLog log = read_lines(bag.path);
  EXPECT_EQ(log.error, "");
  EXPECT_EQ(log.end.cut_off, "");
  EXPECT_GT(bag.expected.size(), least);
  EXPECT_TRUE(log.lines == bag.expected);
}

}  // namespace trussmap::testing
