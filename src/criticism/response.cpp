// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/response.hpp"

#include "criticism/response_bins.hpp"
#include "effects/channel_record.hpp"
#include "effects/place.hpp"
#include "effects/place_patterns.hpp"
#include "geometry/units.hpp"
#include "linalg/dense.hpp"
#include "statistics/median.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

namespace trussmap::criticism {
namespace {

constexpr int kCurvePoints = 73;

/// The variable as a formula; nothing without one, or without a place.
std::optional<Shape> formula_of(const std::string& variable, const Effect& effect) {
  if (variable.empty()) return std::nullopt;
  if (variable != kPlace) return Shape(variable);
  const std::optional<Vector2> place = effects::place_of(effect);
  if (!place) return std::nullopt;
  return Shape(effects::kDistancePattern, {{"x", place->x()}, {"y", place->y()}});
}

/// Least squares by the modes that the data show; bins that no measurement sees are dropped.
/// `traces`: what rivals leave in the measurements, estimated in the same way. `rows`: those that
/// count; empty: all.
void estimate(Response& response, const Score& score, double prior_sd, const fitting::FitState& fit,
              const ScoreTest& tests, const Eigen::MatrixXd& traces, const Eigen::VectorXd& rows) {
  std::vector<ResponseBin>& bins = response.bins;
  const bool all = rows.size() == 0;
  const Eigen::MatrixXd some =
      all ? Eigen::MatrixXd() : Eigen::MatrixXd(rows.asDiagonal() * score.projected);
  const Eigen::MatrixXd& M = all ? score.projected : some;
  const Eigen::MatrixXd S = M.transpose() * M;
  const linalg::SymmetricModes modes = linalg::symmetric_modes(S);
  const double least =
      9.0 * tests.dispersion() / (prior_sd * prior_sd * static_cast<double>(bins.size()));
  const Eigen::VectorXd g = modes.eigenvectors.transpose() * (M.transpose() * tests.residuals());
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(S.rows());
  double explained = 0.0;
  for (Eigen::Index mode = 0; mode < S.rows(); ++mode) {
    if (modes.eigenvalues[mode] < least) continue;
    inverse[mode] = 1.0 / modes.eigenvalues[mode];
    explained += g[mode] * g[mode] * inverse[mode];
  }
  const double left = tests.residuals().squaredNorm() - explained;
  // Of some rows nobody knows how many values the map has taken.
  const double dof =
      all ? static_cast<double>(fit.adjustment.dof) - static_cast<double>(S.rows()) : 0.0;
  const Eigen::MatrixXd projected = modes.eigenvectors * inverse.asDiagonal() *
                                    modes.eigenvectors.transpose() * (M.transpose() * traces);
  response.rivals.resize(static_cast<std::size_t>(traces.cols()));
  const double dispersion = dof > 0.0 ? std::max(1.0, left / dof) : tests.dispersion();
  std::vector<ResponseBin> seen;
  for (Eigen::Index k = 0; k < S.rows(); ++k) {
    if (!(S(k, k) > 0.0)) continue;
    const Eigen::VectorXd part = modes.eigenvectors.row(k);
    ResponseBin bin = bins[static_cast<std::size_t>(k)];
    bin.estimate = -part.dot(inverse.cwiseProduct(g));
    bin.sd = std::sqrt(dispersion * part.dot(inverse.cwiseProduct(part)));
    if (!(bin.sd > 0.0)) continue;
    seen.push_back(bin);
    for (Eigen::Index rival = 0; rival < traces.cols(); ++rival) {
      response.rivals[static_cast<std::size_t>(rival)].emplace_back(bin.at, projected(k, rival));
    }
  }
  bins = std::move(seen);
}

/// What effects with coefficients add to the measurements, poses and landmarks refitted.
Eigen::MatrixXd traces_of(const std::vector<Effect>& effects, const ScoreTest& tests) {
  Eigen::MatrixXd traces =
      Eigen::MatrixXd::Zero(tests.residuals().size(), static_cast<Eigen::Index>(effects.size()));
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const Eigen::MatrixXd columns = tests.projected(tests.columns(effects[k]));
    const Eigen::Index count =
        std::min(columns.cols(), static_cast<Eigen::Index>(effects[k].coefficients.size()));
    for (Eigen::Index column = 0; column < count; ++column) {
      traces.col(static_cast<Eigen::Index>(k)) +=
          effects[k].coefficients[static_cast<std::size_t>(column)] * columns.col(column);
    }
  }
  return traces;
}

}  // namespace

const ShapeRanges::Values& ShapeRanges::values(const Shape& shape) {
  const auto [at, fresh] = values_.try_emplace(shape);
  if (fresh) at->second = context_.values(shape, fitting::ShapeContext::Instant::middle);
  return at->second;
}

EffectRange ShapeRanges::of(const Effect& effect) {
  const std::size_t sessions = context_.recordings().size();
  const std::vector<double> coefficients = fitting::coefficients_of(effect, sessions);
  EffectRange range;
  bool first = true;
  std::vector<const Values*> shapes;
  for (const Shape& shape : effect.shape) shapes.push_back(&values(shape));
  for (std::size_t s = 0; s < sessions; ++s) {
    const MotionRows& drive = context_.recordings()[s].drive;
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      if (drive.rests(row)) continue;
      double g = 0.0;
      for (std::size_t k = 0; k < shapes.size(); ++k) {
        const std::size_t place = effect.per_session ? s * shapes.size() + k : k;
        g += coefficients.at(place) * (*shapes[k])[s][row];
      }
      range.least = first ? g : std::min(range.least, g);
      range.most = first ? g : std::max(range.most, g);
      first = false;
    }
  }
  return range;
}

EffectRange range_of(const Effect& effect, const fitting::ShapeContext& context) {
  return ShapeRanges(context).of(effect);
}

std::string natural_variable(const Effect& effect) {
  std::set<std::string> names;
  for (const Shape& shape : effect.shape) {
    names.insert(shape.variables().begin(), shape.variables().end());
  }
  names.erase("session");
  if (names.contains("x") || names.contains("y")) return {};
  if (!names.empty()) return *names.begin();
  return std::string(effects::record_of(effect.channel).drawn_against);
}

std::vector<Vector2> effect_curve(const Effect& effect, const std::string& variable, double low,
                                  double high) {
  if (effect.coefficients.size() != effect.shape.size()) return {};
  std::vector<double> at;
  at.reserve(kCurvePoints);
  for (int k = 0; k < kCurvePoints; ++k) at.push_back(low + (high - low) * k / (kCurvePoints - 1));
  std::vector<Vector2> curve;
  curve.reserve(at.size());
  for (const double value : at) curve.emplace_back(value, 0.0);
  const std::optional<Vector2> place =
      variable == kPlace ? effects::place_of(effect) : std::nullopt;
  RowVariables variables;
  if (place) {
    for (const double value : at) variables["x"].push_back(place->x() + value);
    variables["y"] = std::vector<double>(at.size(), place->y());
  } else {
    variables[variable] = at;
  }
  for (std::size_t shape = 0; shape < effect.shape.size(); ++shape) {
    for (const std::string& name : effect.shape[shape].variables()) {
      if (!variables.contains(name)) return {};
    }
    try {
      const std::vector<double> f = effect.shape[shape].values(variables);
      for (std::size_t k = 0; k < f.size() && k < curve.size(); ++k) {
        curve[k].y() += effect.coefficients[shape] * f[k];
      }
    } catch (const std::invalid_argument&) {  // not finite somewhere
      return {};
    }
  }
  return curve;
}

namespace {

/// An effect's curve at the level at which its bins show it: where the data do not tell what all
/// bins have in common, the estimates leave that out, and so does the curve.
std::vector<Vector2> levelled(std::vector<Vector2> curve, const Effect& effect,
                              const std::string& variable, const std::vector<Vector2>& projected) {
  if (curve.empty() || projected.empty()) return curve;
  std::vector<double> off;
  for (const Vector2& bin : projected) {
    const std::vector<Vector2> here = effect_curve(effect, variable, bin.x(), bin.x());
    if (here.empty()) return curve;
    off.push_back(bin.y() - here.front().y());
  }
  // The median: a bin across a step has a mean of both sides.
  const double shift = statistics::median(std::move(off));
  for (Vector2& point : curve) point.y() += shift;
  return curve;
}

}  // namespace

Response response_along(const std::string& variable, const Effect& effect,
                        const fitting::FitState& fit, const ScoreTest& tests,
                        const std::vector<Effect>& rivals, const Eigen::VectorXd& rows) {
  const ChannelFacts& facts = facts_of(effect.channel);
  Response result;
  result.channel = effect.channel;
  result.unit = facts.unit;
  result.variable = variable;
  const std::optional<Shape> formula = formula_of(variable, effect);
  if (!formula) return result;
  Bins bins = bins_of(*formula, fit, tests, variable == kPlace);
  if (bins.bins.empty()) return result;
  Effect probe;
  probe.name = std::string(facts.name) + " along " + variable;
  probe.channel = effect.channel;
  probe.shape = std::move(bins.shapes);
  const std::vector<Score> scores = tests.test({probe});
  result.bins = std::move(bins.bins);
  std::vector<Effect> traced = rivals;
  traced.push_back(effect);
  estimate(result, scores.front(), facts.prior_sd, fit, tests, traces_of(traced, tests), rows);
  const std::vector<Vector2> projected = std::move(result.rivals.back());
  result.rivals.pop_back();
  if (result.bins.empty()) return result;
  const bool round = variable == "heading";
  const double low = round || variable == kPlace ? 0.0 : result.bins.front().at;
  const double high = round ? geometry::kFullTurn : result.bins.back().at;
  result.curve = levelled(effect_curve(effect, variable, low, high), effect, variable, projected);
  for (std::size_t k = 0; k < rivals.size(); ++k) {
    if (rivals[k].channel != effect.channel || variable == kPlace) continue;
    std::vector<Vector2> own = levelled(effect_curve(rivals[k], variable, low, high), rivals[k],
                                        variable, result.rivals[k]);
    if (!own.empty()) result.rivals[k] = std::move(own);
  }
  return result;
}

}  // namespace trussmap::criticism
