// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What every method of build_map rests on: the best fit of all that was measured, what is wrong
// with single sightings, and what is wrong with the model.
//
//   recordings --fit, common errors free, gated--> do they differ from 0?
//        yes: they stay, and are named             no: the fit without them
//
// Few sightings are wrong, and each contradicts all others: these are left out. Many that
// contradict alike speak against the model: none is left out then (recording_robust.hpp).
#pragma once

#include "build_map/antenna_place.hpp"
#include "build_map/sighted_drive.hpp"
#include "fit/fit_state.hpp"
#include "trussmap/build_map.hpp"

#include <optional>
#include <vector>

namespace trussmap::map_building {

/// `fit.model` is the user's with the common errors that were freed behind it.
struct MapFitState {
  fitting::FitState fit;
  std::vector<FreedError> freed;
  double p_freed = 1.0;  ///< chance of common errors as large where there are none
  std::optional<AntennaFound> antenna = {};  ///< off the axle, and taken to be there
};

/// No sightings, but fixes or loops in each: there are paths to build, and no map.
[[nodiscard]] bool are_paths_alone(const std::vector<DrivenRecording>& recordings);

/// Survey and truth have no part in it; of paths alone the paths are laid. Throws as build_map
/// does.
[[nodiscard]] MapFitState fit_map(const std::vector<DrivenRecording>& recordings,
                                  const Model& model, const std::optional<double>& gate);

/// Sightings that were left out, with how far each points from its landmark.
[[nodiscard]] std::vector<RejectedSighting> left_out_of(const fitting::FitState& fit);

/// What it says of each session to those who build leg by leg.
[[nodiscard]] std::vector<SessionGuide> guides_of(const fitting::FitState& fit);

/// Its landmarks with their covariances, without routes.
[[nodiscard]] LandmarkGraph adjusted_landmarks(const fitting::FitState& fit);

/// Gives the map's landmarks their orientations, in axes that are turned by `turn` (rad).
void orient_as(const LandmarkGraph& adjusted, double turn, LandmarkGraph& map);

/// Moves the map's landmarks there, and adds those that no leg has.
void place_as(const LandmarkGraph& adjusted, LandmarkGraph& map);

}  // namespace trussmap::map_building
