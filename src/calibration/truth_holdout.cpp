// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/truth_holdout.hpp"

#include "calibration/reckoning.hpp"
#include "drive/legs.hpp"
#include "geometry/index.hpp"
#include "odometry/effect_correction.hpp"

#include <cmath>
#include <optional>

namespace trussmap::calibration {
namespace {

/// The rows, truth and sightings of one span of time.
DrivenRecording cut(const DrivenRecording& whole, double from, double to) {
  constexpr double kSameTime = 1e-9;  // s
  DrivenRecording part;
  part.name = whole.name;
  part.survey = whole.survey;
  part.drive.unicycle = whole.drive.unicycle;
  for (const Covariate& covariate : whole.drive.covariates) {
    part.drive.covariates.push_back({covariate.name, {}});
  }
  for (const WheelColumn& wheel : whole.drive.wheels) {
    part.drive.wheels.push_back({wheel.name, wheel.steers, {}, {}});
  }
  for (std::size_t row = 0; row < whole.drive.rows(); ++row) {
    const double t = whole.drive.t[row];
    if (t <= from + kSameTime || t > to + kSameTime) continue;
    part.drive.t.push_back(t);
    part.drive.forward.push_back(whole.drive.forward[row]);
    part.drive.turn.push_back(whole.drive.turn[row]);
    if (!whole.drive.pair.empty()) {
      part.drive.pair.left.push_back(whole.drive.pair.left[row]);
      part.drive.pair.right.push_back(whole.drive.pair.right[row]);
    }
    if (!whole.drive.sideways.empty()) part.drive.sideways.push_back(whole.drive.sideways[row]);
    for (std::size_t k = 0; k < whole.drive.wheels.size(); ++k) {
      const WheelColumn& wheel = whole.drive.wheels[k];
      part.drive.wheels[k].reading.push_back(wheel.reading[row]);
      part.drive.wheels[k].by_reading.push_back(wheel.by_reading[row]);
    }
    if (whole.drive.has_compass()) part.drive.heading.push_back(whole.drive.heading[row]);
    if (whole.drive.has_gyro()) part.drive.yaw_rate.push_back(whole.drive.yaw_rate[row]);
    for (std::size_t k = 0; k < part.drive.covariates.size(); ++k) {
      part.drive.covariates[k].values.push_back(whole.drive.covariates[k].values[row]);
    }
  }
  for (const TruthRow& row : whole.truth) {
    if (row.t >= from - kSameTime && row.t <= to + kSameTime) part.truth.push_back(row);
  }
  for (const Sighting& sighting : whole.sightings) {
    if (sighting.t >= from && sighting.t <= to) part.sightings.push_back(sighting);
  }
  return part;
}

/// The heading at truth row `at` by all rows of the second before it.
double settled_heading(const DrivenRecording& recording, std::size_t at) {
  constexpr double kSecond = 1.0;  // s
  const TruthRow& last = recording.truth[at];
  double sum = 0.0;
  int rows = 0;
  for (std::size_t k = at; recording.truth[k].t > last.t - kSecond; --k) {
    const TruthRow& row = recording.truth[k];
    if (row.t < recording.drive.start()) break;
    const Pose there = reckoned(recording.drive, pose_of(row), row.t, last.t);
    sum += wrap_angle(there.heading - last.heading);
    ++rows;
    if (k == 0) break;
  }
  return last.heading + (rows > 0 ? sum / rows : 0.0);
}

}  // namespace

std::vector<TruthLeg> truth_legs(const std::vector<DrivenRecording>& recordings, double share,
                                 double leg) {
  std::vector<TruthLeg> legs;
  for (std::size_t session = 0; session < recordings.size(); ++session) {
    const DrivenRecording& recording = recordings[session];
    const std::vector<double> path = drive::driven_path(recording.drive);
    std::optional<std::size_t> from;
    double start = 0.0;
    for (std::size_t row = 0; row < recording.truth.size(); ++row) {
      const double t = recording.truth[row].t;
      if (t < recording.drive.start() || t > recording.drive.t.back()) continue;
      const double at = drive::path_at(recording.drive, path, t);
      if (from && at - start < leg) continue;
      if (from) {
        const bool held_out = drive::is_held_out(legs.size(), share);
        legs.push_back({static_cast<int>(session), *from, row, held_out});
      }
      from = row;
      start = at;
    }
  }
  return legs;
}

TrainingSegments without_held_out(const std::vector<DrivenRecording>& recordings,
                                  const std::vector<TruthLeg>& legs) {
  TrainingSegments training_segments;
  for (std::size_t k = 0; k < legs.size();) {
    if (legs[k].held_out) {
      ++k;
      continue;
    }
    std::size_t last = k;
    while (last + 1 < legs.size() && !legs[last + 1].held_out &&
           legs[last + 1].session == legs[k].session) {
      ++last;
    }
    const DrivenRecording& whole = recordings[idx(legs[k].session)];
    DrivenRecording part = cut(whole, whole.truth[legs[k].from].t, whole.truth[legs[last].to].t);
    if (part.drive.rows() >= 2) {
      training_segments.recordings.push_back(std::move(part));
      training_segments.sessions.push_back(legs[k].session);
    }
    k = last + 1;
  }
  return training_segments;
}

ArrivalErrors arrival_errors(const std::vector<DrivenRecording>& recordings,
                             const std::vector<TruthLeg>& legs, const Model& model) {
  const std::vector<DrivenRecording> corrected = odometry::without_effects(recordings, model);
  ArrivalErrors result;
  for (const TruthLeg& leg : legs) {
    if (!leg.held_out) continue;
    const DrivenRecording& recording = corrected[idx(leg.session)];
    const TruthRow& from = recording.truth[leg.from];
    const TruthRow& to = recording.truth[leg.to];
    const double heading = settled_heading(recording, leg.from);
    const Pose end = reckoned(recording.drive, {from.x, from.y, heading}, from.t, to.t);
    result.distances.push_back((end.position() - Vector2(to.x, to.y)).norm());
  }
  return result;
}

}  // namespace trussmap::calibration
