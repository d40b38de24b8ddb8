// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/adjustment/truth_holdout.hpp"

#include "trussmap/core/index.hpp"
#include "trussmap/odometry/effect_correction.hpp"
#include "trussmap/odometry/merge.hpp"
#include "trussmap/recording/legs.hpp"

#include <cmath>
#include <optional>

namespace trussmap {
namespace {

constexpr int kBlock = 5;  // legs

bool is_held_out(int leg, double share) {
  const int block = leg / kBlock;
  return std::floor((block + 1) * share) > std::floor(block * share);
}

/// The rows and truth of one stretch of time.
Recording cut(const Recording& whole, double from, double to) {
  constexpr double kSameTime = 1e-9;  // s
  Recording part;
  part.name = whole.name;
  part.survey = whole.survey;
  for (const Covariate& covariate : whole.drive.covariates) {
    part.drive.covariates.push_back({covariate.name, {}});
  }
  for (std::size_t row = 0; row < whole.drive.rows(); ++row) {
    const double t = whole.drive.t[row];
    if (t <= from + kSameTime || t > to + kSameTime) continue;
    part.drive.t.push_back(t);
    part.drive.left.push_back(whole.drive.left[row]);
    part.drive.right.push_back(whole.drive.right[row]);
    if (whole.drive.has_compass()) part.drive.heading.push_back(whole.drive.heading[row]);
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

}  // namespace

std::vector<TruthLeg> truth_legs(const std::vector<Recording>& recordings, double share,
                                 double leg) {
  std::vector<TruthLeg> legs;
  for (std::size_t session = 0; session < recordings.size(); ++session) {
    const Recording& recording = recordings[session];
    const std::vector<double> path = driven_path(recording.drive);
    std::optional<std::size_t> from;
    double start = 0.0;
    for (std::size_t row = 0; row < recording.truth.size(); ++row) {
      const double t = recording.truth[row].t;
      if (t < recording.drive.start() || t > recording.drive.t.back()) continue;
      const double at = path_at(recording.drive, path, t);
      if (from && at - start < leg) continue;
      if (from) {
        const bool held_out = is_held_out(static_cast<int>(legs.size()), share);
        legs.push_back({static_cast<int>(session), *from, row, held_out});
      }
      from = row;
      start = at;
    }
  }
  return legs;
}

std::vector<Recording> without_held_out(const std::vector<Recording>& recordings,
                                        const std::vector<TruthLeg>& legs) {
  std::vector<Recording> stretches;
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
    const Recording& whole = recordings[idx(legs[k].session)];
    Recording part = cut(whole, whole.truth[legs[k].from].t, whole.truth[legs[last].to].t);
    if (part.drive.rows() >= 2) stretches.push_back(std::move(part));
    k = last + 1;
  }
  return stretches;
}

ArrivalErrors arrival_errors(const std::vector<Recording>& recordings,
                             const std::vector<TruthLeg>& legs, const Model& model) {
  const std::vector<Recording> corrected = without_effects(recordings, model);
  ArrivalErrors result;
  double sum = 0.0;
  for (const TruthLeg& leg : legs) {
    if (!leg.held_out) continue;
    const Recording& recording = corrected[idx(leg.session)];
    const TruthRow& from = recording.truth[leg.from];
    const TruthRow& to = recording.truth[leg.to];
    Pose pose{from.x, from.y, from.heading};
    for (const DriveRow& row : rows_between(recording.drive, from.t, to.t)) {
      pose =
          compose(pose, arc_displacement(travel_of(recording.drive, row), model.robot.wheelbase));
    }
    sum += (pose.position() - Vector2(to.x, to.y)).squaredNorm();
    ++result.legs;
  }
  if (result.legs > 0) result.rms = std::sqrt(sum / result.legs);
  return result;
}

}  // namespace trussmap
