// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/replicated_recording.hpp"

#include "drive/as_read.hpp"
#include "drive/body_motion.hpp"
#include "fit/noise_free.hpp"
#include "fit/replica_stages.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace trussmap::fitting {
namespace {

constexpr int kLeadingRounds = 4;        // shapes see the rows that they change
constexpr double kDrivenBetween = 0.05;  // m: less is none between two stops

/// Where a robot stands on a landmark.
struct MissedStop {
  std::size_t pose = 0;
  Vector2 missed = Vector2::Zero();  ///< from where the fit has the robot
};

std::size_t pose_of(const estimation::RecordingProblem& problem, int node) {
  return idx(node - problem.landmark_count());
}

/// m from the first pose.
std::vector<double> driven_to_poses(const estimation::RecordingProblem& problem) {
  std::vector<double> driven(problem.poses.size(), 0.0);
  for (const estimation::Measurement& one : problem.measurements) {
    if (!estimation::is_segment(one)) continue;
    for (const estimation::SegmentRow& row : problem.segments[one.source]) {
      driven[pose_of(problem, one.to)] += std::abs(row.path);
    }
  }
  std::partial_sum(driven.begin(), driven.end(), driven.begin());
  return driven;
}

/// Per session, in order. What is missed is drawn anew wherever the robot has driven on.
std::map<int, std::vector<MissedStop>> drawn_stops(const Replica& replica,
                                                   const std::vector<double>& driven,
                                                   statistics::NormalDraws& draw) {
  const FitState& fit = replica.fit;
  const double sd = fit.model.noise.sighting;
  const NoiseFree exact(fit.recordings, fit.model, fit.problem, fit.columns.border, replica.offsets,
                        replica.state);
  std::map<int, std::vector<MissedStop>> stops;
  for (const estimation::Measurement& one : fit.problem.measurements) {
    if (!estimation::is_standing(one)) continue;
    stops[one.session].push_back({pose_of(fit.problem, one.from)});
  }
  for (auto& [session, list] : stops) {
    std::sort(list.begin(), list.end(),
              [](const MissedStop& a, const MissedStop& b) { return a.pose < b.pose; });
    for (std::size_t k = 0; k < list.size(); ++k) {
      const std::size_t pose = list[k].pose;
      if (k > 0 && !(driven[pose] - driven[list[k - 1].pose] > kDrivenBetween)) {
        list[k].missed = list[k - 1].missed;
        continue;
      }
      const Vector2 from_fit =
          exact.state.poses[pose].position() - replica.state.poses[pose].position();
      list[k].missed = from_fit + Vector2(draw(sd), draw(sd));
    }
  }
  return stops;
}

/// Between two landmarks the path gives way little by little: a robot that turns on the spot goes
/// nowhere.
void miss_landmarks(Replica& replica, statistics::NormalDraws& draw) {
  const std::vector<double> driven = driven_to_poses(replica.fit.problem);
  std::map<int, std::vector<MissedStop>> stops = drawn_stops(replica, driven, draw);
  for (std::size_t k = 0; k < replica.state.poses.size(); ++k) {
    const std::vector<MissedStop>& list = stops[replica.fit.problem.poses[k].session];
    if (list.empty()) continue;
    const auto next = std::find_if(list.begin(), list.end(),
                                   [k](const MissedStop& one) { return one.pose >= k; });
    const MissedStop& to = next == list.end() ? list.back() : *next;
    const MissedStop& from = next == list.begin() || next == list.end() ? to : *(next - 1);
    const double way = driven[to.pose] - driven[from.pose];
    const double share = way > kDrivenBetween ? (driven[k] - driven[from.pose]) / way : 1.0;
    const Vector2 missed = from.missed + share * (to.missed - from.missed);
    replica.state.poses[k].x += missed.x();
    replica.state.poses[k].y += missed.y();
  }
}

void lead_through_poses(Replica& replica) {
  const FitState& fit = replica.fit;
  const Robot& robot = fit.model.robot;
  for (int round = 0; round < kLeadingRounds; ++round) {
    const ShapeContext context(replica.timed, robot,
                               replica.paths.empty() ? fit.paths : replica.paths);
    replica.border = border_as_fitted(fit.model, context, fit.columns.border);
    replica.paths = fitted_paths(replica.timed, robot, fit.problem, replica.border, replica.offsets,
                                 replica.state);
    for (std::size_t s = 0; s < replica.timed.size(); ++s) {
      MotionRows& drive = replica.timed[s].drive;
      for (std::size_t row = 0; row < drive.rows(); ++row) {
        Vector2& missing = replica.paths[s].missing[row];
        // Who rests goes on resting; the other rows take its share in the next round.
        if (!drive.rests(row)) {
          drive::add_motion(drive, row, {missing[0], 0.0, missing[1]}, robot);
        }
        missing.setZero();
      }
    }
  }
}

/// Events at their own times, in the order in which a fit of the session sees them.
template <typename Event>
void take_events(const std::vector<DrivenRecording>& recordings, std::size_t s, const Model& model,
                 Channel delay, const std::vector<Event>& timed, std::vector<Event>& own) {
  const DrivenRecording& recording = recordings[s];
  std::vector<double> instants;
  instants.reserve(own.size());
  for (const Event& one : own) instants.push_back(one.t);
  instants = retimed(instants, recording, s, recordings.size(), model.effects, model.robot, delay);
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < own.size(); ++k) {
    if (instants[k] >= recording.drive.start() && instants[k] <= recording.drive.t.back()) {
      order.push_back(k);
    }
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return instants[a] < instants[b]; });
  for (std::size_t k = 0; k < std::min(order.size(), timed.size()); ++k) {
    const double t = own[order[k]].t;
    own[order[k]] = timed[k];
    own[order[k]].t = t;
  }
}

/// Delays back in their places: a fit moves what was sighted to when it was seen. Steering, and
/// wheels of far factors, as they were read: a fit takes these effects in before all else.
std::vector<DrivenRecording> in_own_times(std::vector<DrivenRecording> recordings,
                                          Replica&& replica) {
  const Model& model = replica.fit.model;
  for (std::size_t s = 0; s < recordings.size(); ++s) {
    DrivenRecording& own = recordings[s];
    DrivenRecording& timed = replica.timed[s];
    take_events(recordings, s, model, Channel::delay, timed.sightings, own.sightings);
    take_events(recordings, s, model, Channel::delay, timed.truth, own.truth);
    take_events(recordings, s, model, Channel::fix_delay, timed.fixes, own.fixes);
    own.loops = std::move(timed.loops);
    std::vector<WheelColumn> wheels = std::move(own.drive.wheels);
    own.drive = drive::as_read(std::move(timed.drive), model.robot);
    own.drive.wheels = std::move(wheels);
    own.survey = std::move(timed.survey);
  }
  return recordings;
}

}  // namespace

std::vector<DrivenRecording> replicated(const std::vector<DrivenRecording>& recordings,
                                        const FitState& fit, std::uint64_t seed) {
  statistics::NormalDraws draw{std::mt19937_64(seed)};
  Replica replica{fit, offsets_of(fit), fit.adjustment.state, fit.recordings};
  replica.state.noise.resize(0);
  miss_landmarks(replica, draw);
  lead_through_poses(replica);
  const std::size_t sessions = replica.timed.size();
  DrawnSurvey survey;
  for (std::size_t s = 0; s < sessions; ++s) {
    draw_survey(s, survey, replica, draw);
    draw_truth(s, replica, draw);
  }
  for (std::size_t s = 0; s < sessions; ++s) draw_fixes_and_loops(s, replica, draw);
  draw_sightings(replica, draw);
  for (std::size_t s = 0; s < sessions; ++s) {
    part_wheels_and_gyro(s, replica, draw);
    disturb_drive(s, replica, draw);
    for (const NoiseProcess& one : fit.model.noise.processes) add_process(one, s, replica, draw);
  }
  return in_own_times(recordings, std::move(replica));
}

}  // namespace trussmap::fitting
