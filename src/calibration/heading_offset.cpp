// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/heading_offset.hpp"

#include "calibration/reckoning.hpp"
#include "drive/legs.hpp"
#include "geometry/units.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

#include <fmt/format.h>

namespace trussmap::calibration {
namespace {

constexpr double kWay = 0.2;          // m of driven path between the rows of a pair
constexpr double kStraightest = 0.5;  // of it that the pair's ends must lie apart
constexpr double kAgree = 0.8;

/// Sums over all pairs, with headings as they are and with their sign changed.
struct MeanDirections {
  std::complex<double> as_given;
  std::complex<double> mirrored;
  double weight = 0.0;  // m
};

void add_pairs(MeanDirections& sum, const DrivenRecording& recording) {
  const MotionRows& drive = recording.drive;
  const std::vector<double> path = drive::driven_path(drive);
  std::optional<TruthRow> from;
  double start = 0.0;
  for (const TruthRow& row : recording.truth) {
    if (row.t < drive.start() || row.t > drive.t.back()) continue;
    const double at = drive::path_at(drive, path, row.t);
    if (from && at - start < kWay) continue;
    if (from) {
      const Vector2 driven = reckoned(drive, {}, from->t, row.t).position();
      const Vector2 moved(row.x - from->x, row.y - from->y);
      const double distance = moved.norm();
      if (driven.norm() > kStraightest * kWay && distance > kStraightest * kWay) {
        const double turn = std::atan2(driven.y(), driven.x()) - std::atan2(moved.y(), moved.x());
        sum.as_given += std::polar(distance, turn + from->heading);
        sum.mirrored += std::polar(distance, turn - from->heading);
        sum.weight += distance;
      }
    }
    from = row;
    start = at;
  }
}

}  // namespace

HeadingOffset heading_offset(const std::vector<DrivenRecording>& recordings) {
  MeanDirections sum;
  for (const DrivenRecording& recording : recordings) {
    if (!recording.truth.empty()) add_pairs(sum, recording);
  }
  HeadingOffset result;
  if (!(sum.weight > 0.0)) return result;
  const double agreement = std::abs(sum.as_given) / sum.weight;
  const double mirrored = std::abs(sum.mirrored) / sum.weight;
  // A drive in one direction agrees either way.
  result.clockwise = mirrored > kAgree && agreement < kAgree;
  result.angle = std::arg(result.clockwise ? sum.mirrored : sum.as_given);
  result.agreement = result.clockwise ? mirrored : agreement;
  return result;
}

std::string describe(const HeadingOffset& offset) {
  constexpr double kTurned = 0.2;  // rad: less is a marker put on by hand
  if (offset.agreement < kAgree) {
    return "the truth's headings do not follow the direction of travel; are they in radians, and "
           "of the same clock as the wheels?";
  }
  if (offset.clockwise) {
    return "the truth's headings look clockwise, expected them counter-clockwise from +x";
  }
  if (std::abs(offset.angle) < kTurned) return "";
  // Half a turn is 180 degrees on either side of it.
  const double angle = offset.angle < 0.005 - std::numbers::pi
                           ? offset.angle + 2.0 * std::numbers::pi
                           : offset.angle;
  std::string text = fmt::format(
      "the truth's heading looks turned by {:.2f} rad ({:.0f} degrees) against the direction of "
      "travel; subtract that in truth.csv",
      angle, geometry::kDegrees * angle);
  if (std::abs(offset.angle) > std::numbers::pi - kTurned) {
    text += ", or change the sign of left and right in drive.csv where the wheels count backwards";
  }
  return text;
}

}  // namespace trussmap::calibration
