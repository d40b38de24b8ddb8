// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/build_map.hpp"

#include "build_map/built_path.hpp"
#include "build_map/leg_by_leg.hpp"
#include "build_map/map_doubts.hpp"
#include "build_map/map_fit.hpp"
#include "drive/well_formed.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"
#include "trussmap/gate.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

namespace trussmap {
using namespace map_building;

namespace {

constexpr int kFewestSurveyed = 3;

void check(const std::vector<DrivenRecording>& recordings, const Robot& robot,
           const BuildMapOptions& options) {
  if (recordings.empty()) throw std::invalid_argument("a map needs a recording");
  drive::require_well_formed(recordings, robot);
  if (!(options.gate.value_or(kAdjustmentGate) > 0.0) || !(options.min_drive >= 0.0)) {
    throw std::invalid_argument("an option of build_map is out of range");
  }
}

void require_sightings(const std::vector<DrivenRecording>& recordings) {
  for (const DrivenRecording& one : recordings) {
    if (!one.sightings.empty()) continue;
    throw InputError(one.name, 0,
                     "no landmark was sighted, expected sightings to build a map from; a path is "
                     "built where no recording has any, and all have fixes or loops");
  }
}

std::vector<SightedDrive> sessions_of(const std::vector<fitting::ClearedRecording>& cleared,
                                      const Model& model, const std::vector<SessionGuide>& guides) {
  std::vector<SightedDrive> sessions;
  sessions.reserve(cleared.size());
  for (std::size_t k = 0; k < cleared.size(); ++k) {
    sessions.emplace_back(cleared[k], model, guides[k]);
  }
  return sessions;
}

bool has_stops(const fitting::ClearedRecording& clear) {
  const std::vector<Sighting>& sightings = clear.recording.sightings;
  return std::any_of(sightings.begin(), sightings.end(),
                     [](const Sighting& one) { return one.locates(); });
}

std::set<std::string> landmarks_stood_on(const std::vector<fitting::ClearedRecording>& clear,
                                         const std::vector<SessionGuide>& guides) {
  std::set<std::string> names;
  for (std::size_t s = 0; s < clear.size(); ++s) {
    const std::vector<Sighting>& sightings = clear[s].recording.sightings;
    for (std::size_t k = 0; k < sightings.size(); ++k) {
      if (sightings[k].standing() && !guides[s].left_out[k]) names.insert(sightings[k].landmark);
    }
  }
  return names;
}

std::vector<SurveyPoint> survey_of(const std::vector<DrivenRecording>& recordings) {
  std::map<std::string, SurveyPoint> survey;
  for (const DrivenRecording& recording : recordings) {
    for (const SurveyPoint& point : recording.survey) survey.try_emplace(point.landmark, point);
  }
  std::vector<SurveyPoint> result;
  result.reserve(survey.size());
  for (const auto& [name, point] : survey) result.push_back(point);
  return result;
}

std::optional<MapOnSurvey> laid_on_survey(const BuiltMap& built,
                                          const std::vector<DrivenRecording>& recordings) {
  MapOnSurvey result;
  result.points = survey_of(recordings);
  result.comparison = compare_with_survey(positions_of(built.map), result.points);
  if (result.comparison.landmarks < kFewestSurveyed) return std::nullopt;
  if (!built.dead_reckoned.empty()) {
    result.rms_dead_reckoning =
        survey_rms(built.dead_reckoned, result.points, result.comparison.contradicting);
  }
  return result;
}

BuiltMap map_of(const MapFitState& best, const std::vector<fitting::ClearedRecording>& clear,
                const Model& model, const std::vector<SessionGuide>& guides,
                const BuildMapOptions& options) {
  const LandmarkGraph landmarks = adjusted_landmarks(best.fit);
  LegByLegOptions how{options, landmarks};
  how.stood_on = landmarks_stood_on(clear, guides);
  how.guided = options.method == Method::adjustment;
  if (how.guided) how.build.method = Method::gauss_markov;
  const bool ranges_alone = std::none_of(clear.begin(), clear.end(), has_stops);
  if (ranges_alone && options.method != Method::adjustment) {
    throw InputError(clear.front().recording.name, 0,
                     "has ranges alone, which make no legs, expected the method adjustment");
  }
  BuiltMap built;
  if (!ranges_alone) {
    MapBuilder builder = builder_for(how);
    built = map_leg_by_leg(sessions_of(clear, model, guides), how, builder);
  }
  built.method = options.method;
  if (options.method == Method::adjustment) place_as(landmarks, built.map);
  orient_as(landmarks, 0.0, built.map);
  return built;
}

/// A robot on its way leaves nothing out beforehand.
std::vector<SessionGuide> unguided(std::vector<SessionGuide> guides) {
  for (SessionGuide& guide : guides) {
    guide.left_out.assign(guide.left_out.size(), false);
    guide.yaw_left_out.assign(guide.yaw_left_out.size(), false);
  }
  return guides;
}

/// How an adjusted recording is turned into a map's axes.
struct Turn {
  double angle = 0.0;                  ///< rad
  std::vector<std::string> elsewhere;  ///< landmarks that lie so differently that they have no say
};

/// By the landmarks that both have.
Turn turn_onto(const LandmarkGraph& adjusted, const MapBuilder& builder,
               const std::string& recording) {
  LandmarkPositions here;
  std::vector<SurveyPoint> there;
  std::vector<Vector2> from;
  std::vector<Vector2> to;
  double variance = 0.0;  // of a coordinate, m^2
  for (int k = 0; k < adjusted.landmarks(); ++k) {
    const Landmark& landmark = adjusted.landmark(k);
    const std::optional<int> known = builder.find(landmark.name);
    if (!known) continue;
    const Vector2 place = builder.position(*known);
    here[landmark.name] = landmark.position;
    there.push_back({landmark.name, place.x(), place.y()});
    from.push_back(landmark.position);
    to.push_back(place);
    variance = std::max(variance, 0.5 * landmark.covariance->trace());
  }
  if (from.size() < 2) {
    throw SolveError(
        text::joined(recording, " shares too few landmarks with the map (", from.size(),
                     "), expected two at least to turn it by: it has not the map's axes, "
                     "which a compass in both would give"));
  }
  Turn turn;
  Alignment laid = align_rigidly(from, to);
  if (from.size() > 2) {
    const SurveyComparison agreed = compare_with_survey(here, there);
    laid = agreed.rigid;
    turn.elsewhere = agreed.contradicting;
  }
  turn.angle = laid.angle;
  Vector2 middle = Vector2::Zero();
  for (const Vector2& one : to) middle += one / static_cast<double>(to.size());
  double spread = 0.0;
  for (const Vector2& one : to) spread += (one - middle).squaredNorm();
  constexpr double kMostUncertain = 0.05;  // rad
  const double sd = std::sqrt(std::max(variance, laid.rms * laid.rms) / spread);
  if (!(sd < kMostUncertain)) {
    throw SolveError(
        text::joined(recording, " shares ", from.size(),
                     " landmarks with the map that lie too close together to turn it by, "
                     "expected some farther apart, or a compass in both"));
  }
  return turn;
}

void take_fit(BuiltMap& built, const MapFitState& best) {
  const estimation::RecordingAdjustment& fit = best.fit.adjustment;
  built.fit = MapFit{fit.chi2, fit.dof, fit.p_value, fit.iterations, fit.converged};
  built.freed = best.freed;
}

BuiltMap build_paths(const std::vector<DrivenRecording>& recordings, const Model& model,
                     const BuildMapOptions& options) {
  if (options.method != Method::adjustment) {
    throw InputError(recordings.front().name, 0,
                     "has no landmarks, between which legs go, expected the method adjustment");
  }
  const MapFitState best = fit_map(recordings, model, options.gate);
  BuiltMap built;
  take_fit(built, best);
  built.paths = paths_of(best, recordings, fitting::cleared(recordings, model), model);
  built.quality = quality_of(built.paths, best);
  doubt(built, best, recordings, model);
  return built;
}

/// What the fit says of the map, and what speaks against it.
BuiltMap judged(BuiltMap built, const MapFitState& best, bool guided,
                const std::vector<DrivenRecording>& recordings, const Model& model,
                const std::vector<SightedDrive>& believed) {
  take_fit(built, best);
  const bool on_its_way = built.method != Method::adjustment && !guided;
  if (on_its_way) {
    built.freed.clear();
  } else {
    built.rejected = left_out_of(best.fit);
  }
  ReckonedMap reckoned = reckoned_map(believed);
  built.quality = quality_of(built, best, reckoned);
  built.dead_reckoned = std::move(reckoned.places);
  built.on_survey = laid_on_survey(built, recordings);
  doubt(built, best, recordings, model);
  return built;
}

}  // namespace

BuiltMap build_map(const std::vector<DrivenRecording>& recordings, const Model& model,
                   const BuildMapOptions& options) {
  check(recordings, model.robot, options);
  if (are_paths_alone(recordings)) return build_paths(recordings, model, options);
  require_sightings(recordings);
  const MapFitState best = fit_map(recordings, model, options.gate);
  const std::vector<SessionGuide> guides = guides_of(best.fit);
  const std::vector<fitting::ClearedRecording> believed = fitting::cleared(recordings, model);
  const bool guided = options.method == Method::adjustment;
  BuiltMap built = guided ? map_of(best, best.freed.empty() ? believed : fitting::cleared(best.fit),
                                   best.fit.model, guides, options)
                          : map_of(best, believed, model, unguided(guides), options);
  return judged(std::move(built), best, guided, recordings, model,
                sessions_of(believed, model, guides));
}

BuiltMap extend_map(MapBuilder& builder, const DrivenRecording& recording, const Model& model,
                    MapAxes axes, const BuildMapOptions& options) {
  const std::vector<DrivenRecording> recordings{recording};
  check(recordings, model.robot, options);
  require_sightings(recordings);
  const MapFitState best = fit_map(recordings, model, options.gate);
  const std::vector<SessionGuide> guides = guides_of(best.fit);
  const std::vector<fitting::ClearedRecording> believed = fitting::cleared(recordings, model);
  const std::vector<fitting::ClearedRecording> clear =
      best.freed.empty() ? believed : fitting::cleared(best.fit);
  const LandmarkGraph landmarks = adjusted_landmarks(best.fit);
  const bool extended = builder.landmarks() > 0;
  LegByLegOptions how{options, landmarks};
  how.stood_on = landmarks_stood_on(clear, guides);
  how.build.method = builder.options().method;
  Turn turn;
  if (extended && (axes == MapAxes::landmarks || !recording.drive.has_compass())) {
    turn = turn_onto(landmarks, builder, recording.name);
    how.to_map = rotation(turn.angle);
  }
  BuiltMap built = map_leg_by_leg(sessions_of(clear, best.fit.model, guides), how, builder);
  built.extended = extended;
  orient_as(landmarks, turn.angle, built.map);
  if (!turn.elsewhere.empty()) {
    built.warnings.push_back(
        "the recording and the map have these landmarks at different places: " +
        listed(turn.elsewhere) + "; have they moved, or were labels misread?");
  }
  return judged(std::move(built), best, true, recordings, model,
                sessions_of(believed, model, guides));
}

}  // namespace trussmap
