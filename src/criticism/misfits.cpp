// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/misfits.hpp"

#include "validation/leg_spans.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace trussmap::criticism {
namespace {

constexpr double kLeastChord = 0.1;  // m

double squared(const estimation::RecordingSystem& system, const estimation::Measurement& one,
               std::size_t k) {
  return system.residuals().segment(system.first_row(k), one.rows).squaredNorm();
}

/// A leg as it was driven, beside the chord that the fit has of it.
struct DrivenLeg {
  LegMisfit misfit;
  double force = 0.0;  ///< of its last segment on its end, along the chord
};

class Legs {
 public:
  Legs(const fitting::FitState& fit, const estimation::RecordingSystem& system)
      : problem_(fit.problem), state_(fit.adjustment.state), system_(system) {
    for (std::size_t k = 0; k < problem_.measurements.size(); ++k) {
      const estimation::Measurement& one = problem_.measurements[k];
      if (estimation::is_segment(one)) segment_from_[one.from] = k;
    }
  }

  [[nodiscard]] DrivenLeg driven(const validation::LegSpan& leg) const {
    const estimation::Measurement& from = problem_.measurements[leg.from];
    const estimation::Measurement& to = problem_.measurements[leg.to];
    DrivenLeg result;
    LegMisfit& one = result.misfit;
    one.leg = leg.number;
    one.from = from.to < 0 ? std::string() : problem_.landmarks[idx(from.to)];
    one.to = to.to < 0 ? std::string() : problem_.landmarks[idx(to.to)];
    one.t = leg.time.to;
    Pose reckoned = pose(from.from);
    Vector2 pull = Vector2::Zero();  // of the last segment on the leg's end
    for (int node = from.from; node != to.from;) {
      const auto found = segment_from_.find(node);
      if (found == segment_from_.end()) break;
      const estimation::Measurement& segment = problem_.measurements[found->second];
      one.chi2 += squared(system_, segment, found->second);
      one.dof += segment.rows;
      const Pose& a = pose(segment.from);
      const auto error =
          system_.residuals().segment(system_.first_row(found->second), segment.rows);
      const Eigen::MatrixXd W = segment.whitener.topLeftCorner(segment.rows, segment.rows);
      // As the wheels have it, and not as it is linearised at the noise believed.
      const Eigen::VectorXd raw =
          W.triangularView<Eigen::Lower>().solve(error) + segment.value_offset.head(segment.rows);
      const Pose measured = relative(a, pose(segment.to));
      reckoned =
          compose(reckoned, {measured.x - raw[0], measured.y - raw[1], measured.heading - raw[2]});
      const Eigen::VectorXd force = W.transpose() * error;
      pull = rotation(a.heading) * force.head<2>();
      node = segment.to;
    }
    const Vector2 begin = pose(from.from).position();
    const Vector2 chord = pose(to.from).position() - begin;
    const Vector2 driven = reckoned.position() - begin;
    if (chord.norm() >= kLeastChord) {
      one.stretch_error = (driven.norm() - chord.norm()) / chord.norm();
      one.orientation_error = wrap_angle(direction(driven) - direction(chord));
    }
    if (chord.norm() > 0.0) result.force = pull.dot(chord) / chord.norm();
    return result;
  }

 private:
  [[nodiscard]] const Pose& pose(int node) const {
    return state_.poses[idx(node - problem_.landmark_count())];
  }

  const estimation::RecordingProblem& problem_;
  const estimation::RecordingState& state_;
  const estimation::RecordingSystem& system_;
  std::map<int, std::size_t> segment_from_;  ///< node -> measurement
};

using RouteName = std::pair<std::string, std::string>;

void add(const DrivenLeg& leg, std::map<RouteName, RouteMisfit>& routes) {
  const LegMisfit& one = leg.misfit;
  if (one.from.empty()) return;
  const RouteName name = std::minmax(one.from, one.to);
  RouteMisfit& route = routes[name];
  route.from = name.first;
  route.to = name.second;
  ++route.traversals;
  route.chi2 += one.chi2;
  route.stretch_error += one.stretch_error;
  route.orientation_error += one.orientation_error;
  route.force += leg.force;
}

std::vector<LandmarkMisfit> landmarks_of(const estimation::RecordingProblem& problem,
                                         const estimation::RecordingSystem& system) {
  std::map<int, LandmarkMisfit> landmarks;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const estimation::Measurement& one = problem.measurements[k];
    const bool survey = estimation::is_surveyed_place(one);
    if (!survey && !estimation::is_sighting(one)) continue;
    const int node = survey ? one.from : one.to;
    LandmarkMisfit& landmark = landmarks[node];
    landmark.landmark = problem.landmarks[idx(node)];
    landmark.sightings += survey ? 0 : 1;
    landmark.chi2 += squared(system, one, k);
  }
  std::vector<LandmarkMisfit> result;
  result.reserve(landmarks.size());
  for (auto& [node, landmark] : landmarks) result.push_back(std::move(landmark));
  return result;
}

}  // namespace

Misfits find_misfits(const fitting::FitState& fit, const ScoreTest& tests,
                     const LegOptions& options) {
  Misfits result;
  const Legs legs(fit, tests.system());
  std::map<RouteName, RouteMisfit> routes;
  for (const validation::LegSpan& span : validation::leg_spans(fit, options)) {
    DrivenLeg leg = legs.driven(span);
    add(leg, routes);
    result.legs.push_back(std::move(leg.misfit));
  }
  for (auto& [name, route] : routes) {
    route.stretch_error /= route.traversals;
    route.orientation_error /= route.traversals;
    result.routes.push_back(std::move(route));
  }
  result.landmarks = landmarks_of(fit.problem, tests.system());
  const auto worse = [](const auto& a, const auto& b) { return a.chi2 > b.chi2; };
  std::stable_sort(result.legs.begin(), result.legs.end(), worse);
  std::stable_sort(result.routes.begin(), result.routes.end(), worse);
  std::stable_sort(result.landmarks.begin(), result.landmarks.end(), worse);
  return result;
}

}  // namespace trussmap::criticism
