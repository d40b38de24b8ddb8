// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/kinds/kinds.hpp"
#include "estimation/measurement_rows.hpp"
#include "estimation/mounted_views.hpp"
#include "fit/replica_stages.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::fitting {
namespace {

/// rad; null of a landmark without one.
const double* orientation_of(const Replica& replica, int landmark) {
  const std::vector<int>& oriented = replica.fit.problem.oriented;
  const auto at = std::find(oriented.begin(), oriented.end(), landmark);
  return at == oriented.end()
             ? nullptr
             : &replica.state.orientations[idx(static_cast<int>(at - oriented.begin()))];
}

/// Without noise.
estimation::Vector4 seen_exactly(const Replica& replica, const estimation::Measurement& one) {
  return one.value +
         estimation::measurement_rows(replica.fit.problem, one, replica.state, one.value,
                                      estimation::view_of(replica.border, replica.offsets, one))
             .error;
}

}  // namespace

void draw_survey(std::size_t session, DrawnSurvey& drawn, Replica& replica,
                 statistics::NormalDraws& draw) {
  const Noise& noise = replica.fit.model.noise;
  const std::vector<std::string>& landmarks = replica.fit.problem.landmarks;
  for (SurveyPoint& one : replica.timed[session].survey) {
    const auto at = std::find(landmarks.begin(), landmarks.end(), one.landmark);
    if (at == landmarks.end()) continue;
    const auto landmark = static_cast<int>(at - landmarks.begin());
    const Vector2& place = replica.state.landmarks[idx(landmark)];
    const auto [known, fresh] =
        drawn.places.try_emplace({one.landmark, one.x, one.y}, Vector2::Zero());
    if (fresh) known->second = estimation::kinds::drawn_place(one, place, noise, draw);
    const double* orientation = orientation_of(replica, landmark);
    if (orientation != nullptr && !std::isnan(one.heading)) {
      const auto [heading, new_heading] =
          drawn.headings.try_emplace({one.landmark, one.x, one.y, one.heading}, 0.0);
      if (new_heading)
        heading->second = estimation::kinds::drawn_heading(*orientation, noise, draw);
      one.heading = heading->second;
    }
    one.x = known->second.x();
    one.y = known->second.y();
  }
}

effects::ViewPattern view_at(const Replica& replica, estimation::RecordingStream stream,
                             std::size_t session, std::size_t row) {
  return estimation::view_of(replica.border, replica.offsets, stream, session, row,
                             estimation::mounted_view(replica.fit.model.robot.mounted, stream));
}

void draw_truth(std::size_t session, Replica& replica, statistics::NormalDraws& draw) {
  DrivenRecording& recording = replica.timed[session];
  for (std::size_t row = 0; row < recording.truth.size(); ++row) {
    TruthRow& one = recording.truth[row];
    estimation::kinds::draw(one, pose_at(recording.drive, replica.paths[session], one.t),
                            view_at(replica, estimation::RecordingStream::truth, session, row),
                            replica.fit.model.noise, draw);
  }
}

void draw_fixes_and_loops(std::size_t session, Replica& replica, statistics::NormalDraws& draw) {
  const Noise& noise = replica.fit.model.noise;
  DrivenRecording& recording = replica.timed[session];
  const auto pose = [&](double t) { return pose_at(recording.drive, replica.paths[session], t); };
  for (std::size_t row = 0; row < recording.fixes.size(); ++row) {
    Fix& one = recording.fixes[row];
    estimation::kinds::draw(one, pose(one.t),
                            view_at(replica, estimation::RecordingStream::fixes, session, row),
                            noise, draw);
  }
  for (std::size_t row = 0; row < recording.loops.size(); ++row) {
    Loop& one = recording.loops[row];
    estimation::kinds::draw(one, relative(pose(one.t), pose(one.t2)),
                            view_at(replica, estimation::RecordingStream::loops, session, row),
                            noise, draw);
  }
}

void draw_sightings(Replica& replica, statistics::NormalDraws& draw) {
  for (const estimation::Measurement& one : replica.fit.problem.measurements) {
    if (one.kind->facts().stream != estimation::RecordingStream::sightings) continue;
    one.kind->draw(seen_exactly(replica, one), replica.fit.model.noise, draw,
                   replica.timed[idx(one.session)].sightings[one.source]);
  }
}

}  // namespace trussmap::fitting
