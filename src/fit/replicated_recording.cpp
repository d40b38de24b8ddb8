// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/replicated_recording.hpp"

#include "drive/body_motion.hpp"
#include "drive/row_variables.hpp"
#include "drive/unsteered.hpp"
#include "drive/wheels_and_gyro.hpp"
#include "effects/channel_physics.hpp"
#include "effects/corrected_recording.hpp"
#include "estimation/measurement_rows.hpp"
#include "estimation/noise_states.hpp"
#include "fit/noise_free.hpp"
#include "recording/floor_code.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include <Eigen/Eigenvalues>

namespace trussmap {
namespace {

constexpr int kRounds = 4;            // shapes see the rows that they change
constexpr double kLeastRange = 1e-6;  // m
constexpr double kMoved = 0.05;       // m: less is none between two stops

class Replicator {
 public:
  Replicator(const std::vector<Recording>& recordings, const FitState& fit, std::uint64_t seed)
      : fit_(fit),
        noise_(fit.model.noise),
        offsets_(offsets_of(fit)),
        random_(seed),
        recordings_(recordings),
        timed_(fit.recordings),
        state_(fit.adjustment.state) {}

  std::vector<Recording> run() {
    state_.noise.resize(0);
    miss_landmarks();
    lead_through_poses();
    measure_places();
    measure_fixes_and_loops();
    see_landmarks();
    for (std::size_t s = 0; s < timed_.size(); ++s) {
      part_wheels_and_gyro(s);
      disturb_drive(s);
      for (const NoiseProcess& one : noise_.processes) add(one, s);
    }
    return in_own_times();
  }

 private:
  double drawn(double sd) { return sd * normal_(random_); }

  /// Anew wherever the robot has driven on. Between two landmarks the path gives way little by
  /// little: a robot that turns on the spot goes nowhere.
  void miss_landmarks() {
    struct Stop {
      std::size_t pose = 0;
      Vector2 missed = Vector2::Zero();  ///< from where the fit has the robot
    };
    const std::vector<double> driven = driven_to_poses();
    const NoiseFree exact(fit_.recordings, fit_.model, fit_.problem, fit_.columns.border, offsets_,
                          state_);
    std::map<int, std::vector<Stop>> stops;  // per session
    for (const Measurement& one : fit_.problem.measurements) {
      if (one.kind == MeasurementKind::standing) stops[one.session].push_back({pose_of(one.from)});
    }
    for (auto& [session, list] : stops) {
      std::sort(list.begin(), list.end(),
                [](const Stop& a, const Stop& b) { return a.pose < b.pose; });
      for (std::size_t k = 0; k < list.size(); ++k) {
        const bool moved = k == 0 || driven[list[k].pose] - driven[list[k - 1].pose] > kMoved;
        if (!moved) {
          list[k].missed = list[k - 1].missed;
          continue;
        }
        const std::size_t pose = list[k].pose;
        const Vector2 from_fit = exact.state.poses[pose].position() - state_.poses[pose].position();
        list[k].missed = from_fit + Vector2(drawn(noise_.sighting), drawn(noise_.sighting));
      }
    }
    for (std::size_t k = 0; k < state_.poses.size(); ++k) {
      const std::vector<Stop>& list = stops[fit_.problem.poses[k].session];
      if (list.empty()) continue;
      const auto next =
          std::find_if(list.begin(), list.end(), [k](const Stop& one) { return one.pose >= k; });
      const Stop& to = next == list.end() ? list.back() : *next;
      const Stop& from = next == list.begin() || next == list.end() ? to : *(next - 1);
      const double way = driven[to.pose] - driven[from.pose];
      const double share = way > kMoved ? (driven[k] - driven[from.pose]) / way : 1.0;
      const Vector2 missed = from.missed + share * (to.missed - from.missed);
      state_.poses[k].x += missed.x();
      state_.poses[k].y += missed.y();
    }
  }

  /// m from the first pose.
  [[nodiscard]] std::vector<double> driven_to_poses() const {
    std::vector<double> driven(state_.poses.size(), 0.0);
    for (const Measurement& one : fit_.problem.measurements) {
      if (one.kind != MeasurementKind::segment) continue;
      for (const SegmentRow& row : fit_.problem.segments[one.source]) {
        driven[pose_of(one.to)] += std::abs(row.path);
      }
    }
    std::partial_sum(driven.begin(), driven.end(), driven.begin());
    return driven;
  }

  [[nodiscard]] std::size_t pose_of(int node) const {
    return idx(node - fit_.problem.landmark_count());
  }

  void lead_through_poses() {
    const Robot& robot = fit_.model.robot;
    for (int round = 0; round < kRounds; ++round) {
      const ShapeContext context(timed_, robot, paths_.empty() ? fit_.paths : paths_);
      border_ = border_as_fitted(fit_.model, context, fit_.columns.border);
      paths_ = fitted_paths(timed_, robot, fit_.problem, border_, offsets_, state_);
      for (std::size_t s = 0; s < timed_.size(); ++s) {
        Drive& drive = timed_[s].drive;
        for (std::size_t row = 0; row < drive.rows(); ++row) {
          Vector2& missing = paths_[s].missing[row];
          // Who rests goes on resting; the other rows take its share in the next round.
          if (!drive.rests(row)) {
            add_travel(drive, row, wheel_travel({missing[0], 0.0, missing[1]}, robot));
          }
          missing.setZero();
        }
      }
    }
  }

  /// rad; null of a landmark without one.
  [[nodiscard]] const double* orientation_of(int landmark) const {
    const std::vector<int>& oriented = fit_.problem.oriented;
    const auto at = std::find(oriented.begin(), oriented.end(), landmark);
    return at == oriented.end()
               ? nullptr
               : &state_.orientations[idx(static_cast<int>(at - oriented.begin()))];
  }

  void measure_places() {
    const auto& landmarks = fit_.problem.landmarks;
    // One survey, copied to every session, stays one.
    std::map<std::tuple<std::string, double, double>, Vector2> measured;
    std::map<std::tuple<std::string, double, double, double>, double> headings;
    for (std::size_t s = 0; s < timed_.size(); ++s) {
      for (SurveyPoint& one : timed_[s].survey) {
        const auto at = std::find(landmarks.begin(), landmarks.end(), one.landmark);
        if (at == landmarks.end()) continue;
        const auto landmark = static_cast<int>(at - landmarks.begin());
        const Vector2& place = state_.landmarks[idx(landmark)];
        const double sd = std::isnan(one.sd) ? noise_.survey : one.sd;
        const auto [known, fresh] =
            measured.try_emplace({one.landmark, one.x, one.y}, Vector2::Zero());
        if (fresh) known->second = place + Vector2(drawn(sd), drawn(sd));
        const double* orientation = orientation_of(landmark);
        if (orientation != nullptr && !std::isnan(one.heading)) {
          const auto [heading, new_heading] =
              headings.try_emplace({one.landmark, one.x, one.y, one.heading}, 0.0);
          if (new_heading) heading->second = *orientation + drawn(noise_.yaw);
          one.heading = heading->second;
        }
        one.x = known->second.x();
        one.y = known->second.y();
      }
      for (std::size_t row = 0; row < timed_[s].truth.size(); ++row) {
        TruthRow& one = timed_[s].truth[row];
        const Pose pose = pose_at(timed_[s].drive, paths_[s], one.t);
        Measurement measured_pose;
        measured_pose.kind = MeasurementKind::truth;
        measured_pose.session = static_cast<int>(s);
        measured_pose.source = row;
        const ViewPattern view = view_of(border_, offsets_, measured_pose);
        const Vector2 place =
            pose.position() + rotation(pose.heading) * Vector2(view.ahead, view.left);
        one.x = place.x() + drawn(noise_.truth);
        one.y = place.y() + drawn(noise_.truth);
        one.heading = wrap_angle(pose.heading + view.heading + drawn(noise_.truth_heading));
      }
    }
  }

  void measure_fixes_and_loops() {
    for (std::size_t s = 0; s < timed_.size(); ++s) {
      const Drive& drive = timed_[s].drive;
      for (std::size_t row = 0; row < timed_[s].fixes.size(); ++row) {
        Fix& one = timed_[s].fixes[row];
        const Pose pose = pose_at(drive, paths_[s], one.t);
        Measurement measured;
        measured.kind = MeasurementKind::fix;
        measured.session = static_cast<int>(s);
        measured.source = row;
        const ViewPattern view = view_of(border_, offsets_, measured);
        const Vector2 antenna =
            rotation(pose.heading + view.heading) * Vector2(view.ahead, view.left);
        const double sd = std::isnan(one.sd) ? noise_.fix : one.sd;
        one.x = pose.x + antenna.x() + view.x + drawn(sd);
        one.y = pose.y + antenna.y() + view.y + drawn(sd);
      }
      for (Loop& one : timed_[s].loops) {
        const Pose step =
            relative(pose_at(drive, paths_[s], one.t), pose_at(drive, paths_[s], one.t2));
        const double sd = std::isnan(one.sd) ? noise_.loop : one.sd;
        const double sd_heading = std::isnan(one.sd_heading) ? noise_.loop_heading : one.sd_heading;
        one.dx = step.x + drawn(sd);
        one.dy = step.y + drawn(sd);
        one.dtheta = wrap_angle(step.heading + drawn(sd_heading));
      }
    }
  }

  void see_landmarks() {
    for (const Measurement& one : fit_.problem.measurements) {
      if (one.kind == MeasurementKind::sighting_yaw) see_yaw(one);
      if (!is_sighting(one.kind) || one.kind == MeasurementKind::standing) continue;
      Sighting& sighting = timed_[idx(one.session)].sightings[one.source];
      const Vector4 seen = one.value + measurement_rows(fit_.problem, one, state_, one.value,
                                                        view_of(border_, offsets_, one))
                                           .error;
      if (one.kind == MeasurementKind::direction) {
        sighting.bearing = wrap_angle(seen[0] + drawn(noise_.bearing));
        continue;
      }
      const bool offset = one.kind == MeasurementKind::cartesian_view;
      const double range = offset ? seen.head<2>().norm() : seen[0];
      const double bearing = offset ? direction(seen.head<2>()) : seen[1];
      const double sd = std::hypot(noise_.range, noise_.range_relative * range);
      sighting.range = std::max(range + drawn(sd), kLeastRange);
      if (!std::isnan(sighting.bearing)) {
        sighting.bearing = wrap_angle(bearing + drawn(noise_.bearing));
      }
    }
  }

  /// Where the robot stands beside a floor code stays as it was in its own axes.
  void see_yaw(const Measurement& one) {
    Sighting& sighting = timed_[idx(one.session)].sightings[one.source];
    const Vector2 code = code_from_robot(sighting);
    const double seen = one.value[0] + measurement_rows(fit_.problem, one, state_, one.value,
                                                        view_of(border_, offsets_, one))
                                           .error[0];
    sighting.yaw = wrap_angle(seen + drawn(noise_.yaw));
    if (!std::isnan(sighting.dx)) place_by_code(code, sighting);
  }

  /// Of a drive along which both lead, what wheels and gyro each show without noise.
  void part_wheels_and_gyro(std::size_t s) {
    Drive& drive = timed_[s].drive;
    const auto patterns = drive_patterns(border_, s);
    const Robot& robot = fit_.model.robot;
    for (std::size_t row = 0; row < drive.gyro.size(); ++row) {
      const GyroShare& gyro = drive.gyro[row];
      if (!std::isfinite(gyro.variance)) continue;
      double excess = 0.0;  // that the effects bring
      for (std::size_t k = 0; k < patterns.size(); ++k) {
        if (patterns[k] == nullptr) continue;
        excess += offsets_[static_cast<Eigen::Index>(k)] * (*patterns[k])[row].excess;
      }
      const double along = gyro.along * excess;
      const double apart = wheel_travel({0.0, 0.0, gyro.turn}, robot).right * excess;
      add_travel(drive, row, {along - apart, along + apart});
      if (!drive.sideways.empty()) drive.sideways[row] += gyro.aside * excess;
      const double duration = drive.duration(row);
      const double turn = body_motion(drive, row, robot).turn - excess;
      drive.yaw_rate[row] = (turn + drawn(noise_.gyro * std::sqrt(duration))) / duration;
    }
    drive.gyro.clear();
  }

  /// Of other wheels than two: what their noise does to the body.
  void disturb_columns(Drive& drive, std::size_t row) {
    const ArcNoise own = row_noise(drive, row, 1.0, drive.duration(row), fit_.model.robot, noise_);
    Matrix3 Q;
    Q << own.along, own.along_aside, own.shared,        //
        own.along_aside, own.aside, own.heading_aside,  //
        own.shared, own.heading_aside, own.heading;
    const Eigen::SelfAdjointEigenSolver<Matrix3> axes(Q);
    Eigen::Vector3d more = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      more += drawn(std::sqrt(std::max(axes.eigenvalues()[k], 0.0))) * axes.eigenvectors().col(k);
    }
    add_travel(drive, row, wheel_travel({more[0], 0.0, more[2]}, fit_.model.robot));
    if (!drive.sideways.empty()) drive.sideways[row] += more[1];
  }

  void disturb_drive(std::size_t s) {
    Drive& drive = timed_[s].drive;
    const auto patterns = drive_patterns(border_, s);
    const Robot& robot = fit_.model.robot;
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      double& left = drive.left[row];
      double& right = drive.right[row];
      const double duration = drive.duration(row);
      const double turn = std::abs(body_motion(drive, row, robot).turn);
      const double heading =
          drawn(std::sqrt(noise_.heading_per_s * noise_.heading_per_s * duration +
                          noise_.heading_per_rad * noise_.heading_per_rad * turn));
      const double travel = drawn(noise_.travel_per_s * std::sqrt(duration));
      if (drive.wheels.empty()) {
        const WheelTravel turned = wheel_travel({0.0, 0.0, heading}, robot);
        left += drawn(noise_.left * std::sqrt(std::abs(left))) + travel + turned.left;
        right += drawn(noise_.right * std::sqrt(std::abs(right))) + travel + turned.right;
      } else {
        disturb_columns(drive, row);
      }
      if (!drive.has_compass() || std::isnan(drive.heading[row])) continue;
      double shown = paths_[s].ends[row].heading;
      for (std::size_t k = 0; k < patterns.size(); ++k) {
        if (patterns[k] == nullptr) continue;
        shown += offsets_[static_cast<Eigen::Index>(k)] * (*patterns[k])[row].compass;
      }
      drive.heading[row] = wrap_angle(shown + drawn(noise_.compass));
    }
  }

  /// Delays back in their places: a fit moves what was sighted to when it was seen.
  std::vector<Recording> in_own_times() {
    for (std::size_t s = 0; s < recordings_.size(); ++s) {
      Recording& own = recordings_[s];
      take_events(s, own.sightings, timed_[s].sightings);
      take_events(s, own.truth, timed_[s].truth);
      take_events(s, own.fixes, timed_[s].fixes, Channel::fix_delay);
      own.loops = timed_[s].loops;
      take_drive(own.drive, std::move(timed_[s].drive));
      own.survey = std::move(timed_[s].survey);
    }
    return std::move(recordings_);
  }

  /// Steering as it was read: a fit takes its effects in before all else.
  void take_drive(Drive& own, Drive&& timed) const {
    std::vector<WheelColumn> wheels = std::move(own.wheels);
    own = unsteered(std::move(timed), fit_.model.robot);
    own.wheels = std::move(wheels);
  }

  template <typename Event>
  void take_events(std::size_t s, std::vector<Event>& own, const std::vector<Event>& timed,
                   Channel delay = Channel::delay) const {
    const Recording& recording = recordings_[s];
    std::vector<double> instants;
    instants.reserve(own.size());
    for (const Event& one : own) instants.push_back(one.t);
    instants = retimed(instants, recording, s, recordings_.size(), fit_.model.effects,
                       fit_.model.robot, delay);
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < own.size(); ++k) {
      if (instants[k] >= recording.drive.start() && instants[k] <= recording.drive.t.back()) {
        order.push_back(k);
      }
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return instants[a] < instants[b]; });
    for (std::size_t k = 0; k < std::min(order.size(), timed.size()); ++k) {
      const double t = own[order[k]].t;
      own[order[k]] = timed[k];
      own[order[k]].t = t;
    }
  }

  // ----------------------------------------
  // Processes: g of the channel, drawn for every row's end.

  void add(const NoiseProcess& process, std::size_t s) {
    if (process.channel == Channel::fix_x || process.channel == Channel::fix_y) {
      add_to_fixes(process, s);
      return;
    }
    if (!is_recordable(process.channel)) {
      throw std::invalid_argument("noise of channel \"" + std::string(name_of(process.channel)) +
                                  "\" cannot be drawn: no recording can hold it");
    }
    Drive& drive = timed_[s].drive;
    const std::vector<double> g = gains(process, s);
    switch (acts_on(process.channel)) {
      case ActsOn::readings:
        for (std::size_t row = 0; row < drive.heading.size(); ++row) {
          drive.heading[row] = wrap_angle(drive.heading[row] + g[row]);
        }
        return;
      case ActsOn::drives:
        free_drive(process.channel, g, fit_.model.robot, drive);
        return;
      case ActsOn::views:
        see_through(process, g, timed_[s]);
        return;
    }
  }

  void add_to_fixes(const NoiseProcess& process, std::size_t s) {
    const std::vector<double> g = gains(process, s);
    for (Fix& one : timed_[s].fixes) {
      const bool white = process.process == ProcessKind::white;
      const double value = white ? drawn(process.sd) : g[row_at(timed_[s].drive, one.t)];
      (process.channel == Channel::fix_x ? one.x : one.y) += value;
    }
  }

  void see_through(const NoiseProcess& process, const std::vector<double>& g,
                   Recording& recording) {
    struct Pass {
      double seen = 0.0;
      double value = 0.0;
    };
    std::map<std::string, Pass> passes;
    for (Sighting& one : recording.sightings) {
      if (one.standing() && process.channel != Channel::sighting_yaw) continue;
      double value = g[row_at(recording.drive, one.t)];
      if (process.process == ProcessKind::white) value = drawn(process.sd);
      if (process.process == ProcessKind::per_pass) {
        const auto [at, fresh] = passes.try_emplace(one.landmark, Pass{});
        if (fresh || one.t - at->second.seen > kLongestGap) at->second.value = drawn(process.sd);
        at->second.seen = one.t;
        value = at->second.value;
      }
      one = without(process.channel, value, one);
      one.range = std::max(one.range, kLeastRange);
    }
  }

  [[nodiscard]] std::vector<double> gains(const NoiseProcess& process, std::size_t s) {
    const Drive& drive = timed_[s].drive;
    // Of the recording as it was: rests may be none any more.
    const std::vector<double> ends = ends_of_legs(fit_.recordings[s]);
    const bool way = goes_with_distance(process.process);
    std::vector<double> g(drive.rows(), 0.0);
    double value = is_walk(process.process) ? 0.0 : drawn(process.sd);
    int leg = 0;
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      const double lag =
          way ? 0.5 * std::abs(drive.left[row] + drive.right[row]) : drive.duration(row);
      const double middle = drive.t[row] - 0.5 * drive.duration(row);
      const double before = value;
      switch (process.process) {
        case ProcessKind::white:
          value = drawn(process.sd);
          break;
        case ProcessKind::per_leg: {
          const int at = leg_at(ends, middle);
          if (at != leg) value = drawn(process.sd);
          leg = at;
          break;
        }
        case ProcessKind::per_session:
        case ProcessKind::per_pass:
          break;
        case ProcessKind::correlated_in_t:
        case ProcessKind::correlated_in_distance: {
          const double keep = std::exp(-lag / process.length);
          value = keep * value + drawn(process.sd * std::sqrt(1.0 - keep * keep));
          break;
        }
        case ProcessKind::walk_in_t:
        case ProcessKind::walk_in_distance:
          value += drawn(process.sd * std::sqrt(lag));
          break;
      }
      // Wheels take the mean over a row, of a chain nearly that of its ends.
      const bool mean = is_chain(process.process) && acts_on(process.channel) == ActsOn::drives;
      g[row] = mean ? 0.5 * (before + value) : value;
    }
    return g;
  }

  const FitState& fit_;
  const Noise& noise_;
  Eigen::VectorXd offsets_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::vector<Recording> recordings_;
  std::vector<Recording> timed_;  ///< as fitted: moved back by the delays
  RecordingState state_;          ///< without lasting noise
  std::vector<SessionPath> paths_;
  EffectParameters border_;
};

}  // namespace

std::vector<Recording> replicated(const std::vector<Recording>& recordings, const FitState& fit,
                                  std::uint64_t seed) {
  return Replicator(recordings, fit, seed).run();
}

}  // namespace trussmap
