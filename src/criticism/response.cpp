// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/response.hpp"

#include "effects/place_patterns.hpp"
#include "wording/effect_words.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr int kBins = 9;
constexpr int kHeadingBins = 12;
constexpr std::size_t kFewValues = 9;
constexpr int kCurvePoints = 73;
constexpr double kTurn = 2.0 * std::numbers::pi;

double in_one_turn(double heading) {
  const double rest = std::fmod(heading, kTurn);
  return rest < 0.0 ? rest + kTurn : rest;
}

/// The variable as a formula; nothing without one, or without a place.
std::optional<Shape> formula_of(const std::string& variable, const Effect& effect) {
  if (variable.empty()) return std::nullopt;
  if (variable != kPlace) return Shape(variable);
  const std::optional<Vector2> place = place_of(effect);
  if (!place) return std::nullopt;
  return Shape(kDistancePattern, {{"x", place->x()}, {"y", place->y()}});
}

/// A formula in all rows in which a wheel turns, in order.
std::vector<double> values_of(const Shape& formula, const ModelFit& fit, const ScoreTest& tests) {
  for (std::size_t s = 0; s < fit.recordings.size(); ++s) {
    const RowVariables& rows = tests.context().variables(s, ShapeContext::Instant::middle);
    for (const std::string& name : formula.variables()) {
      if (!rows.contains(name)) return {};
    }
  }
  const auto all = tests.context().values(formula, ShapeContext::Instant::middle);
  std::vector<double> values;
  for (std::size_t s = 0; s < fit.recordings.size(); ++s) {
    const Drive& drive = fit.recordings[s].drive;
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      if (drive.left[row] == 0.0 && drive.right[row] == 0.0) continue;
      values.push_back(formula == "heading" ? in_one_turn(all[s][row]) : all[s][row]);
    }
  }
  std::sort(values.begin(), values.end());
  return values;
}

/// Equally many rows in each; one per value where there are few.
std::vector<double> edges_of(const std::vector<double>& values) {
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
    for (int k = 1; k < kBins; ++k) {
      const double edge = values[values.size() * static_cast<std::size_t>(k) / kBins];
      if (edge - edges.back() > 0.02 * span) edges.push_back(edge);
    }
  }
  edges.push_back(values.back() + 0.01 * span);
  return edges;
}

struct Bins {
  std::vector<ResponseBin> bins;
  std::vector<Shape> shapes;
};

Bins heading_bins(const std::vector<double>& values) {
  Bins result;
  const double width = kTurn / kHeadingBins;
  for (int k = 0; k < kHeadingBins; ++k) {
    const double middle = k * width;
    double sum = 0.0;
    int count = 0;
    for (const double value : values) {
      const double off = std::remainder(value - middle, kTurn);
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

Bins bins_of(const Shape& variable, const std::vector<double>& values) {
  if (variable == "heading") return heading_bins(values);
  Bins result;
  if (!(values.back() > values.front())) return result;
  const std::vector<double> edges = edges_of(values);
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

/// Least squares by the modes that the data show; bins that no measurement sees are dropped.
/// `traces`: what rivals leave in the measurements, estimated alike.
void estimate(Response& response, const Score& score, double prior_sd, const ModelFit& fit,
              const ScoreTest& tests, const Eigen::MatrixXd& traces) {
  std::vector<ResponseBin>& bins = response.bins;
  const Eigen::MatrixXd& M = score.projected;
  const Eigen::MatrixXd S = M.transpose() * M;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(S);
  const double least =
      9.0 * tests.dispersion() / (prior_sd * prior_sd * static_cast<double>(bins.size()));
  const Eigen::VectorXd g = modes.eigenvectors().transpose() * (M.transpose() * tests.residuals());
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(S.rows());
  double explained = 0.0;
  for (Eigen::Index mode = 0; mode < S.rows(); ++mode) {
    if (modes.eigenvalues()[mode] < least) continue;
    inverse[mode] = 1.0 / modes.eigenvalues()[mode];
    explained += g[mode] * g[mode] * inverse[mode];
  }
  const double left = tests.residuals().squaredNorm() - explained;
  const double dof = static_cast<double>(fit.adjustment.dof) - static_cast<double>(S.rows());
  const Eigen::MatrixXd told = modes.eigenvectors() * inverse.asDiagonal() *
                               modes.eigenvectors().transpose() * (M.transpose() * traces);
  response.rivals.resize(static_cast<std::size_t>(traces.cols()));
  const double dispersion = dof > 0.0 ? std::max(1.0, left / dof) : tests.dispersion();
  std::vector<ResponseBin> seen;
  for (Eigen::Index k = 0; k < S.rows(); ++k) {
    if (!(S(k, k) > 0.0)) continue;
    const Eigen::VectorXd part = modes.eigenvectors().row(k);
    ResponseBin bin = bins[static_cast<std::size_t>(k)];
    bin.estimate = -part.dot(inverse.cwiseProduct(g));
    bin.sd = std::sqrt(dispersion * part.dot(inverse.cwiseProduct(part)));
    if (!(bin.sd > 0.0)) continue;
    seen.push_back(bin);
    for (Eigen::Index rival = 0; rival < traces.cols(); ++rival) {
      response.rivals[static_cast<std::size_t>(rival)].emplace_back(bin.at, told(k, rival));
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

EffectRange range_of(const Effect& effect, const ShapeContext& context) {
  const std::size_t sessions = context.recordings().size();
  const std::vector<double> coefficients = coefficients_of(effect, sessions);
  EffectRange range;
  bool first = true;
  std::vector<std::vector<std::vector<double>>> shapes;
  for (const Shape& shape : effect.shape) {
    shapes.push_back(context.values(shape, ShapeContext::Instant::middle));
  }
  for (std::size_t s = 0; s < sessions; ++s) {
    const Drive& drive = context.recordings()[s].drive;
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      if (drive.left[row] == 0.0 && drive.right[row] == 0.0) continue;
      double g = 0.0;
      for (std::size_t k = 0; k < shapes.size(); ++k) {
        const std::size_t place = effect.per_session ? s * shapes.size() + k : k;
        g += coefficients.at(place) * shapes[k][s][row];
      }
      range.least = first ? g : std::min(range.least, g);
      range.most = first ? g : std::max(range.most, g);
      first = false;
    }
  }
  return range;
}

std::string natural_variable(const Effect& effect) {
  std::set<std::string> names;
  for (const Shape& shape : effect.shape) {
    names.insert(shape.variables().begin(), shape.variables().end());
  }
  names.erase("session");
  if (names.contains("x") || names.contains("y")) return {};
  if (!names.empty()) return *names.begin();
  switch (effect.channel) {
    case Channel::turn:
    case Channel::drift:
    case Channel::rotate:
      return "turn_rate";
    case Channel::compass:
      return "heading";
    default:
      return "speed";
  }
}

std::vector<Vector2> effect_curve(const Effect& effect, const std::string& variable, double low,
                                  double high) {
  if (effect.coefficients.size() != effect.shape.size()) return {};
  std::vector<double> at;
  for (int k = 0; k < kCurvePoints; ++k) at.push_back(low + (high - low) * k / (kCurvePoints - 1));
  std::vector<Vector2> curve;
  for (const double value : at) curve.emplace_back(value, 0.0);
  const std::optional<Vector2> place = variable == kPlace ? place_of(effect) : std::nullopt;
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
                              const std::string& variable, const std::vector<Vector2>& told) {
  if (curve.empty() || told.empty()) return curve;
  std::vector<double> off;
  for (const Vector2& bin : told) {
    const std::vector<Vector2> here = effect_curve(effect, variable, bin.x(), bin.x());
    if (here.empty()) return curve;
    off.push_back(bin.y() - here.front().y());
  }
  // The median: a bin across a step has a mean of both sides.
  std::nth_element(off.begin(), off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2),
                   off.end());
  for (Vector2& point : curve) point.y() += off[off.size() / 2];
  return curve;
}

}  // namespace

Response response_along(const std::string& variable, const Effect& effect, const ModelFit& fit,
                        const ScoreTest& tests, const std::vector<Effect>& rivals) {
  const ChannelFacts& facts = facts_of(effect.channel);
  Response result;
  result.channel = effect.channel;
  result.unit = facts.unit;
  result.variable = variable;
  const std::optional<Shape> formula = formula_of(variable, effect);
  if (!formula) return result;
  const std::vector<double> values = values_of(*formula, fit, tests);
  if (values.empty()) return result;
  Bins bins = bins_of(*formula, values);
  if (bins.bins.empty()) return result;
  Effect probe;
  probe.name = std::string(facts.name) + " along " + variable;
  probe.channel = effect.channel;
  probe.shape = std::move(bins.shapes);
  const std::vector<Score> scores = tests.test({probe});
  result.bins = std::move(bins.bins);
  std::vector<Effect> traced = rivals;
  traced.push_back(effect);
  estimate(result, scores.front(), facts.prior_sd, fit, tests, traces_of(traced, tests));
  const std::vector<Vector2> told = std::move(result.rivals.back());
  result.rivals.pop_back();
  if (result.bins.empty()) return result;
  const bool round = variable == "heading";
  const double low = round ? 0.0 : result.bins.front().at;
  const double high = round ? kTurn : result.bins.back().at;
  result.curve = levelled(effect_curve(effect, variable, low, high), effect, variable, told);
  for (std::size_t k = 0; k < rivals.size(); ++k) {
    if (rivals[k].channel != effect.channel || variable == kPlace) continue;
    std::vector<Vector2> own = levelled(effect_curve(rivals[k], variable, low, high), rivals[k],
                                        variable, result.rivals[k]);
    if (!own.empty()) result.rivals[k] = std::move(own);
  }
  return result;
}

}  // namespace trussmap
