// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "experiment/tour_robot.hpp"

#include "geometry/index.hpp"
#include "map/heading_reset.hpp"
#include "map/reckoned_leg.hpp"
#include "simulation/route_robot.hpp"
#include "trussmap/dead_reckoning.hpp"
#include "trussmap/simulation.hpp"

#include <cmath>
#include <optional>
#include <utility>

namespace trussmap::experiment {
namespace {

constexpr double kStanding = 1e-4;  // m, how exactly a pose is a landmark's in the graph

}  // namespace

TourRobot::TourRobot(const TourOptions& options, std::uint64_t seed)
    : options_(options),
      error_random_(random_stream(seed, Stream::wheels)),
      compass_random_(random_stream(seed, Stream::compass)) {}

TourLeg TourRobot::drive(const Vector2& displacement) {
  if (options_.wheels) return drive_wheels(displacement);
  const simulation::MeasuredRoute measured = simulation::measure_route(
      displacement, {options_.odometry_error, options_.compass_error}, error_random_);
  TourLeg leg;
  leg.in_map = {measured.displacement, measured.covariance};
  return leg;
}

HeadingEstimate TourRobot::read(double heading) {
  const double sd = simulation::sd_of_mean_error(options_.compass_error);
  std::normal_distribution<double> error(0.0, sd);
  return {wrap_angle(heading + error(compass_random_)), sd * sd};
}

TourLeg TourRobot::drive_wheels(const Vector2& displacement) {
  const TourWheels& wheels = *options_.wheels;
  const WheelNoise noise{wheels.noise, wheels.noise};
  const double before = heading_;
  const double turn = wrap_angle(direction(displacement) - heading_);
  heading_ += turn;
  const std::vector<DrivenRow> rows =
      drive_route(turn, displacement.norm(), wheels.wheelbase, wheels.noise, error_random_);
  TourLeg leg;
  if (wheels.readings == CompassReadings::row) {
    leg.in_map = with_readings(rows, before);
    tour_begins_ = false;
    return leg;
  }
  const bool reads = wheels.readings == CompassReadings::landmark ||
                     (wheels.readings == CompassReadings::tour && tour_begins_);
  tour_begins_ = false;
  if (reads) {
    leg.reading = read(before);
    believed_ =
        map::with_reading(knows_heading_ ? std::optional(believed_) : std::nullopt, *leg.reading);
    knows_heading_ = true;
  }
  leg.motion.emplace();
  for (const DrivenRow& row : rows) {
    leg.motion = then(*leg.motion, arc_motion({row.left, row.right}, wheels.wheelbase, noise));
  }
  leg.in_map = map::in_map_axes(believed_, leg.motion->displacement.position(),
                                leg.motion->covariance.topLeftCorner<2, 2>());
  believed_.heading += leg.motion->displacement.heading;
  believed_.variance += leg.motion->covariance(2, 2);
  return leg;
}

/// Heading filtered row by row.
Traversal TourRobot::with_readings(const std::vector<DrivenRow>& rows, double heading) {
  const TourWheels& wheels = *options_.wheels;
  Robot robot;
  robot.wheelbase = wheels.wheelbase;
  Noise noise;
  noise.left = noise.right = wheels.noise;
  noise.compass = simulation::sd_of_mean_error(options_.compass_error);
  Recording recording;
  Drive& drive = recording.drive;
  const double whole = heading_ - heading;
  double turned = 0.0;
  double spun = 0.0;  // as recorded, of which the whole turn is known
  for (const DrivenRow& row : rows) {
    if (row.left * row.right < 0.0) spun += (row.right - row.left) / wheels.wheelbase;
  }
  for (const DrivenRow& row : rows) {
    if (row.left * row.right < 0.0 && spun != 0.0) {
      turned += whole * (row.right - row.left) / wheels.wheelbase / spun;
    } else {
      turned = whole;
    }
    drive.t.push_back(static_cast<double>(drive.t.size()) + 1.0);
    drive.left.push_back(row.left);
    drive.right.push_back(row.right);
    drive.heading.push_back(read(heading + turned).heading);
  }
  if (!knows_heading_) believed_ = read(heading);
  knows_heading_ = true;
  PoseEstimate start;
  start.pose.heading = believed_.heading;
  start.covariance(2, 2) = believed_.variance;
  const double last = drive.t.back();
  const PoseEstimate end =
      dead_reckon(start, with_wheels(std::move(recording), robot).drive, 0.0, last, robot, noise);
  believed_ = {end.pose.heading, end.covariance(2, 2)};
  return {end.pose.position(), end.covariance.topLeftCorner<2, 2>()};
}

int TourGraph::visit(const std::string& landmark) {
  const auto [point, is_new] =
      points_.try_emplace(landmark, static_cast<int>(graph_.vertices.size()));
  if (is_new) {
    graph_.vertices.push_back(
        {static_cast<std::int64_t>(graph_.vertices.size()), VertexKind::point, {}, false});
  }
  const int pose = static_cast<int>(graph_.vertices.size());
  graph_.vertices.push_back({pose, VertexKind::pose, {}, false});
  graph_.point_edges.push_back(
      {pose, point->second, Vector2::Zero(), Matrix2::Identity() / (kStanding * kStanding)});
  return pose;
}

void TourGraph::point_north(int pose, const HeadingEstimate& heading) {
  PoseEdge edge;
  edge.from = 0;
  edge.to = pose;
  edge.measured.heading = wrap_angle(heading.heading);
  edge.information(2, 2) = 1.0 / heading.variance;
  graph_.pose_edges.push_back(edge);
}

void TourGraph::add(const std::string& from, const std::string& to, const Motion& motion,
                    const std::optional<HeadingEstimate>& reading) {
  if (here_ < 0) {
    graph_.vertices.push_back({0, VertexKind::pose, Pose{}, true});
    here_ = visit(from);
    if (!reading) point_north(here_, {0.0, 1e-6});
  }
  if (reading) point_north(here_, *reading);
  const int next = visit(to);
  PoseEdge edge;
  edge.from = here_;
  edge.to = next;
  edge.measured = motion.displacement;
  edge.measured.heading = wrap_angle(edge.measured.heading);
  // A pose edge's error lies in the axes of its end.
  const Matrix3 P = pose_rotation(-motion.displacement.heading);
  edge.information = symmetrised((P * motion.covariance * P.transpose()).inverse());
  graph_.pose_edges.push_back(edge);
  here_ = next;
}

LandmarkGraph TourGraph::adjusted(const LandmarkGraph& map) const {
  LandmarkGraph result = map;
  PoseGraph graph = graph_;
  const Vector2 first = map.landmark(0).position;
  const int held = points_.at(map.landmark(0).name);
  graph.vertices[idx(held)].fixed = true;
  graph.vertices[idx(held)].estimate = Pose{first.x(), first.y(), 0.0};
  const PoseGraphAdjustment fit = adjust(graph);
  for (int k = 0; k < map.landmarks(); ++k) {
    result.set_position(k, fit.estimates[idx(points_.at(map.landmark(k).name))].position());
  }
  return result;
}

}  // namespace trussmap::experiment
