// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/sensor_places.hpp"

#include "calibration/reckoning.hpp"
#include "odometry/merge.hpp"
#include "statistics/median.hpp"
#include "statistics/thinned.hpp"
#include "trussmap/dead_reckoning.hpp"
#include "trussmap/planar.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/QR>

namespace trussmap::calibration {
namespace {

/// The places that a channel moves.
struct MovedPlace {
  Channel channel;
  std::optional<Mounting> Mountings::*place;
  double Mounting::*number;
};

constexpr MovedPlace kMoved[] = {{Channel::lever, &Mountings::sensor, &Mounting::x},
                                 {Channel::lever, &Mountings::tracked, &Mounting::x},
                                 {Channel::lever_left, &Mountings::sensor, &Mounting::y},
                                 {Channel::lever_left, &Mountings::tracked, &Mounting::y},
                                 {Channel::truth_heading, &Mountings::tracked, &Mounting::yaw},
                                 {Channel::antenna, &Mountings::antenna, &Mounting::x},
                                 {Channel::antenna_left, &Mountings::antenna, &Mounting::y},
                                 {Channel::scanner, &Mountings::scanner, &Mounting::x},
                                 {Channel::scanner_left, &Mountings::scanner, &Mounting::y},
                                 {Channel::scanner_yaw, &Mountings::scanner, &Mounting::yaw}};

/// What a sensor saw of a motion, in its own axes, and what the wheels say of it.
struct SeenMotion {
  Vector2 seen;
  Pose moved;
  double sd = 0.0;  ///< m, roughly: how far the wheels may be off
};

constexpr std::size_t kMostMotions = 3000;
constexpr double kTravelError = 0.02;   // of the way, and of a turn: what wheels are off by
constexpr double kReadingError = 0.02;  // m

double error_of(double way, double turned, double reach) {
  return kReadingError + kTravelError * (way + turned * reach);
}

std::vector<SeenMotion> motions_of_loops(const DrivenRecording& recording) {
  constexpr double kLongest = 5.0;  // s: further, and dead reckoning tells little
  std::vector<SeenMotion> result;
  const std::size_t every = 1 + recording.loops.size() / kMostMotions;
  for (std::size_t k = 0; k < recording.loops.size(); k += every) {
    const Loop& loop = recording.loops[k];
    if (!(loop.t2 > loop.t) || loop.t2 - loop.t > kLongest) continue;
    if (loop.t < recording.drive.start() || loop.t2 > recording.drive.t.back()) continue;
    const Pose moved = reckoned(recording.drive, {}, loop.t, loop.t2);
    const Vector2 seen(loop.dx, loop.dy);
    result.push_back(
        {seen, moved, error_of(moved.position().norm(), std::abs(moved.heading), seen.norm())});
  }
  return result;
}

/// Of a landmark that is seen again: seen from where it was, less the same turned.
std::vector<SeenMotion> motions_of_sightings(const DrivenRecording& recording) {
  constexpr double kLongest = 120.0;  // s
  struct Before {
    double t = 0.0;
    Pose pose;
    Vector2 offset;
    double way = 0.0;     // m, so far
    double turned = 0.0;  // rad
  };
  std::map<std::string, Before> last;
  std::vector<SeenMotion> result;
  Before now{recording.drive.start(), {}, Vector2::Zero()};
  for (const Sighting& sighting : recording.sightings) {
    if (!sighting.locates() || sighting.t < now.t) continue;
    for (const odometry::DriveRow& row :
         odometry::rows_between(recording.drive, now.t, sighting.t)) {
      const BodyMotion body = odometry::motion_of(recording.drive, row);
      now.pose = compose(now.pose, odometry::displacement_of(body));
      now.way += std::hypot(body.forward, body.sideways);
      now.turned += std::abs(body.turn);
    }
    now.t = sighting.t;
    now.offset = landmark_offset(sighting, {}).offset_robot;
    const auto [there, fresh] = last.try_emplace(sighting.landmark, now);
    if (fresh) continue;
    const Before from = std::exchange(there->second, now);
    if (now.t - from.t > kLongest) continue;
    const Pose moved = relative(from.pose, now.pose);
    result.push_back({from.offset - rotation(moved.heading) * now.offset, moved,
                      error_of(now.way - from.way, now.turned - from.turned,
                               std::max(from.offset.norm(), now.offset.norm()))});
  }
  return trussmap::statistics::thinned(std::move(result), kMostMotions);
}

/// By all of these, those that contradict the others with less say.
std::optional<Mounting> place_by(const std::vector<SeenMotion>& motions) {
  constexpr std::size_t kFewest = 10;
  constexpr double kFurthest = 10.0;  // m
  constexpr double kTellable = 1e-2;  // of the columns' size
  constexpr int kRounds = 8;
  if (motions.size() < kFewest) return std::nullopt;
  const auto rows = 2 * static_cast<Eigen::Index>(motions.size());
  Eigen::MatrixXd A(rows, 4);  // for (c cos y, c sin y, s)
  Eigen::VectorXd b(rows);
  Eigen::VectorXd sds(rows);
  Eigen::Index row = 0;
  for (const SeenMotion& one : motions) {
    A.block<2, 2>(row, 0) << one.seen.x(), -one.seen.y(), one.seen.y(), one.seen.x();
    A.block<2, 2>(row, 2) = Matrix2::Identity() - rotation(one.moved.heading);
    b.segment<2>(row) = one.moved.position();
    sds.segment<2>(row).setConstant(one.sd);
    row += 2;
  }
  Eigen::ArrayXd weights = sds.array().inverse();
  Eigen::Vector4d found = Eigen::Vector4d::Zero();
  for (int round = 0; round < kRounds; ++round) {
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(weights.matrix().asDiagonal() * A);
    solver.setThreshold(kTellable);
    if (solver.rank() < 4) return std::nullopt;
    found = solver.solve(weights.matrix().asDiagonal() * b);
    const Eigen::ArrayXd off = ((A * found - b).array() / sds.array()).abs();
    const double usual = statistics::median({off.data(), off.data() + off.size()});
    weights = sds.array().inverse() / (1.0 + (off / std::max(2.0 * usual, 1e-12)).square()).sqrt();
  }
  const Mounting place{found[2], found[3], std::atan2(found[1], found[0])};
  if (!(std::hypot(place.x, place.y) < kFurthest)) return std::nullopt;
  return place;
}

std::optional<Mounting> place_by(const std::vector<DrivenRecording>& recordings,
                                 std::vector<SeenMotion> (*motions_of)(const DrivenRecording&)) {
  std::vector<SeenMotion> all;
  for (const DrivenRecording& one : recordings) {
    const std::vector<SeenMotion> own = motions_of(one);
    all.insert(all.end(), own.begin(), own.end());
  }
  return place_by(trussmap::statistics::thinned(std::move(all), kMostMotions));
}

}  // namespace

Model with_places_in_robot(Model model) {
  for (Effect& effect : model.effects) {
    if (!effect.is_constant() || effect.per_session || effect.coefficients.empty()) continue;
    double& g = effect.coefficients.front();
    bool moves = false;
    for (const MovedPlace& one : kMoved) {
      if (one.channel != effect.channel) continue;
      moves = true;
      if (g == 0.0) continue;
      std::optional<Mounting>& at = model.robot.mounted.*one.place;
      if (!at) at.emplace();
      (*at).*one.number += g;
    }
    if (moves) g = 0.0;
  }
  return model;
}

MountingPlace place_named(std::string_view of) {
  return of == "antenna"   ? &Mountings::antenna
         : of == "sensor"  ? &Mountings::sensor
         : of == "tracked" ? &Mountings::tracked
                           : &Mountings::scanner;
}

Mounting stated_place(const Mountings& stated, std::string_view of) {
  return (stated.*place_named(of)).value_or(Mounting());
}

Mountings started_places(const std::vector<DrivenRecording>& recordings, const Robot& robot) {
  Mountings mounted = robot.mounted;
  if (!mounted.scanner) mounted.scanner = place_by(recordings, motions_of_loops);
  if (!mounted.sensor) mounted.sensor = place_by(recordings, motions_of_sightings);
  return mounted;
}

}  // namespace trussmap::calibration
