// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "validation/held_out.hpp"

#include "estimation/measurement_rows.hpp"
#include "estimation/recording_descent.hpp"
#include "recording/legs.hpp"
#include "validation/held_out_filter.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <Eigen/LU>

namespace trussmap {
namespace {

constexpr std::size_t kBlock = 5;
constexpr double kLeastChord = 0.1;  // m
constexpr double kForever = 1e300;   // s

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
                          one.kind == MeasurementKind::cartesian_view;
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
  const EffectParameters no_effects;
  RecordingSystem system(problem, no_effects);
  system.linearise(state, Eigen::VectorXd());
  const std::vector<int> loose = find_loose_nodes(system);
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
void leave_unconnected_segments_out(const std::vector<Recording>& recordings, const ModelFit& fit,
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
  if (one.kind == MeasurementKind::cartesian_view) {
    return sensor + rotation(pose.heading + view.heading) * one.value.head<2>();
  }
  return sensor;
}

/// All measurements at a node, and the segment that leaves it.
struct NodeEvents {
  std::vector<std::size_t> views;
  int segment = -1;
};

std::vector<NodeEvents> events_of(const RecordingProblem& problem) {
  std::vector<NodeEvents> events(problem.poses.size());
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    if (one.kind == MeasurementKind::survey) continue;
    NodeEvents& here = events[idx(one.from - problem.landmark_count())];
    if (one.kind == MeasurementKind::segment) {
      here.segment = static_cast<int>(k);
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

HeldOutLegs::End HeldOutLegs::end_of(const RecordingProblem& problem, std::size_t measurement,
                                     const Pose& pose, const ViewPattern& view,
                                     const Eigen::Matrix<double, 4, 3>& by_pose,
                                     const Eigen::Matrix<double, 4, 3>& by_landmark) {
  const Measurement& one = problem.measurements[measurement];
  // From errors, "expected - measured", to "seen - true" in the map.
  Eigen::Matrix<double, 2, 4> T = Eigen::Matrix<double, 2, 4>::Zero();
  const Matrix2 R = rotation(pose.heading + view.heading);
  if (one.kind == MeasurementKind::truth) {
    T.leftCols<2>().setIdentity();
  } else if (one.kind == MeasurementKind::view) {
    const double range = (one.value[0] - view.range) / (1.0 + view.range_scale);
    const Matrix2 along = R * rotation(one.value[1] - view.bearing);
    T.col(0) = -along.col(0) / (1.0 + view.range_scale);
    T.col(1) = -range * along.col(1);
  } else {
    T.leftCols<2>() = -(one.kind == MeasurementKind::standing ? rotation(pose.heading) : R);
  }
  Matrix4 W = one.whitener;
  for (int row = one.rows; row < 4; ++row) W(row, row) = 1.0;
  End end;
  end.measurement = measurement;
  end.landmark = one.to;
  end.by_rows = T * W.inverse();
  end.by_pose = T * by_pose;
  end.by_landmark = (T * by_landmark).leftCols<2>();
  return end;
}

HeldOutLegs::HeldOutLegs(const std::vector<Recording>& recordings, const ModelFit& fit,
                         const ModelFitOptions& options, const LegOptions& leg_options) {
  const std::vector<LegSpan> legs = leg_spans(fit.recordings, fit.problem, leg_options);
  if (std::none_of(legs.begin(), legs.end(), [](const LegSpan& leg) { return leg.held_out; })) {
    return;
  }
  ModelFitOptions how = options;
  how.fit_effects = true;
  how.near = &fit;
  how.still = 1e-5;  // errors of legs are not read so finely
  how.problem.left_out = spans_of(legs, recordings.size());
  leave_unconnected_segments_out(fit.recordings, fit, how.problem);
  undo_delays(recordings, fit.model, how.problem.left_out);
  const ModelFit training = fit_model(recordings, fit.model, how);

  // All measurements of all legs again, by the training's model and map.
  ProblemOptions all = options.problem;
  all.left_out.clear();
  problem_ = make_problem(training.recordings, training.model, all);
  const RecordingProblem& problem = problem_;
  int rows = 0;
  for (const Measurement& one : problem.measurements) {
    first_row_.push_back(rows);
    rows += one.rows;
  }
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
  HeldOutFilter filter(problem, columns.border, offsets, state, map.covariances);
  for (std::size_t pose = 0; pose < problem.poses.size(); ++pose) {
    const int node = problem.pose_node(static_cast<int>(pose));
    const bool first = pose == 0 || problem.poses[pose].session != problem.poses[pose - 1].session;
    if (first) {
      filter.start(node, state.poses[pose]);
      FilterStep fresh;
      fresh.A.setZero();
      steps_.push_back(fresh);
    }
    for (const std::size_t k : events[pose].views) steps_.push_back(filter.see(k));
    for (const std::size_t k : starting[node]) {
      const Measurement& from = problem.measurements[again[k].from];
      const Measurement& to = problem.measurements[again[k].to];
      const bool landmark = to.to >= 0;
      if (landmark && std::isnan(state.landmarks[idx(to.to)].x())) continue;
      HeldOutFilter ahead = filter;
      Leg leg;
      leg.after = steps_.size();
      for (int at = node; at != to.from;) {
        const int segment = events[idx(at - problem.landmark_count())].segment;
        if (segment < 0) break;
        leg.ahead.push_back(ahead.drive(idx(segment)));
        at = problem.measurements[idx(segment)].to;
      }
      const ViewPattern view_from = view_of(columns.border, offsets, from);
      const ViewPattern view_to = view_of(columns.border, offsets, to);
      const auto begin = seen_from(filter.pose(node), from, view_from);
      const auto end = seen_from(ahead.pose(to.from), to, view_to);
      if (!begin || !end) continue;
      const Vector2 target = landmark ? state.landmarks[idx(to.to)] : Vector2(to.value.head<2>());
      const bool known_start = from.to < 0 || !std::isnan(state.landmarks[idx(from.to)].x());
      const Vector2 origin =
          from.to < 0 ? Vector2(from.value.head<2>()) : state.landmarks[idx(from.to)];
      leg.told.leg = k;
      leg.told.from = landmark_of(problem, from);
      leg.told.to = landmark_of(problem, to);
      leg.told.t = again[k].time.to;
      leg.told.arrival_error = *end - target;
      leg.chord = target - origin;
      leg.predicted = *end - *begin;
      leg.told.has_chord = known_start && leg.chord.norm() >= kLeastChord;
      const MeasurementRows rows_from = filter.rows(again[k].from);
      const MeasurementRows rows_to = ahead.rows(again[k].to);
      leg.from = end_of(problem, again[k].from, filter.pose(node), view_from, rows_from.by_from,
                        rows_from.by_to);
      leg.to = end_of(problem, again[k].to, ahead.pose(to.from), view_to, rows_to.by_from,
                      rows_to.by_to);
      legs_.push_back(std::move(leg));
    }
    if (events[pose].segment >= 0) steps_.push_back(filter.drive(idx(events[pose].segment)));
  }
}

Eigen::MatrixXd HeldOutLegs::slopes(const Eigen::MatrixXd& columns,
                                    const Eigen::MatrixXd& landmarks) const {
  const Eigen::Index count = columns.cols();
  const auto rows_of = [&](std::size_t measurement) {
    return columns.middleRows(first_row_[measurement], problem_.measurements[measurement].rows);
  };
  const auto advance = [&](const FilterStep& step, Eigen::MatrixXd& s) {
    s = (step.A * s).eval();
    if (step.measurement < 0) return;
    const auto c = rows_of(static_cast<std::size_t>(step.measurement));
    s += step.B.leftCols(c.rows()) * c;
    if (step.landmark >= 0) s += step.L * landmarks.middleRows(2 * step.landmark, 2);
  };
  const auto seen = [&](const End& end, const Eigen::MatrixXd& s) -> Eigen::MatrixXd {
    const auto c = rows_of(end.measurement);
    Eigen::MatrixXd result = end.by_pose * s + end.by_rows.leftCols(c.rows()) * c;
    if (end.landmark >= 0) result += end.by_landmark * landmarks.middleRows(2 * end.landmark, 2);
    return result;
  };
  const auto target = [&](const End& end) -> Eigen::MatrixXd {
    if (end.landmark < 0) return Eigen::MatrixXd::Zero(2, count);
    return landmarks.middleRows(2 * end.landmark, 2);
  };
  Eigen::MatrixXd result(6 * static_cast<Eigen::Index>(legs_.size()), count);
  Eigen::MatrixXd s = Eigen::MatrixXd::Zero(3, count);
  std::size_t done = 0;
  for (std::size_t k = 0; k < legs_.size(); ++k) {
    const Leg& leg = legs_[k];
    for (; done < leg.after; ++done) advance(steps_[done], s);
    Eigen::MatrixXd ahead = s;
    for (const FilterStep& step : leg.ahead) advance(step, ahead);
    const auto row = 6 * static_cast<Eigen::Index>(k);
    const Eigen::MatrixXd arrival = seen(leg.to, ahead);
    const Eigen::MatrixXd chord = target(leg.to) - target(leg.from);
    result.middleRows(row, 2) = arrival;
    result.middleRows(row + 2, 2) = arrival - seen(leg.from, s) + chord;
    result.middleRows(row + 4, 2) = chord;
  }
  return result;
}

HeldOut HeldOutLegs::moved(const Eigen::VectorXd& change) const {
  HeldOut result;
  double squares = 0.0;
  int chords = 0;
  for (std::size_t k = 0; k < legs_.size(); ++k) {
    const Leg& leg = legs_[k];
    LegPrediction one = leg.told;
    Vector2 predicted = leg.predicted;
    Vector2 chord = leg.chord;
    if (change.size() > 0) {
      const auto row = 6 * static_cast<Eigen::Index>(k);
      one.arrival_error += change.segment<2>(row);
      predicted += change.segment<2>(row + 2);
      chord += change.segment<2>(row + 4);
    }
    if (one.has_chord) {
      one.stretch_error = std::abs(predicted.norm() - chord.norm()) / chord.norm();
      one.orientation_error = std::abs(wrap_angle(direction(predicted) - direction(chord)));
      result.stretch_error += one.stretch_error;
      result.orientation_error += one.orientation_error;
      ++chords;
    }
    squares += one.arrival_error.squaredNorm();
    result.legs.push_back(std::move(one));
  }
  if (result.legs.empty()) return result;
  result.arrival_rms = std::sqrt(squares / static_cast<double>(result.legs.size()));
  result.stretch_error /= std::max(1, chords);
  result.orientation_error /= std::max(1, chords);
  return result;
}

bool HeldOutLegs::same_layout(const RecordingProblem& problem) const {
  const auto& ours = problem_.measurements;
  const auto& theirs = problem.measurements;
  return problem_.landmarks == problem.landmarks &&
         std::equal(ours.begin(), ours.end(), theirs.begin(), theirs.end(),
                    [](const Measurement& a, const Measurement& b) {
                      return a.kind == b.kind && a.from == b.from && a.to == b.to &&
                             a.rows == b.rows;
                    });
}

HeldOut predict_held_out(const std::vector<Recording>& recordings, const ModelFit& fit,
                         const ModelFitOptions& options, const LegOptions& legs) {
  return HeldOutLegs(recordings, fit, options, legs).metrics();
}

}  // namespace trussmap
