// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "workbench/tried_legs.hpp"

#include "drive/elapsed_time.hpp"
#include "geometry/index.hpp"
#include "recording/time_spans.hpp"
#include "validation/training.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

namespace trussmap {
namespace {

std::string landmark_of(const estimation::RecordingProblem& problem, std::size_t measurement) {
  const estimation::Measurement& one = problem.measurements[measurement];
  return one.to < 0 ? std::string() : problem.landmarks[idx(one.to)];
}

/// Whether a straight line meets the rectangle between two corners (Liang and Barsky).
bool meets(const Vector2& from, const Vector2& to, const Vector2& low, const Vector2& high) {
  double first = 0.0, last = 1.0;
  for (Eigen::Index k = 0; k < 2; ++k) {
    const double way = to[k] - from[k];
    const std::array<double, 2> ends{low[k] - from[k], high[k] - from[k]};
    if (way == 0.0) {
      if (ends[0] > 0.0 || ends[1] < 0.0) return false;
      continue;
    }
    first = std::max(first, std::min(ends[0] / way, ends[1] / way));
    last = std::min(last, std::max(ends[0] / way, ends[1] / way));
  }
  return first <= last;
}

}  // namespace

}  // namespace trussmap

namespace trussmap::workbench {

std::vector<TriedLeg> tried_legs(const std::vector<DrivenRecording>& recordings,
                                 const fitting::FitState& fit, const LegOptions& options) {
  const estimation::RecordingProblem whole =
      fit.used.left_out.empty() ? fit.problem : fitting::whole_problem(fit);
  std::vector<std::vector<TimeSpan>> spans(recordings.size());
  std::vector<TriedLeg> legs;
  for (const validation::LegSpan& span : validation::leg_spans(fit.recordings, whole, options)) {
    const std::size_t session = idx(span.session);
    const auto place = [&](double t) {
      return fitting::pose_at(fit.recordings[session].drive, fit.paths[session], t).position();
    };
    TriedLeg leg;
    leg.number = span.number;
    leg.recording = session;
    leg.from = landmark_of(whole, span.from);
    leg.to = landmark_of(whole, span.to);
    leg.begin = place(span.time.from);
    leg.end = place(span.time.to);
    leg.held_out = span.held_out;
    leg.excluded = !fit.used.left_out.empty() &&
                   recording::overlaps_any(span.time, fit.used.left_out[session]);
    spans[session].push_back(span.time);
    legs.push_back(std::move(leg));
  }
  spans = validation::recorded_spans(std::move(spans), recordings, fit);
  std::vector<std::size_t> next(spans.size(), 0);
  for (TriedLeg& leg : legs) leg.time = spans[leg.recording][next[leg.recording]++];
  return legs;
}

Eigen::VectorXd rows_of_legs(const std::vector<std::size_t>& numbers,
                             const std::vector<validation::LegSpan>& legs,
                             const fitting::FitState& fit,
                             const estimation::RecordingSystem& system) {
  if (numbers.empty()) return {};
  const std::set<std::size_t> wanted(numbers.begin(), numbers.end());
  std::vector<std::vector<TimeSpan>> spans(fit.recordings.size());
  for (const validation::LegSpan& leg : legs) {
    if (wanted.contains(leg.number)) spans[idx(leg.session)].push_back(leg.time);
  }
  for (std::vector<TimeSpan>& one : spans) one = recording::merged(std::move(one));
  Eigen::VectorXd rows = Eigen::VectorXd::Zero(system.rows());
  for (std::size_t k = 0; k < fit.problem.measurements.size(); ++k) {
    const estimation::Measurement& one = fit.problem.measurements[k];
    if (one.session < 0) continue;
    const double from = fit.problem.time_of(one.from);
    const double to = estimation::is_segment(one) ? fit.problem.time_of(one.to) : from;
    const std::vector<TimeSpan>& here = spans[idx(one.session)];
    const bool within = std::any_of(here.begin(), here.end(), [&](const TimeSpan& span) {
      return span.from <= from && to <= span.to;
    });
    if (within) rows.segment(system.first_row(k), one.rows).setOnes();
  }
  return rows;
}

}  // namespace trussmap::workbench

namespace trussmap {

std::vector<std::size_t> legs_in_area(const TriedModel& model, const Vector2& corner,
                                      const Vector2& opposite) {
  std::vector<std::size_t> numbers;
  for (const TriedLeg& leg : model.legs()) {
    if (meets(leg.begin, leg.end, corner.cwiseMin(opposite), corner.cwiseMax(opposite))) {
      numbers.push_back(leg.number);
    }
  }
  return numbers;
}

std::vector<std::size_t> legs_in_time(const TriedModel& model, const TimeSpan& elapsed) {
  const std::vector<double> shifts = drive::elapsed_shifts(model.recordings());
  std::vector<std::size_t> numbers;
  for (const TriedLeg& leg : model.legs()) {
    const double shift = shifts[leg.recording];
    if (leg.time.from + shift < elapsed.to && elapsed.from < leg.time.to + shift) {
      numbers.push_back(leg.number);
    }
  }
  return numbers;
}

}  // namespace trussmap
