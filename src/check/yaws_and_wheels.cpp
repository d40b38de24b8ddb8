// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A landmark's yaw read twice, and the wheels' turn in between: the axis stands still, so the yaw
// falls by as much as the robot turns.
//
//   yaw_2 - yaw_1 = -turn
//
// A turn by half a circle or a whole one says nothing of the sign.
#include "check/findings.hpp"
#include "geometry/units.hpp"
#include "statistics/median.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>

namespace trussmap::check {
namespace {

constexpr double kLongestYaws = 600.0;  // s: until then the wheels have not drifted by much
constexpr double kLeastSine = 0.4;      // of the turn
constexpr double kYawsAgree = 0.35;     // rad, median
constexpr std::size_t kFewestYaws = 8;

/// In degrees, where a fifth of them are beyond a whole turn in radians. Returns rad per unit.
double unit_of(Checked& checked, const char* file, const char* column, const char* plural,
               const std::vector<double>& angles) {
  std::vector<double> sizes;
  for (const double angle : angles) {
    if (std::isfinite(angle)) sizes.push_back(std::abs(angle));
  }
  if (sizes.empty()) return 1.0;
  const auto beyond = std::count_if(
      sizes.begin(), sizes.end(), [](double size) { return size > 2.0 * std::numbers::pi + 0.1; });
  if (5 * beyond < std::ssize(sizes)) return 1.0;
  checked.add(file, column, "angle unit",
              text::joined(beyond, " of ", sizes.size(), " ", plural,
                           " are beyond a whole turn in radians (",
                           figure(*std::max_element(sizes.begin(), sizes.end())),
                           "): they look like degrees"),
              "convert them to radians");
  return geometry::kDegree;
}

}  // namespace

void check_yaw_units(Checked& checked) {
  std::vector<double> yaws;
  for (const Sighting& one : checked.recording.sightings) yaws.push_back(one.yaw);
  checked.yaw_unit = unit_of(checked, "sightings.csv", "yaw", "yaws", yaws);
  std::vector<double> headings;
  for (const SurveyPoint& one : checked.recording.survey) headings.push_back(one.heading);
  unit_of(checked, "survey.csv", "heading", "headings", headings);
}

int yaws_sign(const Checked& checked, const Track& track) {
  std::map<std::string_view, const Sighting*> last;
  std::vector<double> as_recorded;  // rad off
  std::vector<double> negated;
  for (const Sighting& one : checked.recording.sightings) {
    if (!std::isfinite(one.yaw)) continue;
    const Sighting*& before = last[one.landmark];
    if (before != nullptr && one.t - before->t <= kLongestYaws) {
      const double turn = track.at(one.t).heading - track.at(before->t).heading;
      const double change = checked.yaw_unit * (one.yaw - before->yaw);
      if (std::abs(std::sin(turn)) > kLeastSine) {
        as_recorded.push_back(std::abs(wrap_angle(change + turn)));
        negated.push_back(std::abs(wrap_angle(change - turn)));
      }
    }
    before = &one;
  }
  if (as_recorded.size() < kFewestYaws) return 0;
  const double right = statistics::median(std::move(as_recorded));
  const double wrong = statistics::median(std::move(negated));
  if (right < kYawsAgree && right < wrong) return 1;
  return wrong < kYawsAgree ? -1 : 0;
}

}  // namespace trussmap::check
