// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/logs/map_guess.hpp"

#include <algorithm>
#include <set>

namespace trussmap {
namespace {

const std::vector<std::string> kTruthWords{"truth", "ground",    "mocap",    "vicon",
                                           "vrpn",  "optitrack", "qualisys", "/gt"};
const std::vector<std::string> kMarkWords{"tag",      "marker", "aruco",  "fiducial",
                                          "landmark", "april",  "beacon", "dock"};
const std::vector<std::string> kPlaceWords{"landmark", "code",    "tag",   "rfid",
                                           "qr",       "station", "marker"};
const std::vector<std::string> kBeaconWords{"uwb", "beacon", "anchor", "tag", "radio", "/range/"};

bool varies(const LogTopicFacts& topic, const std::string& path) {
  const auto found = std::find_if(topic.fields.begin(), topic.fields.end(),
                                  [&](const LogFieldFacts& one) { return one.path == path; });
  return found != topic.fields.end() && found->largest > found->least;
}

const LogFieldFacts* field_of(const LogTopicFacts& topic, const std::string& path) {
  const auto found = std::find_if(topic.fields.begin(), topic.fields.end(),
                                  [&](const LogFieldFacts& one) { return one.path == path; });
  return found == topic.fields.end() ? nullptr : &*found;
}

class TypeGuesser {
 public:
  TypeGuesser(const LogSurvey& survey, MapText& text) : survey_(survey), text_(text) {}

  Guessed guess() {
    time();
    wheels();
    imu();
    frames();
    for (const LogTopicFacts& topic : survey_.topics) {
      if (topic.messages > 0) places(topic);
    }
    truth();
    covariates();
    return found_;
  }

 private:
  void time() {
    text_.table("time");
    text_.text("from", "stamp", "header.stamp, and where there is none when it was recorded (log)");
  }

  /// Topics of a type, those with messages.
  [[nodiscard]] std::vector<const LogTopicFacts*> of_type(std::string_view type) const {
    std::vector<const LogTopicFacts*> found;
    for (const LogTopicFacts& one : survey_.topics) {
      if (short_type(one.type) == type && one.messages > 1) found.push_back(&one);
    }
    return found;
  }

  /// The two wheels among a JointState's joints.
  [[nodiscard]] static std::pair<std::string, std::string> joints_of(const LogTopicFacts& topic) {
    std::vector<std::string> left;
    std::vector<std::string> right;
    for (const LogFieldFacts& one : topic.fields) {
      if (!one.path.starts_with("position[") || !(one.largest > one.least)) continue;
      if (!has_word(one.path, {"wheel"})) continue;
      if (has_word(one.path, {"left", "_l_", "l_wheel", "wheel_l"})) left.push_back(one.path);
      if (has_word(one.path, {"right", "_r_", "r_wheel", "wheel_r"})) right.push_back(one.path);
    }
    if (left.size() != 1 || right.size() != 1) return {};
    return {left.front(), right.front()};
  }

  void robot(bool radius) {
    text_.blank();
    text_.table("robot");
    double base = 0.0;
    for (const FrameFacts& one : survey_.frames) {
      if (one.is_static && has_word(one.child, {"wheel"}) && has_word(one.child, {"left"})) {
        base = 2.0 * one.translation_y;
      }
    }
    if (base > 0.01) {
      text_.number("wheelbase", base, "m, twice how far to the left the left wheel's frame is");
    } else {
      text_.number("wheelbase", Robot().wheelbase, std::string("m between the wheels; ") + kState);
      ++found_.to_state;
    }
    if (!radius) return;
  }

  void wheels() {
    const std::vector<const LogTopicFacts*> odometries = odometry_topics();
    for (const LogTopicFacts* topic : of_type("sensor_msgs/JointState")) {
      const auto [left, right] = joints_of(*topic);
      if (left.empty()) continue;
      robot(true);
      for (const auto& [name, path] : {std::pair{"left", left}, std::pair{"right", right}}) {
        text_.blank();
        text_.table(std::string("wheels.") + name);
        text_.text("field", topic->name + '/' + path);
        text_.text("unit", "rad", "turns of the wheel so far");
        text_.number("radius", 0.05, std::string("m; ") + kState);
      }
      found_.to_state += 2;
      found_.wheels = true;
      if (!odometries.empty()) {
        text_.blank();
        text_.comment(
            "In place of [wheels.left] and [wheels.right], as the robot's own odometry has it:");
        text_.comment("[odometry]");
        text_.comment("twist = " + toml_string(odometries.front()->name));
      }
      return;
    }
    if (odometries.empty()) return;
    robot(false);
    text_.blank();
    const LogTopicFacts& topic = *odometries.front();
    const bool twist =
        varies(topic, "twist.twist.linear.x") && varies(topic, "twist.twist.angular.z");
    text_.table("odometry");
    text_.text(twist ? "twist" : "pose", topic.name,
               twist ? "velocities, held since the message before (pose: from its poses)"
                     : "from its poses: it has no velocities");
    for (std::size_t k = 1; k < odometries.size(); ++k) {
      text_.comment("another: " + odometries[k]->name);
    }
    found_.wheels = true;
  }

  /// Those that are the wheels' own first: no filter's, no truth.
  [[nodiscard]] std::vector<const LogTopicFacts*> odometry_topics() const {
    std::vector<const LogTopicFacts*> found = of_type("nav_msgs/Odometry");
    std::erase_if(found, [](const LogTopicFacts* one) { return has_word(one->name, kTruthWords); });
    std::stable_sort(found.begin(), found.end(), [](const auto* a, const auto* b) {
      const auto rank = [](const LogTopicFacts* one) {
        if (has_word(one->name, {"wheel", "raw", "controller"})) return 0;
        return has_word(one->name, {"filter", "ekf", "fused", "laser", "visual", "global", "gps",
                                    "map", "vio", "icp", "slam"})
                   ? 2
                   : 1;
      };
      return rank(a) < rank(b);
    });
    return found;
  }

  void imu() {
    for (const LogTopicFacts* topic : of_type("sensor_msgs/Imu")) {
      const LogFieldFacts* none = field_of(*topic, "orientation_covariance[0]");
      const bool oriented =
          varies(*topic, "orientation.z") && (none == nullptr || none->largest >= 0.0);
      const bool turns = varies(*topic, "angular_velocity.z");
      if (turns) {
        text_.blank();
        text_.table("yaw_rate");
        text_.text("field", topic->name + "/angular_velocity.z");
        text_.text("unit", "rad/s", "counter-clockwise; sign = -1 where it is not");
      }
      if (oriented) {
        text_.blank();
        const bool compass = !turns || !of_type("sensor_msgs/MagneticField").empty();
        const std::string off = compass ? "" : "# ";
        if (!compass) {
          text_.comment(
              "The IMU's orientation, if a magnetometer is in it; what sums up its own gyro is no "
              "compass:");
        }
        text_.line(off + "[heading]");
        text_.line(off + "field = " + toml_string(topic->name + "/orientation"));
        text_.line(off + "unit = \"quaternion\"");
      }
      if (turns || oriented) return;
    }
  }

  [[nodiscard]] std::string base_frame() const {
    for (const char* wanted : {"base_link", "base_footprint", "base"}) {
      for (const FrameFacts& one : survey_.frames) {
        if (one.child == wanted || one.parent == wanted) return wanted;
      }
    }
    return "base_link";
  }

  /// Frames that a camera sees: they move, and are called like a tag.
  void frames() {
    std::vector<const FrameFacts*> seen;
    for (const FrameFacts& one : survey_.frames) {
      const bool numbered = one.child.find(':') != std::string::npos;
      if (!one.is_static && one.samples > 0 && (numbered || has_word(one.child, kMarkWords)) &&
          !has_word(one.child, {"wheel", "base"})) {
        seen.push_back(&one);
      }
    }
    std::set<std::string> done;
    for (const FrameFacts* one : seen) {
      const std::string pattern = pattern_of(one->child);
      if (!done.insert(pattern).second) continue;
      text_.blank();
      text_.list("sightings", "each transform to such a frame is a sighting");
      text_.text("frames", pattern);
      text_.text("base", base_frame(), "the robot's frame: between its wheels, x ahead");
      const bool flat = one->upright_z > 0.7;
      text_.text("axis", flat ? "x" : "z",
                 flat ? "whose direction in the plane is the tag's own: its z stands up"
                      : "whose direction in the plane is the tag's own: it hangs on a wall");
      found_.places = true;
    }
  }

  /// "tag36h11:*" of "tag36h11:5".
  [[nodiscard]] static std::string pattern_of(const std::string& name) {
    std::size_t end = name.find(':');
    if (end != std::string::npos) return name.substr(0, end + 1) + "*";
    end = name.find_first_of("0123456789");
    return end == std::string::npos || end == 0 ? name : name.substr(0, end) + "*";
  }

  void places(const LogTopicFacts& topic) {
    const std::string type = short_type(topic.type);
    if (type == "sensor_msgs/NavSatFix") {
      text_.blank();
      text_.table("fixes", "x to the east and y to the north of the first");
      text_.text("topic", topic.name);
      found_.places = true;
    } else if (type == "geometry_msgs/PointStamped" &&
               has_word(topic.name, {"fix", "gps", "gnss", "uwb", "position"})) {
      text_.blank();
      text_.table("fixes");
      text_.text("topic", topic.name);
      found_.places = true;
    } else if (type == "std_msgs/String" && has_word(topic.name, kPlaceWords)) {
      text_.blank();
      text_.list("sightings", "the robot stands on what it names");
      text_.text("topic", topic.name);
      text_.text("landmark", "data");
      found_.places = true;
    } else if (type == "sensor_msgs/Range") {
      const bool beacon = has_word(topic.name, kBeaconWords);
      const std::string off = beacon ? "" : "# ";
      text_.blank();
      if (!beacon) text_.comment("Only if this is the range to a beacon, not to obstacles:");
      text_.line(off + "[[sightings]]");
      text_.line(off + "topic = " + toml_string(topic.name));
      text_.line(off + "name = " + toml_string(topic.name.substr(topic.name.rfind('/') + 1)),
                 "the beacon");
      text_.line(off + "range = \"range\"");
      found_.places = found_.places || beacon;
    } else if (type == "ros2_aruco_interfaces/ArucoMarkers") {
      text_.blank();
      text_.list("sightings");
      text_.text("topic", topic.name);
      text_.text("each", "poses");
      text_.text("landmark", "../marker_ids[#]", "the number in the list beside");
      text_.line("position = \".\"", "the marker as the camera of header.frame_id has it");
      text_.text("prefix", "marker");
      text_.text("base", base_frame());
      text_.text("axis", "z");
      found_.places = true;
    } else if (type == "apriltag_msgs/AprilTagDetectionArray" && survey_.frames.empty()) {
      text_.blank();
      text_.comment(topic.name +
                    " has the tags' corners in the picture alone: record /tf, where the");
      text_.comment("detector puts their poses.");
    }
  }

  void truth() {
    for (const LogTopicFacts& topic : survey_.topics) {
      const std::string type = short_type(topic.type);
      const bool pose = type == "geometry_msgs/PoseStamped" ||
                        type == "geometry_msgs/PoseWithCovarianceStamped" ||
                        type == "nav_msgs/Odometry" || type == "geometry_msgs/TransformStamped";
      if (!pose || topic.messages < 2) continue;
      const bool is_truth = has_word(topic.name, kTruthWords);
      if (!is_truth && type == "nav_msgs/Odometry") continue;
      text_.blank();
      const std::string off = is_truth ? "" : "# ";
      if (!is_truth) {
        text_.comment(
            "Only if measured apart from the robot (motion capture), no estimate of its own:");
      }
      text_.line(off + "[truth]");
      text_.line(off + "pose = " + toml_string(topic.name));
      found_.places = found_.places || is_truth;
      if (is_truth) return;
    }
  }

  void covariates() {
    bool any = false;
    for (const LogTopicFacts& topic : survey_.topics) {
      const std::string type = short_type(topic.type);
      std::string path;
      if (type == "sensor_msgs/BatteryState") path = "voltage";
      if (type == "sensor_msgs/Temperature") path = "temperature";
      if (type.starts_with("std_msgs/")) path = "data";
      if (path.empty() || !varies(topic, path)) continue;
      if (!any) {
        text_.blank();
        text_.table("covariates", "what else may matter; a row has the last value before its end");
      }
      any = true;
      const std::string name = covariate_name(
          path == "data" ? topic.name.substr(topic.name.rfind('/') + 1) : topic.name + '_' + path);
      text_.text(name, topic.name + '/' + path);
    }
  }

  const LogSurvey& survey_;
  MapText& text_;
  Guessed found_;
};

}  // namespace

Guessed guess_by_types(const LogSurvey& survey, MapText& text) {
  return TypeGuesser(survey, text).guess();
}

}  // namespace trussmap
