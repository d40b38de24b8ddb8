// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/data_lacks.hpp"

#include "drive/legs.hpp"
#include "drive/row_variables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

namespace trussmap::criticism {
namespace {

constexpr double kVaried = 0.15;       // standard deviation over mean
constexpr int kFewSectors = 4;         // of eight
constexpr double kSectorShare = 0.02;  // of the path
constexpr double kOneSided = 0.15;     // of the turning
constexpr double kRests = 0.02;        // of the time
constexpr std::size_t kManyRows = 20;

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

void add(const DrivenRecording& recording, const Robot& robot, Contents& contents) {
  const MotionRows& drive = recording.drive;
  const std::vector<drive::MotionKind> kinds = drive::motion_kinds(drive, robot);
  double heading = 0.0;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const double begin = row == 0 ? drive.start() : drive.t[row - 1];
    const double duration = drive.t[row] - begin;
    const auto [path, aside, turn] = drive.motion(row);
    heading += turn;
    contents.time += duration;
    contents.path += std::abs(path);
    const double around = wrap_angle(heading) + std::numbers::pi;
    const auto sector = static_cast<std::size_t>(around / (std::numbers::pi / 4.0));
    contents.sector_path[std::min<std::size_t>(sector, 7)] += std::abs(path);
    (turn > 0.0 ? contents.left : contents.right) += std::abs(turn);
    switch (kinds[row]) {
      case drive::MotionKind::standing:
        contents.standing += duration;
        break;
      case drive::MotionKind::spinning:
        contents.spin_rates.push_back(std::abs(turn) / duration);
        break;
      case drive::MotionKind::driving:
        contents.speeds.push_back(std::abs(path) / duration);
        break;
    }
  }
  const std::vector<drive::Stop> stops = drive::stops_of(recording.sightings);
  const std::vector<double> driven = drive::driven_path(drive);
  for (const drive::Leg& leg : drive::legs_of(recording, stops)) {
    contents.legs.push_back(drive::path_at(drive, driven, stops[leg.to].t) -
                            drive::path_at(drive, driven, stops[leg.from].t));
  }
  for (const drive::Stop& stop : stops) {
    ++contents.visits[recording.sightings[stop.reference].landmark];
  }
}

int driven_sectors(const Contents& contents) {
  return static_cast<int>(
      std::count_if(contents.sector_path.begin(), contents.sector_path.end(),
                    [&](double path) { return path > kSectorShare * contents.path; }));
}

void add_lacks_of_sensors(const std::vector<DrivenRecording>& recordings, bool positions,
                          bool truth, std::vector<DataLack>& lacks) {
  const bool headings =
      std::any_of(recordings.begin(), recordings.end(), [](const DrivenRecording& recording) {
        return recording.drive.has_compass() || recording.drive.has_gyro();
      });
  if (!positions) lacks.push_back({Lack::positions});
  if (!headings && !truth) lacks.push_back({Lack::compass});
}

void add_lacks_of_drives(const Contents& contents, std::vector<DataLack>& lacks) {
  const int sectors = driven_sectors(contents);
  if (sectors < kFewSectors) lacks.push_back({Lack::headings, sectors, 8});
  const double turned = contents.left + contents.right;
  if (turned > 0.0 && std::min(contents.left, contents.right) < kOneSided * turned) {
    lacks.push_back({Lack::turning_sense, 0, 0, std::max(contents.left, contents.right) / turned,
                     contents.left > contents.right});
  }
  if (contents.legs.size() > 2 && spread(contents.legs) < kVaried) {
    lacks.push_back({Lack::leg_lengths});
  }
  if (contents.speeds.size() > kManyRows && spread(contents.speeds) < kVaried) {
    lacks.push_back({Lack::speeds});
  }
  if (contents.spin_rates.size() > kManyRows && spread(contents.spin_rates) < kVaried) {
    lacks.push_back({Lack::spin_rates});
  }
  if (contents.standing < kRests * contents.time) lacks.push_back({Lack::rests});
}

void add_lacks_of_covariates(const std::vector<DrivenRecording>& recordings,
                             std::vector<DataLack>& lacks) {
  if (recordings.size() > 1) return;
  for (const Covariate& covariate : recordings.front().drive.covariates) {
    const auto [least, most] =
        std::minmax_element(covariate.values.begin(), covariate.values.end());
    if (least == covariate.values.end() || *least != *most) continue;
    DataLack lack{Lack::covariate_range};
    lack.name = covariate.name;
    lacks.push_back(std::move(lack));
  }
}

}  // namespace

std::vector<DataLack> lacks_of(const std::vector<DrivenRecording>& recordings, const Robot& robot,
                               const FitOptions& options) {
  Contents contents;
  bool survey = false;
  bool truth = false;
  bool fixes = false;
  for (const DrivenRecording& recording : recordings) {
    add(recording, robot, contents);
    survey = survey || (options.use_survey && !recording.survey.empty());
    truth = truth || (options.use_truth && !recording.truth.empty());
    fixes = fixes || (options.use_fixes && !recording.fixes.empty());
  }
  std::vector<DataLack> lacks;
  add_lacks_of_sensors(recordings, survey || truth || fixes, truth, lacks);
  add_lacks_of_drives(contents, lacks);
  add_lacks_of_covariates(recordings, lacks);
  const auto once =
      static_cast<int>(std::count_if(contents.visits.begin(), contents.visits.end(),
                                     [](const auto& visit) { return visit.second == 1; }));
  if (!survey && once > 0 && contents.visits.size() > 2) {
    lacks.push_back({Lack::revisits, once, static_cast<int>(contents.visits.size())});
  }
  return lacks;
}

}  // namespace trussmap::criticism
