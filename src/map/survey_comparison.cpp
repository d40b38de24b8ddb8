// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/survey_comparison.hpp"

#include "map/common_landmarks.hpp"
#include "statistics/median.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace trussmap::map {

CommonLandmarks common_landmarks(const LandmarkPositions& map,
                                 const std::vector<SurveyPoint>& survey,
                                 const std::vector<std::string>& leave_out) {
  CommonLandmarks common;
  for (const SurveyPoint& point : survey) {
    const auto found = map.find(point.landmark);
    if (found == map.end()) continue;
    if (std::find(leave_out.begin(), leave_out.end(), point.landmark) != leave_out.end()) continue;
    common.names.push_back(point.landmark);
    common.in_map.push_back(found->second);
    common.surveyed.emplace_back(point.x, point.y);
  }
  return common;
}

}  // namespace trussmap::map

namespace trussmap {
using namespace map;

namespace {

constexpr double kMedians = 10.0;
constexpr std::size_t kMostPairs = 5000;
constexpr double kRms = 10.0;
constexpr std::size_t kFewest = 3;

std::vector<double> distances(const CommonLandmarks& common, const Alignment& alignment) {
  std::vector<double> result;
  result.reserve(common.names.size());
  for (std::size_t k = 0; k < common.names.size(); ++k) {
    result.push_back((alignment.apply(common.in_map[k]) - common.surveyed[k]).norm());
  }
  return result;
}

/// The pair's alignment whose median distance is least (Rousseeuw, "Least median of squares
/// regression", 1984): of all pairs, or of some drawn at random where they are many.
Alignment robust_alignment(const CommonLandmarks& common) {
  const std::size_t count = common.names.size();
  Alignment best;
  double least = std::numeric_limits<double>::infinity();
  const auto try_pair = [&](std::size_t i, std::size_t j) {
    const Alignment candidate = align_rigidly({common.in_map[i], common.in_map[j]},
                                              {common.surveyed[i], common.surveyed[j]});
    const double middle = statistics::median(distances(common, candidate));
    if (middle < least) {
      least = middle;
      best = candidate;
    }
  };
  if (count * (count - 1) / 2 <= kMostPairs) {
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = i + 1; j < count; ++j) try_pair(i, j);
    }
    return best;
  }
  std::mt19937_64 random(1);
  for (std::size_t k = 0; k < kMostPairs; ++k) {
    const std::size_t i = random() % count;
    const std::size_t j = random() % count;
    if (i != j) try_pair(i, j);
  }
  return best;
}

CommonLandmarks subset(const CommonLandmarks& common, const std::vector<bool>& keep) {
  CommonLandmarks result;
  for (std::size_t k = 0; k < common.names.size(); ++k) {
    if (!keep[k]) continue;
    result.names.push_back(common.names[k]);
    result.in_map.push_back(common.in_map[k]);
    result.surveyed.push_back(common.surveyed[k]);
  }
  return result;
}

/// Which landmarks agree with the survey.
std::vector<bool> agreeing(const CommonLandmarks& common) {
  const std::size_t count = common.names.size();
  std::vector<bool> all(count, true);
  std::vector<bool> keep = all;
  Alignment alignment = robust_alignment(common);
  for (int round = 0; round < 3; ++round) {
    const std::vector<double> off = distances(common, alignment);
    const double middle = statistics::median(off);
    double sum = 0.0;
    double kept = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      if (off[k] > kMedians * middle) continue;
      sum += off[k] * off[k];
      kept += 1.0;
    }
    const double limit = std::max(kMedians * middle, kRms * std::sqrt(sum / kept));
    for (std::size_t k = 0; k < count; ++k) keep[k] = off[k] <= limit;
    const auto left_out = static_cast<std::size_t>(std::count(keep.begin(), keep.end(), false));
    if (3 * left_out > count || count - left_out < kFewest) return all;
    const CommonLandmarks inner = subset(common, keep);
    alignment = align_rigidly(inner.in_map, inner.surveyed);
  }
  return keep;
}

}  // namespace

LandmarkPositions positions_of(const LandmarkGraph& map) {
  LandmarkPositions positions;
  for (int k = 0; k < map.landmarks(); ++k) {
    positions[map.landmark(k).name] = map.landmark(k).position;
  }
  return positions;
}

SurveyComparison compare_with_survey(const LandmarkPositions& map,
                                     const std::vector<SurveyPoint>& survey) {
  SurveyComparison result;
  const CommonLandmarks common = common_landmarks(map, survey, {});
  result.landmarks = static_cast<int>(common.names.size());
  if (common.names.size() < kFewest) return result;
  const std::vector<bool> keep = agreeing(common);
  const CommonLandmarks inner = subset(common, keep);
  result.landmarks = static_cast<int>(inner.names.size());
  result.rigid = align_rigidly(inner.in_map, inner.surveyed);
  result.similarity = align_by_similarity(inner.in_map, inner.surveyed);
  result.rms_all = align_rigidly(common.in_map, common.surveyed).rms;

  std::vector<std::size_t> outside;
  for (std::size_t k = 0; k < keep.size(); ++k) {
    if (!keep[k]) outside.push_back(k);
  }
  const double near = kMedians * std::max(result.rigid.rms, 1e-9);
  for (const std::size_t a : outside) {
    result.contradicting.push_back(common.names[a]);
    for (const std::size_t b : outside) {
      if (b <= a) continue;
      const Vector2 off_a = result.rigid.apply(common.in_map[a]) - common.surveyed[b];
      const Vector2 off_b = result.rigid.apply(common.in_map[b]) - common.surveyed[a];
      if (off_a.norm() <= near && off_b.norm() <= near) {
        result.exchanged.emplace_back(common.names[a], common.names[b]);
      }
    }
  }
  return result;
}

double survey_rms(const LandmarkPositions& map, const std::vector<SurveyPoint>& survey,
                  const std::vector<std::string>& leave_out) {
  const CommonLandmarks common = common_landmarks(map, survey, leave_out);
  return common.names.size() < 2 ? 0.0 : align_rigidly(common.in_map, common.surveyed).rms;
}

namespace {

struct InBoth {
  std::vector<Vector2> map;
  std::vector<Vector2> truth;
};

InBoth in_both(const LandmarkGraph& map, const LandmarkPositions& truth) {
  InBoth both;
  for (int k = 0; k < map.landmarks(); ++k) {
    const auto at = truth.find(map.landmark(k).name);
    if (at == truth.end()) continue;
    both.map.push_back(map.landmark(k).position);
    both.truth.push_back(at->second);
  }
  if (both.map.size() < 2) {
    throw std::invalid_argument("map and truth have fewer than two landmarks in common");
  }
  return both;
}

}  // namespace

Alignment onto_truth(const LandmarkGraph& map, const LandmarkPositions& truth) {
  const InBoth both = in_both(map, truth);
  return align_rigidly(both.map, both.truth);
}

LandmarkGraph laid_over(const LandmarkGraph& map, const LandmarkPositions& truth) {
  const Alignment onto = onto_truth(map, truth);
  LandmarkGraph laid = map;
  for (int k = 0; k < map.landmarks(); ++k) {
    laid.set_position(k, onto.apply(map.landmark(k).position));
  }
  return laid;
}

MapErrors map_errors(const LandmarkGraph& map, const LandmarkPositions& truth, Laid laid) {
  const InBoth both = in_both(map, truth);
  const std::vector<Vector2>& found = both.map;
  const std::vector<Vector2>& true_places = both.truth;
  Alignment onto;
  if (laid == Laid::aligned) onto = align_rigidly(found, true_places);
  MapErrors errors;
  const std::size_t first = laid == Laid::aligned ? 0 : 1;
  double sum = 0.0;
  for (std::size_t k = first; k < found.size(); ++k) {
    sum += (onto.apply(found[k]) - true_places[k]).norm();
  }
  errors.position = sum / static_cast<double>(found.size() - first);
  for (int number = 0; number < map.routes(); ++number) {
    const Landmark& source = map.landmark(map.route(number).source);
    const Landmark& target = map.landmark(map.route(number).target);
    const auto from = truth.find(source.name);
    const auto to = truth.find(target.name);
    if (from == truth.end() || to == truth.end()) continue;
    const Vector2 way = to->second - from->second;
    if (!(way.norm() > 0.0)) continue;
    const Vector2 lies = rotation(onto.angle) * (target.position - source.position);
    errors.stretch += std::abs(lies.norm() - way.norm()) / way.norm();
    errors.orientation += std::abs(wrap_angle(direction(lies) - direction(way)));
    ++errors.routes;
  }
  errors.stretch /= std::max(1, errors.routes);
  errors.orientation /= std::max(1, errors.routes);
  return errors;
}

}  // namespace trussmap
