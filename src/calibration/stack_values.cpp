// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/stack_values.hpp"

#include "drive/body_motion.hpp"
#include "drive/wheel_kinematics.hpp"
#include "trussmap/dead_reckoning.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include <fmt/format.h>

namespace trussmap {
using namespace calibration;

namespace {

/// What of the list is there to be told.
class Told {
 public:
  Told(const Robot& robot, const std::vector<RobotConstant>& list,
       const std::vector<ConstantValue>& values, bool mean)
      : robot_(robot), list_(list), values_(values), shows_mean_(mean) {}

  [[nodiscard]] const RobotConstant* find(const std::string& name) const {
    const auto found = std::find_if(list_.begin(), list_.end(), [&name](const RobotConstant& one) {
      return one.name == name && one.determined;
    });
    return found == list_.end() ? nullptr : &*found;
  }

  /// Mean of these wheels of the values, where one of them was asked for and none is unknown; all
  /// of them where `count` is 0.
  [[nodiscard]] std::optional<double> wheels(std::size_t first = 0, std::size_t count = 0) const {
    if (count == 0 && !shows_mean_) return std::nullopt;
    double sum = 0.0;
    std::size_t wheels = 0;
    std::size_t there = 0;
    bool asked = false;
    for (const ConstantValue& one : values_) {
      if (one.kind != ConstantKind::wheel) continue;
      const std::size_t place = there++;
      if (place < first || (count > 0 && place >= first + count)) continue;
      for (const RobotConstant& listed : list_) {
        if (listed.name != one.name) continue;
        if (!listed.determined) return std::nullopt;
        asked = true;
      }
      sum += listed_value(one);
      ++wheels;
    }
    return asked ? std::optional(sum / static_cast<double>(wheels)) : std::nullopt;
  }

  [[nodiscard]] std::size_t wheel_count() const {
    return static_cast<std::size_t>(
        std::count_if(values_.begin(), values_.end(),
                      [](const ConstantValue& one) { return one.kind == ConstantKind::wheel; }));
  }

  /// Whether a length stands in the list, be it as not determined.
  [[nodiscard]] bool asked_for_length() const {
    return std::any_of(list_.begin(), list_.end(), [](const RobotConstant& one) {
      return one.name == "wheelbase" || one.name == "length" || one.name == "radius";
    });
  }

  /// By what the length that turns go by is to be multiplied.
  [[nodiscard]] std::optional<double> length() const {
    const bool by_wheelbase =
        drive::has_left_and_right(robot_) || robot_.drive == DriveKind::mecanum;
    const RobotConstant* found = find(by_wheelbase                       ? "wheelbase"
                                      : robot_.drive == DriveKind::omni3 ? "radius"
                                                                         : "length");
    if (found == nullptr) return std::nullopt;
    return found->after / (by_wheelbase ? robot_.wheelbase : robot_.length);
  }

  /// Mean of all wheels, whether or not it was asked for.
  [[nodiscard]] double mean() const {
    double sum = 0.0;
    for (const ConstantValue& one : values_) {
      if (one.kind == ConstantKind::wheel) sum += listed_value(one);
    }
    return sum / static_cast<double>(std::max<std::size_t>(1, wheel_count()));
  }

 private:
  [[nodiscard]] double listed_value(const ConstantValue& one) const {
    const RobotConstant* listed = find(one.name);
    return listed == nullptr ? one.value : listed->after;
  }

  const Robot& robot_;
  const std::vector<RobotConstant>& list_;
  const std::vector<ConstantValue>& values_;
  bool shows_mean_;
};

void add_ros_two_sides(const Told& told, const Robot& robot, std::vector<StackValue>& out) {
  constexpr const char* kStack = "ros2_controllers, diff_drive_controller";
  if (const auto length = told.length()) {
    out.push_back({kStack, "wheel_separation_multiplier", *length, false,
                   fmt::format("of wheel_separation: {:.6g}", robot.wheelbase)});
  }
  const std::size_t side = told.wheel_count() / 2;
  const char* note = side > 1 ? "mean of its side" : "";
  if (const auto left = told.wheels(0, side)) {
    out.push_back({kStack, "left_wheel_radius_multiplier", *left, false, note});
  }
  if (const auto right = told.wheels(side, side)) {
    out.push_back({kStack, "right_wheel_radius_multiplier", *right, false, note});
  }
}

void add_ros(const Told& told, const Robot& robot, std::vector<StackValue>& out) {
  const std::optional<double> wheels = told.wheels();
  const std::optional<double> length = told.length();
  const auto add = [&out](const char* stack, const char* length_key,
                          const std::optional<double>& metres, const char* wheel_key,
                          const std::optional<double>& times) {
    if (metres) out.push_back({stack, length_key, *metres, false, "m"});
    if (times) out.push_back({stack, wheel_key, *times, true, "mean of the wheels"});
  };
  const auto scaled = [&length](double metres) {
    return length ? std::optional(*length * metres) : std::nullopt;
  };
  switch (robot.drive) {
    case DriveKind::differential:
    case DriveKind::skid_steer:
      return add_ros_two_sides(told, robot, out);
    case DriveKind::mecanum:
      return add("ros2_controllers, mecanum_drive_controller",
                 "kinematics.sum_of_robot_center_projection_on_X_Y_axis",
                 scaled(0.5 * (robot.wheelbase + robot.length)), "kinematics.wheels_radius",
                 wheels);
    case DriveKind::omni3:
      return add("ros2_controllers, omni_wheel_drive_controller", "robot_radius",
                 scaled(robot.length), "wheel_radius", wheels);
    case DriveKind::ackermann:
      return add("ros2_controllers, ackermann_steering_controller", "wheelbase",
                 scaled(robot.length), "traction_wheels_radius", wheels);
    case DriveKind::tricycle:
      return add("ros2_controllers, tricycle_steering_controller", "wheelbase",
                 scaled(robot.length), "traction_wheels_radius", wheels);
    case DriveKind::unicycle:
    case DriveKind::wheels:
      return;
  }
}

void add_road_runner(const Told& told, const Robot& robot, std::vector<StackValue>& out) {
  const bool mecanum = robot.drive == DriveKind::mecanum;
  if (!mecanum && robot.drive != DriveKind::differential) return;
  constexpr const char* kStack = "Road Runner";
  const char* note = mecanum ? "mean of the wheels" : "it knows one size of both wheels";
  const std::optional<double> wheels = told.wheels();
  if (wheels) out.push_back({kStack, "inPerTick", *wheels, true, note});
  const RobotConstant* aside = told.find("sideways");
  if (mecanum && (wheels || aside != nullptr)) {
    out.push_back({kStack, "lateralInPerTick",
                   told.mean() * (aside == nullptr ? 1.0 : aside->after), true, ""});
  }
  if (const auto length = told.length()) {
    out.push_back({kStack, "trackWidthTicks", *length / told.mean(), true, ""});
  } else if (wheels && !told.asked_for_length()) {
    out.push_back({kStack, "trackWidthTicks", 1.0 / *wheels, true, "the track stays"});
  }
}

constexpr double kMoves = 0.01;  // m/s, below which a row is rest

}  // namespace

}  // namespace trussmap

namespace trussmap::calibration {

std::vector<StackValue> stack_values(const Robot& robot, const std::vector<RobotConstant>& list,
                                     const std::vector<ConstantValue>& values, bool mean) {
  const Told told(robot, list, values, mean);
  std::vector<StackValue> out;
  add_ros(told, robot, out);
  add_road_runner(told, robot, out);
  return out;
}

}  // namespace trussmap::calibration

namespace trussmap {

RobotConstants with_velocity_variances(RobotConstants constants,
                                       const std::vector<DrivenRecording>& recordings,
                                       const Model& model) {
  if (constants.empty()) return constants;
  constexpr std::size_t kMostRows = 2000;  // of a recording; their noise hardly differs
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double time = 0.0;
  double way = 0.0;
  std::size_t rows = 0;
  for (const DrivenRecording& recording : recordings) {
    MotionRows drive = recording.drive;
    drive.yaw_rate.clear();
    drive.heading.clear();
    const std::size_t step = 1 + drive.rows() / kMostRows;
    double from = drive.start();
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      const double duration = drive.t[row] - from;
      const double travel = drive::mean_travel(drive.motion(row), model.robot);
      if (row % step == 0 && travel > kMoves * duration) {
        const PoseEstimate moved =
            dead_reckon({}, drive, from, drive.t[row], model.robot, model.noise);
        sum += moved.covariance.diagonal() / (duration * duration);
        time += duration;
        way += travel;
        ++rows;
      }
      from = drive.t[row];
    }
  }
  if (rows == 0) return constants;
  const auto count = static_cast<double>(rows);
  const std::string at =
      fmt::format("at {:.2g} m/s, a message each {:.2g} s", way / time, time / count);
  constexpr const char* kStack = "robot_localization, twist.covariance of the odometry";
  const auto add = [&](const char* key, double variance, const std::string& note) {
    constants.stacks.push_back({kStack, key, variance / count, false, note});
  };
  add("[0]", sum.x(), "vx, (m/s)^2, " + at);
  if (sum.y() > 1e-3 * sum.x()) add("[7]", sum.y(), "vy, (m/s)^2");
  add("[35]", sum.z(), "vyaw, (rad/s)^2");
  return constants;
}

}  // namespace trussmap
