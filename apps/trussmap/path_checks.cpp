// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "path_checks.hpp"

#include "command_line.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>

namespace trussmap::app {
namespace {

namespace fs = std::filesystem;

/// What is written, by the names that it has in every command.
constexpr std::array<std::string_view, 11> kWritten{"--out",  "OUT",       "--json", "--html",
                                                    "--csv",  "--svg",     "--tum",  "--kitti",
                                                    "--mcap", "--drawing", "--write"};
/// What is neither: stores and folders that a command goes on with, or adds files to.
constexpr std::array<std::string_view, 6> kGoesOn{"--store", "FLEET",  "--work",
                                                  "--plots", "--maps", "--floor-map"};
/// Of a recording's folder.
constexpr std::array<std::string_view, 6> kStreams{"drive.csv", "sightings.csv", "survey.csv",
                                                   "truth.csv", "fixes.csv",     "loops.csv"};

template <typename Names>
bool is_one_of(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

struct GivenPath {
  std::string option;
  fs::path path;
};

/// The same file or folder, by whatever links and names; one that is not there yet by its name.
bool same_place(const fs::path& a, const fs::path& b) {
  std::error_code unknown;
  if (fs::equivalent(a, b, unknown)) return true;
  const auto whole = [](const fs::path& path) {
    std::error_code ignored;
    return fs::weakly_canonical(fs::absolute(path, ignored), ignored);
  };
  return whole(a) == whole(b);
}

/// A terminal, pipe or device may well be both.
bool is_stream(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored) && !fs::is_regular_file(path, ignored) &&
         !fs::is_directory(path, ignored);
}

void check_against(const GivenPath& out, const GivenPath& in) {
  if (is_stream(out.path)) return;
  if (same_place(out.path, in.path)) {
    throw UsageError(out.option + " " + out.path.string() + " is what " + in.option +
                     " reads, expected another place to write to");
  }
  std::error_code ignored;
  const bool within = is_one_of(kStreams, out.path.filename().string()) &&
                      fs::is_directory(in.path, ignored) &&
                      same_place(fs::absolute(out.path, ignored).parent_path(), in.path);
  if (within) {
    throw UsageError(out.option + " " + out.path.string() + " is a file of the recording that " +
                     in.option + " reads, expected another place to write to");
  }
}

}  // namespace

void check_paths(const CLI::App& command) {
  std::vector<GivenPath> in;
  std::vector<GivenPath> out;
  for (const CLI::Option* option : command.get_options()) {
    const std::string type = option->get_type_name();
    const std::string name = option->get_single_name();
    const bool is_path =
        type == "FILE" || type == "DIR" || type == "FILE|DIR" || name == "RECORDING";
    if (!is_path || option->count() == 0) continue;
    for (const std::string& given : option->results()) {
      const std::string shown = option->get_positional() ? name : "--" + option->get_single_name();
      if (given.empty()) throw UsageError(shown + " is empty, expected a path");
      if (is_one_of(kGoesOn, shown)) continue;
      (is_one_of(kWritten, shown) ? out : in).push_back({shown, given});
    }
  }
  for (const GivenPath& one : out) {
    for (const GivenPath& read : in) check_against(one, read);
  }
}

void check_output(const fs::path& out, const std::string& option,
                  const std::vector<fs::path>& read) {
  for (const fs::path& one : read) check_against({"OUT", out}, {option, one});
}

}  // namespace trussmap::app
