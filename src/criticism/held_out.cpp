// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/criticism/held_out.hpp"

#include "trussmap/adjustment/measurement_rows.hpp"
#include "trussmap/adjustment/recording_descent.hpp"
#include "trussmap/recording/legs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <Eigen/LU>

namespace trussmap {
namespace {

constexpr std::size_t kBlock = 5;
constexpr double kLeastChord = 0.1;      // m
constexpr double kFirstPlaceSd = 1.0;    // m: what the filter is told of its first pose
constexpr double kForever = 1e300;       // s
constexpr double kFirstHeadingSd = 0.3;  // rad

bool is_held_out(std::size_t leg, double share) {
  const auto block = static_cast<double>(leg / kBlock);
  return std::floor((block + 1.0) * share + 1e-9) > std::floor(block * share + 1e-9);
}

double pose_time(const RecordingProblem& problem, int node) {
  return problem.poses[idx(node - problem.landmark_count())].t;
}

void add_sighted_legs(const Recording& recording, int session, const RecordingProblem& problem,
                      const LegOptions& options, std::vector<LegSpan>& legs) {
  std::map<std::size_t, std::size_t> measurement_of;  // sighting -> measurement
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    const bool sighting = one.kind == MeasurementKind::standing ||
                          one.kind == MeasurementKind::view ||
                          one.kind == MeasurementKind::near_view;
    if (sighting && one.session == session) measurement_of[one.source] = k;
  }
  const std::vector<Stop> stops = stops_of(recording.sightings);
  for (const Leg& leg : legs_of(recording, stops, options.min_drive)) {
    const Stop& from = stops[leg.from];
    const Stop& to = stops[leg.to];
    legs.push_back({session,
                    {from.t, to.t},
                    measurement_of.at(from.reference),
                    measurement_of.at(to.reference),
                    false});
  }
}

void add_truth_legs(const Recording& recording, int session, const RecordingProblem& problem,
                    const LegOptions& options, std::vector<LegSpan>& legs) {
  const std::vector<double> path = driven_path(recording.drive);
  bool any = false;
  LegSpan leg;
  double begun = 0.0;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    if (one.kind != MeasurementKind::truth || one.session != session) continue;
    const double t = pose_time(problem, one.from);
    const double driven = path_at(recording.drive, path, t);
    if (any && driven - begun < options.leg) continue;
    if (any) {
      leg.to = k;
      leg.time.to = t;
      legs.push_back(leg);
    }
    leg = {session, {t, t}, k, k, false};
    begun = driven;
    any = true;
  }
}

/// Held-out legs as spans of time, neighbours joined.
std::vector<std::vector<TimeSpan>> spans_of(const std::vector<LegSpan>& legs,
                                            std::size_t sessions) {
  std::vector<std::vector<TimeSpan>> spans(sessions);
  for (const LegSpan& leg : legs) {
    if (!leg.held_out) continue;
    std::vector<TimeSpan>& here = spans[idx(leg.session)];
    if (!here.empty() && here.back().to >= leg.time.from) {
      here.back().to = leg.time.to;
    } else {
      here.push_back(leg.time);
    }
  }
  return spans;
}

/// Poses that nothing ties to the map, or else of which something can move freely.
std::set<int> loose_poses(const std::vector<Recording>& recordings, const ModelFit& fit,
                          const RecordingProblem& problem) {
  const std::vector<int> untied = untied_poses(problem);
  if (!untied.empty()) return {untied.begin(), untied.end()};
  const std::map<std::string, Vector2> places = landmark_places(fit);
  RecordingState state;
  for (const std::string& name : problem.landmarks) state.landmarks.push_back(places.at(name));
  for (const PoseNode& node : problem.poses) {
    const std::size_t session = idx(node.session);
    state.poses.push_back(pose_at(recordings[session].drive, fit.paths[session], node.t));
  }
  RecordingSystem system(problem, {});
  system.linearise(state, Eigen::VectorXd());
  const std::vector<int> loose = find_loose_nodes(system, problem);
  const std::set<int> nodes(loose.begin(), loose.end());
  std::set<int> poses;
  for (const Measurement& one : problem.measurements) {
    if (one.session < 0) continue;
    if (nodes.contains(one.from) || nodes.contains(one.to)) {
      poses.insert(one.from - problem.landmark_count());
    }
  }
  return poses;
}

/// Whole stretches between spans in which something is loose are left out too.
void leave_loose_stretches_out(const std::vector<Recording>& recordings, const ModelFit& fit,
                               ProblemOptions& options) {
  for (int round = 0; round < 20; ++round) {
    const RecordingProblem problem = make_problem(recordings, fit.model, options);
    const std::set<int> poses = loose_poses(recordings, fit, problem);
    if (poses.empty()) return;
    for (const int k : poses) {
      const PoseNode& pose = problem.poses[idx(k)];
      std::vector<TimeSpan>& spans = options.left_out[idx(pose.session)];
      const bool gone = std::any_of(spans.begin(), spans.end(), [&](const TimeSpan& span) {
        return span.from < pose.t && pose.t < span.to;
      });
      if (gone) continue;  // with another pose of its stretch
      // From the beginning of the span before it to the end of the span after it.
      TimeSpan stretch{-kForever, kForever};
      for (const TimeSpan& span : spans) {
        if (span.to <= pose.t) stretch.from = std::max(stretch.from, span.from);
        if (span.from >= pose.t) stretch.to = std::min(stretch.to, span.to);
      }
      std::erase_if(spans, [&](const TimeSpan& span) {
        return span.from >= stretch.from && span.to <= stretch.to;
      });
      spans.push_back(stretch);
      std::sort(spans.begin(), spans.end(),
                [](const TimeSpan& a, const TimeSpan& b) { return a.from < b.from; });
    }
  }
}

/// Times of the fit's sightings and truth rows back to those recorded, before delays were taken
/// out.
void undo_delays(const std::vector<Recording>& recordings, const Model& model,
                 std::vector<std::vector<TimeSpan>>& spans) {
  for (std::size_t s = 0; s < spans.size(); ++s) {
    std::vector<double> recorded;
    for (const Sighting& sighting : recordings[s].sightings) recorded.push_back(sighting.t);
    for (const TruthRow& row : recordings[s].truth) recorded.push_back(row.t);
    const std::vector<double> moved =
        retimed(recorded, recordings[s], s, recordings.size(), model.effects, model.robot);
    std::map<double, double> back;
    for (std::size_t k = 0; k < moved.size(); ++k) back[moved[k]] = recorded[k];
    // The nearest: the fit's coefficients have moved a little since it took its delays out.
    const auto recorded_at = [&back](double t) {
      auto after = back.lower_bound(t);
      if (after == back.begin()) return after->second;
      const auto before = std::prev(after);
      return after == back.end() || t - before->first < after->first - t ? before->second
                                                                         : after->second;
    };
    for (TimeSpan& span : spans[s]) {
      if (span.from > -kForever) span.from = recorded_at(span.from);
      if (span.to < kForever) span.to = recorded_at(span.to);
    }
  }
}

/// Follows the robot through one session, with the map as known.
class Filter {
 public:
  Filter(const RecordingProblem& problem, const EffectBorder& border,
         const Eigen::VectorXd& offsets, const RecordingState& map,
         const std::vector<Matrix2>& map_covariances)
      : problem_(problem),
        border_(border),
        offsets_(offsets),
        state_(map),
        covariances_(map_covariances) {}

  void start(int node, const Pose& pose) {
    at(node) = pose;
    P_ = Eigen::Vector3d(kFirstPlaceSd * kFirstPlaceSd, kFirstPlaceSd * kFirstPlaceSd,
                         kFirstHeadingSd * kFirstHeadingSd)
             .asDiagonal();
  }

  [[nodiscard]] const Pose& pose(int node) const {
    return state_.poses[idx(node - problem_.landmark_count())];
  }

  /// Along a piece: its compass innovation first, which shares noise with its motion.
  void drive(const Measurement& piece) {
    std::vector<const std::vector<DrivePattern>*> patterns;
    for (const EffectPattern& effect : border_) {
      patterns.push_back(effect.drives.empty() ? nullptr : &effect.drives[idx(piece.session)]);
    }
    const PieceMotion motion =
        piece_motion(problem_.pieces[piece.source], patterns, offsets_).motion;
    Matrix4 W = piece.whitener;
    Matrix4 C = Matrix4::Zero();
    for (int k = piece.rows; k < 4; ++k) W(k, k) = 1.0;
    const Matrix4 inverse = W.inverse();
    C = inverse * inverse.transpose();
    Eigen::Matrix<double, 6, 6> joint = Eigen::Matrix<double, 6, 6>::Zero();  // pose, (d, a)
    joint.topLeftCorner<3, 3>() = P_;
    joint.bottomRightCorner<3, 3>() = C.topLeftCorner<3, 3>();
    Eigen::Matrix<double, 6, 1> mean = Eigen::Matrix<double, 6, 1>::Zero();
    if (piece.rows == 4) {
      // m - heading = its own noise, which goes with the motion's.
      Eigen::Matrix<double, 6, 1> with = joint.col(2);
      with.tail<3>() -= C.topRightCorner<3, 1>();
      const double variance = P_(2, 2) + C(3, 3);
      const double innovation = wrap_angle(motion.mean_heading - pose(piece.from).heading);
      // The motion's noise is that of "measured - true" here, the innovation's likewise.
      mean = with * (innovation / variance);
      joint -= with * with.transpose() / variance;
    }
    Pose from = pose(piece.from);
    from.x += mean[0];
    from.y += mean[1];
    from.heading += mean[2];
    Pose step = motion.displacement;
    step.x += mean[3];
    step.y += mean[4];
    step.heading += mean[5];
    at(piece.to) = compose(from, step);
    Eigen::Matrix<double, 3, 6> F = Eigen::Matrix<double, 3, 6>::Zero();
    F.leftCols<3>().setIdentity();
    F.block<2, 1>(0, 2) = quarter_turn(rotation(from.heading) * step.position());
    F.block<2, 2>(0, 3) = rotation(from.heading);
    F(2, 5) = 1.0;
    P_ = F * joint * F.transpose();
    P_ = (0.5 * (P_ + P_.transpose())).eval();
  }

  /// A sighting of a known landmark, or a truth row.
  void see(const Measurement& one) {
    if (one.to >= 0 && std::isnan(state_.landmarks[idx(one.to)].x())) return;
    const MeasurementRows rows =
        measurement_rows(problem_, one, state_, one.value, view_of(border_, offsets_, one));
    const Eigen::MatrixXd W = one.whitener.topLeftCorner(one.rows, one.rows);
    const Eigen::MatrixXd H = W * rows.by_from.topRows(one.rows);
    const Eigen::VectorXd error = W * rows.error.head(one.rows);
    Eigen::MatrixXd S = H * P_ * H.transpose() + Eigen::MatrixXd::Identity(one.rows, one.rows);
    if (one.to >= 0) {
      const Eigen::MatrixXd L = W * rows.by_to.topLeftCorner(one.rows, 2);
      S += L * covariances_[idx(one.to)] * L.transpose();
    }
    const Eigen::MatrixXd gain = P_ * H.transpose() * S.inverse();
    const Eigen::Vector3d change = -gain * error;
    Pose& pose = at(one.from);
    pose.x += change[0];
    pose.y += change[1];
    pose.heading += change[2];
    P_ = (P_ - gain * H * P_).eval();
    P_ = (0.5 * (P_ + P_.transpose())).eval();
  }

  [[nodiscard]] const RecordingState& state() const { return state_; }
  [[nodiscard]] const Matrix3& covariance() const { return P_; }

 private:
  Pose& at(int node) { return state_.poses[idx(node - problem_.landmark_count())]; }

  const RecordingProblem& problem_;
  const EffectBorder& border_;
  const Eigen::VectorXd& offsets_;
  RecordingState state_;
  const std::vector<Matrix2>& covariances_;
  Matrix3 P_ = Matrix3::Zero();
};

/// Where a measurement says that what it measures lies, from a pose: the landmark, or the point
/// that truth tracks. Nothing where only a range was measured.
std::optional<Vector2> seen_from(const Pose& pose, const Measurement& one,
                                 const ViewPattern& view) {
  const Vector2 sensor = pose.position() + rotation(pose.heading) * Vector2(view.ahead, view.left);
  if (one.kind == MeasurementKind::view) {
    if (one.rows < 2) return std::nullopt;
    const double range = (one.value[0] - view.range) / (1.0 + view.range_scale);
    const double way = pose.heading + view.heading - view.bearing + one.value[1];
    return sensor + range * rotation(way).col(0);
  }
  if (one.kind == MeasurementKind::near_view) {
    return sensor + rotation(pose.heading + view.heading) * one.value.head<2>();
  }
  return sensor;
}

/// All measurements at a node, and the piece that leaves it.
struct NodeEvents {
  std::vector<std::size_t> views;
  int piece = -1;
};

std::vector<NodeEvents> events_of(const RecordingProblem& problem) {
  std::vector<NodeEvents> events(problem.poses.size());
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    if (one.kind == MeasurementKind::survey) continue;
    NodeEvents& here = events[idx(one.from - problem.landmark_count())];
    if (one.kind == MeasurementKind::piece) {
      here.piece = static_cast<int>(k);
    } else {
      here.views.push_back(k);
    }
  }
  return events;
}

/// Landmarks of the problem where the training has them, else where a survey does, else NaN.
struct KnownMap {
  std::vector<Vector2> places;
  std::vector<Matrix2> covariances;
};

KnownMap known_map(const RecordingProblem& problem, const ModelFit& training, bool survey,
                   const std::vector<Recording>& recordings) {
  std::map<std::string, std::pair<Vector2, Matrix2>> known;
  for (const Recording& recording : recordings) {
    for (const SurveyPoint& point : recording.survey) {
      if (!survey) break;
      const double sd = std::isnan(point.sd) ? training.model.noise.survey : point.sd;
      known[point.landmark] = {Vector2(point.x, point.y), sd * sd * Matrix2::Identity()};
    }
  }
  for (std::size_t k = 0; k < training.problem.landmarks.size(); ++k) {
    known[training.problem.landmarks[k]] = {training.adjustment.state.landmarks[k],
                                            training.adjustment.landmark_covariances[k]};
  }
  KnownMap map;
  for (const std::string& name : problem.landmarks) {
    const auto found = known.find(name);
    const bool is_known = found != known.end();
    map.places.push_back(is_known ? found->second.first : Vector2(kAbsent, kAbsent));
    map.covariances.push_back(is_known ? found->second.second : Matrix2::Zero());
  }
  return map;
}

std::string landmark_of(const RecordingProblem& problem, const Measurement& one) {
  return one.to < 0 ? std::string() : problem.landmarks[idx(one.to)];
}

}  // namespace

std::vector<LegSpan> leg_spans(const std::vector<Recording>& recordings,
                               const RecordingProblem& problem, const LegOptions& options) {
  std::vector<LegSpan> legs;
  for (std::size_t s = 0; s < recordings.size(); ++s) {
    const int session = static_cast<int>(s);
    if (recordings[s].sightings.empty()) {
      add_truth_legs(recordings[s], session, problem, options, legs);
    } else {
      add_sighted_legs(recordings[s], session, problem, options, legs);
    }
  }
  for (std::size_t k = 0; k < legs.size(); ++k) legs[k].held_out = is_held_out(k, options.share);
  return legs;
}

HeldOut predict_held_out(const std::vector<Recording>& recordings, const ModelFit& fit,
                         const ModelFitOptions& options, const LegOptions& leg_options) {
  HeldOut result;
  const std::vector<LegSpan> legs = leg_spans(fit.recordings, fit.problem, leg_options);
  if (std::none_of(legs.begin(), legs.end(), [](const LegSpan& leg) { return leg.held_out; })) {
    return result;
  }
  ModelFitOptions how = options;
  how.fit_effects = true;
  how.near = &fit;
  how.problem.left_out = spans_of(legs, recordings.size());
  leave_loose_stretches_out(fit.recordings, fit, how.problem);
  undo_delays(recordings, fit.model, how.problem.left_out);
  const ModelFit training = fit_model(recordings, fit.model, how);

  // All measurements of all legs again, by the training's model and map.
  ProblemOptions all = options.problem;
  all.left_out.clear();
  const RecordingProblem problem = make_problem(training.recordings, training.model, all);
  const ShapeContext context(training.recordings, training.model.robot, training.paths);
  const EffectColumns columns = effect_columns(training.model.effects, context);
  Eigen::VectorXd offsets = offsets_of(training);
  for (std::size_t k = 0; k < columns.border.size(); ++k) {
    offsets[static_cast<Eigen::Index>(k)] +=
        training.columns.border[k].reference - columns.border[k].reference;
  }
  const KnownMap map = known_map(problem, training, options.problem.survey, recordings);
  RecordingState state;
  state.landmarks = map.places;
  for (const PoseNode& node : problem.poses) {
    const std::size_t session = idx(node.session);
    state.poses.push_back(
        pose_at(training.recordings[session].drive, training.paths[session], node.t));
  }
  const std::vector<NodeEvents> events = events_of(problem);
  const std::vector<LegSpan> again = leg_spans(training.recordings, problem, leg_options);
  std::map<int, std::vector<std::size_t>> starting;  // node -> legs
  for (std::size_t k = 0; k < again.size(); ++k) {
    if (again[k].held_out) starting[problem.measurements[again[k].from].from].push_back(k);
  }
  double squares = 0.0;
  double stretch = 0.0;
  double orientation = 0.0;
  int chords = 0;
  Filter filter(problem, columns.border, offsets, state, map.covariances);
  for (std::size_t pose = 0; pose < problem.poses.size(); ++pose) {
    const int node = problem.pose_node(static_cast<int>(pose));
    const bool first = pose == 0 || problem.poses[pose].session != problem.poses[pose - 1].session;
    if (first) filter.start(node, state.poses[pose]);
    for (const std::size_t k : events[pose].views) filter.see(problem.measurements[k]);
    for (const std::size_t k : starting[node]) {
      const Measurement& from = problem.measurements[again[k].from];
      const Measurement& to = problem.measurements[again[k].to];
      const bool landmark = to.to >= 0;
      if (landmark && std::isnan(state.landmarks[idx(to.to)].x())) continue;
      Filter ahead = filter;
      for (int at = node; at != to.from;) {
        const int piece = events[idx(at - problem.landmark_count())].piece;
        if (piece < 0) break;
        ahead.drive(problem.measurements[idx(piece)]);
        at = problem.measurements[idx(piece)].to;
      }
      const auto begin = seen_from(filter.pose(node), from, view_of(columns.border, offsets, from));
      const auto end = seen_from(ahead.pose(to.from), to, view_of(columns.border, offsets, to));
      if (!begin || !end) continue;
      const Vector2 target = landmark ? state.landmarks[idx(to.to)] : Vector2(to.value.head<2>());
      LegPrediction one;
      one.leg = k;
      one.from = landmark_of(problem, from);
      one.to = landmark_of(problem, to);
      one.t = again[k].time.to;
      one.arrival_error = *end - target;
      const bool known_start = from.to < 0 || !std::isnan(state.landmarks[idx(from.to)].x());
      const Vector2 origin =
          from.to < 0 ? Vector2(from.value.head<2>()) : state.landmarks[idx(from.to)];
      const Vector2 chord = target - origin;
      const Vector2 predicted = *end - *begin;
      one.has_chord = known_start && chord.norm() >= kLeastChord;
      if (one.has_chord) {
        one.stretch_error = std::abs(predicted.norm() - chord.norm()) / chord.norm();
        one.orientation_error = std::abs(wrap_angle(direction(predicted) - direction(chord)));
        stretch += one.stretch_error;
        orientation += one.orientation_error;
        ++chords;
      }
      squares += one.arrival_error.squaredNorm();
      result.legs.push_back(one);
    }
    if (events[pose].piece >= 0) filter.drive(problem.measurements[idx(events[pose].piece)]);
  }
  if (result.legs.empty()) return result;
  result.arrival_rms = std::sqrt(squares / static_cast<double>(result.legs.size()));
  result.stretch_error = chords > 0 ? stretch / chords : 0.0;
  result.orientation_error = chords > 0 ? orientation / chords : 0.0;
  return result;
}

}  // namespace trussmap
