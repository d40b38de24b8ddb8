// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT

#include "drive/body_motion.hpp"
#include "logs/bag_builder.hpp"
#include "logs/recording_bag_map.hpp"
#include "odometry/row_reckoner.hpp"
#include "odometry/wheels_and_gyro.hpp"
#include "trussmap/log_files.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

namespace trussmap {
using namespace logs;

namespace {

Pose per_second(const Pose& motion, double seconds) {
  return {motion.x / seconds, motion.y / seconds, motion.heading / seconds};
}

/// Where `to` is from `from`, in its axes.
Pose seen_from(const Pose& from, const Pose& to) {
  const Vector2 way = rotation(-from.heading) * (to.position() - from.position());
  return {way.x(), way.y(), to.heading - from.heading};
}

double first_time(const DrivenRecording& recording) {
  double first = recording.drive.start();
  if (!recording.truth.empty()) first = std::min(first, recording.truth.front().t);
  if (!recording.fixes.empty()) first = std::min(first, recording.fixes.front().t);
  return first;
}

/// A recording on its way into a bag, topic by topic.
class RecordingBag {
 public:
  RecordingBag(const DrivenRecording& recording, const Model& model, const BagOptions& options)
      : recording_(recording),
        drive_(recording.drive),
        model_(model),
        options_(options),
        bag_(recording.name, options, first_time(recording)) {
    model_.effects.clear();
  }

  Bag run() {
    add_wheels();
    add_odometry();
    add_compass_and_gyro();
    add_sightings();
    add_fixes_and_truth();
    add_covariates();
    bag_.leave_out(recording_.loops.size(), "loops");
    bag_.leave_out(recording_.survey.size(), "surveyed landmarks");
    Bag bag = bag_.finish();
    bag.map = bag_map(bag, parts_, recording_, model_, options_);
    return bag;
  }

 private:
  /// Each wheel's readings, and what turns a reading into an angle.
  struct Wheel {
    std::string column;
    std::string joint;
    const std::vector<double>* readings;
    bool steers;
  };

  [[nodiscard]] std::vector<Wheel> wheels() const {
    const std::vector<std::string>& columns = model_.robot.columns;
    if (drive_.wheels.empty()) {
      if (columns.size() == 2) {
        return {{columns[0], columns[0], &drive_.pair.left, false},
                {columns[1], columns[1], &drive_.pair.right, false}};
      }
      return {{"left", "left_wheel", &drive_.pair.left, false},
              {"right", "right_wheel", &drive_.pair.right, false}};
    }
    std::vector<Wheel> found;
    for (const WheelColumn& one : drive_.wheels) {
      found.push_back({one.name, one.name, &one.reading, one.steers});
    }
    return found;
  }

  void add_wheels() {
    const std::vector<Wheel> wheels = this->wheels();
    std::vector<std::string> names;
    std::vector<double> travels(wheels.size(), 0.0);  // m so far
    std::vector<double> positions;
    for (const Wheel& one : wheels) {
      names.push_back(one.joint);
      parts_.wheels.push_back({one.column, one.joint, one.steers});
      // The first row's steering holds from its start.
      positions.push_back(one.steers ? one.readings->front() : 0.0);
    }
    const auto add = [&](double t) {
      bag_.add("/joint_states", kJointStateType, t,
               to_cdr(JointStateMessage{bag_.header(t, ""), names, positions}));
    };
    add(drive_.start());
    for (std::size_t row = 0; row < drive_.rows(); ++row) {
      for (std::size_t k = 0; k < wheels.size(); ++k) {
        const double reading = (*wheels[k].readings)[row];
        travels[k] += reading;
        positions[k] = wheels[k].steers ? reading : travels[k] / options_.wheel_radius;
      }
      add(drive_.t[row]);
    }
  }

  void add_odometry() {
    const std::vector<TimedPose> poses = dead_reckoned_poses(recording_, model_);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      OdometryMessage message{bag_.header(poses[k].t, options_.odom_frame), options_.robot_frame,
                              poses[k].estimate.pose, poses[k].estimate.covariance};
      if (k > 0) {
        const std::size_t row = k - 1;
        const double seconds = drive_.duration(row);
        const BodyMotion motion = drive_.motion(row);
        message.twist = per_second({motion.forward, motion.sideways, motion.turn}, seconds);
        message.twist_covariance =
            odometry::row_covariance(drive_, row, 1.0, seconds, model_.robot, model_.noise) /
            (seconds * seconds);
      } else {
        message.twist_covariance.diagonal().setConstant(kUnknownVariance);
      }
      bag_.add("/odom", kOdometryType, poses[k].t, to_cdr(message));
    }
  }

  void add_compass_and_gyro() {
    for (std::size_t row = 0; row < drive_.rows(); ++row) {
      ImuMessage message{bag_.header(drive_.t[row], options_.robot_frame), {}, {}};
      if (drive_.has_compass() && !std::isnan(drive_.heading[row])) {
        message.heading = {drive_.heading[row], std::pow(model_.noise.compass, 2)};
      }
      if (drive_.has_gyro() && !std::isnan(drive_.yaw_rate[row])) {
        // An angle random walk, of the mean over the row.
        message.yaw_rate = {drive_.yaw_rate[row],
                            std::pow(model_.noise.gyro, 2) / drive_.duration(row)};
      }
      if (!message.heading && !message.yaw_rate) continue;
      bag_.add("/imu/data", kImuType, drive_.t[row], to_cdr(message));
    }
  }

  void add_sightings() {
    std::size_t bearings = 0;
    std::size_t yaws = 0;
    parts_.yaws = true;
    std::vector<TransformMessage> transforms;  // of one time
    double t = 0.0;
    const auto close_transforms = [&] {
      if (transforms.empty()) return;
      bag_.add("/tf", kTransformsType, t, to_cdr(transforms));
      transforms.clear();
    };
    for (const Sighting& one : recording_.sightings) {
      if (one.t != t) close_transforms();
      t = one.t;
      const bool has_range = !std::isnan(one.range);
      if (has_range && !std::isnan(one.bearing)) {
        transforms.push_back({bag_.header(t, options_.robot_frame),
                              one.landmark,
                              {one.range * std::cos(one.bearing), one.range * std::sin(one.bearing),
                               std::isnan(one.yaw) ? 0.0 : one.yaw}});
        parts_.yaws = parts_.yaws && !std::isnan(one.yaw);
        continue;
      }
      if (!std::isnan(one.yaw)) ++yaws;
      if (one.standing()) {
        bag_.add("/landmark", kTextType, t, text_to_cdr(one.landmark));
      } else if (has_range) {
        add_range(one);
      } else {
        ++bearings;
      }
    }
    close_transforms();
    bag_.leave_out(bearings, "bearings alone");
    bag_.leave_out(yaws, "yaws of landmarks that were not seen by range and bearing");
  }

  void add_range(const Sighting& one) {
    const double sd =
        std::hypot(model_.noise.range, model_.noise.range_relative * std::abs(one.range));
    const std::string topic = bag_.topic_below("/range", one.landmark);
    if (ranges_.insert(topic).second) parts_.ranges.emplace_back(topic, one.landmark);
    bag_.add(topic, kRangeType, one.t,
             to_cdr(RangeMessage{bag_.header(one.t, one.landmark), one.range, sd * sd}));
  }

  void add_fixes_and_truth() {
    std::size_t stated = 0;
    for (const Fix& one : recording_.fixes) {
      bag_.add("/fix", kPointStampedType, one.t,
               point_to_cdr(bag_.header(one.t, options_.map_frame), {one.x, one.y}));
      if (!std::isnan(one.sd) || !std::isnan(one.quality)) ++stated;
    }
    for (const TruthRow& one : recording_.truth) {
      bag_.add("/truth", kPoseStampedType, one.t,
               pose_to_cdr(bag_.header(one.t, options_.map_frame), {one.x, one.y, one.heading}));
    }
    bag_.leave_out(stated, "standard deviations or qualities of fixes");
  }

  void add_covariates() {
    const std::vector<std::string>& columns = model_.robot.columns;
    for (const Covariate& one : drive_.covariates) {
      // The wheels of another drive stand in /joint_states.
      if (std::find(columns.begin(), columns.end(), one.name) != columns.end()) continue;
      const std::string topic = bag_.topic_below("/covariates", one.name);
      parts_.covariates.emplace_back(one.name, topic);
      for (std::size_t row = 0; row < drive_.rows(); ++row) {
        bag_.add(topic, kNumberType, drive_.t[row], number_to_cdr(one.values[row]));
      }
    }
  }

  const DrivenRecording& recording_;
  const MotionRows& drive_;
  Model model_;
  const BagOptions& options_;
  BagBuilder bag_;
  BagMapParts parts_;
  std::set<std::string> ranges_;  // topics
};

}  // namespace

Bag format_odometry_bag(const std::vector<TimedPose>& poses, bool in_map_frame,
                        const BagOptions& options) {
  if (poses.empty()) throw std::invalid_argument("a bag of no poses");
  for (std::size_t k = 1; k < poses.size(); ++k) {
    if (!(poses[k].t > poses[k - 1].t)) {
      throw std::invalid_argument("poses whose times do not increase");
    }
  }
  BagBuilder bag("the poses", options, poses.front().t);
  const std::string& frame = in_map_frame ? options.map_frame : options.odom_frame;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    OdometryMessage message{bag.header(poses[k].t, frame), options.robot_frame,
                            poses[k].estimate.pose, poses[k].estimate.covariance};
    if (poses.size() > 1) {
      const std::size_t end = std::max<std::size_t>(k, 1);
      message.twist = per_second(seen_from(poses[end - 1].estimate.pose, poses[end].estimate.pose),
                                 poses[end].t - poses[end - 1].t);
    }
    message.twist_covariance.diagonal().setConstant(kUnknownVariance);
    bag.add("/odometry/corrected", kOdometryType, poses[k].t, to_cdr(message));
  }
  return bag.finish();
}

Bag format_recording_bag(const Recording& recording, const Model& model,
                         const BagOptions& options) {
  if (!(options.wheel_radius > 0.0 && std::isfinite(options.wheel_radius))) {
    throw std::invalid_argument("the wheel radius must be above 0");
  }
  DrivenRecording taken = with_wheels(recording, model.robot);
  Model as_written = model;
  if (!taken.drive.unicycle.empty()) {  // the joints are those of two wheels that show the same
    for (std::size_t row = 0; row < taken.drive.rows(); ++row) {
      const auto [left, right] = drive::wheel_travel(taken.drive.motion(row), model.robot);
      taken.drive.pair.left.push_back(left);
      taken.drive.pair.right.push_back(right);
    }
    taken.drive.unicycle.clear();
    as_written.robot.drive = DriveKind::differential;
    as_written.robot.columns.clear();
  }
  return RecordingBag(taken, as_written, options).run();
}

}  // namespace trussmap
