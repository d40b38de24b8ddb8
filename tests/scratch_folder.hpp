// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A folder of the test's own that goes when the test does, and the command run from a test.
#pragma once

#include "command_path.hpp"
#include "json_file.hpp"
#include "json_schema.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

namespace trussmap::testing {

class ScratchFolder {
 public:
  ScratchFolder() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string("trussmap_") + info->test_suite_name() + "_" + info->name() +
                       "_" + std::to_string(::getpid());
    for (char& c : name) c = c == '/' ? '_' : c;
    path_ = std::filesystem::temp_directory_path() / name;
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }

  /// Every file below, with its content.
  [[nodiscard]] std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> result;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path_)) {
      if (!entry.is_regular_file()) continue;
      std::ostringstream text;
      text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
      result[std::filesystem::relative(entry.path(), path_).string()] = text.str();
    }
    return result;
  }

 private:
  std::filesystem::path path_;
};

struct Ran {
  int status = -1;
  std::string output;  ///< standard output and error together
};

/// Runs the trussmap command. What it writes with --json must be as its schema has it.
inline Ran run_trussmap(const std::string& arguments) {
  Ran ran;
  FILE* pipe = ::popen((command_path() + " " + arguments + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return ran;
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    ran.output.append(buffer.data(), count);
  }
  const int status = ::pclose(pipe);
  ran.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  const std::filesystem::path written = json_file_of(arguments);
  if (ran.status == 0 && std::filesystem::is_regular_file(written)) {
    for (const std::string& wrong : against_schema(read_json(written), definition_for(arguments))) {
      ADD_FAILURE() << "trussmap " << arguments << "\n  its JSON: " << wrong;
    }
  }
  return ran;
}

}  // namespace trussmap::testing
