// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/map_files.hpp"

#include "io/landmark_conversion.hpp"
#include "trussmap/error.hpp"

#include <stdexcept>

namespace trussmap {

namespace {

bool is_yaml(const std::filesystem::path& file) {
  return file.extension() == ".yaml" || file.extension() == ".yml";
}

}  // namespace

bool is_map_file(const std::filesystem::path& file) {
  const auto ending = file.extension();
  return ending == ".graphml" || ending == ".g2o" || ending == ".geojson" || ending == ".dot" ||
         is_yaml(file);
}

LandmarkGraph read_map(const std::filesystem::path& file) {
  if (file.extension() == ".graphml") return read_map_graphml(file);
  if (file.extension() != ".g2o") {
    throw InputError(file.string(), 0, "is named like no map, expected .graphml or .g2o");
  }
  const PoseGraph graph = read_g2o(file.string());
  try {
    return io::to_landmark_graph(graph);
  } catch (const std::invalid_argument& error) {
    throw InputError(file.string(), 0, error.what());
  }
}

std::string format_map(const LandmarkGraph& map, const std::filesystem::path& file,
                       const std::string& comment) {
  const auto ending = file.extension();
  if (ending == ".graphml") return format_map_graphml(map, comment);
  if (ending == ".geojson") return format_geojson(map);
  if (ending == ".dot") return format_dot(map);
  if (is_yaml(file)) return format_map_yaml(map, {.comment = comment}).text;
  if (ending != ".g2o") {
    throw InputError(file.string(), 0,
                     "is named like no map, expected .graphml, .g2o, .geojson, .dot or .yaml");
  }
  try {
    return format_g2o(io::to_pose_graph(map));
  } catch (const std::invalid_argument& error) {
    throw InputError(file.string(), 0, std::string("cannot hold this map: ") + error.what());
  }
}

}  // namespace trussmap
