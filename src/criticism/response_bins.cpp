// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/response_bins.hpp"

#include "geometry/units.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap::criticism {
namespace {

constexpr std::size_t kBins = 9;
constexpr int kHeadingBins = 12;
constexpr std::size_t kFewValues = 9;

double in_one_turn(double heading) {
  const double rest = std::fmod(heading, geometry::kFullTurn);
  return rest < 0.0 ? rest + geometry::kFullTurn : rest;
}

/// A formula in all rows in which a wheel turns, in order.
std::vector<double> values_of(const Shape& formula, const fitting::FitState& fit,
                              const ScoreTest& tests) {
  for (std::size_t s = 0; s < fit.recordings.size(); ++s) {
    const RowVariables& rows = tests.context().variables(s, fitting::ShapeContext::Instant::middle);
    for (const std::string& name : formula.variables()) {
      if (!rows.contains(name)) return {};
    }
  }
  const auto all = tests.context().values(formula, fitting::ShapeContext::Instant::middle);
  std::vector<double> values;
  for (std::size_t s = 0; s < fit.recordings.size(); ++s) {
    const MotionRows& drive = fit.recordings[s].drive;
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      if (drive.rests(row)) continue;
      values.push_back(formula == "heading" ? in_one_turn(all[s][row]) : all[s][row]);
    }
  }
  std::sort(values.begin(), values.end());
  return values;
}

/// How many of the rows lie below each edge between bins: of distances from a place those near it
/// are told apart.
std::vector<std::size_t> rows_below(std::size_t rows, bool from_place) {
  std::vector<std::size_t> below;
  if (from_place) {
    for (const std::size_t percent : {1U, 3U, 6U, 11U, 20U, 35U, 55U, 77U}) {
      below.push_back(rows * percent / 100);
    }
    return below;
  }
  for (std::size_t k = 1; k < kBins; ++k) below.push_back(rows * k / kBins);
  return below;
}

/// Equally many rows in each, but near a place; one per value where there are few.
std::vector<double> edges_of(const std::vector<double>& values, bool from_place) {
  const double span = values.back() - values.front();
  std::vector<double> distinct;
  for (const double value : values) {
    if (distinct.empty() || value - distinct.back() > 1e-6 * span) distinct.push_back(value);
    if (distinct.size() > kFewValues) break;
  }
  std::vector<double> edges{values.front() - 0.01 * span};
  if (distinct.size() <= kFewValues) {
    for (std::size_t k = 1; k < distinct.size(); ++k) {
      edges.push_back(0.5 * (distinct[k - 1] + distinct[k]));
    }
  } else {
    for (const std::size_t below : rows_below(values.size(), from_place)) {
      const double edge = values[below];
      if (edge - edges.back() > 0.02 * span) edges.push_back(edge);
    }
  }
  edges.push_back(values.back() + 0.01 * span);
  return edges;
}

Bins heading_bins(const std::vector<double>& values) {
  Bins result;
  const double width = geometry::kFullTurn / kHeadingBins;
  for (int k = 0; k < kHeadingBins; ++k) {
    const double middle = k * width;
    double sum = 0.0;
    int count = 0;
    for (const double value : values) {
      const double off = std::remainder(value - middle, geometry::kFullTurn);
      if (std::abs(off) > 0.5 * width) continue;
      sum += off;
      ++count;
    }
    if (count == 0) continue;
    result.bins.push_back(
        {middle + sum / count, middle - 0.5 * width, middle + 0.5 * width, 0.0, 0.0});
    result.shapes.emplace_back(
        "(1+sign(cos(heading-{middle})-{edge}))/2",
        std::vector<ShapeParameter>{{"middle", middle}, {"edge", std::cos(0.5 * width)}});
  }
  return result;
}

Bins bins_of(const Shape& variable, const std::vector<double>& values, bool from_place) {
  if (variable == "heading") return heading_bins(values);
  Bins result;
  if (!(values.back() > values.front())) return result;
  const std::vector<double> edges = edges_of(values, from_place);
  auto from = values.begin();
  for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
    const auto to = std::lower_bound(from, values.end(), edges[k + 1]);
    if (to == from) continue;
    double sum = 0.0;
    for (auto at = from; at != to; ++at) sum += *at;
    result.bins.push_back({sum / static_cast<double>(to - from), edges[k], edges[k + 1], 0.0, 0.0});
    result.shapes.emplace_back(
        fmt::format("(sign({0}-{{low}})-sign({0}-{{high}}))/2", variable.text()),
        std::vector<ShapeParameter>{{"low", edges[k]}, {"high", edges[k + 1]}});
    from = to;
  }
  return result;
}

}  // namespace

Bins bins_of(const Shape& formula, const fitting::FitState& fit, const ScoreTest& tests,
             bool from_place) {
  const std::vector<double> values = values_of(formula, fit, tests);
  return values.empty() ? Bins() : bins_of(formula, values, from_place);
}

}  // namespace trussmap::criticism
