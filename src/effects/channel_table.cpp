// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The table of channels: a row each. Physics as in channel_physics.hpp.
#include "drive/body_motion.hpp"
#include "drive/row_motion.hpp"
#include "drive/steered_motion.hpp"
#include "effects/channel_record.hpp"
#include "effects/steering_patterns.hpp"

#include <algorithm>
#include <deque>
#include <string>
#include <utility>

namespace trussmap::effects {
namespace {

using drive::RowMotion;

constexpr ChannelTarget kReadings{.kind = ActsOn::readings};
constexpr ChannelTarget kSightings{.kind = ActsOn::views, .sightings = true};
constexpr ChannelTarget kTruth{.kind = ActsOn::views, .truth = true};
constexpr ChannelTarget kSightingsAndTruth{.kind = ActsOn::views, .sightings = true, .truth = true};
constexpr ChannelTarget kFixes{.kind = ActsOn::views, .fixes = true};
constexpr ChannelTarget kLoops{.kind = ActsOn::views, .loops = true};

bool has_two_wheels(const Robot& robot) {
  return robot.drive == DriveKind::differential;
}

bool goes_sideways(const Robot& robot) {
  return robot.drive == DriveKind::omni3 || robot.drive == DriveKind::mecanum ||
         (robot.drive == DriveKind::wheels && !robot.matrix.row(1).isZero(0.0));
}

DrivePattern as_pattern(const BodyMotion& motion) {
  return {.advance = motion.forward, .slip = motion.sideways, .turn = motion.turn};
}

bool has_rear_wheel(const Robot& robot) {
  return robot.drive == DriveKind::ackermann;
}

/// Stamped g late, the robot is believed to be where it was g later.
ViewPattern late_view(double g, double speed, double turn_rate) {
  return {.ahead = -g * speed, .heading = -g * turn_rate};
}

/// All but the single wheels.
std::vector<ChannelRecord> single_records() {
  using enum Channel;
  return {
      {.facts = {travel, "travel", "", 0.1, "forward travel"},
       .wheel_pattern =
           [](double g, const RowMotion& row) {
             return DrivePattern{.advance = g * row.body.forward};
           },
       .phrase = {"the robot travels", "further than its wheels say",
                  "less far than its wheels say"},
       .noun = "travel error",
       .axis = "robot travels further than measured by"},
      {.facts = {left, "left", "", 0.1, "travel of the left wheel"},
       .of_drive = has_two_wheels,
       .wheel_pattern =
           [](double g, const RowMotion& row) {
             const double more = g * drive::wheel_travel(row.body, row.wheelbase).left;
             return as_pattern(drive::body_motion({more, 0.0}, row.wheelbase));
           },
       .phrase = {"the left wheel rolls", "further than it says", "less far than it says"},
       .noun = "left wheel's error",
       .axis = "left wheel rolls further than it says by",
       .below_zero = "the left wheel counts backwards: the sign of its ticks?"},
      {.facts = {right, "right", "", 0.1, "travel of the right wheel"},
       .of_drive = has_two_wheels,
       .wheel_pattern =
           [](double g, const RowMotion& row) {
             const double more = g * drive::wheel_travel(row.body, row.wheelbase).right;
             return as_pattern(drive::body_motion({0.0, more}, row.wheelbase));
           },
       .phrase = {"the right wheel rolls", "further than it says", "less far than it says"},
       .noun = "right wheel's error",
       .axis = "right wheel rolls further than it says by",
       .below_zero = "the right wheel counts backwards: the sign of its ticks?"},
      {.facts = {wheels, "wheels", "", 0.1, "travel of all wheels"},
       .wheel_pattern = [](double g, const RowMotion& row) { return as_pattern(g * row.body); },
       .phrase = {"all wheels are", "larger than nominal", "smaller than nominal"},
       .noun = "error of all wheels",
       .axis = "all wheels larger than nominal by",
       .below_zero = "all wheels count backwards: the sign of their ticks?"},
      {.facts = {difference, "difference", "", 0.1, "right wheel's travel over left's"},
       .of_drive = has_two_wheels,
       .wheel_pattern =
           [](double g, const RowMotion& row) {
             return DrivePattern{.advance = 0.25 * g * row.wheelbase * row.body.turn,
                                 .turn = g * row.body.forward / row.wheelbase};
           },
       .phrase = {"the right wheel is", "larger than the left", "smaller than the left"},
       .noun = "difference of the wheels",
       .axis = "right wheel larger than the left by"},
      {.facts = {turn, "turn", "", 0.1, "rotation"},
       .wheel_pattern =
           [](double g, const RowMotion& row) { return DrivePattern{.turn = g * row.body.turn}; },
       .drawn_against = "turn_rate",
       .phrase = {"the robot turns", "more than its wheels say", "less than its wheels say"},
       .noun = "turning error",
       .axis = "robot turns more than measured by",
       .below_zero =
           "the robot turns the other way round than its wheels say: left and right exchanged, "
           "or all wheels counting backwards?"},
      {.facts = {drift, "drift", "rad/s", 0.01, "rotation with time"},
       .wheel_pattern = [](double g,
                           const RowMotion& row) { return DrivePattern{.turn = g * row.duration}; },
       .drawn_against = "turn_rate",
       .phrase = {"the heading drifts by", "to the left", "to the right"},
       .noun = "heading drift",
       .axis = "heading drifts to the left by"},
      {.facts = {advance, "advance", "m", 0.02, "travel per event"},
       .wheel_pattern = [](double g, const RowMotion&) { return DrivePattern{.advance = g}; },
       .varies = false,
       .phrase = {"each event moves the robot", "forward", "back"},
       .noun = "travel error per event",
       .axis = "robot moves forward per event by"},
      {.facts = {rotate, "rotate", "rad", 0.05, "rotation per event"},
       .wheel_pattern = [](double g, const RowMotion&) { return DrivePattern{.turn = g}; },
       .drawn_against = "turn_rate",
       .varies = false,
       .phrase = {"each event turns the robot by", "to the left", "to the right"},
       .noun = "turning error per event",
       .axis = "robot turns left per event by"},
      {.facts = {creep, "creep", "", 0.1, "slip to the left, per travel"},
       .recordable = false,
       .wheel_pattern =
           [](double g, const RowMotion& row) {
             return DrivePattern{.slip = g * row.body.forward};
           },
       .phrase = {"the robot slips by", "of its travel to the left", "of its travel to the right"},
       .noun = "sideways slip",
       .axis = "slip to the left, of the travel"},
      {.facts = {gyro, "gyro", "rad/s", 0.1, "yaw rate that the gyro reads"},
       .gyro_pattern = [](double g, const RowMotion& row) { return -g * row.duration; },
       .yaw_rate_without = [](double g, double yaw_rate) { return yaw_rate - g; },
       .noise_source = "gyro",
       .drawn_against = "turn_rate",
       .phrase = {"the gyro reads", "too much", "too little"},
       .noun = "gyro bias",
       .axis = "gyro reads too much by"},
      {.facts = {gyro_scale, "gyro_scale", "", 0.1, "turn that the gyro reads, in proportion"},
       .gyro_pattern = [](double g, const RowMotion& row) { return g * row.gyro_turn; },
       .yaw_rate_without = [](double g, double yaw_rate) { return yaw_rate * (1.0 + g); },
       .noise_source = "gyro",
       .drawn_against = "turn_rate",
       .phrase = {"the robot turns", "more than its gyro says", "less than its gyro says"},
       .noun = "error of the gyro's scale",
       .axis = "robot turns more than its gyro says by"},
      {.facts = {lever, "lever", "m", 0.3, "sensor's place ahead of the axle"},
       .target = kSightingsAndTruth,
       .recordable = false,
       .view_pattern = [](double g, double, double) { return ViewPattern{.ahead = g}; },
       .phrase = {"the sensor sits", "ahead of the axle", "behind the axle"},
       .noun = "sensor's place ahead",
       .axis = "sensor ahead by"},
      {.facts = {lever_left, "lever_left", "m", 0.3, "sensor's place to the axle's left"},
       .target = kSightingsAndTruth,
       .recordable = false,
       .view_pattern = [](double g, double, double) { return ViewPattern{.left = g}; },
       .phrase = {"the sensor sits", "to the left of the axle's centre",
                  "to the right of the axle's centre"},
       .noun = "sensor's place to the left",
       .axis = "sensor to the left by"},
      {.facts = {compass, "compass", "rad", 0.5, "compass reading"},
       .target = kReadings,
       .wheel_pattern = [](double g, const RowMotion&) { return DrivePattern{.compass = g}; },
       .noise_source = "compass",
       .drawn_against = "heading",
       .phrase = {"the compass reads", "too much", "too little"},
       .noun = "compass error",
       .axis = "compass reads too much by"},
      {.facts = {range, "range", "m", 0.3, "range reading"},
       .target = kSightingsAndTruth,
       .view_pattern = [](double g, double, double) { return ViewPattern{.range = g}; },
       .noise_source = "range",
       .reading = true,
       .phrase = {"ranges read", "too much", "too little"},
       .noun = "range error",
       .axis = "ranges too long by"},
      {.facts = {range_scale, "range_scale", "", 0.1, "range reading, in proportion"},
       .target = kSightingsAndTruth,
       .view_pattern = [](double g, double, double) { return ViewPattern{.range_scale = g}; },
       .noise_source = "range",
       .reading = true,
       .phrase = {"ranges read", "too much", "too little"},
       .noun = "error of the range's scale",
       .axis = "ranges too long by"},
      {.facts = {bearing, "bearing", "rad", 0.5, "bearing reading"},
       .target = kSightingsAndTruth,
       .view_pattern = [](double g, double, double) { return ViewPattern{.bearing = g}; },
       .noise_source = "bearing",
       .reading = true,
       .phrase = {"bearings read", "too much", "too little"},
       .noun = "bearing error",
       .axis = "bearings too large by"},
      {.facts = {delay, "delay", "s", 0.5, "time stamp of sightings and truth"},
       .target = kSightingsAndTruth,
       .recordable = false,
       .delay = true,
       .view_pattern = late_view,
       .phrase = {"sightings and truth are stamped", "late", "early"},
       .noun = "delay of sightings",
       .axis = "sightings stamped late by"},
      {.facts = {truth_heading, "truth_heading", "rad", 0.5, "heading of truth rows"},
       .target = kTruth,
       .recordable = false,
       .view_pattern = [](double g, double, double) { return ViewPattern{.heading = g}; },
       .noise_source = "truth",
       .phrase = {"the truth's heading is turned", "to the left", "to the right"},
       .noun = "error of the truth's heading",
       .axis = "truth's heading turned left by"},
      {.facts = {antenna, "antenna", "m", 0.3, "antenna's place ahead of the axle"},
       .target = kFixes,
       .recordable = false,
       .view_pattern = [](double g, double, double) { return ViewPattern{.ahead = g}; },
       .phrase = {"the antenna sits", "ahead of the axle", "behind the axle"},
       .noun = "antenna's place ahead",
       .axis = "antenna ahead by"},
      {.facts = {antenna_left, "antenna_left", "m", 0.3, "antenna's place to the axle's left"},
       .target = kFixes,
       .recordable = false,
       .view_pattern = [](double g, double, double) { return ViewPattern{.left = g}; },
       .phrase = {"the antenna sits", "to the left of the axle's centre",
                  "to the right of the axle's centre"},
       .noun = "antenna's place to the left",
       .axis = "antenna to the left by"},
      {.facts = {fix_delay, "fix_delay", "s", 0.5, "time stamp of fixes"},
       .target = kFixes,
       .recordable = false,
       .delay = true,
       .view_pattern = late_view,
       .phrase = {"fixes are stamped", "late", "early"},
       .noun = "delay of fixes",
       .axis = "fixes stamped late by"},
      {.facts = {fix_x, "fix_x", "m", 1.0, "fixes along the map's x axis"},
       .target = kFixes,
       .recordable = false,
       .view_pattern = [](double g, double, double) { return ViewPattern{.x = g}; },
       .noise_source = "fix",
       .reading = true,
       .phrase = {"fixes lie", "too far along x", "too far against x"},
       .noun = "error of fixes along x",
       .axis = "fixes too far along x by"},
      {.facts = {fix_y, "fix_y", "m", 1.0, "fixes along the map's y axis"},
       .target = kFixes,
       .recordable = false,
       .view_pattern = [](double g, double, double) { return ViewPattern{.y = g}; },
       .noise_source = "fix",
       .reading = true,
       .phrase = {"fixes lie", "too far along y", "too far against y"},
       .noun = "error of fixes along y",
       .axis = "fixes too far along y by"},
      {.facts = {sideways, "sideways", "", 0.1, "travel to the left"},
       .of_drive = goes_sideways,
       .wheel_pattern =
           [](double g, const RowMotion& row) {
             return DrivePattern{.slip = g * row.body.sideways};
           },
       .phrase = {"the robot moves to the side", "more than its wheels say",
                  "less than its wheels say"},
       .noun = "error of the way to the side",
       .axis = "robot moves sideways more than measured by"},
      {.facts = {steer, "steer", "rad", 0.1, "steering angle"},
       .of_drive = drive::has_steering,
       .wheel_pattern = [](double g,
                           const RowMotion& row) { return more_steering_pattern(g, 0.0, row); },
       .phrase = {"the steered wheel points", "further to the left than it says",
                  "further to the right than it says"},
       .noun = "steering offset",
       .axis = "steering further left than measured by"},
      {.facts = {steer_gain, "steer_gain", "", 0.1, "steering angle, in proportion"},
       .of_drive = drive::has_steering,
       .wheel_pattern = [](double g,
                           const RowMotion& row) { return more_steering_pattern(0.0, g, row); },
       .phrase = {"the steered wheel turns", "further than it says", "less far than it says"},
       .noun = "error of the steering's gain",
       .axis = "steered wheel turns further than it says by"},
      {.facts = {sighting_yaw, "sighting_yaw", "rad", 0.5, "yaw reading of a landmark"},
       .target = kSightings,
       .view_pattern = [](double g, double, double) { return ViewPattern{.yaw = g}; },
       .noise_source = "yaw",
       .reading = true,
       .phrase = {"yaws of landmarks read", "too much", "too little"},
       .noun = "error of the landmarks' yaw",
       .axis = "yaws of landmarks too large by"},
      {.facts = {scanner, "scanner", "m", 0.3, "scanner's place ahead of the axle"},
       .target = kLoops,
       .recordable = false,
       .view_pattern = [](double g, double, double) { return ViewPattern{.ahead = g}; },
       .phrase = {"the scanner sits", "ahead of the axle", "behind the axle"},
       .noun = "scanner's place ahead",
       .axis = "scanner ahead by"},
      {.facts = {scanner_left, "scanner_left", "m", 0.3, "scanner's place to the axle's left"},
       .target = kLoops,
       .recordable = false,
       .view_pattern = [](double g, double, double) { return ViewPattern{.left = g}; },
       .phrase = {"the scanner sits", "to the left of the axle's centre",
                  "to the right of the axle's centre"},
       .noun = "scanner's place to the left",
       .axis = "scanner to the left by"},
      {.facts = {scanner_yaw, "scanner_yaw", "rad", 0.5, "where the scanner looks"},
       .target = kLoops,
       .recordable = false,
       .view_pattern = [](double g, double, double) { return ViewPattern{.heading = g}; },
       .phrase = {"the scanner looks", "to the left of ahead", "to the right of ahead"},
       .noun = "scanner's yaw",
       .axis = "scanner turned left by"},
      {.facts = {wheel_left, "wheel_left", "m", 0.3,
                 "place of the wheel whose travel is read, to the left"},
       .of_drive = has_rear_wheel,
       .wheel_pattern = measured_left_pattern,
       .drawn_against = "turn_rate",
       .varies = false,
       .phrase = {"the travel is that of a wheel", "further to the left than stated",
                  "further to the right than stated"},
       .noun = "measured wheel's place",
       .axis = "measured wheel further left than stated by"},
      {.facts = {steer_left, "steer_left", "m", 0.3,
                 "place of the wheel whose steering angle is read, to the left"},
       .of_drive = drive::has_steering,
       .wheel_pattern = steered_left_pattern,
       .drawn_against = "turn_rate",
       .varies = false,
       .phrase = {"the steering angle is that of a wheel", "further to the left than stated",
                  "further to the right than stated"},
       .noun = "steered wheel's place",
       .axis = "steered wheel further left than stated by"},
      {.facts = {other_axle, "other_axle", "", 1.0, "axle whose travel is read"},
       .of_drive = drive::has_steering,
       .wheel_pattern = other_axle_pattern,
       .drawn_against = "turn_rate",
       .varies = false,
       .phrase = {"the travel is that of the other axle by", "of the difference",
                  "of the difference less"},
       .noun = "other axle's travel",
       .axis = "travel is the other axle's by"}};
}

/// Whether the n-th of a drive's own wheels rolls; one that is steered has the channel wheels.
template <std::size_t n>
bool has_wheel(const Robot& robot) {
  return !has_two_wheels(robot) && robot.drive != DriveKind::unicycle &&
         !drive::has_steering(robot) && n < robot.columns.size();
}

template <std::size_t n>
DrivePattern wheel_pattern(double g, const RowMotion& row) {
  if (row.wheels == nullptr || n >= row.wheels->size()) return {};
  const WheelColumn& column = (*row.wheels)[n];
  return column.steers ? DrivePattern() : more_of(column, row.row, g * column.reading[row.row]);
}

/// A text with a word in the place of "{}", kept as long as the program runs.
std::string_view with_word(std::string text, std::string_view word) {
  static std::deque<std::string> kept;
  constexpr std::string_view kOpen = "{}";
  return kept.emplace_back(text.replace(text.find(kOpen), kOpen.size(), word));
}

/// The row of the n-th wheel, from 0.
template <std::size_t n>
ChannelRecord wheel_record() {
  constexpr std::string_view kNumbers[] = {"1", "2", "3", "4", "5", "6"};
  constexpr std::string_view kOrdinals[] = {"first", "second", "third", "fourth", "fifth", "sixth"};
  const std::string_view which = kOrdinals[n];
  return {.facts = {static_cast<Channel>(static_cast<std::size_t>(Channel::wheel1) + n),
                    with_word("wheel{}", kNumbers[n]), "", 0.1,
                    with_word("travel of the {} wheel", which)},
          .of_drive = has_wheel<n>,
          .wheel_pattern = wheel_pattern<n>,
          .varies = false,
          .phrase = {with_word("the {} wheel rolls", which), "further than it says",
                     "less far than it says"},
          .noun = with_word("{} wheel's error", which),
          .axis = with_word("{} wheel rolls further than it says by", which),
          .below_zero = with_word("the {} wheel counts backwards: the sign of its ticks?", which)};
}

template <std::size_t... n>
std::vector<ChannelRecord> wheel_records(std::index_sequence<n...>) {
  return {wheel_record<n>()...};
}

}  // namespace

const std::vector<ChannelRecord>& channel_records() {
  static const std::vector<ChannelRecord> records = [] {
    constexpr std::size_t kWheels = 6;
    std::vector<ChannelRecord> all = single_records();
    for (ChannelRecord& one : wheel_records(std::make_index_sequence<kWheels>())) {
      all.push_back(one);
    }
    std::sort(all.begin(), all.end(), [](const ChannelRecord& a, const ChannelRecord& b) {
      return a.facts.channel < b.facts.channel;
    });
    return all;
  }();
  return records;
}

const ChannelRecord& record_of(Channel channel) {
  return channel_records().at(static_cast<std::size_t>(channel));
}

}  // namespace trussmap::effects
