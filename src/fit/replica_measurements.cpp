// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/measurement_rows.hpp"
#include "fit/replica_stages.hpp"
#include "recording/floor_code.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap {
namespace {

/// rad; null of a landmark without one.
const double* orientation_of(const Replica& replica, int landmark) {
  const std::vector<int>& oriented = replica.fit.problem.oriented;
  const auto at = std::find(oriented.begin(), oriented.end(), landmark);
  return at == oriented.end()
             ? nullptr
             : &replica.state.orientations[idx(static_cast<int>(at - oriented.begin()))];
}

ViewPattern view_of_row(const Replica& replica, MeasurementKind kind, std::size_t session,
                        std::size_t row) {
  Measurement one;
  one.kind = kind;
  one.session = static_cast<int>(session);
  one.source = row;
  return view_of(replica.border, replica.offsets, one);
}

/// Without noise.
Vector4 seen_exactly(const Replica& replica, const Measurement& one) {
  return one.value + measurement_rows(replica.fit.problem, one, replica.state, one.value,
                                      view_of(replica.border, replica.offsets, one))
                         .error;
}

/// Where the robot stands beside a floor code stays as it was in its own axes.
void draw_yaw(double seen, double sd, Sighting& sighting, NormalDraws& draw) {
  const Vector2 code = code_from_robot(sighting);
  sighting.yaw = wrap_angle(seen + draw(sd));
  if (!std::isnan(sighting.dx)) place_by_code(code, sighting);
}

}  // namespace

void draw_survey(std::size_t session, DrawnSurvey& drawn, Replica& replica, NormalDraws& draw) {
  const Noise& noise = replica.fit.model.noise;
  const std::vector<std::string>& landmarks = replica.fit.problem.landmarks;
  for (SurveyPoint& one : replica.timed[session].survey) {
    const auto at = std::find(landmarks.begin(), landmarks.end(), one.landmark);
    if (at == landmarks.end()) continue;
    const auto landmark = static_cast<int>(at - landmarks.begin());
    const Vector2& place = replica.state.landmarks[idx(landmark)];
    const double sd = std::isnan(one.sd) ? noise.survey : one.sd;
    const auto [known, fresh] =
        drawn.places.try_emplace({one.landmark, one.x, one.y}, Vector2::Zero());
    if (fresh) known->second = place + Vector2(draw(sd), draw(sd));
    const double* orientation = orientation_of(replica, landmark);
    if (orientation != nullptr && !std::isnan(one.heading)) {
      const auto [heading, new_heading] =
          drawn.headings.try_emplace({one.landmark, one.x, one.y, one.heading}, 0.0);
      if (new_heading) heading->second = *orientation + draw(noise.yaw);
      one.heading = heading->second;
    }
    one.x = known->second.x();
    one.y = known->second.y();
  }
}

void draw_truth(std::size_t session, Replica& replica, NormalDraws& draw) {
  const Noise& noise = replica.fit.model.noise;
  Recording& recording = replica.timed[session];
  for (std::size_t row = 0; row < recording.truth.size(); ++row) {
    TruthRow& one = recording.truth[row];
    const Pose pose = pose_at(recording.drive, replica.paths[session], one.t);
    const ViewPattern view = view_of_row(replica, MeasurementKind::truth, session, row);
    const Vector2 place = pose.position() + rotation(pose.heading) * Vector2(view.ahead, view.left);
    one.x = place.x() + draw(noise.truth);
    one.y = place.y() + draw(noise.truth);
    one.heading = wrap_angle(pose.heading + view.heading + draw(noise.truth_heading));
  }
}

void draw_fixes_and_loops(std::size_t session, Replica& replica, NormalDraws& draw) {
  const Noise& noise = replica.fit.model.noise;
  Recording& recording = replica.timed[session];
  const SessionPath& path = replica.paths[session];
  for (std::size_t row = 0; row < recording.fixes.size(); ++row) {
    Fix& one = recording.fixes[row];
    const Pose pose = pose_at(recording.drive, path, one.t);
    const ViewPattern view = view_of_row(replica, MeasurementKind::fix, session, row);
    const Vector2 antenna = rotation(pose.heading + view.heading) * Vector2(view.ahead, view.left);
    const double sd = std::isnan(one.sd) ? noise.fix : one.sd;
    one.x = pose.x + antenna.x() + view.x + draw(sd);
    one.y = pose.y + antenna.y() + view.y + draw(sd);
  }
  for (Loop& one : recording.loops) {
    const Pose step =
        relative(pose_at(recording.drive, path, one.t), pose_at(recording.drive, path, one.t2));
    const double sd = std::isnan(one.sd) ? noise.loop : one.sd;
    const double sd_heading = std::isnan(one.sd_heading) ? noise.loop_heading : one.sd_heading;
    one.dx = step.x + draw(sd);
    one.dy = step.y + draw(sd);
    one.dtheta = wrap_angle(step.heading + draw(sd_heading));
  }
}

void draw_sightings(Replica& replica, NormalDraws& draw) {
  const Noise& noise = replica.fit.model.noise;
  for (const Measurement& one : replica.fit.problem.measurements) {
    const bool yaw = one.kind == MeasurementKind::sighting_yaw;
    if (!yaw && (!is_sighting(one.kind) || one.kind == MeasurementKind::standing)) continue;
    Sighting& sighting = replica.timed[idx(one.session)].sightings[one.source];
    const Vector4 seen = seen_exactly(replica, one);
    if (yaw) {
      draw_yaw(seen[0], noise.yaw, sighting, draw);
      continue;
    }
    if (one.kind == MeasurementKind::direction) {
      sighting.bearing = wrap_angle(seen[0] + draw(noise.bearing));
      continue;
    }
    const bool offset = one.kind == MeasurementKind::cartesian_view;
    const double range = offset ? seen.head<2>().norm() : seen[0];
    const double bearing = offset ? direction(seen.head<2>()) : seen[1];
    const double sd = std::hypot(noise.range, noise.range_relative * range);
    sighting.range = std::max(range + draw(sd), kLeastDrawnRange);
    if (!std::isnan(sighting.bearing)) {
      sighting.bearing = wrap_angle(bearing + draw(noise.bearing));
    }
  }
}

}  // namespace trussmap
