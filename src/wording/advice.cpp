// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/comparison.hpp"
#include "recording/legs.hpp"
#include "recording/row_variables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>

namespace trussmap {
namespace {

/// What the drives of all sessions hold.
struct Contents {
  std::array<double, 8> sector_path{};  ///< m driven, by heading
  double path = 0.0;
  double left = 0.0;      ///< rad turned
  double right = 0.0;     ///< rad
  double standing = 0.0;  ///< s
  double time = 0.0;      ///< s
  std::vector<double> spin_rates, speeds, legs;
  std::map<std::string, int> visits;
};

double spread(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  double mean = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return mean > 0.0 ? std::sqrt(squares / static_cast<double>(values.size())) / mean : 0.0;
}

void add(const Recording& recording, const Model& model, Contents& contents) {
  const Drive& drive = recording.drive;
  const std::vector<MotionKind> kinds = motion_kinds(drive);
  double heading = 0.0;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const double begin = row == 0 ? drive.start() : drive.t[row - 1];
    const double duration = drive.t[row] - begin;
    const double path = 0.5 * (drive.left[row] + drive.right[row]);
    const double turn = (drive.right[row] - drive.left[row]) / model.robot.wheelbase;
    heading += turn;
    contents.time += duration;
    contents.path += std::abs(path);
    const double around = wrap_angle(heading) + std::numbers::pi;
    const auto sector = static_cast<std::size_t>(around / (std::numbers::pi / 4.0));
    contents.sector_path[std::min<std::size_t>(sector, 7)] += std::abs(path);
    (turn > 0.0 ? contents.left : contents.right) += std::abs(turn);
    switch (kinds[row]) {
      case MotionKind::standing:
        contents.standing += duration;
        break;
      case MotionKind::spinning:
        contents.spin_rates.push_back(std::abs(turn) / duration);
        break;
      case MotionKind::driving:
        contents.speeds.push_back(std::abs(path) / duration);
        break;
    }
  }
  const std::vector<Stop> stops = stops_of(recording.sightings);
  const std::vector<double> driven = driven_path(drive);
  for (const Leg& leg : legs_of(recording, stops)) {
    contents.legs.push_back(path_at(drive, driven, stops[leg.to].t) -
                            path_at(drive, driven, stops[leg.from].t));
  }
  for (const Stop& stop : stops) {
    ++contents.visits[recording.sightings[stop.reference].landmark];
  }
}

}  // namespace

std::vector<std::string> advice_on(const std::vector<Recording>& recordings, const Model& model,
                                   const ProblemOptions& options) {
  constexpr double kVaried = 0.15;
  std::vector<std::string> advice;
  Contents contents;
  bool survey = false;
  bool truth = false;
  bool compass = false;
  for (const Recording& recording : recordings) {
    add(recording, model, contents);
    survey = survey || (options.survey && !recording.survey.empty());
    truth = truth || (options.truth && !recording.truth.empty());
    compass = compass || recording.drive.has_compass();
  }
  if (!survey && !truth) {
    advice.emplace_back(
        "no survey and no truth: scale, compass offset and loss per start cannot be seen; measure "
        "the distance between two landmarks, better a few positions");
  }
  if (!compass && !truth) {
    advice.emplace_back(
        "no compass: headings come from the landmarks alone, and effects on turning are two to "
        "four times harder to see");
  }
  const auto driven_sectors =
      std::count_if(contents.sector_path.begin(), contents.sector_path.end(),
                    [&](double path) { return path > 0.02 * contents.path; });
  if (driven_sectors < 4) {
    advice.push_back(fmt::format(
        "only {} of 8 directions are driven: effects that depend on the heading (iron, slope) stay "
        "hidden; drive the routes in other directions too",
        driven_sectors));
  }
  const double turned = contents.left + contents.right;
  if (turned > 0.0 && std::min(contents.left, contents.right) < 0.15 * turned) {
    advice.push_back(fmt::format(
        "{:.0f} % of all turning is to the {}: wheelbase and turn asymmetry look alike; drive the "
        "tour the other way round as well",
        100.0 * std::max(contents.left, contents.right) / turned,
        contents.left > contents.right ? "left" : "right"));
  }
  if (contents.legs.size() > 2 && spread(contents.legs) < kVaried) {
    advice.emplace_back(
        "all legs are about equally long: scale and loss per start look alike; add routes of half "
        "and of double the length");
  }
  if (contents.speeds.size() > 20 && spread(contents.speeds) < kVaried) {
    advice.emplace_back("one speed: scale and slip with speed look alike; drive some legs slowly");
  }
  if (contents.spin_rates.size() > 20 && spread(contents.spin_rates) < kVaried) {
    advice.emplace_back(
        "turns on the spot at one rate: wheelbase and turn scrub look alike; turn slowly and fast");
  }
  if (contents.standing < 0.02 * contents.time) {
    advice.emplace_back(
        "no rests: heading drift with time looks like unequal wheels; stand still for a minute");
  }
  for (const Covariate& covariate : recordings.front().drive.covariates) {
    const auto [least, most] =
        std::minmax_element(covariate.values.begin(), covariate.values.end());
    if (least != covariate.values.end() && *least == *most && recordings.size() == 1) {
      advice.push_back(
          fmt::format("{} never changes: its effects cannot be seen; vary it", covariate.name));
    }
  }
  const auto once = std::count_if(contents.visits.begin(), contents.visits.end(),
                                  [](const auto& visit) { return visit.second == 1; });
  if (!survey && once > 0 && contents.visits.size() > 2) {
    advice.push_back(fmt::format(
        "{} of {} landmarks are visited once: they check nothing; come back to them by another "
        "route",
        once, contents.visits.size()));
  }
  return advice;
}

}  // namespace trussmap
