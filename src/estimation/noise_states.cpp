// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/noise_states.hpp"

#include "drive/legs.hpp"
#include "drive/row_motion.hpp"
#include "drive/row_variables.hpp"
#include "effects/channel_record.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace trussmap::estimation {
namespace {

constexpr double kLeastRest = 0.5;       // s: a shorter rest ends no leg
constexpr double kLeastVariance = 1e-8;  // of a step of a unit process

/// A process that is to be laid over a problem.
struct ProcessToLay {
  const RecordingProblem& problem;
  const std::vector<DrivenRecording>& recordings;
  const Robot& robot;
  const std::vector<std::vector<Matrix4>>& influences;  ///< per segment and row
  Channel channel;
  ProcessKind process;
  double length;

  [[nodiscard]] const MotionRows& drive_of(const Measurement& one) const {
    return recordings[idx(one.session)].drive;
  }
  [[nodiscard]] std::size_t pose_of(int node) const { return idx(node - problem.landmark_count()); }
};

/// What a unit of g adds to the pattern of a view.
effects::ViewVector unit_view(const ProcessToLay& lasting, const Measurement& one) {
  const MotionRows& drive = lasting.drive_of(one);
  const std::size_t row = drive::row_at(drive, lasting.problem.time_of(one.from));
  const double duration = std::max(drive.duration(row), 1e-9);
  const BodyMotion motion = drive.motion(row);
  return one.kind->unit_view(lasting.channel, one, motion.forward / duration,
                             motion.turn / duration);
}

/// What a unit of g in each row adds to what was driven.
std::vector<Vector4> unit_rows(const ProcessToLay& lasting, const Measurement& one) {
  const std::vector<SegmentRow>& rows = lasting.problem.segments[one.source];
  const MotionRows& drive = lasting.drive_of(one);
  std::vector<Vector4> c =
      is_segment(one) ? unit_columns(drive, rows, lasting.influences[one.source], lasting.channel,
                                     lasting.robot)
                      : unit_excesses(drive, rows, lasting.problem.gyro_weights[one.source],
                                      lasting.channel, lasting.robot);
  for (Vector4& row : c) {
    if (one.rows < 4) row[3] = 0.0;
  }
  return c;
}

NoiseTerm driven_term(int state, const Vector4& by) {
  NoiseTerm term;
  term.state = state;
  term.by.head<4>() = by;
  return term;
}

LaidProcess nothing_of(const RecordingProblem& problem) {
  const std::size_t count = problem.measurements.size();
  return {
      {}, std::vector<std::vector<NoiseTerm>>(count), std::vector<Matrix4>(count, Matrix4::Zero())};
}

/// A state each, of what is no row and no reading.
LaidProcess lay_white(const ProcessToLay& lasting) {
  LaidProcess laid = nothing_of(lasting.problem);
  for (std::size_t k = 0; k < laid.terms.size(); ++k) {
    const Measurement& one = lasting.problem.measurements[k];
    if (!one.kind->shows(lasting.channel, one)) continue;
    if (is_driven(one)) {
      for (const Vector4& row : unit_rows(lasting, one)) laid.within[k] += row * row.transpose();
    } else if (effects::record_of(lasting.channel).reading) {  // its variance is the reading's own
      laid.within[k] = one.kind->reading_variance(lasting.channel, one);
    } else {
      laid.terms[k].push_back({static_cast<int>(laid.states.size()), unit_view(lasting, one)});
      laid.states.push_back({});
    }
  }
  return laid;
}

/// A state per instant, each of which follows from the one before.
struct Chain {
  std::vector<NoiseState> states;
  std::vector<int> at_pose;  ///< -1: none
};

Chain chain_of(const ProcessToLay& lasting) {
  const RecordingProblem& problem = lasting.problem;
  std::vector<bool> wanted(problem.poses.size(), false);
  for (const Measurement& one : problem.measurements) {
    if (one.kind->shows(lasting.channel, one)) wanted[lasting.pose_of(one.from)] = true;
  }
  if (effects::acts_on(lasting.channel) != effects::ActsOn::views)
    wanted.assign(wanted.size(), true);
  Chain chain{{}, std::vector<int>(problem.poses.size(), -1)};
  int session = -1;
  double elapsed = 0.0;  // from the session's start to the last instant
  std::vector<double> driven;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    if (!wanted[k]) continue;
    const PoseNode& node = problem.poses[k];
    const MotionRows& drive = lasting.recordings[idx(node.session)].drive;
    const bool first = node.session != session;
    double at = node.t - drive.start();
    if (goes_with_distance(lasting.process)) {
      if (first) driven = drive::driven_path(drive);
      at = drive::path_at(drive, driven, node.t);
    }
    const int last = static_cast<int>(chain.states.size()) - 1;
    chain.at_pose[k] = last + 1;
    if (first && is_correlated(lasting.process)) {
      chain.states.push_back({});
    } else {
      const Lag lag = lag_of(lasting.process, first ? at : at - elapsed, lasting.length);
      chain.states.push_back({0, first ? -1 : last, first ? 0.0 : lag.keep,
                              std::sqrt(std::max(lag.end, kLeastVariance))});
    }
    session = node.session;
    elapsed = at;
  }
  return chain;
}

LaidProcess lay_chain(const ProcessToLay& lasting) {
  auto [states, at_pose] = chain_of(lasting);
  const bool at_ends = effects::acts_on(lasting.channel) == effects::ActsOn::readings;
  LaidProcess laid = nothing_of(lasting.problem);
  laid.states = std::move(states);
  for (std::size_t k = 0; k < laid.terms.size(); ++k) {
    const Measurement& one = lasting.problem.measurements[k];
    if (!one.kind->shows(lasting.channel, one)) continue;
    const int state = at_pose[lasting.pose_of(one.from)];
    if (!is_driven(one)) {
      laid.terms[k].push_back({state, unit_view(lasting, one)});
      continue;
    }
    const auto [by_start, keep, uu, uw, ww] =
        process_moments(lasting.problem.segments[one.source], unit_rows(lasting, one),
                        lasting.process, lasting.length, at_ends);
    const Vector4 K = ww > kLeastVariance ? Vector4(uw / ww) : Vector4(Vector4::Zero());
    laid.within[k] = uu - K * uw.transpose();
    laid.within[k] = (0.5 * (laid.within[k] + laid.within[k].transpose())).eval();
    // Which states a segment has must not depend on the length.
    if (by_start.isZero(0.0)) continue;
    const int end = is_segment(one) ? one.to : one.from + 1;
    laid.terms[k].push_back(driven_term(state, by_start - keep * K));
    laid.terms[k].push_back(driven_term(at_pose[lasting.pose_of(end)], K));
  }
  return laid;
}

/// When each landmark was last seen in each session, and in which pass.
class Passes {
 public:
  int pass_of(const Measurement& one, double t) {
    auto& [seen, pass] = passes_.try_emplace({one.session, one.to}, t, 0).first->second;
    if (t - seen > kLongestGap) ++pass;
    seen = t;
    return pass;
  }

 private:
  std::map<std::pair<int, int>, std::pair<double, int>> passes_;
};

/// A state per leg, session or pass.
LaidProcess lay_constants(const ProcessToLay& lasting) {
  std::vector<std::vector<double>> ends(lasting.recordings.size());  // of legs
  for (std::size_t s = 0; lasting.process == ProcessKind::per_leg && s < ends.size(); ++s) {
    ends[s] = ends_of_legs(lasting.recordings[s]);
  }
  LaidProcess laid = nothing_of(lasting.problem);
  std::map<std::array<int, 3>, int> states;
  const auto state_of = [&](int session, int part, int landmark) {
    const auto [at, fresh] =
        states.try_emplace({session, part, landmark}, static_cast<int>(laid.states.size()));
    if (fresh) laid.states.push_back({});
    return at->second;
  };
  Passes passes;
  for (std::size_t k = 0; k < laid.terms.size(); ++k) {
    const Measurement& one = lasting.problem.measurements[k];
    if (!one.kind->shows(lasting.channel, one)) continue;
    const double t = lasting.problem.time_of(one.from);
    const std::vector<double>& legs = ends[idx(one.session)];
    if (is_driven(one)) {
      // A rest within a segment parts two legs.
      const std::vector<SegmentRow>& rows = lasting.problem.segments[one.source];
      for (const auto& [leg, sum] : sums_by_leg(rows, unit_rows(lasting, one), t, legs)) {
        const int state = state_of(one.session, leg, -1);
        if (!sum.isZero(0.0)) laid.terms[k].push_back(driven_term(state, sum));
      }
      continue;
    }
    const int state = lasting.process == ProcessKind::per_pass
                          ? state_of(one.session, passes.pass_of(one, t), one.to)
                          : state_of(one.session, leg_at(legs, t), -1);
    laid.terms[k].push_back({state, unit_view(lasting, one)});
  }
  return laid;
}

}  // namespace

std::vector<double> ends_of_legs(const DrivenRecording& recording) {
  std::vector<double> ends;
  for (const Sighting& sighting : recording.sightings) {
    if (sighting.standing()) ends.push_back(sighting.t);
  }
  if (!ends.empty()) return ends;
  const MotionRows& drive = recording.drive;
  double rested = 0.0;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const bool rests = drive.rests(row);
    rested = rests ? rested + drive.duration(row) : 0.0;
    const bool last = rests && row + 1 < drive.rows() && !drive.rests(row + 1);
    if (last && rested >= kLeastRest) ends.push_back(drive.t[row]);
  }
  return ends;
}

int leg_at(const std::vector<double>& ends, double t) {
  return static_cast<int>(std::lower_bound(ends.begin(), ends.end(), t) - ends.begin());
}

std::map<int, Vector4> sums_by_leg(const std::vector<SegmentRow>& rows,
                                   const std::vector<Vector4>& c, double from,
                                   const std::vector<double>& ends) {
  std::map<int, Vector4> sums;
  double t = from;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const double middle = t + 0.5 * rows[row].duration;
    t += rows[row].duration;
    sums.try_emplace(leg_at(ends, middle), Vector4::Zero()).first->second += c[row];
  }
  return sums;
}

std::vector<Vector4> unit_columns(const MotionRows& drive, const std::vector<SegmentRow>& rows,
                                  const std::vector<Matrix4>& influences, Channel channel,
                                  const Robot& robot) {
  const bool reads = effects::acts_on(channel) == effects::ActsOn::readings;
  std::vector<Vector4> c(rows.size(), Vector4::Zero());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (reads && std::isnan(rows[row].reading)) continue;
    const std::size_t at = rows[row].row;
    const effects::DrivePattern unit =
        effects::drive_pattern(channel, 1.0, drive::row_motion(drive, at, robot));
    c[row] = influences[row] * Vector4(unit.advance, unit.slip, unit.turn, unit.compass);
  }
  return c;
}

std::vector<Vector4> unit_excesses(const MotionRows& drive, const std::vector<SegmentRow>& rows,
                                   const std::vector<Vector4>& weights, Channel channel,
                                   const Robot& robot) {
  std::vector<Vector4> c(rows.size(), Vector4::Zero());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::size_t at = rows[row].row;
    const effects::DrivePattern unit =
        effects::drive_pattern(channel, 1.0, drive::row_motion(drive, at, robot));
    c[row] = rows[row].part * unit.excess * weights[row];
  }
  return c;
}

ProcessLayer::ProcessLayer(const RecordingProblem& problem,
                           const std::vector<DrivenRecording>& recordings, const Robot& robot)
    : problem_(problem), recordings_(recordings), robot_(robot) {
  influences_.reserve(problem.segments.size());
  for (const std::vector<SegmentRow>& rows : problem.segments) {
    influences_.push_back(row_influences(rows));
  }
}

LaidProcess ProcessLayer::lay(Channel channel, ProcessKind process, double length) const {
  const ProcessToLay lasting{problem_, recordings_, robot_, influences_, channel, process, length};
  if (process == ProcessKind::white) return lay_white(lasting);
  return is_chain(process) ? lay_chain(lasting) : lay_constants(lasting);
}

}  // namespace trussmap::estimation
