// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Logs for tests: written by scripts that know nothing of our readers, and read into lines.
#pragma once

#include "logs/message_log.hpp"
#include "scratch_folder.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::testing {

/// {x=0.5 n=12i tag='a' list=[1i 2i]/2}: numbers with all their digits, lists with their lengths.
inline std::string in_text(logs::FieldRef field) {
  const auto parts = [&field](const char* open, const char* close) {
    std::string text = open;
    for (const logs::FieldRef& one : field.children()) {
      text += (text.size() > 1 ? " " : "") + std::string(one.name()) +
              (one.name().empty() ? "" : "=") + in_text(one);
    }
    return text + close;
  };
  switch (field.kind()) {
    case logs::FieldKind::group:
      return parts("{", "}");
    case logs::FieldKind::list:
      return parts("[", "]/") + std::to_string(field.field().length);
    case logs::FieldKind::text:
      return "'" + std::string(field.field().text) + "'";
    case logs::FieldKind::integer:
      return std::to_string(field.field().integer) + "i";
    case logs::FieldKind::number:
      break;
  }
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", field.number());
  return text;
}

struct LoggedMessages {
  std::vector<std::string> lines;  ///< "TOPIC TIME FIELDS", without the time where there is none
  logs::LogEnd end;
  std::string error;        ///< behind the file's name; empty: none
  std::size_t longest = 0;  ///< list or text
};

inline std::size_t longest_in(logs::FieldRef field) {
  std::size_t longest = std::max(field.field().length, field.field().text.size());
  for (const logs::FieldRef& one : field.children()) longest = std::max(longest, longest_in(one));
  return longest;
}

template <typename Reader>
LoggedMessages messages_of(const Reader& reader, const std::filesystem::path& file,
                           std::size_t elements = 4096) {
  LoggedMessages found;
  logs::LogVisit visit;
  visit.elements = elements;
  visit.wanted = [](const logs::LogTopic&) { return true; };
  visit.message = [&found](const logs::LogMessage& message) {
    const std::string time = message.has_time ? " " + std::to_string(message.log_time) : "";
    found.lines.push_back(message.topic.name + time + " " + in_text(message.fields));
    found.longest = std::max(found.longest, longest_in(message.fields));
  };
  try {
    found.end = reader(file, visit);
  } catch (const InputError& error) {
    found.error = std::string(error.what()).substr(file.string().size());
  }
  return found;
}

inline std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The log that a script writes to the file `path`, with the modules of tests/logs/bags at hand.
inline std::filesystem::path written_by(const ScratchFolder& scratch, const std::string& script) {
  const std::filesystem::path log = scratch.path() / "a.log";
  const auto file =
      scratch.write("write.py", "import sys\nsys.dont_write_bytecode = True\nsys.path.insert(0, '" +
                                    std::string(TRUSSMAP_SOURCE_DIR) +
                                    "/tests/logs/bags')\npath = '" + log.string() + "'\n" + script);
  // Where Debian's packages for Python are; another Python may come first in the search path.
  const std::string python =
      std::filesystem::exists("/usr/bin/python3") ? "/usr/bin/python3" : "python3";
  EXPECT_EQ(std::system((python + " " + file.string()).c_str()), 0) << script;
  return log;
}

/// Cut off at every tenth byte: what was before is read, and that it is cut off is said, in one
/// line; nothing at all is said where it ends between two records.
template <typename Reader>
void expect_prefixes(const Reader& reader, const std::string& log, std::size_t header) {
  const ScratchFolder scratch;
  const LoggedMessages whole = messages_of(reader, scratch.write("whole", log));
  ASSERT_EQ(whole.error, "");
  ASSERT_EQ(whole.end.cut_off, "");
  std::size_t cut_off = 0;
  std::size_t before = 0;
  for (std::size_t size = header; size < log.size(); size += 10) {
    const LoggedMessages part = messages_of(reader, scratch.write("part", log.substr(0, size)));
    EXPECT_EQ(part.error, "") << size;
    ASSERT_LE(part.lines.size(), whole.lines.size()) << size;
    EXPECT_GE(part.lines.size(), before) << size;
    before = part.lines.size();
    EXPECT_TRUE(std::equal(part.lines.begin(), part.lines.end(), whole.lines.begin())) << size;
    if (part.end.cut_off.empty()) continue;
    ++cut_off;
    EXPECT_TRUE(part.end.cut_off.starts_with("at byte ")) << part.end.cut_off;
    EXPECT_EQ(part.end.cut_off.find('\n'), std::string::npos);
  }
  EXPECT_GT(cut_off, (log.size() - header) / 10 * 3 / 4);
  EXPECT_GE(before, whole.lines.size() / 2);
}

/// Damaged at every seventh byte: read or refused in one line with the place; never a list or a
/// text that is longer than the file.
template <typename Reader>
void expect_damage_is_survived(const Reader& reader, const std::string& log) {
  const ScratchFolder scratch;
  std::size_t refused = 0;
  for (std::size_t at = 0; at < log.size(); at += 7) {
    for (const int byte : {log[at] ^ 0xFF, log[at] ^ 0x01, 0x00, 0x7F}) {
      std::string damaged = log;
      damaged[at] = static_cast<char>(byte);
      const LoggedMessages read = messages_of(reader, scratch.write("damaged", damaged));
      EXPECT_LE(read.longest, log.size()) << at;
      EXPECT_TRUE(read.error.empty() || read.error.starts_with(": at byte ")) << read.error;
      EXPECT_EQ(read.error.find('\n'), std::string::npos);
      refused += read.error.empty() ? 0U : 1U;
    }
  }
  EXPECT_GT(refused, 0U);
}

}  // namespace trussmap::testing
