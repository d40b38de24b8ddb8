// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// A landmark map from recordings, in one call.
//
//   recordings, model --build_map--> BuiltMap: the map, what was left out of it, how good it is
//
//   adjustment
//           least squares of everything that was recorded
//   elastic, elastic_printed, gauss_markov
//           leg by leg, as a robot would build it on the way (map_builder.hpp): every leg is
//           dead-reckoned and handed to the builder
//
// The adjustment tells sightings that are wrong, few, each against all others, from a model that is
// wrong: those are left out; where the model is, the errors that nearly every robot has (wheel
// diameters, wheelbase, heading drift, hard iron) are estimated beside the map and named. The other
// methods build what a robot would have had on its way: headings by compass or corners, nothing
// left out but by the builder's gate, nothing known of what comes later. The adjustment then judges
// that map.
//
// The model's effects act with the coefficients that it states. Surveys judge the map, and have no
// part in it. Its frame is that of the first session with a compass (else of the first): the first
// landmark lies at the origin and the first heading points as its compass says. Leg by leg, a
// further session begins where it first sights a landmark of the map.
//
// Recordings of which none sights a landmark, but that have fixes or loops, have no map: what is
// built is their adjusted path, in the frame of the fixes, else in that of the first pose.
#pragma once

#include "trussmap/landmark_map.hpp"
#include "trussmap/map_builder.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/survey_comparison.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap {

struct BuildMapOptions {
  Method method = Method::adjustment;
  RefinementScope scope = {};            ///< of the elastic methods
  std::optional<StiffnessLaw> law = {};  ///< of `elastic`; absent: its own
  bool relax = false;                    ///< leg by leg: at the end all comes to equilibrium
  double min_drive = kDefaultMinDrive;   ///< m of driven path: a shorter drive is no leg
  /// Standard deviations beyond which a sighting is left out, however many are; infinity: none is.
  /// Absent: 4, widened where too many would go.
  std::optional<double> gate = {};
};

struct RejectedSighting {
  std::string recording;
  double t = 0.0;  ///< s
  std::string landmark;
  double misfit = 0.0;  ///< m, from where the map has the landmark
};

/// A systematic error that the model does not have, estimated beside the map.
struct FreedError {
  Effect effect;           ///< with its coefficients
  std::vector<double> sd;  ///< of each
};

/// How well the adjustment fits what was measured.
struct MapFit {
  double chi2 = 0.0;  ///< of the measurements kept
  int dof = 0;
  double p_value = 1.0;  ///< chance of a chi^2 as large where the model is right
  int iterations = 0;
  bool converged = false;
};

/// How good a map is, as far as that is known without a survey.
struct MapQuality {
  /// How far landmarks are from the truth, by the adjustment, after the best rotation and
  /// translation: root mean square distances, m; the noise taken as large as it turned out to be.
  /// Where there are none: how far the robot is, where something was measured, in the path's frame.
  double median_sd = 0.0;
  double worst_sd = 0.0;
  std::string worst_landmark;
  int oriented = 0;                    ///< landmarks of which yaws tell an orientation
  double median_sd_heading = kAbsent;  ///< rad, of these in the map's frame; likewise
  double dispersion = 1.0;             ///< chi^2/dof: 1 where the model's noise explains all errors
  int loops = 0;                       ///< from a landmark back to it
  /// By how much dead reckoning misses a loop's start, as a share of the way: median, NaN without
  /// loops.
  double misclosure_share = kAbsent;
  int sightings = 0;
  double left_out_share = 0.0;  ///< of the sightings; where there are none, of fixes and loops
  double from_adjusted = 0.0;   ///< rms distance from the adjustment's map, m
};

/// The map beside the recordings' surveys.
struct MapOnSurvey {
  std::vector<SurveyPoint> points;  ///< of all sessions, each landmark once, by name
  SurveyComparison comparison;
  /// m, rigid, over the same landmarks; NaN: they are not reckoned, of ranges alone.
  double rms_dead_reckoning = kAbsent;
};

/// A fix or a loop beside an adjusted path.
struct PathTie {
  bool loop = false;
  double t = 0.0;       ///< s
  double t2 = kAbsent;  ///< s, of a loop
  /// m: the fix; of a loop, where the path has the robot at t.
  Vector2 from = Vector2::Zero();
  Vector2 to = Vector2::Zero();  ///< m: where the path has the antenna; the robot at t2
  double misfit = 0.0;           ///< m, between what was measured and the path
  bool left_out = false;         ///< it contradicts the others
};

/// A path beside the truth, after the best rotation and translation.
struct PathOnTruth {
  int rows = 0;                     ///< of the truth, within the drive
  double rms = 0.0;                 ///< m
  double rms_dead_reckoning = 0.0;  ///< m, laid on the truth by itself
};

/// Where the robot drove, of a recording without landmarks.
struct BuiltPath {
  std::string recording;
  std::vector<Vector2> adjusted;       ///< m: at the drive's start and at the end of every row
  std::vector<Vector2> dead_reckoned;  ///< m, the same, never corrected, laid on the adjusted path
  double length = 0.0;                 ///< m
  double rms_dead_reckoning = 0.0;     ///< m, of it from the adjusted path
  double median_sd = 0.0;              ///< m, as MapQuality
  double worst_sd = 0.0;               ///< m
  double worst_t = 0.0;                ///< s, when
  std::vector<PathTie> ties;           ///< fixes, then loops, in order of time
  std::optional<PathOnTruth> on_truth;
};

/// Errors of a map that grew leg by leg, when its routes had all been driven (again).
struct TourErrors {
  MapErrors errors;      ///< after the best rotation and translation
  bool complete = true;  ///< false: the recording ended within the tour
};

struct BuiltMap {
  LandmarkGraph map;  ///< with covariances of the landmarks where they were adjusted
  Method method = Method::adjustment;
  bool extended = false;  ///< the map was there before, with other recordings' landmarks
  int legs = 0;
  int new_landmarks = 0;  ///< of the map's, those that these recordings brought
  /// Landmarks at arrivals that the builder left out, for they contradict the map; of extend_map.
  std::vector<std::string> off_map;
  int first_sight = 0;     ///< loops closed
  int refinements = 0;     ///< known routes driven again
  int side_sightings = 0;  ///< routes from a leg's end to what else was seen there
  std::vector<RejectedSighting> rejected;
  std::vector<TourErrors> tours;         ///< leg by leg and surveyed: after each tour
  bool relaxed = false;                  ///< its end was an equilibrium of the whole
  std::vector<BuiltPath> paths;          ///< one per recording, where there are no landmarks
  std::vector<FreedError> freed;         ///< what was estimated beside the map; empty: nothing
  std::vector<std::string> unconfirmed;  ///< landmarks that one sighting from afar alone has
  /// Positions by dead reckoning alone, never corrected: mean over all sightings of a landmark (of
  /// the first recording that saw it), in that recording's frame.
  LandmarkPositions dead_reckoned;
  MapFit fit;  ///< of the adjustment
  MapQuality quality;
  std::optional<MapOnSurvey> on_survey;  ///< where three landmarks of the map were surveyed
  std::vector<std::string> warnings;     ///< in words: what speaks against the map, and the remedy
  std::vector<std::string> notes;        ///< in words: what is worth knowing besides

  /// Nothing speaks against the map.
  [[nodiscard]] bool good() const { return warnings.empty(); }
};

/// Whose axes a map has that recordings are to extend.
enum class MapAxes {
  compass,    ///< those of a compass: a recording with a compass has the same
  landmarks,  ///< of its own: every recording is turned until the landmarks fit
};

/// Hands one session's legs to a builder that may hold a map already, by the builder's method. What
/// build_map does to a recording before its legs are reckoned is done to this one, on its own: it
/// is adjusted, wrong sightings are left out, common errors freed. A recording that has not the
/// map's axes is turned by the landmarks that both have. The result tells of this recording, but
/// for its map, which is the builder's. Of the options the gate and min_drive count. Throws as
/// build_map does, and SolveError where a recording would have to be turned and shares fewer than
/// two landmarks with the map; the builder may have taken some of the legs then.
[[nodiscard]] BuiltMap extend_map(MapBuilder& builder, const DrivenRecording& recording,
                                  const Model& model, MapAxes axes,
                                  const BuildMapOptions& options = {});
[[nodiscard]] inline BuiltMap extend_map(MapBuilder& builder, const Recording& recording,
                                         const Model& model, MapAxes axes,
                                         const BuildMapOptions& options = {}) {
  return extend_map(builder, with_wheels(recording, model.robot), model, axes, options);
}

/// Builds one map from the sessions, or the path where none sights a landmark (by the method
/// adjustment alone). Throws InputError where a recording has no sightings (and others do, or it
/// has neither fixes nor loops) or there is no leg, SolveError where a session or a landmark is
/// tied to nothing, std::invalid_argument on options out of range, on a recording that is not as
/// recording.hpp has it and, naming it, on an effect that cannot be applied.
[[nodiscard]] BuiltMap build_map(const std::vector<DrivenRecording>& recordings, const Model& model,
                                 const BuildMapOptions& options = {});
[[nodiscard]] inline BuiltMap build_map(const std::vector<Recording>& recordings,
                                        const Model& model, const BuildMapOptions& options = {}) {
  return build_map(with_wheels(recordings, model.robot), model, options);
}

}  // namespace trussmap
