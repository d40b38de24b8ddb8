// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map_yaml_output.hpp"

#include "option_checks.hpp"
#include "terminal.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/write_files.hpp"

#include <vector>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

/// "L0_0, L0_1 and 14 more"
std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 5;
  if (names.size() <= kShown + 1) return fmt::format("{}", fmt::join(names, ", "));
  return fmt::format("{} and {} more", fmt::join(names.begin(), names.begin() + kShown, ", "),
                     names.size() - kShown);
}

}  // namespace

void add_map_yaml(const Command& command, MapYamlOptions& options) {
  command
      .add_option("--layout", options.layout,
                  "Of a map to .yaml: markers with frame_id, id, pose and covariance (nav2), or "
                  "the tag bundle of apriltag_ros (apriltag); nav2 if left out")
      .check(one_of({"nav2", "apriltag"}));
  command
      .add_option("--tag-size", options.tag_size,
                  "Of a map to .yaml: edge of the tags' black square [m]; apriltag needs it")
      .check(above_zero());
}

void check_map_yaml(const std::filesystem::path& out, const MapYamlOptions& options) {
  if (is_yaml_file(out) || (!options.layout && !options.tag_size)) return;
  throw UsageError(std::string(options.layout ? "--layout" : "--tag-size") +
                   " goes with a map to .yaml, and " + out.string() + " is none");
}

bool is_yaml_file(const std::filesystem::path& file) {
  return file.extension() == ".yaml" || file.extension() == ".yml";
}

void write_map_yaml(const LandmarkGraph& map, const std::filesystem::path& out,
                    const MapYamlOptions& options) {
  const bool bundle = options.layout.value_or("nav2") == "apriltag";
  if (bundle && !options.tag_size) {
    throw UsageError("--layout apriltag: each tag has a size there, expected --tag-size");
  }
  YamlMapOptions how;
  how.layout = bundle ? YamlLayout::apriltag : YamlLayout::markers;
  how.tag_size = options.tag_size;
  const YamlMap yaml = format_map_yaml(map, how);
  write_file(out, yaml.text);
  if (!yaml.without_id.empty()) {
    fmt::print("{}", warning_text(fmt::format(
                         "{}: {} (no number at the end of the name, or one that several have)",
                         bundle ? "left out" : "without an id", some_of(yaml.without_id))));
  }
  if (!yaml.without_heading.empty()) {
    fmt::print("note: {} landmarks have no heading in the map, and are not turned\n",
               yaml.without_heading.size());
  }
}

}  // namespace trussmap::app
