// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/fitted_path.hpp"

#include "drive/body_motion.hpp"
#include "drive/row_variables.hpp"
#include "odometry/row_reckoner.hpp"
#include "parallel/parallel_for.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

namespace trussmap::fitting {
namespace {

/// One session's rows under the effects.
class Reckoner {
 public:
  Reckoner(const MotionRows& drive, std::vector<effects::DrivePattern> effects)
      : drive_(drive), effects_(std::move(effects)) {}

  /// Motion over part of the drive, in the frame of its start.
  [[nodiscard]] Pose motion(double from, double to) const {
    return estimation::segment_motion(moved(estimation::segment_rows(drive_, from, to)))
        .displacement;
  }
  [[nodiscard]] Pose motion(const estimation::SegmentRow& row) const {
    const estimation::SegmentRow moved = estimation::with_effects(row, effects_);
    return odometry::displacement_of({moved.path, moved.slip, moved.turn});
  }
  [[nodiscard]] std::vector<estimation::SegmentRow> moved(
      const std::vector<estimation::SegmentRow>& rows) const {
    return estimation::with_effects(rows, effects_);
  }

 private:
  const MotionRows& drive_;
  std::vector<effects::DrivePattern> effects_;  ///< all of them together
};

/// Travel and turn that each row lacks, as white noise of the wheels would have it that adds up to
/// what the whole lacks: Q A' (sum A Q A')^-1 e, with A the row's influence and Q its share of
/// noise.
std::vector<Vector2> estimated_noise(const std::vector<estimation::SegmentRow>& rows,
                                     const MotionRows& drive, const Robot& robot,
                                     const std::vector<estimation::Matrix4>& influences,
                                     const Eigen::Vector3d& lacking) {
  constexpr double kLeastShare = 1e-6;  // m: rows at rest may err too
  // Beside what wheels do: a wheel that hardly turns would have to turn again and again to bring a
  // resting robot sideways.
  constexpr double kSlip = 1e-6;
  using Influence = Eigen::Matrix<double, 3, 2>;
  std::vector<Influence> spread(rows.size());
  Matrix3 total = Matrix3::Zero();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    Influence A;
    A.col(0) = influences[k].block<3, 1>(0, 0);
    A.col(1) = influences[k].block<3, 1>(0, 2);
    const WheelTravel own = rows[k].part * drive::own_travel(drive, rows[k].row, robot);
    const Vector2 of_wheels(std::abs(own.left) + kLeastShare, std::abs(own.right) + kLeastShare);
    const Matrix2 by = drive::by_travel(drive, robot);
    Matrix2 Q = by * of_wheels.asDiagonal() * by.transpose();
    if (!drive.gyro.empty()) {
      const GyroShare& gyro = drive.gyro[rows[k].row];
      Q = (Q - Vector2(gyro.along, gyro.turn) * Q.row(1)).eval();
      Q(1, 0) = Q(0, 1);
    }
    spread[k] = A * Q;
    total += spread[k] * A.transpose();
  }
  total.diagonal().array() += kSlip;
  const Eigen::Vector3d pull = total.ldlt().solve(lacking);
  std::vector<Vector2> noise;
  noise.reserve(rows.size());
  for (const Influence& one : spread) noise.emplace_back(one.transpose() * pull);
  return noise;
}

/// A row's end, or that of its part, and what the noise did in it.
struct FittedRow {
  std::size_t row = 0;
  Pose end;
  Vector2 missing = Vector2::Zero();
};

/// The rows that lie between two nodes.
std::vector<FittedRow> rows_between(const MotionRows& drive, const Robot& robot,
                                    const Reckoner& reckoner, const estimation::PoseNode& from,
                                    const Pose& at_from, const estimation::PoseNode& to,
                                    const Pose& at_to) {
  constexpr int kRounds = 3;  // the noise bends the path on which it acts
  std::vector<estimation::SegmentRow> rows = estimation::segment_rows(drive, from.t, to.t);
  const Pose wanted = relative(at_from, at_to);
  std::vector<Vector2> missing(rows.size(), Vector2::Zero());
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<estimation::SegmentRow> moved = reckoner.moved(rows);
    const Pose reached = estimation::segment_motion(moved).displacement;
    const Eigen::Vector3d lacking(wanted.x - reached.x, wanted.y - reached.y,
                                  wrap_angle(wanted.heading - reached.heading));
    const std::vector<Vector2> noise =
        estimated_noise(rows, drive, robot, estimation::row_influences(moved), lacking);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const Vector2 own = rows[k].part * noise[k];
      rows[k].path += own[0];
      rows[k].turn += own[1];
      missing[k] += own;
    }
  }
  Pose pose = at_from;
  std::vector<Pose> reached;
  for (const estimation::SegmentRow& row : rows) {
    pose = compose(pose, reckoner.motion(row));
    reached.push_back(pose);
  }
  // What a wheel cannot have done (a slip sideways while standing) is spread evenly.
  const Vector2 left = at_to.position() - pose.position();
  const double left_turn = wrap_angle(at_to.heading - pose.heading);
  std::vector<FittedRow> result;
  result.reserve(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double share = static_cast<double>(k + 1) / static_cast<double>(rows.size());
    Pose end = reached[k];
    end.x += share * left.x();
    end.y += share * left.y();
    end.heading += share * left_turn;
    result.push_back({rows[k].row, end, missing[k]});
  }
  return result;
}

/// Per row; empty without a gyro.
std::vector<double> excesses(const MotionRows& drive,
                             const std::vector<effects::DrivePattern>& effects) {
  std::vector<double> result;
  result.reserve(drive.gyro.size());
  for (const GyroShare& one : drive.gyro) result.push_back(one.excess);
  for (std::size_t row = 0; row < std::min(result.size(), effects.size()); ++row) {
    result[row] += effects[row].excess;
  }
  return result;
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

std::vector<SessionPath> fitted_paths(const std::vector<DrivenRecording>& recordings,
                                      const Robot& robot,
                                      const estimation::RecordingProblem& problem,
                                      const estimation::EffectParameters& border,
                                      const Eigen::VectorXd& offsets,
                                      const estimation::RecordingState& state) {
  std::vector<SessionPath> paths(recordings.size());
  std::vector<int> first(recordings.size(), -1);
  std::vector<int> last(recordings.size(), -1);
  for (std::size_t k = 0; k < problem.poses.size(); ++k) {
    const std::size_t session = idx(problem.poses[k].session);
    if (first[session] < 0) first[session] = static_cast<int>(k);
    last[session] = static_cast<int>(k);
  }
  for (std::size_t s = 0; s < recordings.size(); ++s) {
    const MotionRows& drive = recordings[s].drive;
    std::vector<effects::DrivePattern> effects = estimation::summed_patterns_of(border, offsets, s);
    SessionPath& path = paths[s];
    path.ends.resize(drive.rows());
    path.missing.assign(drive.rows(), Vector2::Zero());
    path.excess = excesses(drive, effects);
    const Reckoner reckoner(drive, std::move(effects));
    if (first[s] < 0) continue;
    const estimation::PoseNode& first_node = problem.poses[idx(first[s])];
    path.start = before(state.poses[idx(first[s])], reckoner.motion(drive.start(), first_node.t));
    Pose pose = path.start;
    for (const estimation::SegmentRow& row :
         estimation::segment_rows(drive, drive.start(), first_node.t)) {
      pose = compose(pose, reckoner.motion(row));
      path.ends[row.row] = pose;
    }
    std::vector<std::vector<FittedRow>> between(idx(last[s] - first[s]));
    parallel::parallel_for(between.size(), [&](std::size_t j) {
      const std::size_t k = idx(first[s]) + j;
      between[j] = rows_between(drive, robot, reckoner, problem.poses[k], state.poses[k],
                                problem.poses[k + 1], state.poses[k + 1]);
    });
    for (const std::vector<FittedRow>& rows : between) {
      for (const FittedRow& one : rows) {
        path.ends[one.row] = one.end;
        path.missing[one.row] += one.missing;
      }
    }
    pose = state.poses[idx(last[s])];
    for (const estimation::SegmentRow& row :
         estimation::segment_rows(drive, problem.poses[idx(last[s])].t, drive.t.back())) {
      pose = compose(pose, reckoner.motion(row));
      path.ends[row.row] = pose;
    }
  }
  return paths;
}

Pose pose_at(const MotionRows& drive, const SessionPath& path, double t) {
  const std::size_t row = drive::row_at(drive, t);
  const Pose& from = row == 0 ? path.start : path.ends[row - 1];
  const Pose& to = path.ends[row];
  const double begin = row == 0 ? drive.start() : drive.t[row - 1];
  const double share = std::clamp((t - begin) / (drive.t[row] - begin), 0.0, 1.0);
  const double turn = wrap_angle(to.heading - from.heading);
  return {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y),
          from.heading + share * turn};
}

}  // namespace trussmap::fitting
