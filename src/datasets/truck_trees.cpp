// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "datasets/truck_trees.hpp"

#include "geometry/index.hpp"
#include "io/recording_limits.hpp"
#include "trussmap/error.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/pose_graph.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>

namespace trussmap::datasets {
namespace {

constexpr std::size_t kMostRows = 400;  // of an edge: 10 s

/// Six digits were written.
bool same(double sum, double written) {
  return std::abs(sum - written) <= 1e-5 * std::abs(written) + 1e-10;
}

bool rests(const BodyStep& step) {
  return step.ahead == 0.0;
}

/// How many rows from `first` on sum up to the edge; 0: none.
std::size_t rows_of(const Pose& edge, const std::vector<BodyStep>& steps, std::size_t first) {
  Pose sum;
  const std::size_t end = std::min(steps.size(), first + kMostRows);
  for (std::size_t row = first; row < end; ++row) {
    sum.x += steps[row].ahead * std::cos(sum.heading);
    sum.y += steps[row].ahead * std::sin(sum.heading);
    sum.heading += steps[row].turned;
    if (same(sum.x, edge.x) && same(sum.y, edge.y) && same(sum.heading, edge.heading)) {
      return row + 1 - first;
    }
  }
  return 0;
}

class TreeFinder {
 public:
  TreeFinder(const PoseGraph& graph, const std::string& file, const std::vector<BodyStep>& steps)
      : graph_(graph), file_(file), steps_(steps) {}

  /// The row at which each pose stands, by vertices: as many rows are over.
  std::map<int, std::size_t> run() {
    std::size_t at = 0;
    int last = graph_.pose_edges.empty() ? -1 : graph_.pose_edges.front().from;
    for (const PoseEdge& edge : graph_.pose_edges) {
      if (edge.from != last) {
        fail("has an edge from pose " + name_of(edge.from) + " after one to pose " + name_of(last) +
             ", expected the odometry from pose to pose in order");
      }
      std::size_t rows = rows_of(edge.measured, steps_, at);
      while (rows == 0 && at < steps_.size() && rests(steps_[at])) {
        rows = rows_of(edge.measured, steps_, ++at);
      }
      if (rows == 0) {
        fail("has an edge from pose " + name_of(edge.from) + " to " + name_of(edge.to) +
             " that the drive has not, expected the graph of this very drive");
      }
      rows_.try_emplace(edge.from, at);
      at += rows;
      rows_.insert_or_assign(edge.to, at);
      last = edge.to;
    }
    return rows_;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(file_, 0, what); }

  [[nodiscard]] std::string name_of(int vertex) const {
    return std::to_string(graph_.vertices[idx(vertex)].id);
  }

  const PoseGraph& graph_;
  const std::string& file_;
  const std::vector<BodyStep>& steps_;
  std::map<int, std::size_t> rows_;
};

}  // namespace

int take_trees(const std::filesystem::path& graph, const std::vector<BodyStep>& steps,
               Recording& recording) {
  const std::string file = graph.string();
  const PoseGraph read = read_g2o(file);
  const std::map<int, std::size_t> rows = TreeFinder(read, file, steps).run();
  std::int64_t last = 0;  // trees are counted on from the last pose
  for (const GraphVertex& one : read.vertices) {
    if (is_pose(one)) last = std::max(last, one.id);
  }
  const Drive& drive = recording.drive;
  for (const PointEdge& edge : read.point_edges) {
    const auto row = rows.find(edge.pose);
    if (row == rows.end()) {
      throw InputError(file, 0,
                       "sees a tree from pose " + std::to_string(read.vertices[idx(edge.pose)].id) +
                           ", to which no odometry leads, expected poses of the drive");
    }
    if (!(edge.measured.norm() > 0.0)) {
      throw InputError(file, 0, "sees a tree where the truck is, expected a range above 0");
    }
    const double t = row->second == 0 ? drive.start() : drive.t[row->second - 1];
    recording.sightings.push_back({t, std::to_string(read.vertices[idx(edge.point)].id - last - 1),
                                   edge.measured.norm(),
                                   std::atan2(edge.measured.y(), edge.measured.x())});
    io::SourceLine(file, 0).expect(recording.sightings.back());
  }
  std::stable_sort(recording.sightings.begin(), recording.sightings.end(),
                   [](const Sighting& a, const Sighting& b) { return a.t < b.t; });
  return static_cast<int>(rows.size());
}

}  // namespace trussmap::datasets
