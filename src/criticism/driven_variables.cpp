// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/driven_variables.hpp"

#include "drive/row_variables.hpp"
#include "drive/wheel_kinematics.hpp"

#include <algorithm>
#include <set>

namespace trussmap::criticism {
namespace {

constexpr std::size_t kThinned = 2000;
using Instant = fitting::ShapeContext::Instant;

bool in_all_sessions(const std::string& name, const fitting::ShapeContext& context) {
  for (std::size_t s = 0; s < context.recordings().size(); ++s) {
    if (!context.variables(s, Instant::middle).contains(name)) return false;
  }
  return true;
}

}  // namespace

Spread spread_of(const std::string& name, const fitting::ShapeContext& context) {
  Spread spread{name, 1e300, -1e300, 0.0, {}, 0};
  std::vector<double> values;
  for (std::size_t s = 0; s < context.recordings().size(); ++s) {
    const RowVariables& variables = context.variables(s, Instant::middle);
    const std::vector<double>& own = variables.at(name);
    const std::vector<double>& speed = variables.at("speed");
    const std::vector<double>& turn_rate = variables.at("turn_rate");
    for (std::size_t row = 0; row < own.size(); ++row) {
      if (speed[row] != 0.0 || turn_rate[row] != 0.0) values.push_back(own[row]);
    }
  }
  if (values.empty()) return spread;
  const std::size_t step = 1 + values.size() / kThinned;
  for (std::size_t k = 0; k < values.size(); k += step) spread.sorted.push_back(values[k]);
  for (const double value : values) {
    spread.least = std::min(spread.least, value);
    spread.most = std::max(spread.most, value);
    spread.mean += value / static_cast<double>(values.size());
  }
  std::sort(spread.sorted.begin(), spread.sorted.end());
  std::set<double> distinct;
  for (const double value : spread.sorted) {
    if (distinct.size() < 10) distinct.insert(value);
  }
  spread.distinct = distinct.size();
  return spread;
}

std::vector<std::string> covariates_of(const fitting::ShapeContext& context) {
  std::vector<std::string> names;
  for (const Covariate& one : context.recordings().front().drive.covariates) {
    const auto& reserved = recording::reserved_variables();
    if (std::find(reserved.begin(), reserved.end(), one.name) != reserved.end()) continue;
    if (drive::is_own_column(context.robot(), one.name)) continue;
    if (in_all_sessions(one.name, context)) names.push_back(one.name);
  }
  return names;
}

bool goes_with_only(const Effect& effect, const std::vector<std::string>& names) {
  return std::ranges::all_of(effect.shape, [&names](const Shape& one) {
    const std::vector<std::string>& own = one.variables();
    return !own.empty() && std::ranges::all_of(own, [&names](const std::string& name) {
      return std::ranges::find(names, name) != names.end();
    });
  });
}

Area driven_area(const fitting::FitState& fit) {
  constexpr int kAcross = 8;
  Area area;
  std::vector<Vector2> places;
  for (const fitting::SessionPath& path : fit.paths) {
    for (const Pose& pose : path.ends) {
      area.low = area.low.cwiseMin(pose.position());
      area.high = area.high.cwiseMax(pose.position());
      if (places.empty() || (places.back() - pose.position()).norm() > 0.1) {
        places.push_back(pose.position());
      }
    }
  }
  const Vector2 extent = area.high - area.low;
  if (!(extent.maxCoeff() > 0.5)) return area;
  area.step = extent.maxCoeff() / kAcross;
  const int columns = std::max(1, static_cast<int>(std::lround(extent.x() / area.step)));
  const int rows = std::max(1, static_cast<int>(std::lround(extent.y() / area.step)));
  for (int i = 0; i <= columns; ++i) {
    for (int j = 0; j <= rows; ++j) {
      const Vector2 centre = area.low + Vector2(extent.x() * i / columns, extent.y() * j / rows);
      const bool near = std::any_of(places.begin(), places.end(), [&](const Vector2& place) {
        return (place - centre).norm() < 0.75 * area.step;
      });
      if (near) area.centres.push_back(centre);
    }
  }
  return area;
}

}  // namespace trussmap::criticism
