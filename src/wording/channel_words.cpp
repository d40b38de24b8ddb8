// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "wording/channel_words.hpp"

#include "geometry/units.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap {

Scale scale_of(Channel channel) {
  switch (channel) {
    case Channel::drift:
    case Channel::gyro:
      return {kDegrees * 60.0, " deg/min"};
    case Channel::advance:
    case Channel::lever:
    case Channel::lever_left:
    case Channel::range:
    case Channel::antenna:
    case Channel::antenna_left:
    case Channel::fix_x:
    case Channel::fix_y:
      return {1e3, " mm"};
    case Channel::rotate:
    case Channel::compass:
    case Channel::bearing:
    case Channel::sighting_yaw:
    case Channel::truth_heading:
    case Channel::steer:
      return {kDegrees, " deg"};
    case Channel::delay:
    case Channel::fix_delay:
      return {1e3, " ms"};
    default:
      return {100.0, " %"};
  }
}

Phrase phrase_of(Channel channel) {
  switch (channel) {
    case Channel::travel:
      return {"the robot travels", "further than its wheels say", "less far than its wheels say"};
    case Channel::left:
      return {"the left wheel rolls", "further than it says", "less far than it says"};
    case Channel::right:
      return {"the right wheel rolls", "further than it says", "less far than it says"};
    case Channel::wheels:
      return {"both wheels are", "larger than nominal", "smaller than nominal"};
    case Channel::difference:
      return {"the right wheel is", "larger than the left", "smaller than the left"};
    case Channel::turn:
      return {"the robot turns", "more than its wheels say", "less than its wheels say"};
    case Channel::drift:
      return {"the heading drifts by", "to the left", "to the right"};
    case Channel::advance:
      return {"each event moves the robot", "forward", "back"};
    case Channel::rotate:
      return {"each event turns the robot by", "to the left", "to the right"};
    case Channel::creep:
      return {"the robot slips by", "of its travel to the left", "of its travel to the right"};
    case Channel::gyro:
      return {"the gyro reads", "too much", "too little"};
    case Channel::gyro_scale:
      return {"the robot turns", "more than its gyro says", "less than its gyro says"};
    case Channel::lever:
      return {"the sensor sits", "ahead of the axle", "behind the axle"};
    case Channel::lever_left:
      return {"the sensor sits", "to the left of the axle's centre",
              "to the right of the axle's centre"};
    case Channel::compass:
      return {"the compass reads", "too much", "too little"};
    case Channel::range:
    case Channel::range_scale:
      return {"ranges read", "too much", "too little"};
    case Channel::bearing:
      return {"bearings read", "too much", "too little"};
    case Channel::sighting_yaw:
      return {"yaws of landmarks read", "too much", "too little"};
    case Channel::delay:
      return {"sightings and truth are stamped", "late", "early"};
    case Channel::truth_heading:
      return {"the truth's heading is turned", "to the left", "to the right"};
    case Channel::antenna:
      return {"the antenna sits", "ahead of the axle", "behind the axle"};
    case Channel::antenna_left:
      return {"the antenna sits", "to the left of the axle's centre",
              "to the right of the axle's centre"};
    case Channel::fix_delay:
      return {"fixes are stamped", "late", "early"};
    case Channel::fix_x:
      return {"fixes lie", "too far along x", "too far against x"};
    case Channel::fix_y:
      return {"fixes lie", "too far along y", "too far against y"};
    case Channel::sideways:
      return {"the robot moves to the side", "more than its wheels say",
              "less than its wheels say"};
    case Channel::wheel1:
      return {"the first wheel rolls", "further than it says", "less far than it says"};
    case Channel::wheel2:
      return {"the second wheel rolls", "further than it says", "less far than it says"};
    case Channel::wheel3:
      return {"the third wheel rolls", "further than it says", "less far than it says"};
    case Channel::wheel4:
      return {"the fourth wheel rolls", "further than it says", "less far than it says"};
    case Channel::wheel5:
      return {"the fifth wheel rolls", "further than it says", "less far than it says"};
    case Channel::wheel6:
      return {"the sixth wheel rolls", "further than it says", "less far than it says"};
    case Channel::steer:
      return {"the steered wheel points", "further to the left than it says",
              "further to the right than it says"};
    case Channel::steer_gain:
      return {"the steered wheel turns", "further than it says", "less far than it says"};
  }
  return {"", "", ""};
}

const char* noun_of(Channel channel) {
  switch (channel) {
    case Channel::travel:
      return "travel error";
    case Channel::left:
      return "left wheel's error";
    case Channel::right:
      return "right wheel's error";
    case Channel::wheels:
      return "error of both wheels";
    case Channel::difference:
      return "difference of the wheels";
    case Channel::turn:
      return "turning error";
    case Channel::drift:
      return "heading drift";
    case Channel::advance:
      return "travel error per event";
    case Channel::rotate:
      return "turning error per event";
    case Channel::creep:
      return "sideways slip";
    case Channel::gyro:
      return "gyro bias";
    case Channel::gyro_scale:
      return "error of the gyro's scale";
    case Channel::lever:
      return "sensor's place ahead";
    case Channel::lever_left:
      return "sensor's place to the left";
    case Channel::compass:
      return "compass error";
    case Channel::range:
      return "range error";
    case Channel::range_scale:
      return "error of the range's scale";
    case Channel::bearing:
      return "bearing error";
    case Channel::sighting_yaw:
      return "error of the landmarks' yaw";
    case Channel::delay:
      return "delay of sightings";
    case Channel::truth_heading:
      return "error of the truth's heading";
    case Channel::antenna:
      return "antenna's place ahead";
    case Channel::antenna_left:
      return "antenna's place to the left";
    case Channel::fix_delay:
      return "delay of fixes";
    case Channel::fix_x:
      return "error of fixes along x";
    case Channel::fix_y:
      return "error of fixes along y";
    case Channel::sideways:
      return "error of the way to the side";
    case Channel::wheel1:
      return "first wheel's error";
    case Channel::wheel2:
      return "second wheel's error";
    case Channel::wheel3:
      return "third wheel's error";
    case Channel::wheel4:
      return "fourth wheel's error";
    case Channel::wheel5:
      return "fifth wheel's error";
    case Channel::wheel6:
      return "sixth wheel's error";
    case Channel::steer:
      return "steering offset";
    case Channel::steer_gain:
      return "error of the steering's gain";
  }
  return "";
}

std::string channel_in_words(Channel channel) {
  switch (channel) {
    case Channel::travel:
      return "robot travels further than measured by";
    case Channel::wheels:
      return "both wheels larger than nominal by";
    case Channel::left:
      return "left wheel rolls further than it says by";
    case Channel::right:
      return "right wheel rolls further than it says by";
    case Channel::creep:
      return "slip to the left, of the travel";
    case Channel::turn:
      return "robot turns more than measured by";
    case Channel::difference:
      return "right wheel larger than the left by";
    case Channel::drift:
      return "heading drifts to the left by";
    case Channel::compass:
      return "compass reads too much by";
    case Channel::gyro:
      return "gyro reads too much by";
    case Channel::gyro_scale:
      return "robot turns more than its gyro says by";
    case Channel::range:
    case Channel::range_scale:
      return "ranges too long by";
    case Channel::bearing:
      return "bearings too large by";
    case Channel::sighting_yaw:
      return "yaws of landmarks too large by";
    case Channel::lever:
      return "sensor ahead by";
    case Channel::lever_left:
      return "sensor to the left by";
    case Channel::advance:
      return "robot moves forward per event by";
    case Channel::rotate:
      return "robot turns left per event by";
    case Channel::delay:
      return "sightings stamped late by";
    case Channel::truth_heading:
      return "truth's heading turned left by";
    case Channel::antenna:
      return "antenna ahead by";
    case Channel::antenna_left:
      return "antenna to the left by";
    case Channel::fix_delay:
      return "fixes stamped late by";
    case Channel::fix_x:
      return "fixes too far along x by";
    case Channel::fix_y:
      return "fixes too far along y by";
    case Channel::sideways:
      return "robot moves sideways more than measured by";
    case Channel::wheel1:
      return "first wheel rolls further than it says by";
    case Channel::wheel2:
      return "second wheel rolls further than it says by";
    case Channel::wheel3:
      return "third wheel rolls further than it says by";
    case Channel::wheel4:
      return "fourth wheel rolls further than it says by";
    case Channel::wheel5:
      return "fifth wheel rolls further than it says by";
    case Channel::wheel6:
      return "sixth wheel rolls further than it says by";
    case Channel::steer:
      return "steering further left than measured by";
    case Channel::steer_gain:
      return "steered wheel turns further than it says by";
  }
  return "";
}

ShownUnit shown_unit(const std::string& unit) {
  if (unit.empty()) return {100.0, "%"};
  if (unit == "rad") return {kDegrees, "\u00b0"};
  if (unit == "rad/s") return {kDegrees, "\u00b0/s"};
  if (unit == "m") return {1000.0, "mm"};
  if (unit == "s") return {1000.0, "ms"};
  return {1.0, unit};
}

std::string shown(double value, const std::string& unit) {
  const ShownUnit as = shown_unit(unit);
  return two_digits(as.factor * value) + (as.name.starts_with("\u00b0") ? "" : " ") + as.name;
}

std::string variable_in_words(const std::string& variable) {
  return variable == "turn_rate"    ? "turn rate"
         : variable == "t"          ? "time"
         : variable == "distance"   ? "distance driven"
         : variable == "arc_angle"  ? "angle turned while driving"
         : variable == "spin_angle" ? "angle turned on the spot"
                                    : variable;
}

std::string variables_in_words(const std::string& text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t space = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, space - at);
    result += variable_in_words(word);
    if (space < text.size()) result += ' ';
    at = space + 1;
  }
  return result;
}

std::string place_text(const Vector2& place) {
  return fmt::format("x {:.1f} m, y {:.1f} m", place.x(), place.y());
}

}  // namespace trussmap
