// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map_files.hpp"

#include "commands.hpp"
#include "pose_graph/landmark_conversion.hpp"
#include "trussmap/map_files.hpp"

namespace trussmap::app {

bool is_map_file(const std::filesystem::path& file) {
  const auto ending = file.extension();
  return ending == ".graphml" || ending == ".g2o" || ending == ".geojson" || ending == ".dot";
}

void check_map_format(const std::filesystem::path& file) {
  if (is_map_file(file)) return;
  throw UsageError("cannot write " + file.string() + ": expected .graphml, .g2o, .geojson or .dot");
}

std::string format_map(const LandmarkGraph& map, const std::filesystem::path& file,
                       const std::string& comment) {
  check_map_format(file);
  if (file.extension() == ".g2o") return format_g2o(to_pose_graph(map));
  if (file.extension() == ".geojson") return format_geojson(map);
  if (file.extension() == ".dot") return format_dot(map);
  return format_map_graphml(map, comment);
}

LandmarkGraph read_map(const std::filesystem::path& file) {
  if (file.extension() == ".graphml") return read_map_graphml(file);
  if (file.extension() == ".g2o") return to_landmark_graph(read_g2o(file.string()));
  throw UsageError("cannot tell what " + file.string() +
                   " is: expected a map (.graphml, .g2o), DIR/RobotN of an MRCLAM data set, or "
                   "an OptiOdom run (..._run-NN.csv, plain or .xz)");
}

}  // namespace trussmap::app
