// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/map_guess.hpp"

#include <algorithm>
#include <optional>
#include <set>

namespace trussmap::logs {
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

/// Topics of a type, those with messages.
std::vector<const LogTopicFacts*> topics_of_type(const LogSurvey& survey, std::string_view type) {
  std::vector<const LogTopicFacts*> found;
  for (const LogTopicFacts& one : survey.topics) {
    if (short_type(one.type) == type && one.messages > 1) found.push_back(&one);
  }
  return found;
}

/// How many figures are left to state.
int robot_by_type(const LogSurvey& survey, MapText& text) {
  const WheelTopics& topics = survey.wheels;
  text.blank();
  text.table("robot");
  double base = 0.0;
  for (const FrameFacts& one : survey.frames) {
    if (one.is_static && has_word(one.child, {"wheel"}) && has_word(one.child, {"left"})) {
      base = 2.0 * one.translation_y;
    }
  }
  if (topics.constants) {
    text.number("wheelbase", topics.constants->wheelbase,
                "m between the wheels, as " + topics.odometry + " has it");
  } else if (base > 0.01) {
    text.number("wheelbase", base, "m, twice how far to the left the left wheel's frame is");
  } else {
    text.number("wheelbase", Robot().wheelbase, std::string("m between the wheels; ") + kState);
    return 1;
  }
  return 0;
}

/// How many figures are left to state; nothing where there are no wheels.
std::optional<int> wheels_by_type(const LogSurvey& survey, MapText& text) {
  const WheelTopics& topics = survey.wheels;
  if (!topics.left.empty()) {
    int to_state = robot_by_type(survey, text);
    text.blank();
    text.table("wheels");
    text.text("unit", "rad", "turns of the wheel so far");
    if (topics.constants) {
      text.number("radius", topics.constants->radius, "m, as " + topics.odometry + " has it");
    } else {
      text.number("radius", 0.05, std::string("m; ") + kState);
      ++to_state;
    }
    text.line("left.field = " + io::toml_string(topics.left));
    text.line("right.field = " + io::toml_string(topics.right));
    if (topics.odometry.empty()) return to_state;
    text.blank();
    text.comment("In place of [wheels], as the robot's own odometry has it:");
    text.comment("[odometry]");
    text.comment("twist = " + io::toml_string(topics.odometry));
    text.comment("compare = true   # beside [wheels]: says where the two contradict each other");
    return to_state;
  }
  if (topics.odometry.empty()) return std::nullopt;
  const int to_state = robot_by_type(survey, text);
  text.blank();
  text.table("odometry");
  const auto topic = std::find_if(survey.topics.begin(), survey.topics.end(),
                                  [&](const auto& one) { return one.name == topics.odometry; });
  const bool twist =
      varies(*topic, "twist.twist.linear.x") && varies(*topic, "twist.twist.angular.z");
  text.text(twist ? "twist" : "pose", topics.odometry,
            twist ? "velocities, held since the message before (pose: from its poses)"
                  : "from its poses: it has no velocities");
  for (const std::string& one : topics.others) text.comment("another: " + one);
  return to_state;
}

void imu_by_type(const LogSurvey& survey, MapText& text) {
  for (const LogTopicFacts* topic : topics_of_type(survey, "sensor_msgs/Imu")) {
    const LogFieldFacts* none = field_of(*topic, "orientation_covariance[0]");
    const bool oriented =
        varies(*topic, "orientation.z") && (none == nullptr || none->largest >= 0.0);
    const bool turns = varies(*topic, "angular_velocity.z");
    if (turns) {
      text.blank();
      text.table("yaw_rate");
      text.text("field", topic->name + "/angular_velocity.z");
      text.text("unit", "rad/s", "counter-clockwise; sign = -1 where it is not");
    }
    if (oriented) {
      text.blank();
      const bool compass = !turns || !topics_of_type(survey, "sensor_msgs/MagneticField").empty();
      const std::string off = compass ? "" : "# ";
      if (!compass) {
        text.comment(
            "The IMU's orientation, if a magnetometer is in it; what sums up its own gyro is no "
            "compass:");
      }
      text.line(off + "[heading]");
      text.line(off + "field = " + io::toml_string(topic->name + "/orientation"));
      text.line(off + "unit = \"quaternion\"");
    }
    if (turns || oriented) return;
  }
}

std::string base_frame(const LogSurvey& survey) {
  for (const char* wanted : {"base_link", "base_footprint", "base"}) {
    for (const FrameFacts& one : survey.frames) {
      if (one.child == wanted || one.parent == wanted) return wanted;
    }
  }
  return "base_link";
}

/// "tag36h11:*" of "tag36h11:5".
std::string pattern_of(const std::string& name) {
  std::size_t end = name.find(':');
  if (end != std::string::npos) return name.substr(0, end + 1) + "*";
  end = name.find_first_of("0123456789");
  return end == std::string::npos || end == 0 ? name : name.substr(0, end) + "*";
}

/// Frames that a camera sees: they move, and are called like a tag. Whether there are some.
bool frames_by_type(const LogSurvey& survey, MapText& text) {
  std::vector<const FrameFacts*> seen;
  for (const FrameFacts& one : survey.frames) {
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
    text.blank();
    text.list("sightings", "each transform to such a frame is a sighting");
    text.text("frames", pattern);
    if (one->topic != "/tf") text.text("tf", one->topic);
    text.text("base", base_frame(survey), "the robot's frame: between its wheels, x ahead");
    if (!one->turns) {
      text.line("use_yaw = false", "it never turns: whoever sees it does not see its direction");
      continue;
    }
    const bool flat = survey.upright_share(*one, base_frame(survey)) > 0.7;
    text.text("axis", flat ? "x" : "z",
              flat ? "whose direction in the plane is the tag's own: its z stands up"
                   : "whose direction in the plane is the tag's own: it hangs on a wall");
  }
  return !seen.empty();
}

/// Whether the topic ties the drive to a place.
bool place_by_type(const LogSurvey& survey, const LogTopicFacts& topic, MapText& text) {
  const std::string type = short_type(topic.type);
  if (type == "sensor_msgs/NavSatFix") {
    text.blank();
    text.table("fixes", "x to the east and y to the north of the first");
    text.text("topic", topic.name);
    return true;
  }
  if (type == "geometry_msgs/PointStamped" &&
      has_word(topic.name, {"fix", "gps", "gnss", "uwb", "position"})) {
    text.blank();
    text.table("fixes");
    text.text("topic", topic.name);
    return true;
  }
  if (type == "std_msgs/String" && has_word(topic.name, kPlaceWords)) {
    text.blank();
    text.list("sightings", "the robot stands on what it names");
    text.text("topic", topic.name);
    text.text("landmark", "data");
    return true;
  }
  if (type == "sensor_msgs/Range") {
    const bool beacon = has_word(topic.name, kBeaconWords);
    const std::string off = beacon ? "" : "# ";
    text.blank();
    if (!beacon) text.comment("Only if this is the range to a beacon, not to obstacles:");
    text.line(off + "[[sightings]]");
    text.line(off + "topic = " + io::toml_string(topic.name));
    text.line(off + "name = " + io::toml_string(topic.name.substr(topic.name.rfind('/') + 1)),
              "the beacon");
    text.line(off + "range = \"range\"");
    return beacon;
  }
  if (type == "ros2_aruco_interfaces/ArucoMarkers") {
    text.blank();
    text.list("sightings");
    text.text("topic", topic.name);
    text.text("each", "poses");
    text.text("landmark", "../marker_ids[#]", "the number in the list beside");
    text.line("position = \".\"", "the marker as the camera of header.frame_id has it");
    text.text("prefix", "marker");
    text.text("base", base_frame(survey));
    text.text("axis", "z");
    return true;
  }
  if (type == "apriltag_msgs/AprilTagDetectionArray" && survey.frames.empty()) {
    text.blank();
    text.comment(topic.name + " has the tags' corners in the picture alone: record /tf, where the");
    text.comment("detector puts their poses.");
  }
  return false;
}

/// Whether there is some.
bool truth_by_type(const LogSurvey& survey, MapText& text) {
  for (const LogTopicFacts& topic : survey.topics) {
    const std::string type = short_type(topic.type);
    const bool pose = type == "geometry_msgs/PoseStamped" ||
                      type == "geometry_msgs/PoseWithCovarianceStamped" ||
                      type == "nav_msgs/Odometry" || type == "geometry_msgs/TransformStamped";
    if (!pose || topic.messages < 2) continue;
    const bool is_truth = is_called_truth(topic.name);
    if (!is_truth && type == "nav_msgs/Odometry") continue;
    text.blank();
    const std::string off = is_truth ? "" : "# ";
    if (!is_truth) {
      text.comment(
          "Only if measured apart from the robot (motion capture), no estimate of its own:");
    }
    text.line(off + "[truth]");
    text.line(off + "pose = " + io::toml_string(topic.name));
    if (is_truth) return true;
  }
  return false;
}

void covariates_by_type(const LogSurvey& survey, MapText& text) {
  bool any = false;
  std::set<std::string> names;
  for (const LogTopicFacts& topic : survey.topics) {
    const std::string type = short_type(topic.type);
    std::string path;
    if (type == "sensor_msgs/BatteryState") path = "voltage";
    if (type == "sensor_msgs/Temperature") path = "temperature";
    if (type.starts_with("std_msgs/")) path = "data";
    if (path.empty() || !varies(topic, path)) continue;
    if (!any) {
      text.blank();
      text.table("covariates", "what else may matter; a row has the last value before its end");
    }
    any = true;
    std::string name = covariate_name(path == "data" ? topic.name.substr(topic.name.rfind('/') + 1)
                                                     : topic.name + '_' + path);
    while (!names.insert(name).second) name += "_2";
    text.text(name, topic.name + '/' + path);
  }
}

}  // namespace

Guessed guess_by_types(const LogSurvey& survey, MapText& text) {
  Guessed found;
  const std::optional<int> wheels = wheels_by_type(survey, text);
  found.wheels = wheels.has_value();
  found.to_state = wheels.value_or(0);
  imu_by_type(survey, text);
  found.places = frames_by_type(survey, text);
  for (const LogTopicFacts& topic : survey.topics) {
    if (topic.messages > 0 && place_by_type(survey, topic, text)) found.places = true;
  }
  if (truth_by_type(survey, text)) found.places = true;
  covariates_by_type(survey, text);
  return found;
}

}  // namespace trussmap::logs
