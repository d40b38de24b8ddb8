// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/recording_bag_map.hpp"

#include "logs/map_text.hpp"
#include "trussmap/model_file.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::logs {
namespace {

bool has_topic(const Bag& bag, const std::string& name) {
  return std::any_of(bag.topics.begin(), bag.topics.end(),
                     [&](const Bag::Topic& one) { return one.name == name; });
}

bool any_in(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double one) { return !std::isnan(one); });
}

void add_drive(MapText& map, const BagMapParts& parts, const MotionRows& drive, double radius) {
  for (const BagMapParts::Wheel& one : parts.wheels) {
    map.blank();
    map.table("wheels." + one.column);
    map.text("field", "/joint_states/position[" + one.joint + "]");
    map.text("unit", "rad");
    if (!one.steers) map.number("radius", radius);
  }
  if (any_in(drive.heading)) {
    map.blank();
    map.table("heading");
    map.text("field", "/imu/data/orientation");
    map.text("unit", "quaternion");
  }
  if (any_in(drive.yaw_rate)) {
    map.blank();
    map.table("yaw_rate");
    map.text("field", "/imu/data/angular_velocity.z");
    map.text("unit", "rad/s");
  }
}

void add_sightings(MapText& map, const Bag& bag, const BagMapParts& parts,
                   const std::string& robot_frame) {
  if (has_topic(bag, "/tf")) {
    map.blank();
    map.list("sightings");
    map.text("frames", "*");
    map.text("base", robot_frame);
    if (!parts.yaws) map.line("use_yaw = false");
  }
  if (has_topic(bag, "/landmark")) {
    map.blank();
    map.list("sightings");
    map.text("topic", "/landmark");
    map.text("landmark", "data");
  }
  for (const auto& [topic, landmark] : parts.ranges) {
    map.blank();
    map.list("sightings");
    map.text("topic", topic);
    map.text("name", landmark);
    map.text("range", "range");
  }
}

void add_survey(MapText& map, const std::vector<SurveyPoint>& survey) {
  if (survey.empty()) return;
  map.blank();
  map.table("survey.landmarks");
  for (const SurveyPoint& one : survey) {
    std::string numbers = fmt::format("[{}, {}", one.x, one.y);
    if (!std::isnan(one.heading)) numbers += fmt::format(", {}", one.heading);
    map.line(io::toml_string(one.landmark) + " = " + numbers + "]");
  }
}

}  // namespace

std::string bag_map(const Bag& bag, const BagMapParts& parts, const DrivenRecording& recording,
                    const Model& model, const BagOptions& options) {
  MapText map;
  map.line(format_model(model));
  map.table("time");
  map.text("from", "stamp");
  add_drive(map, parts, recording.drive, options.wheel_radius);
  add_sightings(map, bag, parts, options.robot_frame);
  if (has_topic(bag, "/fix")) {
    map.blank();
    map.table("fixes");
    map.text("topic", "/fix");
  }
  if (has_topic(bag, "/truth")) {
    map.blank();
    map.table("truth");
    map.text("pose", "/truth");
  }
  add_survey(map, recording.survey);
  if (!parts.covariates.empty()) {
    map.blank();
    map.table("covariates");
    for (const auto& [name, topic] : parts.covariates) map.text(name, topic + "/data");
  }
  return map.str();
}

}  // namespace trussmap::logs
