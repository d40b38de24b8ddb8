// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "validation/leg_predictor.hpp"

#include "estimation/measurement_rows.hpp"
#include "trussmap/gate.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <Eigen/LU>

namespace trussmap::validation {
namespace {

constexpr double kLeastChord = 0.1;  // m

/// Landmarks of a problem where the training has them, else where a survey does, else NaN.
struct KnownMap {
  std::vector<Vector2> places;
  std::vector<Matrix2> covariances;
};

KnownMap known_map(const estimation::RecordingProblem& problem, const fitting::FitState& training,
                   bool survey, const std::vector<DrivenRecording>& recordings) {
  std::map<std::string, std::pair<Vector2, Matrix2>> known;
  for (const DrivenRecording& recording : recordings) {
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

/// Orientations of a problem where the training has them, else where a survey does, else NaN.
void know_orientations(const fitting::FitState& training, bool survey,
                       const std::vector<DrivenRecording>& recordings, TrainedModel& result) {
  std::map<std::string, std::pair<double, double>> known;  // rad, rad^2
  const double surveyed = std::pow(training.model.noise.yaw, 2);
  for (const DrivenRecording& recording : recordings) {
    for (const SurveyPoint& point : recording.survey) {
      if (survey && !std::isnan(point.heading)) known[point.landmark] = {point.heading, surveyed};
    }
  }
  const estimation::RecordingAdjustment& fit = training.adjustment;
  for (std::size_t k = 0; k < training.problem.oriented.size(); ++k) {
    if (std::isnan(fit.orientation_sds[k])) continue;
    known[training.problem.landmarks[idx(training.problem.oriented[k])]] = {
        fit.state.orientations[k], std::pow(fit.orientation_sds[k], 2)};
  }
  for (const int landmark : result.problem.oriented) {
    const auto found = known.find(result.problem.landmarks[idx(landmark)]);
    const bool is_known = found != known.end();
    result.state.orientations.push_back(is_known ? found->second.first : kAbsent);
    result.orientation_variances.push_back(is_known ? found->second.second : 0.0);
  }
}

std::string landmark_of(const estimation::RecordingProblem& problem,
                        const estimation::Measurement& one) {
  return one.to < 0 ? std::string() : problem.landmarks[idx(one.to)];
}

}  // namespace

TrainedModel trained_model(const fitting::FitState& training,
                           const std::vector<DrivenRecording>& recordings,
                           const estimation::ProblemOptions& options) {
  TrainedModel result;
  estimation::ProblemOptions all = options;
  all.left_out.clear();
  result.recordings = training.recordings;
  result.problem = estimation::make_problem(training.recordings, training.model, all);
  const fitting::ShapeContext context(training.recordings, training.model.robot, training.paths);
  result.effects = fitting::effect_columns(training.model.effects, context).border;
  result.offsets = fitting::offsets_of(training);
  for (std::size_t k = 0; k < result.effects.size(); ++k) {
    result.effects[k].reference = training.columns.border[k].reference;
  }
  KnownMap map = known_map(result.problem, training, options.survey, recordings);
  result.state.landmarks = std::move(map.places);
  result.covariances = std::move(map.covariances);
  know_orientations(training, options.survey, recordings, result);
  for (const estimation::PoseNode& node : result.problem.poses) {
    const std::size_t session = idx(node.session);
    result.state.poses.push_back(
        fitting::pose_at(training.recordings[session].drive, training.paths[session], node.t));
  }
  return result;
}

LegPredictor::LegPredictor(const TrainedModel& trained, const std::vector<LegSpan>& legs)
    : trained_(trained),
      problem_(trained.problem),
      legs_(legs),
      events_(trained.problem.poses.size()),
      filter_(trained.problem, trained.effects, trained.offsets, trained.state, trained.covariances,
              trained.orientation_variances) {
  for (std::size_t k = 0; k < problem_.measurements.size(); ++k) {
    const estimation::Measurement& one = problem_.measurements[k];
    // What lies ahead is not known yet, and a loop ties it to what lies behind.
    if (one.session < 0 || estimation::is_tie(one)) continue;
    PoseEvents& here = events_[idx(one.from - problem_.landmark_count())];
    if (estimation::is_segment(one)) {
      here.segment = static_cast<int>(k);
    } else if (!estimation::is_driven(one)) {
      here.views.push_back(k);
    }
  }
  for (std::size_t k = 0; k < legs.size(); ++k) {
    if (legs[k].held_out) starting_[problem_.measurements[legs[k].from].from].push_back(k);
  }
}

void LegPredictor::run() {
  for (std::size_t pose = 0; pose < problem_.poses.size(); ++pose) {
    const bool first =
        pose == 0 || problem_.poses[pose].session != problem_.poses[pose - 1].session;
    if (first) begin_session(pose);
    const PoseEvents& here = events_[pose];
    for (const std::size_t k : here.views) {
      if (!trained_.left_out.contains(k)) steps_.push_back(filter_.see(k));
    }
    for (const std::size_t k : starting_[problem_.pose_node(static_cast<int>(pose))]) {
      if (std::optional<PredictedLeg> leg = predicted(k)) predicted_.push_back(std::move(*leg));
    }
    if (here.segment >= 0) steps_.push_back(filter_.drive(idx(here.segment)));
  }
  pass_over_misread();
}

void LegPredictor::pass_over_misread() {
  const auto misread = std::ranges::count(predicted_, true, &PredictedLeg::misread);
  // Of more it is the model that is wrong.
  const auto legs = static_cast<double>(predicted_.size());
  if (static_cast<double>(misread) > std::max(1.0, kMostLeftOut * legs)) return;
  std::erase_if(predicted_, [](const PredictedLeg& leg) { return leg.misread; });
}

bool LegPredictor::is_misread(std::size_t measurement, const Vector2& seen_at) const {
  constexpr double kNearer = 0.25;  // of how far its own landmark is
  const estimation::Measurement& one = problem_.measurements[measurement];
  if (one.to < 0 || !trained_.left_out.contains(measurement)) return false;
  const double near = kNearer * (seen_at - true_place(one)).norm();
  return std::ranges::any_of(trained_.state.landmarks, [&](const Vector2& place) {
    return (seen_at - place).norm() < near;  // never where a place is not known
  });
}

void LegPredictor::begin_session(std::size_t pose) {
  filter_.start(problem_.pose_node(static_cast<int>(pose)), trained_.state.poses[pose]);
  FilterStep fresh;
  fresh.A.setZero();
  steps_.push_back(fresh);
}

Vector2 LegPredictor::true_place(const estimation::Measurement& measurement) const {
  return measurement.to < 0 ? Vector2(measurement.value.head<2>())
                            : trained_.state.landmarks[idx(measurement.to)];
}

std::optional<Vector2> LegPredictor::seen_by(std::size_t measurement,
                                             const HeldOutFilter& filter) const {
  const estimation::Measurement& one = problem_.measurements[measurement];
  return one.kind->seen_from(one, filter.pose(one.from),
                             estimation::view_of(trained_.effects, trained_.offsets, one));
}

std::optional<PredictedLeg> LegPredictor::predicted(std::size_t k) const {
  const estimation::Measurement& from = problem_.measurements[legs_[k].from];
  const estimation::Measurement& to = problem_.measurements[legs_[k].to];
  const Vector2 target = true_place(to);
  if (std::isnan(target.x())) return std::nullopt;
  HeldOutFilter ahead = filter_;
  PredictedLeg leg;
  leg.after = steps_.size();
  for (int at = from.from; at != to.from;) {
    const int segment = events_[idx(at - problem_.landmark_count())].segment;
    if (segment < 0) break;
    leg.ahead.push_back(ahead.drive(idx(segment)));
    at = problem_.measurements[idx(segment)].to;
  }
  const std::optional<Vector2> begin = seen_by(legs_[k].from, filter_);
  const std::optional<Vector2> end = seen_by(legs_[k].to, ahead);
  if (!begin || !end) return std::nullopt;
  leg.chord = target - true_place(from);
  leg.predicted = *end - *begin;
  leg.prediction.leg = legs_[k].number;
  leg.prediction.from = landmark_of(problem_, from);
  leg.prediction.to = landmark_of(problem_, to);
  leg.prediction.t = legs_[k].time.to;
  leg.prediction.arrival_error = *end - target;
  leg.prediction.has_chord = leg.chord.norm() >= kLeastChord;  // not where the start is not known
  if (trained_.left_out.contains(legs_[k].from)) leg.prediction.has_chord = false;
  leg.misread = is_misread(legs_[k].to, *end);
  leg.from = end_of(legs_[k].from, filter_);
  leg.to = end_of(legs_[k].to, ahead);
  leg.prediction.expected_error = expected_error(leg.to, ahead);
  return leg;
}

/// Whitened rows have unit variances. Pose and landmark are taken as independent: what the filter
/// has seen of the landmark on earlier visits is forgotten by the time it has driven a leg.
double LegPredictor::expected_error(const LegEnd& end, const HeldOutFilter& filter) {
  Matrix2 covariance = end.by_rows * end.by_rows.transpose() +
                       end.by_pose * filter.pose_covariance() * end.by_pose.transpose();
  if (end.landmark >= 0) {
    covariance += end.by_landmark * filter.covariance(end.landmark) * end.by_landmark.transpose();
  }
  return std::sqrt(covariance.trace());
}

LegEnd LegPredictor::end_of(std::size_t measurement, const HeldOutFilter& filter) const {
  const estimation::Measurement& one = problem_.measurements[measurement];
  const Pose& pose = filter.pose(one.from);
  const effects::ViewPattern view = estimation::view_of(trained_.effects, trained_.offsets, one);
  const estimation::MeasurementRows rows = filter.rows(measurement);
  const Eigen::Matrix<double, 2, 4> T = one.kind->seen_by_rows(one, pose, view);
  estimation::Matrix4 W = one.whitener;
  for (int row = one.rows; row < 4; ++row) W(row, row) = 1.0;
  LegEnd end;
  end.measurement = measurement;
  end.landmark = one.to;
  end.by_rows = T * W.inverse();
  end.by_pose = T * rows.by_from;
  end.by_landmark = (T * rows.by_to).leftCols<2>();
  return end;
}

}  // namespace trussmap::validation
