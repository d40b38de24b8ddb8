// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A pose graph (g2o) as a recording: what SLAM benchmarks are kept in.
//
//   poses, in order of their ids   a second apart, the first at t = 0
//   edge from one to the next      a row of the drive `wheels`, whose columns forward, sideways [m]
//                                  and turn [rad] move the body evenly along one arc
//   every other edge of poses      a loop, with its own standard deviations
//   edge to a point                a sighting by range and bearing, of a landmark named by its id
//
// A recording has one noise for all rows and all sightings: the median of the edges'. The noise of
// a row arises evenly along it. Estimates of the vertices are not read.
#include "datasets/formats.hpp"
#include "geometry/index.hpp"
#include "io/recording_limits.hpp"
#include "statistics/median.hpp"
#include "trussmap/error.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/pose_graph.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/LU>

namespace trussmap::datasets {
namespace {

/// An edge the other way round; its information goes along.
PoseEdge reversed(const PoseEdge& edge) {
  PoseEdge result;
  result.from = edge.to;
  result.to = edge.from;
  const Matrix2 back = rotation(-edge.measured.heading);
  const Vector2 place = -(back * edge.measured.position());
  result.measured = {place.x(), place.y(), -edge.measured.heading};
  // d(reversed)/d(edge), less what errors of second order add.
  Matrix3 J = -pose_rotation(-edge.measured.heading);
  J.topRightCorner<2, 1>() = -quarter_turn(place);
  const Matrix3 inverse = J.inverse();
  result.information = inverse.transpose() * edge.information * inverse;
  return result;
}

/// Way ahead and to the left of a body that turns evenly as it goes.
Vector2 even_way(const Pose& displacement) {
  const double half = 0.5 * displacement.heading;
  const double chord = std::abs(half) < 1e-8 ? 1.0 : std::sin(half) / half;
  return rotation(-half) * displacement.position() / chord;
}

struct GraphRecording {
  Recording recording;
  Model model;           ///< the drive, and the noise
  int uneven_edges = 0;  ///< rows whose noise is not half to twice the median
};

class GraphReader {
 public:
  GraphReader(const PoseGraph& graph, const std::string& file) : graph_(graph), file_(file) {}

  GraphRecording run() {
    if (!graph_.displacement_edges.empty()) {
      fail("has edges between points, expected poses and what was seen from them");
    }
    number_poses();
    take_pose_edges();
    make_rows();
    make_sightings();
    if (result_.recording.loops.empty() && result_.recording.sightings.empty()) {
      fail("has no edges but those from pose to pose, expected loops or points");
    }
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(file_, 0, what); }

  [[nodiscard]] std::string name_of(int vertex) const {
    return std::to_string(graph_.vertices[idx(vertex)].id);
  }

  /// For SourceLine: edges have no lines any more.
  [[nodiscard]] std::string edge_name(int from, int to) const {
    return file_ + ", edge from " + name_of(from) + " to " + name_of(to);
  }

  [[noreturn]] void unknown(int from, int to) const {
    fail("has an edge from " + name_of(from) + " to " + name_of(to) +
         " that leaves a coordinate unknown, expected information of full rank");
  }

  [[nodiscard]] Matrix3 covariance_of(const PoseEdge& edge) const {
    Matrix3 covariance = edge.information.inverse();
    if (!covariance.allFinite() || !(covariance.diagonal().minCoeff() > 0.0)) {
      unknown(edge.from, edge.to);
    }
    return covariance;
  }

  void number_poses() {
    for (std::size_t k = 0; k < graph_.vertices.size(); ++k) {
      if (is_pose(graph_.vertices[k])) order_.push_back(static_cast<int>(k));
    }
    if (order_.size() < 3) {
      fail("has " + std::to_string(order_.size()) + " poses, expected three at least");
    }
    std::sort(order_.begin(), order_.end(), [this](int a, int b) {
      return graph_.vertices[idx(a)].id < graph_.vertices[idx(b)].id;
    });
    place_.resize(graph_.vertices.size());
    for (std::size_t k = 0; k < order_.size(); ++k) place_[idx(order_[k])] = static_cast<int>(k);
    steps_.resize(order_.size() - 1);
  }

  void take_pose_edges() {
    for (const PoseEdge& given : graph_.pose_edges) {
      const bool onward = place_[idx(given.from)] <= place_[idx(given.to)];
      const PoseEdge edge = onward ? given : reversed(given);
      const int from = place_[idx(edge.from)];
      if (place_[idx(edge.to)] == from + 1 && !steps_[idx(from)]) {
        steps_[idx(from)] = edge;
        continue;
      }
      if (edge.from == edge.to) fail("has an edge from " + name_of(edge.from) + " to itself");
      const Matrix3 covariance = covariance_of(edge);
      result_.recording.loops.push_back(
          {static_cast<double>(from), static_cast<double>(place_[idx(edge.to)]), edge.measured.x,
           edge.measured.y, edge.measured.heading,
           std::sqrt(0.5 * (covariance(0, 0) + covariance(1, 1))), std::sqrt(covariance(2, 2))});
      io::SourceLine(edge_name(edge.from, edge.to), 0).expect(result_.recording.loops.back());
    }
  }

  void make_rows() {
    Drive& drive = result_.recording.drive;
    drive.covariates = {{"forward", {}}, {"sideways", {}}, {"turn", {}}};
    std::vector<double> travel;
    std::vector<double> heading;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      if (!steps_[k]) {
        fail("has no edge from pose " + name_of(order_[k]) + " to the next, " +
             name_of(order_[k + 1]) + ", expected odometry between all");
      }
      const Vector2 way = even_way(steps_[k]->measured);
      drive.t.push_back(static_cast<double>(k + 1));
      drive.covariates[0].values.push_back(way.x());
      drive.covariates[1].values.push_back(way.y());
      drive.covariates[2].values.push_back(steps_[k]->measured.heading);
      io::SourceLine(edge_name(steps_[k]->from, steps_[k]->to), 0).expect_last_row(drive);
      const Matrix3 covariance = covariance_of(*steps_[k]);
      travel.push_back(0.5 * (covariance(0, 0) + covariance(1, 1)));
      heading.push_back(covariance(2, 2));
    }
    Model& model = result_.model;
    model.robot.drive = DriveKind::wheels;
    model.robot.columns = {"forward", "sideways", "turn"};
    model.robot.matrix = Matrix3::Identity();
    Noise& noise = model.noise;
    noise.left = noise.right = 0.0;
    noise.travel_per_s = std::sqrt(statistics::median(travel));
    noise.heading_per_s = std::sqrt(statistics::median(heading));
    const auto even = [](double variance, double sd) {
      return std::sqrt(variance) < 2.0 * sd && std::sqrt(variance) > 0.5 * sd;
    };
    for (std::size_t k = 0; k < travel.size(); ++k) {
      const bool both =
          even(travel[k], noise.travel_per_s) && even(heading[k], noise.heading_per_s);
      result_.uneven_edges += both ? 0 : 1;
    }
  }

  void make_sightings() {
    std::vector<Sighting>& sightings = result_.recording.sightings;
    std::vector<double> along;
    std::vector<double> across;
    for (const PointEdge& edge : graph_.point_edges) {
      const double range = edge.measured.norm();
      if (!(range > 0.0)) fail("sees a point where the robot is, expected a range above 0");
      const double bearing = std::atan2(edge.measured.y(), edge.measured.x());
      sightings.push_back(
          {static_cast<double>(place_[idx(edge.pose)]), name_of(edge.point), range, bearing});
      io::SourceLine(edge_name(edge.pose, edge.point), 0).expect(sightings.back());
      const Matrix2 R = rotation(bearing);
      if (!(edge.information.determinant() > 0.0)) unknown(edge.pose, edge.point);
      const Matrix2 covariance = R.transpose() * edge.information.inverse() * R;
      along.push_back(covariance(0, 0));
      across.push_back(covariance(1, 1) / (range * range));
    }
    std::stable_sort(sightings.begin(), sightings.end(),
                     [](const Sighting& a, const Sighting& b) { return a.t < b.t; });
    if (sightings.empty()) return;
    result_.model.noise.range = std::sqrt(statistics::median(along));
    result_.model.noise.bearing = std::sqrt(statistics::median(across));
  }

  const PoseGraph& graph_;
  const std::string& file_;
  std::vector<int> order_;  ///< vertices of the poses
  std::vector<int> place_;  ///< of a vertex in it
  std::vector<std::optional<PoseEdge>> steps_;
  GraphRecording result_;
};

}  // namespace

bool is_graph_recording(const std::filesystem::path& file) {
  return file.extension() == ".g2o" || file.string().ends_with(".g2o.xz");
}

Dataset read_graph_recording(const std::filesystem::path& file) {
  const std::string name = file.string();
  const PoseGraph graph = read_g2o(name);
  GraphRecording read = GraphReader(graph, name).run();
  read.recording.name = name;
  std::vector<DatasetFigure> figures{
      counted("rows", read.recording.drive.rows(), "drive rows, a second per pose"),
      counted("loops", read.recording.loops.size(), "loops"),
      counted("sightings", read.recording.sightings.size(), "sightings"),
      counted("uneven_edges", read.uneven_edges,
              "rows whose noise is not half to twice the median, which the model has")};
  return {std::move(read.recording), std::move(read.model), 0.0,
          "the pose graph " + name + ", a second per pose", std::move(figures)};
}

}  // namespace trussmap::datasets
