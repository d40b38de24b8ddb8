// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A landmark map from recordings, in one call.
//
//   recordings, model --build_map--> BuiltMap: the map, what was kept out of it, how good it is
//
//   elastic, elastic_printed, gauss_markov
//           leg by leg, as a robot would build it on the way (map_builder.hpp): every leg is
//           dead-reckoned, gated against the map so far and handed to the builder
//   adjustment
//           least squares of everything that was recorded; the routes are then laid leg by leg,
//           with headings taken from the adjusted map
//
// The model's effects act with the coefficients that it states; nothing is fitted. Surveys judge
// the map, and have no part in it. Its frame is that of the first session with a compass (else of
// the first): the first landmark lies at the origin and the first heading points as its compass
// says.
//
// Gate: a sighting whose landmark would lie too far from where the map has it is kept out and named
// (gate.hpp). A landmark that is only seen from afar enters the map when `confirmations` sightings
// agree on where it is: one misread label cannot place it.
//
// Without a compass the heading is taken from the map on every leg between landmarks that it knows.
// While the map is young that carries its errors along; therefore the recordings are gone through
// `looks` times, each time building the map anew, with headings and gate from the map of the look
// before. A further session begins where it first sights a landmark of the map; without a compass
// its heading there follows from the next landmarks of the map that it meets.
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
  Method method = Method::elastic;
  Eta eta{.hold_first = false};         ///< of the elastic methods
  double min_drive = kDefaultMinDrive;  ///< m of driven path: a shorter drive is no leg
  std::optional<double> gate =
      {};                 ///< standard deviations; infinity: none; absent: the method's own
  int looks = 2;          ///< without a compass
  int settle = 5;         ///< rounds in which an elastic map comes to rest (MapBuilder::settle)
  int confirmations = 3;  ///< of a landmark that is only seen from afar
  double map_sd = 0.3;    ///< m per coordinate: how wrong the map may be while it is built
  /// rad, added to the noise of bearings where there is no compass: headings rest on single
  /// sightings then, and one that comes late while the robot turns is off by more than its noise.
  double bearing_slack = 0.1;
};

struct RejectedSighting {
  std::string recording;
  double t = 0.0;  ///< s
  std::string landmark;
  double misfit = 0.0;  ///< m, from where the map has the landmark
};

/// How well an adjustment's map fits what was measured.
struct MapFit {
  double chi2 = 0.0;  ///< of the measurements kept
  int dof = 0;
  double p_value = 1.0;  ///< chance of a chi^2 as large where the model is right
  int iterations = 0;
  bool converged = false;
};

/// The map beside the recordings' surveys.
struct MapOnSurvey {
  std::vector<SurveyPoint> points;  ///< of all sessions, each landmark once, by name
  SurveyComparison comparison;
  double rms_dead_reckoning = 0.0;  ///< m, rigid, over the same landmarks
};

struct BuiltMap {
  LandmarkGraph map;  ///< with covariances of the landmarks where they were adjusted
  Method method = Method::elastic;
  int legs = 0;
  int first_sight = 0;     ///< loops closed
  int refinements = 0;     ///< known routes driven again
  int side_sightings = 0;  ///< routes from a leg's end to what else was seen there
  std::vector<RejectedSighting> rejected;
  std::vector<std::string> unconfirmed;  ///< landmarks sighted, but never often enough
  /// Positions by dead reckoning alone, never corrected: mean over all sightings of a landmark (of
  /// the first recording that saw it), in that recording's frame.
  LandmarkPositions dead_reckoned;
  std::optional<MapFit> fit;             ///< of an adjustment
  std::optional<MapOnSurvey> on_survey;  ///< where three landmarks of the map were surveyed
  std::vector<std::string> warnings;     ///< in words: what speaks against the map, and the remedy
};

/// Builds one map from the sessions. Throws InputError where a recording has no sightings or there
/// is no leg, SolveError where a session or a landmark is tied to nothing, std::invalid_argument on
/// options out of range, on a recording that is not as recording.hpp has it and, naming it, on an
/// effect that cannot be applied.
[[nodiscard]] BuiltMap build_map(const std::vector<Recording>& recordings, const Model& model,
                                 const BuildMapOptions& options = {});

}  // namespace trussmap
