// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/row_variables.hpp"
#include "fit/cleared_recording.hpp"
#include "fit/fit_state.hpp"
#include "geometry/index.hpp"
#include "odometry/row_reckoner.hpp"
#include "trussmap/arc.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace trussmap {
using namespace fitting;

namespace {

/// The covariance of positions turned into axes that are turned by so much.
Matrix3 turned(const Matrix3& covariance, double angle) {
  Matrix3 R = Matrix3::Identity();
  R.topLeftCorner<2, 2>() = rotation(angle);
  return R * covariance * R.transpose();
}

/// The wheels' motion in a row, or the part of it between two times, with the model's noise.
Motion row_motion(const MotionRows& drive, std::size_t row, double from, double to,
                  const Model& model) {
  const double begin = row == 0 ? drive.start() : drive.t[row - 1];
  const double part = (to - from) / (drive.t[row] - begin);
  return {odometry::displacement_of(part * drive.motion(row)),
          odometry::row_covariance(drive, row, part, to - from, model.robot, model.noise)};
}

/// A session of a fit: what is known at its nodes, and between them.
class AdjustedSession {
 public:
  AdjustedSession(const ModelFit& fit, std::size_t session)
      : fit_(*fit.state),
        drive_(fit_.recordings[session].drive),
        path_(fit_.paths[session]),
        wheels_(cleared(fit_)[session].recording.drive) {
    const std::vector<Matrix3> covariances =
        estimation::pose_covariances(fit_.problem, fit_.columns.border, fit_.adjustment);
    for (std::size_t k = 0; k < fit_.problem.poses.size(); ++k) {
      const estimation::PoseNode& node = fit_.problem.poses[k];
      if (idx(node.session) != session) continue;
      nodes_.push_back({node.t, {fit_.adjustment.state.poses[k], covariances[k]}});
    }
  }

  std::vector<TimedPose> run() {
    if (nodes_.empty()) throw SolveError("nothing was measured in this session");
    result_.push_back({drive_.start(), {path_.start, Matrix3::Zero()}});
    for (std::size_t row = 0; row < drive_.rows(); ++row) {
      result_.push_back({drive_.t[row], {path_.ends[row], Matrix3::Zero()}});
    }
    std::size_t first = 0;  // of the results, not before the first node
    while (result_[first].t < nodes_.front().t) ++first;
    reckon_back(first);
    std::size_t at = first;
    for (std::size_t k = 0; k + 1 < nodes_.size(); ++k) at = bridge(nodes_[k], nodes_[k + 1], at);
    reckon_on(at);
    return std::move(result_);
  }

 private:
  [[nodiscard]] Motion driven(double from, double to) const {
    Motion motion;
    for (std::size_t row = drive::row_at(wheels_, from); row < wheels_.rows(); ++row) {
      const double begin = std::max(from, row == 0 ? wheels_.start() : wheels_.t[row - 1]);
      const double end = std::min(to, wheels_.t[row]);
      if (end > begin) motion = then(motion, row_motion(wheels_, row, begin, end, fit_.model));
      if (wheels_.t[row] >= to) break;
    }
    return motion;
  }

  /// Results before the first node: from the node back along what was driven in between.
  void reckon_back(std::size_t first) {
    const TimedPose& node = nodes_.front();
    Motion way;
    double until = node.t;
    for (std::size_t k = first; k-- > 0;) {
      way = then(driven(result_[k].t, until), way);
      until = result_[k].t;
      const Matrix2 R = rotation(result_[k].estimate.pose.heading);
      const Vector2 swing = quarter_turn(R * way.displacement.position());
      Matrix3 by_node = Matrix3::Identity();
      by_node.block<2, 1>(0, 2) = -swing;
      Matrix3 by_way = Matrix3::Zero();
      by_way.topLeftCorner<2, 2>() = -R;
      by_way.block<2, 1>(0, 2) = swing;
      by_way(2, 2) = -1.0;
      result_[k].estimate.covariance = by_node * node.estimate.covariance * by_node.transpose() +
                                       by_way * way.covariance * by_way.transpose();
    }
  }

  /// Results from `at` up to the second node; what both leave open is least known half way.
  std::size_t bridge(const TimedPose& from, const TimedPose& to, std::size_t at) {
    if (at == result_.size() || result_[at].t > to.t) return at;
    const Matrix3 way = turned(driven(from.t, to.t).covariance, from.estimate.pose.heading);
    for (; at < result_.size() && result_[at].t <= to.t; ++at) {
      const double share = (result_[at].t - from.t) / (to.t - from.t);
      result_[at].estimate.covariance = (1.0 - share) * from.estimate.covariance +
                                        share * to.estimate.covariance +
                                        share * (1.0 - share) * way;
    }
    return at;
  }

  /// Results after the last node.
  void reckon_on(std::size_t at) {
    Motion known{nodes_.back().estimate.pose, nodes_.back().estimate.covariance};
    double since = nodes_.back().t;
    for (; at < result_.size(); ++at) {
      known = then(known, driven(since, result_[at].t));
      since = result_[at].t;
      result_[at].estimate.covariance = known.covariance;
    }
  }

  const FitState& fit_;
  const MotionRows& drive_;
  const SessionPath& path_;
  MotionRows wheels_;  ///< freed from the effects
  std::vector<TimedPose> nodes_;
  std::vector<TimedPose> result_;
};

}  // namespace

std::vector<TimedPose> dead_reckoned_poses(const DrivenRecording& recording, const Model& model) {
  const ClearedRecording clear = std::move(cleared({recording}, model).front());
  const MotionRows& drive = clear.recording.drive;
  const InitialHeading first = initial_heading(drive, drive.start(), model.robot, model.noise);
  std::vector<TimedPose> result;
  result.reserve(drive.rows() + 1);
  PoseEstimate start;
  start.covariance(2, 2) = first.heading.variance;
  result.push_back({drive.start(), start});
  const double heading = first.heading.heading;
  const std::vector<PoseEstimate> ends =
      dead_reckoned_estimates(drive, model.robot, model.noise, clear.slip);
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const Vector2 place = rotation(-heading) * ends[row].pose.position();
    result.push_back({drive.t[row],
                      {{place.x(), place.y(), ends[row].pose.heading - heading},
                       turned(ends[row].covariance, -heading)}});
  }
  return result;
}

std::vector<TimedPose> adjusted_poses(const ModelFit& fit, std::size_t session) {
  if (session >= fit.state->recordings.size()) {
    throw std::invalid_argument("the fit has no session of this number");
  }
  if (fit.state->paths.empty()) throw std::invalid_argument("the fit has laid no paths");
  return AdjustedSession(fit, session).run();
}

}  // namespace trussmap
