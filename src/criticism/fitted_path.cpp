// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/criticism/fitted_path.hpp"

#include "trussmap/adjustment/measurement_rows.hpp"
#include "trussmap/effects/row_variables.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap {
namespace {

/// One session's rows under the effects.
class Reckoner {
 public:
  Reckoner(const Drive& drive, const Robot& robot, const EffectBorder& border,
           const Eigen::VectorXd& offsets, int session)
      : drive_(drive), robot_(robot), border_(border), offsets_(offsets), session_(idx(session)) {}

  /// Motion over part of the drive, in the frame of its start.
  [[nodiscard]] Pose motion(double from, double to) const {
    return motion(piece_rows(drive_, from, to, robot_));
  }
  [[nodiscard]] Pose motion(const std::vector<PieceRow>& rows) const {
    std::vector<const std::vector<DrivePattern>*> patterns;
    patterns.reserve(border_.size());
    for (const EffectPattern& effect : border_) {
      patterns.push_back(effect.drives.empty() ? nullptr : &effect.drives[session_]);
    }
    return piece_motion(rows, patterns, offsets_).motion.displacement;
  }

 private:
  const Drive& drive_;
  const Robot& robot_;
  const EffectBorder& border_;
  const Eigen::VectorXd& offsets_;
  std::size_t session_;
};

/// Fills the ends of the rows that lie between two nodes.
void fill_between(const Drive& drive, const Robot& robot, const Reckoner& reckoner,
                  const PoseNode& from, const Pose& at_from, const PoseNode& to, const Pose& at_to,
                  SessionPath& path) {
  const std::vector<PieceRow> rows = piece_rows(drive, from.t, to.t, robot);
  std::vector<Pose> reached;
  std::vector<Pose> steps;
  Pose pose = at_from;
  for (const PieceRow& row : rows) {
    steps.push_back(reckoner.motion(std::vector<PieceRow>{row}));
    pose = compose(pose, steps.back());
    reached.push_back(pose);
  }
  if (rows.empty()) return;
  const Vector2 missing = at_to.position() - pose.position();
  const double missing_turn = wrap_angle(at_to.heading - pose.heading);
  Pose before = at_from;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double share = static_cast<double>(k + 1) / static_cast<double>(rows.size());
    Pose& end = path.ends[rows[k].row];
    end = reached[k];
    end.x += share * missing.x();
    end.y += share * missing.y();
    end.heading += share * missing_turn;
    const Pose step = relative(before, end);
    path.missing[rows[k].row] += Vector2(step.x - steps[k].x, step.heading - steps[k].heading);
    before = end;
  }
}

/// The pose that a motion leads from to `end`.
Pose before(const Pose& end, const Pose& motion) {
  Pose start;
  start.heading = end.heading - motion.heading;
  const Vector2 place = end.position() - rotation(start.heading) * motion.position();
  start.x = place.x();
  start.y = place.y();
  return start;
}

}  // namespace

std::vector<SessionPath> fitted_paths(const std::vector<Recording>& recordings, const Robot& robot,
                                      const RecordingProblem& problem, const EffectBorder& border,
                                      const Eigen::VectorXd& offsets, const RecordingState& state) {
  std::vector<SessionPath> paths(recordings.size());
  std::vector<int> first(recordings.size(), -1);
  std::vector<int> last(recordings.size(), -1);
  for (std::size_t k = 0; k < problem.poses.size(); ++k) {
    const std::size_t session = idx(problem.poses[k].session);
    if (first[session] < 0) first[session] = static_cast<int>(k);
    last[session] = static_cast<int>(k);
  }
  for (std::size_t s = 0; s < recordings.size(); ++s) {
    const Drive& drive = recordings[s].drive;
    const Reckoner reckoner(drive, robot, border, offsets, static_cast<int>(s));
    SessionPath& path = paths[s];
    path.ends.resize(drive.rows());
    path.missing.assign(drive.rows(), Vector2::Zero());
    if (first[s] < 0) continue;
    const PoseNode& first_node = problem.poses[idx(first[s])];
    path.start = before(state.poses[idx(first[s])], reckoner.motion(drive.start(), first_node.t));
    Pose pose = path.start;
    for (const PieceRow& row : piece_rows(drive, drive.start(), first_node.t, robot)) {
      pose = compose(pose, reckoner.motion(std::vector<PieceRow>{row}));
      path.ends[row.row] = pose;
    }
    for (int k = first[s]; k < last[s]; ++k) {
      fill_between(drive, robot, reckoner, problem.poses[idx(k)], state.poses[idx(k)],
                   problem.poses[idx(k + 1)], state.poses[idx(k + 1)], path);
    }
    pose = state.poses[idx(last[s])];
    for (const PieceRow& row :
         piece_rows(drive, problem.poses[idx(last[s])].t, drive.t.back(), robot)) {
      pose = compose(pose, reckoner.motion(std::vector<PieceRow>{row}));
      path.ends[row.row] = pose;
    }
  }
  return paths;
}

RecordingState standing_exactly(const RecordingProblem& problem, const EffectBorder& border,
                                const Eigen::VectorXd& offsets, const RecordingState& state) {
  std::vector<Vector2> sums(state.poses.size(), Vector2::Zero());
  std::vector<int> counts(state.poses.size(), 0);
  for (const Measurement& one : problem.measurements) {
    if (one.kind != MeasurementKind::standing) continue;
    const ViewPattern view = view_of(border, offsets, one);
    const std::size_t pose = idx(one.from - problem.landmark_count());
    sums[pose] += state.landmarks[idx(one.to)] -
                  rotation(state.poses[pose].heading) * Vector2(view.ahead, view.left);
    ++counts[pose];
  }
  RecordingState result = state;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (counts[k] == 0) continue;
    result.poses[k].x = sums[k].x() / counts[k];
    result.poses[k].y = sums[k].y() / counts[k];
  }
  return result;
}

Pose pose_at(const Drive& drive, const SessionPath& path, double t) {
  const std::size_t row = row_at(drive, t);
  const Pose& from = row == 0 ? path.start : path.ends[row - 1];
  const Pose& to = path.ends[row];
  const double begin = row == 0 ? drive.start() : drive.t[row - 1];
  const double share = std::clamp((t - begin) / (drive.t[row] - begin), 0.0, 1.0);
  const double turn = wrap_angle(to.heading - from.heading);
  return {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y),
          from.heading + share * turn};
}

}  // namespace trussmap
