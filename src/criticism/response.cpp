// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/criticism/response.hpp"

#include "trussmap/effects/catalogue.hpp"
#include "trussmap/effects/shape.hpp"

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

/// The variable in all rows in which a wheel turns, in order.
std::vector<double> values_of(const std::string& variable, const ModelFit& fit,
                              const ScoreTest& tests) {
  std::vector<double> values;
  for (std::size_t s = 0; s < fit.recordings.size(); ++s) {
    const Drive& drive = fit.recordings[s].drive;
    const RowVariables& rows = tests.context().variables(s, ShapeContext::Instant::middle);
    const auto found = rows.find(variable);
    if (found == rows.end()) return {};
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      if (drive.left[row] == 0.0 && drive.right[row] == 0.0) continue;
      values.push_back(variable == "heading" ? in_one_turn(found->second[row])
                                             : found->second[row]);
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
  std::vector<std::string> shapes;
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
    result.shapes.push_back(
        fmt::format("(1+sign(cos(heading-({:.9g}))-({:.9g})))/2", middle, std::cos(0.5 * width)));
  }
  return result;
}

Bins bins_of(const std::string& variable, const std::vector<double>& values) {
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
    result.shapes.push_back(fmt::format("(sign({0}-({1:.9g}))-sign({0}-({2:.9g})))/2", variable,
                                        edges[k], edges[k + 1]));
    from = to;
  }
  return result;
}

/// Least squares by the modes that the data show; bins that no measurement sees are dropped.
void estimate(std::vector<ResponseBin>& bins, const Score& score, double plausible,
              const ModelFit& fit, const ScoreTest& tests) {
  const Eigen::MatrixXd& M = score.projected;
  const Eigen::MatrixXd S = M.transpose() * M;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(S);
  const double least =
      9.0 * tests.dispersion() / (plausible * plausible * static_cast<double>(bins.size()));
  const Eigen::VectorXd g = modes.eigenvectors().transpose() * (M.transpose() * tests.residuals());
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(S.rows());
  double explained = 0.0;
  for (Eigen::Index mode = 0; mode < S.rows(); ++mode) {
    if (modes.eigenvalues()[mode] < least) continue;
    inverse[mode] = 1.0 / modes.eigenvalues()[mode];
    explained += g[mode] * g[mode] * inverse[mode];
  }
  const double left = fit.adjustment.chi2 - explained;
  const double dof = static_cast<double>(fit.adjustment.dof) - static_cast<double>(S.rows());
  const double dispersion = dof > 0.0 ? std::max(1.0, left / dof) : tests.dispersion();
  std::vector<ResponseBin> seen;
  for (Eigen::Index k = 0; k < S.rows(); ++k) {
    if (!(S(k, k) > 0.0)) continue;
    const Eigen::VectorXd part = modes.eigenvectors().row(k);
    ResponseBin bin = bins[static_cast<std::size_t>(k)];
    bin.estimate = -part.dot(inverse.cwiseProduct(g));
    bin.sd = std::sqrt(dispersion * part.dot(inverse.cwiseProduct(part)));
    if (bin.sd > 0.0) seen.push_back(bin);
  }
  bins = std::move(seen);
}

}  // namespace

std::string natural_variable(const Effect& effect) {
  std::set<std::string> names;
  for (const std::string& shape : effect.shape) {
    for (std::string& name : variables_of(shape)) names.insert(std::move(name));
  }
  names.erase("session");
  if (names.contains("x") || names.contains("y")) return {};
  if (!names.empty()) return *names.begin();
  const std::string& channel = effect.channel;
  if (channel == "turn" || channel == "drift" || channel == "rotate") return "turn_rate";
  return channel == "compass" ? "heading" : "speed";
}

std::vector<Vector2> effect_curve(const Effect& effect, const std::string& variable, double low,
                                  double high) {
  if (effect.coefficients.size() != effect.shape.size()) return {};
  std::vector<double> at;
  for (int k = 0; k < kCurvePoints; ++k) at.push_back(low + (high - low) * k / (kCurvePoints - 1));
  std::vector<Vector2> curve;
  for (const double value : at) curve.emplace_back(value, 0.0);
  for (std::size_t shape = 0; shape < effect.shape.size(); ++shape) {
    for (const std::string& name : variables_of(effect.shape[shape])) {
      if (name != variable) return {};
    }
    RowVariables variables;
    variables[variable] = at;
    try {
      const std::vector<double> f = evaluate_shape(effect.shape[shape], variables);
      for (std::size_t k = 0; k < f.size() && k < curve.size(); ++k) {
        curve[k].y() += effect.coefficients[shape] * f[k];
      }
    } catch (const std::invalid_argument&) {  // not finite somewhere
      return {};
    }
  }
  return curve;
}

Response response_along(const std::string& variable, const Effect& effect, const ModelFit& fit,
                        const ScoreTest& tests) {
  const ChannelFacts& facts = facts_of(parse_channel(effect.channel).value());
  Response result;
  result.channel = effect.channel;
  result.unit = facts.unit;
  result.variable = variable;
  const std::vector<double> values = values_of(variable, fit, tests);
  if (values.empty()) return result;
  Bins bins = bins_of(variable, values);
  if (bins.bins.empty()) return result;
  Effect probe;
  probe.name = effect.channel + " along " + variable;
  probe.channel = effect.channel;
  probe.shape = std::move(bins.shapes);
  const std::vector<Score> scores = tests.test({probe});
  result.bins = std::move(bins.bins);
  estimate(result.bins, scores.front(), facts.plausible, fit, tests);
  if (result.bins.empty()) return result;
  const bool round = variable == "heading";
  result.curve = effect_curve(effect, variable, round ? 0.0 : result.bins.front().at,
                              round ? kTurn : result.bins.back().at);
  return result;
}

}  // namespace trussmap
