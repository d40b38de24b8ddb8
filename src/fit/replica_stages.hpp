// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The stages of a recording drawn anew (replicated_recording.hpp). They draw from one stream, so
// their order is part of what a seed means.
#pragma once

#include "fit/fit_state.hpp"
#include "statistics/normal_draws.hpp"

#include <string>
#include <tuple>

namespace trussmap::fitting {

/// The fit's recordings on their way to new ones.
struct Replica {
  const FitState& fit;
  Eigen::VectorXd offsets;
  estimation::RecordingState state;    ///< without lasting noise; the robot misses landmarks
  std::vector<DrivenRecording> timed;  ///< as fitted: moved back by the delays
  std::vector<SessionPath> paths = {};
  estimation::EffectParameters border = {};
};

/// What a survey, copied to every session, has been drawn to say: it stays one.
struct DrawnSurvey {
  std::map<std::tuple<std::string, double, double>, Vector2> places;
  std::map<std::tuple<std::string, double, double, double>, double> headings;
};

void draw_survey(std::size_t session, DrawnSurvey& drawn, Replica& replica,
                 statistics::NormalDraws& draw);
void draw_truth(std::size_t session, Replica& replica, statistics::NormalDraws& draw);
void draw_fixes_and_loops(std::size_t session, Replica& replica, statistics::NormalDraws& draw);
void draw_sightings(Replica& replica, statistics::NormalDraws& draw);

/// Of a drive along which both lead, what wheels and gyro each show; the gyro's noise.
void part_wheels_and_gyro(std::size_t session, Replica& replica, statistics::NormalDraws& draw);
/// Noise of wheels and compass.
void disturb_drive(std::size_t session, Replica& replica, statistics::NormalDraws& draw);
/// Throws std::invalid_argument on a channel that no recording can hold.
void add_process(const NoiseProcess& process, std::size_t session, Replica& replica,
                 statistics::NormalDraws& draw);

}  // namespace trussmap::fitting
