// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/recording_start.hpp"

#include "estimation/recording_descent.hpp"
#include "estimation/recording_robust.hpp"
#include "trussmap/alignment.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/LU>

namespace trussmap {
namespace {

using Landmarks = std::vector<std::optional<Vector2>>;

/// Measurements by the poses that they belong to.
struct ByPose {
  std::vector<int> segment_from;  ///< measurement that leads on from here, -1: none
  std::vector<std::vector<int>> others;
};

ByPose by_pose(const RecordingProblem& problem) {
  ByPose result;
  result.segment_from.assign(problem.poses.size(), -1);
  result.others.resize(problem.poses.size());
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    if (one.kind == MeasurementKind::survey) continue;
    const std::size_t pose = idx(one.from - problem.landmark_count());
    if (one.kind == MeasurementKind::segment) {
      result.segment_from[pose] = static_cast<int>(k);
    } else {
      result.others[pose].push_back(static_cast<int>(k));
    }
  }
  return result;
}

Eigen::MatrixXd covariance_of(const Measurement& one) {
  const Eigen::MatrixXd W = one.whitener.topLeftCorner(one.rows, one.rows);
  return (W.transpose() * W).inverse();
}

Vector2 offset_of(const Measurement& one) {
  switch (one.kind) {
    case MeasurementKind::view:
      return one.rows == 1 ? Vector2(one.value[0], 0.0)
                           : Vector2(one.value[0] * rotation(one.value[1]).col(0));
    case MeasurementKind::cartesian_view:
      return one.value.head<2>();
    default:
      return Vector2::Zero();
  }
}

/// A robot that is reckoned from pose to pose.
class Reckoner {
 public:
  Reckoner(const RecordingProblem& problem, const StartOptions& options, Landmarks& landmarks)
      : problem_(problem), options_(options), landmarks_(landmarks) {}

  void place(const Pose& pose, const Matrix3& covariance) {
    pose_ = pose;
    covariance_ = covariance;
  }
  [[nodiscard]] const Pose& pose() const { return pose_; }

  void read_compass(const Measurement& segment) {
    if (segment.rows < 4) return;
    Eigen::Matrix<double, 1, 3> H(0.0, 0.0, 1.0);
    Eigen::VectorXd innovation(1);
    innovation << wrap_angle(segment.value[3] - pose_.heading);
    update(H, innovation, covariance_of(segment).bottomRightCorner(1, 1));
  }

  void drive(const Measurement& segment) {
    const Matrix3 T = pose_rotation(pose_.heading);
    const Vector2 step = T.topLeftCorner<2, 2>() * segment.value.head<2>();
    Matrix3 F = Matrix3::Identity();
    F.topRightCorner<2, 1>() = quarter_turn(step);
    const Matrix3 own = covariance_of(segment).topLeftCorner(3, 3);
    covariance_ = symmetrised(F * covariance_ * F.transpose() + T * own * T.transpose());
    pose_ = {pose_.x + step.x(), pose_.y + step.y(), pose_.heading + segment.value[2]};
  }

  /// Corrects by truth and landmarks that have a place, if wanted; then places the others.
  void look(const std::vector<const Measurement*>& seen, bool correct) {
    for (const Measurement* one : seen) {
      if (one->kind == MeasurementKind::truth) meet_truth(*one);
    }
    if (correct) {
      for (const Measurement* one : seen) {
        if (is_sighting(one->kind) && landmarks_[idx(one->to)]) meet_landmark(*one);
      }
    }
    for (const Measurement* one : seen) {
      if (!is_sighting(one->kind)) continue;
      std::optional<Vector2>& landmark = landmarks_[idx(one->to)];
      if (!landmark) landmark = sighted(*one);
    }
  }

  [[nodiscard]] Vector2 sighted(const Measurement& one) const {
    return pose_.position() + rotation(pose_.heading) * offset_of(one);
  }

 private:
  void meet_truth(const Measurement& one) {
    Eigen::Vector3d innovation = one.value.head<3>();
    innovation -= Eigen::Vector3d(pose_.x, pose_.y, pose_.heading);
    innovation[2] = wrap_angle(innovation[2]);
    update(Matrix3::Identity(), innovation, covariance_of(one));
  }

  void meet_landmark(const Measurement& one) {
    RecordingState state;
    state.landmarks.assign(problem_.landmarks.size(), Vector2::Zero());
    Measurement here = one;
    here.from = problem_.landmark_count();
    state.landmarks[idx(one.to)] = *landmarks_[idx(one.to)];
    state.poses = {pose_};
    const MeasurementRows rows = measurement_rows(problem_, here, state, one.value, {});
    const Eigen::MatrixXd by_landmark = rows.by_to.topLeftCorner(one.rows, 2);
    const Eigen::MatrixXd R = covariance_of(one) + options_.map_sd * options_.map_sd * by_landmark *
                                                       by_landmark.transpose();
    update(rows.by_from.topRows(one.rows), -rows.error.head(one.rows), R);
  }

  void update(const Eigen::MatrixXd& H, const Eigen::VectorXd& innovation,
              const Eigen::MatrixXd& R) {
    const Eigen::MatrixXd S = H * covariance_ * H.transpose() + R;
    const Eigen::MatrixXd inverse = S.inverse();
    if (innovation.dot(inverse * innovation) > options_.gate) {
      doubt();
      return;
    }
    const Eigen::MatrixXd gain = covariance_ * H.transpose() * inverse;
    const Eigen::Vector3d change = gain * innovation;
    pose_.x += change[0];
    pose_.y += change[1];
    pose_.heading += change[2];
    covariance_ = symmetrised(covariance_ - gain * H * covariance_);
  }

  /// After several contradictions it is the robot that is lost, not the sightings that are wrong.
  void doubt() {
    constexpr double kDoubt = 0.05;  // m and rad
    covariance_.diagonal().array() += kDoubt * kDoubt;
  }

  const RecordingProblem& problem_;
  StartOptions options_;
  Landmarks& landmarks_;
  Pose pose_;
  Matrix3 covariance_ = Matrix3::Zero();
};

/// Poses of one problem part, laid down one after the other.
class Layer {
 public:
  Layer(const RecordingProblem& problem, const StartOptions& options)
      : problem_(problem),
        options_(options),
        links_(by_pose(problem)),
        landmarks_(problem.landmarks.size()),
        poses_(problem.poses.size()) {}

  /// Poses first ... last, from a pose that is known that well.
  void lay(int first, int last, const Pose& start, const Matrix3& covariance, bool correct) {
    Reckoner robot(problem_, options_, landmarks_);
    robot.place(start, covariance);
    for (int k = first; k <= last; ++k) {
      const int segment = links_.segment_from[idx(k)];
      if (segment >= 0) robot.read_compass(problem_.measurements[idx(segment)]);
      robot.look(seen_at(k), correct);
      poses_[idx(k)] = robot.pose();
      if (k < last) robot.drive(problem_.measurements[idx(segment)]);
    }
  }

  /// Poses before `first`, backwards, by the motions alone.
  void lay_backwards(int first) {
    for (int k = first - 1; k >= 0; --k) {
      const Measurement& segment = problem_.measurements[idx(links_.segment_from[idx(k)])];
      const Pose motion{segment.value[0], segment.value[1], segment.value[2]};
      poses_[idx(k)] = compose(poses_[idx(k + 1)], inverse(motion));
      for (const Measurement* one : seen_at(k)) {
        if (!is_sighting(one->kind) || landmarks_[idx(one->to)]) continue;
        const Pose& pose = poses_[idx(k)];
        landmarks_[idx(one->to)] = pose.position() + rotation(pose.heading) * offset_of(*one);
      }
    }
  }

  [[nodiscard]] std::vector<const Measurement*> seen_at(int pose) const {
    std::vector<const Measurement*> seen;
    for (const int k : links_.others[idx(pose)]) seen.push_back(&problem_.measurements[idx(k)]);
    return seen;
  }

  /// The compass at the first pose that has one, less the turn up to there.
  [[nodiscard]] Pose first_pose() const {
    Pose pose;
    double turned = 0.0;
    for (const int segment : links_.segment_from) {
      if (segment < 0) break;
      const Measurement& one = problem_.measurements[idx(segment)];
      if (one.rows == 4) {
        pose.heading = wrap_angle(one.value[3] - turned);
        break;
      }
      turned += one.value[2];
    }
    return pose;
  }

  [[nodiscard]] const Measurement* truth_at(int pose) const {
    for (const Measurement* one : seen_at(pose)) {
      if (one->kind == MeasurementKind::truth) return one;
    }
    return nullptr;
  }

  [[nodiscard]] int pose_count() const { return static_cast<int>(poses_.size()); }
  Landmarks& landmarks() { return landmarks_; }
  std::vector<Pose>& poses() { return poses_; }

 private:
  const RecordingProblem& problem_;
  StartOptions options_;
  ByPose links_;
  Landmarks landmarks_;
  std::vector<Pose> poses_;
};

bool has_compass(const RecordingProblem& problem) {
  return std::any_of(
      problem.measurements.begin(), problem.measurements.end(),
      [](const Measurement& one) { return one.kind == MeasurementKind::segment && one.rows == 4; });
}

/// Adjusts the poses laid down so far and the landmarks they see.
void adjust_stretch(const RecordingProblem& session, const StartOptions& options, int count,
                    Layer& layer) {
  const ProblemPart part = part_of(session, 0, count);
  RecordingState state;
  for (const int landmark : part.landmarks) {
    state.landmarks.push_back(*layer.landmarks()[idx(landmark)]);
  }
  state.poses.assign(layer.poses().begin(), layer.poses().begin() + count);
  const EffectParameters no_effects;
  RecordingSystem system(part.problem, no_effects);
  const Eigen::VectorXd none;
  constexpr DescentOptions kRough{30, 1e-4, kNegligibleDecrease};
  RecordingDescent fit;
  if (std::isfinite(options.gate)) {
    for (int round = 0; round < 4; ++round) {
      system.linearise(state, none);
      system.set_weights(soft_weights(part.problem, system.squared_errors(), options.gate));
      fit = descend(system, state, none, {5, 1e-4, kNegligibleDecrease});
      state = fit.state;
    }
  } else {
    fit = descend(system, state, none, kRough);
  }
  for (std::size_t k = 0; k < part.landmarks.size(); ++k) {
    layer.landmarks()[idx(part.landmarks[k])] = fit.state.landmarks[k];
  }
  std::copy(fit.state.poses.begin(), fit.state.poses.end(), layer.poses().begin());
}

/// One session in a frame of its own (with truth rows: theirs).
void lay_session(const RecordingProblem& session, const StartOptions& options, Layer& layer) {
  constexpr int kFirstStretch = 30;  // poses
  constexpr int kLeastStretch = 20;
  const int poses = layer.pose_count();
  for (int k = 0; k < poses; ++k) {
    if (const Measurement* truth = layer.truth_at(k)) {
      const Pose pose{truth->value[0], truth->value[1], truth->value[2]};
      layer.lay(k, poses - 1, pose, covariance_of(*truth), true);
      layer.lay_backwards(k);
      return;
    }
  }
  const Matrix3 unknown_heading =
      Eigen::Vector3d(0.0, 0.0, has_compass(session) ? 10.0 : 0.0).asDiagonal();
  if (has_compass(session)) {
    layer.lay(0, poses - 1, layer.first_pose(), unknown_heading, true);
    return;
  }
  const Matrix3 adjusted = Eigen::Vector3d(1e-2, 1e-2, 1e-3).asDiagonal();
  int laid = std::min(poses, kFirstStretch);
  layer.lay(0, laid - 1, Pose(), Matrix3::Zero(), true);
  while (laid < poses) {
    adjust_stretch(session, options, laid, layer);
    const int next = std::min(poses, laid + std::max(kLeastStretch, laid / 3));
    layer.lay(laid - 1, next - 1, layer.poses()[idx(laid - 1)], adjusted, true);
    laid = next;
  }
}

/// Lays a session over landmarks that have their place.
void lay_over(const Landmarks& known, bool turn, Layer& layer) {
  std::vector<Vector2> here;
  std::vector<Vector2> there;
  for (std::size_t k = 0; k < known.size(); ++k) {
    if (!known[k] || !layer.landmarks()[k]) continue;
    here.push_back(*layer.landmarks()[k]);
    there.push_back(*known[k]);
  }
  if (here.empty()) return;
  Alignment over;
  if (turn && here.size() >= 2) {
    over = align_rigidly(here, there);
  } else {
    for (std::size_t k = 0; k < here.size(); ++k) {
      over.translation += (there[k] - here[k]) / static_cast<double>(here.size());
    }
  }
  for (std::optional<Vector2>& landmark : layer.landmarks()) {
    if (landmark) landmark = over.apply(*landmark);
  }
  for (Pose& pose : layer.poses()) {
    const Vector2 position = over.apply(pose.position());
    pose = {position.x(), position.y(), pose.heading + over.angle};
  }
}

/// First and count of each session's poses.
std::vector<std::pair<int, int>> session_spans(const RecordingProblem& problem) {
  std::vector<std::pair<int, int>> spans(problem.sessions.size(), {0, 0});
  for (std::size_t k = 0; k < problem.poses.size(); ++k) {
    auto& [first, count] = spans[idx(problem.poses[k].session)];
    if (count++ == 0) first = static_cast<int>(k);
  }
  return spans;
}

/// part_of keeps no truth; a session's start needs it.
ProblemPart session_of(const RecordingProblem& problem, int first, int count) {
  ProblemPart part = part_of(problem, first, count);
  for (const Measurement& one : problem.measurements) {
    const int pose = one.from - problem.landmark_count() - first;
    if (one.kind != MeasurementKind::truth || pose < 0 || pose >= count) continue;
    part.problem.measurements.push_back(one);
    part.problem.measurements.back().from = part.problem.pose_node(pose);
  }
  return part;
}

Landmarks surveyed(const RecordingProblem& problem) {
  Landmarks known(problem.landmarks.size());
  for (const Measurement& one : problem.measurements) {
    if (one.kind == MeasurementKind::survey) known[idx(one.from)] = one.value.head<2>();
  }
  return known;
}

}  // namespace

ProblemPart part_of(const RecordingProblem& problem, int first, int count) {
  ProblemPart part;
  part.first_pose = first;
  std::vector<int> place(problem.landmarks.size(), -1);
  const int offset = problem.landmark_count() + first;
  const auto inside = [&](int node) { return node >= offset && node < offset + count; };
  std::vector<const Measurement*> kept;
  for (const Measurement& one : problem.measurements) {
    if (one.kind == MeasurementKind::survey || one.kind == MeasurementKind::truth) continue;
    if (!inside(one.from) || (one.kind == MeasurementKind::segment && !inside(one.to))) continue;
    kept.push_back(&one);
    if (one.kind == MeasurementKind::segment || place[idx(one.to)] >= 0) continue;
    place[idx(one.to)] = static_cast<int>(part.landmarks.size());
    part.landmarks.push_back(one.to);
    part.problem.landmarks.push_back(problem.landmarks[idx(one.to)]);
  }
  part.problem.sessions = problem.sessions;
  part.problem.poses.assign(problem.poses.begin() + first, problem.poses.begin() + first + count);
  for (const Measurement* one : kept) {
    Measurement moved = *one;
    moved.from = part.problem.pose_node(one->from - offset);
    if (one->kind == MeasurementKind::segment) {
      moved.to = part.problem.pose_node(one->to - offset);
      moved.source = part.problem.segments.size();
      part.problem.segments.push_back(problem.segments[one->source]);
    } else {
      moved.to = place[idx(one->to)];
    }
    part.problem.measurements.push_back(moved);
  }
  return part;
}

RecordingState start_of(const RecordingProblem& problem, const StartOptions& options) {
  Landmarks known = surveyed(problem);
  const bool frame_given = std::any_of(
      problem.measurements.begin(), problem.measurements.end(), [](const Measurement& one) {
        return one.kind == MeasurementKind::survey || one.kind == MeasurementKind::truth;
      });
  RecordingState state;
  state.poses.resize(problem.poses.size());
  for (const auto& [first, count] : session_spans(problem)) {
    if (count == 0) continue;
    const ProblemPart part = session_of(problem, first, count);
    Layer layer(part.problem, options);
    lay_session(part.problem, options, layer);
    Landmarks in_part;
    for (const int landmark : part.landmarks) in_part.push_back(known[idx(landmark)]);
    const bool in_truth_frame = part.problem.measurements.back().kind == MeasurementKind::truth;
    if (!in_truth_frame) lay_over(in_part, !has_compass(part.problem), layer);
    for (std::size_t k = 0; k < part.landmarks.size(); ++k) {
      std::optional<Vector2>& place = known[idx(part.landmarks[k])];
      if (!place) place = layer.landmarks()[k];
    }
    std::copy(layer.poses().begin(), layer.poses().end(), state.poses.begin() + first);
  }
  for (const std::optional<Vector2>& landmark : known) {
    state.landmarks.push_back(landmark.value_or(Vector2::Zero()));
  }
  if (!frame_given && !state.landmarks.empty()) {
    const Vector2 origin = state.landmarks.front();
    for (Vector2& landmark : state.landmarks) landmark -= origin;
    for (Pose& pose : state.poses) {
      pose.x -= origin.x();
      pose.y -= origin.y();
    }
  }
  return state;
}

RecordingState dead_reckoned(const RecordingProblem& problem) {
  RecordingState state;
  state.poses.resize(problem.poses.size());
  std::vector<Vector2> sums(problem.landmarks.size(), Vector2::Zero());
  std::vector<double> counts(problem.landmarks.size(), 0.0);
  for (const auto& [first, count] : session_spans(problem)) {
    if (count == 0) continue;
    const ProblemPart part = part_of(problem, first, count);
    Layer layer(part.problem, {});
    const Matrix3 start =
        Eigen::Vector3d(0.0, 0.0, has_compass(part.problem) ? 10.0 : 0.0).asDiagonal();
    layer.lay(0, count - 1, layer.first_pose(), start, false);
    for (int k = 0; k < count; ++k) {
      const Pose& pose = layer.poses()[idx(k)];
      state.poses[idx(first + k)] = pose;
      for (const Measurement* one : layer.seen_at(k)) {
        if (!is_sighting(one->kind)) continue;
        const std::size_t landmark = idx(part.landmarks[idx(one->to)]);
        sums[landmark] += pose.position() + rotation(pose.heading) * offset_of(*one);
        counts[landmark] += 1.0;
      }
    }
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    state.landmarks.emplace_back(sums[k] / std::max(counts[k], 1.0));
  }
  return state;
}

}  // namespace trussmap
