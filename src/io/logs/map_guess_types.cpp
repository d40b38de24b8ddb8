// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/logs/map_guess.hpp"

#include <algorithm>
#include <set>

namespace trussmap {
namespace {

const std::vector<std::string> kMarkWords{"tag",      "marker", "aruco",  "fiducial",
                                          "landmark", "april",  "beacon", "dock"};
const std::vector<std::string> kPlaceWords{"landmark", "code",    "tag",   "rfid",
                                           "qr",       "station", "marker"};
const std::vector<std::string> kBeaconWords{"uwb", "beacon", "anchor", "tag", "radio", "/range/"};

const LogFieldFacts* field_of(const LogTopicFacts& topic, const std::string& path) {
  const auto found = std::find_if(topic.fields.begin(), topic.fields.end(),
                                  [&](const LogFieldFacts& one) { return one.path == path; });
  return found == topic.fields.end() ? nullptr : &*found;
}

bool varies(const LogTopicFacts& topic, const std::string& path) {
  const LogFieldFacts* field = field_of(topic, path);
  return field != nullptr && field->largest > field->least;
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

  void robot(const WheelTopics& topics) {
    text_.blank();
    text_.table("robot");
    double base = 0.0;
    for (const FrameFacts& one : survey_.frames) {
      if (one.is_static && has_word(one.child, {"wheel"}) && has_word(one.child, {"left"})) {
        base = 2.0 * one.translation_y;
      }
    }
    if (topics.constants) {
      text_.number("wheelbase", topics.constants->wheelbase,
                   "m between the wheels, as " + topics.odometry + " has it");
    } else if (base > 0.01) {
      text_.number("wheelbase", base, "m, twice how far to the left the left wheel's frame is");
    } else {
      text_.number("wheelbase", Robot().wheelbase, std::string("m between the wheels; ") + kState);
      ++found_.to_state;
    }
  }

  void wheels() {
    const WheelTopics& topics = survey_.wheels;
    if (!topics.left.empty()) {
      robot(topics);
      text_.blank();
      text_.table("wheels");
      text_.text("unit", "rad", "turns of the wheel so far");
      if (topics.constants) {
        text_.number("radius", topics.constants->radius, "m, as " + topics.odometry + " has it");
      } else {
        text_.number("radius", 0.05, std::string("m; ") + kState);
        ++found_.to_state;
      }
      text_.line("left.field = " + toml_string(topics.left));
      text_.line("right.field = " + toml_string(topics.right));
      found_.wheels = true;
      if (topics.odometry.empty()) return;
      text_.blank();
      text_.comment("In place of [wheels], as the robot's own odometry has it:");
      text_.comment("[odometry]");
      text_.comment("twist = " + toml_string(topics.odometry));
      return;
    }
    if (topics.odometry.empty()) return;
    robot(topics);
    text_.blank();
    text_.table("odometry");
    const auto topic = std::find_if(survey_.topics.begin(), survey_.topics.end(),
                                    [&](const auto& one) { return one.name == topics.odometry; });
    const bool twist =
        varies(*topic, "twist.twist.linear.x") && varies(*topic, "twist.twist.angular.z");
    text_.text(twist ? "twist" : "pose", topics.odometry,
               twist ? "velocities, held since the message before (pose: from its poses)"
                     : "from its poses: it has no velocities");
    for (const std::string& one : topics.others) text_.comment("another: " + one);
    found_.wheels = true;
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
      if (one->topic != "/tf") text_.text("tf", one->topic);
      text_.text("base", base_frame(), "the robot's frame: between its wheels, x ahead");
      if (!one->turns) {
        text_.line("use_yaw = false", "it never turns: whoever sees it does not see its direction");
        found_.places = true;
        continue;
      }
      const bool flat = survey_.upright_share(*one, base_frame()) > 0.7;
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
      const bool is_truth = is_called_truth(topic.name);
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
    std::set<std::string> names;
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
      std::string name = covariate_name(
          path == "data" ? topic.name.substr(topic.name.rfind('/') + 1) : topic.name + '_' + path);
      while (!names.insert(name).second) name += "_2";
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
