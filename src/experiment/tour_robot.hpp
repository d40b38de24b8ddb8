// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The robot of a tour, and what it measures of each route: with errors of given sizes in map axes,
// or by its wheels and perhaps a compass.
#pragma once

#include "trussmap/arc.hpp"
#include "trussmap/landmark_map.hpp"
#include "trussmap/pose_graph.hpp"
#include "trussmap/tour_experiment.hpp"

#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace trussmap::experiment {

/// One traversal as measured.
struct TourLeg {
  Traversal in_map;                        ///< by dead reckoning where it is from wheels, map axes
  std::optional<Motion> motion;            ///< by wheels, in the robot's own axes
  std::optional<HeadingEstimate> reading;  ///< of the compass, before the motion
};

class TourRobot {
 public:
  TourRobot(const TourOptions& options, std::uint64_t seed);

  void begin_tour() { tour_begins_ = true; }

  /// Along a true displacement, m.
  [[nodiscard]] TourLeg drive(const Vector2& displacement);

 private:
  [[nodiscard]] TourLeg drive_wheels(const Vector2& displacement);
  [[nodiscard]] Traversal with_readings(const std::vector<DrivenRow>& rows, double heading);
  [[nodiscard]] HeadingEstimate read(double heading);

  const TourOptions& options_;
  std::mt19937_64 error_random_;
  std::mt19937_64 compass_random_;
  double heading_ = 0.0;        // rad, true
  HeadingEstimate believed_;    // by wheels and compass alone
  bool knows_heading_ = false;  // a compass has told it
  bool tour_begins_ = true;
};

/// Everything that wheels and compass measured, as a pose graph: a pose per visit of a landmark.
class TourGraph {
 public:
  void add(const std::string& from, const std::string& to, const Motion& motion,
           const std::optional<HeadingEstimate>& reading);
  [[nodiscard]] bool empty() const { return graph_.vertices.empty(); }

  /// The landmarks of a map where the graph's least squares have them; the map's first landmark
  /// stays, and without any reading the first heading is 0.
  [[nodiscard]] LandmarkGraph adjusted(const LandmarkGraph& map) const;

 private:
  int visit(const std::string& landmark);
  void point_north(int pose, const HeadingEstimate& heading);

  PoseGraph graph_;  // vertex 0: a fixed pose with heading 0
  std::map<std::string, int> points_;
  int here_ = -1;
};

}  // namespace trussmap::experiment
