// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Truth against the wheels, stretch by stretch: lengths tell a unit, turns of heading and of course
// tell signs and axes, and heading against course on straight stretches a tracker that is turned.
#include "check/findings.hpp"
#include "geometry/units.hpp"
#include "statistics/median.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace trussmap::check {
namespace {

constexpr double kTruthStretch = 0.5;     // m, or
constexpr double kStretchTurn = 0.5;      // rad, or
constexpr double kLongestStretch = 10.0;  // s
constexpr std::size_t kFewestTruths = 12;
constexpr double kClearTruth = 0.7;  // correlation
constexpr double kStraight = 0.15;   // rad
constexpr double kTurned = 0.14;     // rad

struct TruthStretch {
  Pose wheels;           ///< way, in the track's axes
  Vector2 truth;         ///< way
  double turn = 0;       ///< of the truth, in its unit, not wrapped
  double heading = 0.0;  ///< of the truth, halfway
  double forward = 0.0;  ///< m driven, signed
  double aside = 0.0;    ///< rad, of the wheels' way from ahead
  double way = 0.0;      ///< m driven
};

std::vector<TruthStretch> stretches_of(const DrivenRecording& recording, const Track& track) {
  std::vector<TruthStretch> result;
  const MotionRows& drive = recording.drive;
  const TruthRow* before = nullptr;
  for (const TruthRow& row : recording.truth) {
    if (row.t < drive.start() || row.t > drive.t.back()) continue;
    if (before == nullptr || row.t - before->t > kLongestStretch) {
      before = &row;
      continue;
    }
    const double way = track.way_at(row.t) - track.way_at(before->t);
    const Pose a = track.at(before->t);
    const Pose b = track.at(row.t);
    if (way < kTruthStretch && std::abs(b.heading - a.heading) < kStretchTurn) continue;
    TruthStretch one;
    one.wheels = {b.x - a.x, b.y - a.y, b.heading - a.heading};
    one.truth = {row.x - before->x, row.y - before->y};
    one.turn = row.heading - before->heading;
    one.heading = before->heading + 0.5 * wrap_angle(one.turn);
    const double along = 0.5 * (a.heading + b.heading);
    one.forward = one.wheels.x * std::cos(along) + one.wheels.y * std::sin(along);
    one.aside = direction(one.wheels.position()) - along;
    one.way = way;
    result.push_back(one);
    before = &row;
  }
  return result;
}

/// By far: as degrees do.
bool turns_more_than_wheels(const std::vector<TruthStretch>& stretches) {
  double wheels = 0.0;
  double truth = 0.0;
  for (const TruthStretch& one : stretches) {
    wheels += std::abs(one.wheels.heading);
    truth += std::abs(std::remainder(one.turn, 360.0));
  }
  constexpr double kFar = 8.0;
  return truth > kFar * wheels;
}

/// Turns brought within half a turn, of so many units; 0: as they are, in radians.
double correlation(const std::vector<TruthStretch>& stretches, double turn) {
  double ww = 0.0;
  double wt = 0.0;
  double tt = 0.0;
  for (const TruthStretch& one : stretches) {
    const double truth =
        turn > 0.0 ? std::remainder(one.turn, turn) * 2.0 * std::numbers::pi / turn : one.turn;
    ww += one.wheels.heading * one.wheels.heading;
    wt += one.wheels.heading * truth;
    tt += truth * truth;
  }
  return ww > 0.0 && tt > 0.0 ? wt / std::sqrt(ww * tt) : 0.0;
}

int sign_of_course(const std::vector<TruthStretch>& stretches) {
  double alike = 0.0;
  double mirrored = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 1; k < stretches.size(); ++k) {
    const TruthStretch& a = stretches[k - 1];
    const TruthStretch& b = stretches[k];
    if (a.truth.norm() < 0.2 || b.truth.norm() < 0.2) continue;
    const double wheels = direction(b.wheels.position()) - direction(a.wheels.position());
    const double truth = direction(b.truth) - direction(a.truth);
    if (std::abs(std::sin(wheels)) < 0.2) continue;
    ++count;
    alike += std::cos(wheels - truth);
    mirrored += std::cos(wheels + truth);
  }
  if (count < kFewestTruths) return 0;
  const auto n = static_cast<double>(count);
  if (alike > kClearTruth * n && alike > mirrored) return 1;
  if (mirrored > kClearTruth * n && mirrored > alike) return -1;
  return 0;
}

void check_unit(Checked& checked, const std::vector<TruthStretch>& stretches) {
  std::vector<double> ratios;
  for (const TruthStretch& one : stretches) {
    const double way = one.wheels.position().norm();
    if (way > 0.3) ratios.push_back(one.truth.norm() / way);
  }
  if (ratios.size() < kFewestTruths) return;
  const double ratio = statistics::median(std::move(ratios));
  if (!(ratio > 0.0) || !looks_like_a_unit(ratio)) return;
  const std::string unit = unit_of_ratio(ratio);
  checked.add("truth.csv", "x,y", "truth unit",
              text::joined("the truth goes ", figure(ratio), " times as far as the wheels (median)",
                           unit.empty() ? "" : ": as if in " + unit),
              "convert the truth to metres, or the wheels' travels");
}

void check_turned(Checked& checked, const std::vector<TruthStretch>& stretches) {
  const bool to_the_side = !checked.recording.drive.sideways.empty();
  MeanAngle offset;
  for (const TruthStretch& one : stretches) {
    if (std::abs(one.wheels.heading) > kStraight || one.truth.norm() < 0.3) continue;
    if (to_the_side) {
      offset.add(one.heading + one.aside - direction(one.truth));
      continue;
    }
    const Vector2 course = one.forward < 0.0 ? Vector2(-one.truth) : one.truth;
    offset.add(one.heading - direction(course));
  }
  if (!offset.is_clear() || std::abs(offset.angle()) < kTurned) return;
  checked.add("truth.csv", "heading", "truth turned",
              text::joined("on straight stretches the heading lies ",
                           figure(offset.angle() * geometry::kDegrees, "degrees"),
                           " off the course (", offset.count(), " stretches)"),
              "turn the tracker's body frame to the robot's forward axis, or fit the effect "
              "\"truth heading\"");
}

void check_compass_frame(Checked& checked) {
  const DrivenRecording& recording = checked.recording;
  if (!recording.drive.has_compass() || checked.wrong.contains("heading")) return;
  MeanAngle offset;
  std::size_t row = 0;
  const MotionRows& drive = recording.drive;
  for (const TruthRow& truth : recording.truth) {
    while (row < drive.rows() && drive.t[row] < truth.t) ++row;
    if (row == drive.rows()) break;
    if (std::isnan(drive.heading[row]) || drive.t[row] - truth.t > 0.5) continue;
    offset.add(drive.heading[row] - truth.heading);
  }
  if (!offset.is_clear() || std::abs(offset.angle()) < kCompassTurned) return;
  checked.add("drive.csv", "heading", "compass turned",
              text::joined("the compass reads ", figure(offset.angle() * geometry::kDegrees),
                           " degrees more than the truth's heading"),
              "readings count from the map's x axis, not from north");
}

}  // namespace

TruthAgreement truth_agreement(const Checked& checked, const Track& track) {
  TruthAgreement result;
  const std::vector<TruthStretch> stretches = stretches_of(checked.recording, track);
  if (stretches.size() < kFewestTruths) return result;
  const double radians = correlation(stretches, 2.0 * std::numbers::pi);
  const double going_on = correlation(stretches, 0.0);
  result.in_degrees = std::abs(radians) < kClearTruth &&
                      std::abs(correlation(stretches, 360.0)) > kClearTruth &&
                      turns_more_than_wheels(stretches);
  if (result.in_degrees) return result;
  if (std::abs(radians) < kClearTruth &&
      std::abs(going_on) > kClearTruth) {  // whole turns between rows
    result.by_heading = going_on > 0.0 ? 1 : -1;
  }
  if (std::abs(radians) > kClearTruth) result.by_heading = radians > 0.0 ? 1 : -1;
  result.by_course = sign_of_course(stretches);
  double turned = 0.0;
  for (const TruthStretch& one : stretches) turned += std::pow(wrap_angle(one.turn), 2);
  constexpr double kTurns = 0.2;      // rad, rms
  constexpr double kOnTheSpot = 0.4;  // rad
  constexpr std::ptrdiff_t kFewestSpins = 6;
  const auto spins =
      std::count_if(stretches.begin(), stretches.end(), [&](const TruthStretch& one) {
        const double turn = wrap_angle(one.turn);
        return std::abs(turn) > kOnTheSpot &&
               looks_unsigned(turn, one.wheels.heading, one.way, checked.wheelbase);
      });
  result.unsigned_wheels = result.by_heading == 0 && spins >= kFewestSpins;
  result.contradicts =
      result.by_heading == 0 && turned > kTurns * kTurns * static_cast<double>(stretches.size());
  return result;
}

void check_truth(Checked& checked, const Track& track, const TruthAgreement& agreement) {
  const std::vector<TruthStretch> stretches = stretches_of(checked.recording, track);
  if (stretches.size() < kFewestTruths) return;
  check_unit(checked, stretches);
  if (agreement.in_degrees) {
    checked.add(
        "truth.csv", "heading", "angle unit",
        text::joined("as degrees the headings turn with the wheels (correlation ",
                     text::fixed_text(std::abs(correlation(stretches, 360.0)), 2),
                     "), as radians they do not (",
                     text::fixed_text(std::abs(correlation(stretches, 2.0 * std::numbers::pi)), 2),
                     ")"),
        "convert the headings to radians");
  }
  if (agreement.by_heading <= 0 || agreement.by_course <= 0) return;
  check_turned(checked, stretches);
  if (!checked.wrong.contains("truth heading")) check_compass_frame(checked);
}

}  // namespace trussmap::check
