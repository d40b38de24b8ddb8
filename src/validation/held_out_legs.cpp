// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "validation/held_out_legs.hpp"

#include "fit/column_builder.hpp"
#include "validation/training.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <tuple>
#include <utility>

namespace trussmap {
using namespace validation;

namespace {

/// Legs in times that are not to be used judge nothing: they stay legs.
std::set<std::size_t> passed_over(const std::vector<LegSpan>& legs,
                                  const std::vector<std::vector<TimeSpan>>& excluded) {
  std::set<std::size_t> numbers;
  for (const LegSpan& leg : legs) {
    if (is_excluded(leg, excluded)) numbers.insert(leg.number);
  }
  return numbers;
}

void hold_out_no(const std::set<std::size_t>& numbers, std::vector<LegSpan>& legs) {
  for (LegSpan& leg : legs) leg.held_out = leg.held_out && !numbers.contains(leg.number);
}

/// Which of the measurements those are that the fit leaves out.
std::set<std::size_t> left_out_in(const estimation::RecordingProblem& problem,
                                  const fitting::FitState& fit) {
  using Row = std::tuple<estimation::RecordingStream, int, std::size_t>;
  const auto row_of = [](const estimation::Measurement& one) {
    return Row(one.kind->facts().stream, one.session, one.source);
  };
  std::set<Row> rows;
  for (const int k : fit.adjustment.left_out) rows.insert(row_of(fit.problem.measurements[idx(k)]));
  std::set<std::size_t> result;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const estimation::Measurement& one = problem.measurements[k];
    if (!estimation::is_driven(one) && rows.contains(row_of(one))) result.insert(k);
  }
  return result;
}

}  // namespace

}  // namespace trussmap

namespace trussmap::validation {

/// Columns over all measurements, where a fit leaves some out and legs drive through them.
class HeldOutLegs::OwnColumns {
 public:
  OwnColumns(TrainedModel trained, const fitting::FitState& training, const fitting::FitState& fit)
      : trained_(std::move(trained)),
        paths_(training.paths),
        context_(trained_.recordings, training.model.robot, paths_),
        builder_(context_, trained_.problem, trained_.effects, trained_.offsets, trained_.state,
                 std::vector<double>(trained_.problem.measurements.size(), 1.0)) {
    trained_.problem.segments = {};
    trained_.problem.gyro_weights = {};
    const std::vector<std::string>& known = fit.problem.landmarks;
    const auto row_of = [&](int landmark) {
      const std::string& name = trained_.problem.landmarks[idx(landmark)];
      return std::find(known.begin(), known.end(), name) - known.begin();
    };
    const auto count = static_cast<std::ptrdiff_t>(known.size());
    for (int k = 0; k < trained_.problem.landmark_count(); ++k) {
      const std::ptrdiff_t at = row_of(k);
      rows_.push_back(at < count ? 2 * at : -1);
      rows_.push_back(at < count ? 2 * at + 1 : -1);
    }
    const std::vector<int>& oriented = fit.problem.oriented;
    for (const int landmark : trained_.problem.oriented) {
      const auto at = std::find(oriented.begin(), oriented.end(), row_of(landmark));
      rows_.push_back(at == oriented.end() ? -1 : 2 * count + (at - oriented.begin()));
    }
  }

  [[nodiscard]] Eigen::MatrixXd of(const Effect& effect) { return builder_.columns(effect); }

  /// What moves the fit's landmarks, of the legs' landmarks: what the fit has not stays.
  [[nodiscard]] Eigen::MatrixXd moved(const Eigen::MatrixXd& landmarks) const {
    Eigen::MatrixXd result =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows_.size()), landmarks.cols());
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (rows_[k] >= 0) result.row(static_cast<Eigen::Index>(k)) = landmarks.row(rows_[k]);
    }
    return result;
  }

 private:
  TrainedModel trained_;
  std::vector<fitting::SessionPath> paths_;
  fitting::ShapeContext context_;
  fitting::ColumnBuilder builder_;
  std::vector<std::ptrdiff_t> rows_;  ///< of the fit's landmarks and orientations; -1: none
};

HeldOutLegs::HeldOutLegs(const std::vector<DrivenRecording>& recordings,
                         const fitting::FitState& fit, const fitting::FitterOptions& options,
                         const LegOptions& leg_options) {
  const bool all = fit.used.left_out.empty();
  std::vector<LegSpan> legs =
      leg_spans(fit.recordings, all ? fit.problem : fitting::whole_problem(fit), leg_options);
  const std::set<std::size_t> unused = passed_over(legs, fit.used.left_out);
  hold_out_no(unused, legs);
  if (std::none_of(legs.begin(), legs.end(), [](const LegSpan& leg) { return leg.held_out; })) {
    return;
  }
  const fitting::FitState training = fit_without(legs, recordings, fit, options);
  TrainedModel trained = trained_model(training, recordings, options.problem);
  trained.left_out = left_out_in(trained.problem, fit);
  // Delays may have moved sightings, and so the ends of legs.
  std::vector<LegSpan> again = leg_spans(trained.recordings, trained.problem, leg_options);
  hold_out_no(unused, again);
  LegPredictor predictor(trained, again);
  predictor.run();
  steps_ = predictor.take_steps();
  legs_ = predictor.take_legs();
  if (all) {
    problem_ = std::move(trained.problem);
    has_slopes_ = same_layout(fit.problem);
  } else {
    problem_ = trained.problem;
    own_ = std::make_shared<OwnColumns>(std::move(trained), training, fit);
    has_slopes_ = true;
  }
  problem_.segments = {};
  problem_.gyro_weights = {};
  int rows = 0;
  for (const estimation::Measurement& one : problem_.measurements) {
    first_row_.push_back(rows);
    rows += one.rows;
  }
}

Eigen::MatrixXd HeldOutLegs::slopes(const Effect& effect, const Eigen::MatrixXd& columns,
                                    const Eigen::MatrixXd& landmarks) const {
  return own_ ? slopes(own_->of(effect), own_->moved(landmarks)) : slopes(columns, landmarks);
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
    if (step.seen < 0) return;
    const int size = problem_.size_of(step.seen);
    const int row = problem_.is_orientation(step.seen)
                        ? 2 * problem_.landmark_count() + step.seen - problem_.pose_end()
                        : 2 * step.seen;
    s += step.L.leftCols(size) * landmarks.middleRows(row, size);
  };
  const auto seen = [&](const LegEnd& end, const Eigen::MatrixXd& s) -> Eigen::MatrixXd {
    const auto c = rows_of(end.measurement);
    Eigen::MatrixXd result = end.by_pose * s + end.by_rows.leftCols(c.rows()) * c;
    if (end.landmark >= 0)
      result += end.by_landmark * landmarks.middleRows(Eigen::Index{2} * end.landmark, 2);
    return result;
  };
  const auto target = [&](const LegEnd& end) -> Eigen::MatrixXd {
    if (end.landmark < 0) return Eigen::MatrixXd::Zero(2, count);
    return landmarks.middleRows(Eigen::Index{2} * end.landmark, 2);
  };
  Eigen::MatrixXd result(6 * static_cast<Eigen::Index>(legs_.size()), count);
  Eigen::MatrixXd s = Eigen::MatrixXd::Zero(3, count);
  std::size_t done = 0;
  for (std::size_t k = 0; k < legs_.size(); ++k) {
    const PredictedLeg& leg = legs_[k];
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
  double expected = 0.0;
  int chords = 0;
  for (std::size_t k = 0; k < legs_.size(); ++k) {
    const PredictedLeg& leg = legs_[k];
    LegPrediction one = leg.prediction;
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
    expected += one.expected_error * one.expected_error;
    result.legs.push_back(std::move(one));
  }
  if (result.legs.empty()) return result;
  result.arrival_rms = std::sqrt(squares / static_cast<double>(result.legs.size()));
  result.expected_rms = std::sqrt(expected / static_cast<double>(result.legs.size()));
  result.stretch_error /= std::max(1, chords);
  result.orientation_error /= std::max(1, chords);
  return result;
}

bool HeldOutLegs::same_layout(const estimation::RecordingProblem& problem) const {
  const auto& ours = problem_.measurements;
  const auto& theirs = problem.measurements;
  return problem_.landmarks == problem.landmarks && problem_.oriented == problem.oriented &&
         std::equal(ours.begin(), ours.end(), theirs.begin(), theirs.end(),
                    [](const estimation::Measurement& a, const estimation::Measurement& b) {
                      return a.kind == b.kind && a.from == b.from && a.to == b.to &&
                             a.rows == b.rows;
                    });
}

}  // namespace trussmap::validation

namespace trussmap {

HeldOut predict_held_out(const std::vector<DrivenRecording>& recordings, const ModelFit& fit,
                         const LegOptions& legs) {
  return HeldOutLegs(recordings, fit, legs).metrics();
}

}  // namespace trussmap
