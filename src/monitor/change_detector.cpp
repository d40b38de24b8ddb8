// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "monitor/change_detector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace trussmap::monitor {
namespace {

/// Beyond, evidence is not told any more: it stays a finite number.
constexpr double kMostEvidence = 1e300;

double log_of_sum(const Eigen::ArrayXd& logs) {
  const double most = logs.maxCoeff();
  return std::isfinite(most) ? most + std::log((logs - most).exp().sum()) : most;
}

}  // namespace

ChangeDetector::ChangeDetector(const DetectorOptions& options, std::vector<double> usual)
    : options_(options),
      usual_(
          Eigen::Map<const Eigen::ArrayXd>(usual.data(), static_cast<Eigen::Index>(usual.size()))) {
  starts_.reserve(options.starts + 1);
}

/// Logarithms of weight x E, per effect.
Eigen::ArrayXd ChangeDetector::log_parts(const Start& start, const Eigen::ArrayXd& sum) const {
  const Eigen::ArrayXd s2 = usual_.square();
  const Eigen::ArrayXd spread =
      1.0 + s2 * options_.margin * options_.margin * start.gram.diagonal().array();
  return start.log_weight - 0.5 * spread.log() + 0.5 * s2 * sum.square() / spread;
}

std::optional<std::size_t> ChangeDetector::make_room() {
  if (!starts_.empty() && leg_ + 2 - starts_.front().leg > options_.horizon) {
    starts_.erase(starts_.begin());
    return 0;
  }
  if (starts_.size() < options_.starts) return std::nullopt;
  const auto age = [&](std::size_t k) { return static_cast<double>(leg_ + 2 - starts_[k].leg); };
  std::size_t pair = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < starts_.size(); ++k) {
    const double ratio = age(k) / age(k + 1);
    if (ratio >= least) continue;
    least = ratio;
    pair = k;
  }
  const Eigen::ArrayXd older = log_parts(starts_[pair]);
  const Eigen::ArrayXd younger = log_parts(starts_[pair + 1]);
  const bool keeps_older = log_of_sum(older) >= log_of_sum(younger);
  const std::size_t gone = keeps_older ? pair + 1 : pair;
  const Eigen::ArrayXd& kept = keeps_older ? older : younger;
  const Eigen::ArrayXd& given = keeps_older ? younger : older;
  starts_[keeps_older ? pair : pair + 1].log_weight +=
      (given - kept).max(0.0) + (1.0 + (-(given - kept).abs()).exp()).log();
  starts_.erase(starts_.begin() + static_cast<std::ptrdiff_t>(gone));
  return gone;
}

void ChangeDetector::begin(long leg, double hours) {
  const Eigen::Index effects = usual_.size();
  leg_ = leg;
  Start start;
  start.leg = leg;
  start.log_weight = Eigen::ArrayXd::Constant(
      effects, std::log(options_.rate * hours / static_cast<double>(effects)));
  start.clipped = start.measured = Eigen::ArrayXd::Zero(effects);
  start.gram = Eigen::MatrixXd::Zero(effects, effects);
  starts_.push_back(std::move(start));
}

void ChangeDetector::take(const Eigen::VectorXd& whitened, const Eigen::MatrixXd& columns) {
  const Eigen::VectorXd clipped = whitened.cwiseMax(-options_.clip).cwiseMin(options_.clip);
  const Eigen::Index effects = usual_.size();
  for (std::size_t k = 0; k < starts_.size(); ++k) {
    Eigen::MatrixXd h = columns.middleCols(static_cast<Eigen::Index>(k) * effects, effects);
    const Eigen::ArrayXXd seen = (h * usual_.matrix().asDiagonal()).array().abs();
    h = (seen < options_.floor).select(0.0, h);
    starts_[k].clipped += (h.transpose() * clipped).array();
    starts_[k].measured += (h.transpose() * whitened).array();
    starts_[k].gram.noalias() += h.transpose() * h;
  }
}

void ChangeDetector::alarmed(long leg) {
  alarm_ = leg;
}

void ChangeDetector::clear() {
  starts_.clear();
  alarm_.reset();
}

std::size_t ChangeDetector::telling() const {
  if (!alarm_) return starts_.size();
  const auto after = std::find_if(starts_.begin(), starts_.end(),
                                  [this](const Start& one) { return one.leg > *alarm_; });
  return after == starts_.begin() ? starts_.size()
                                  : static_cast<std::size_t>(after - starts_.begin());
}

double ChangeDetector::evidence() const {
  double sum = 0.0;
  for (const Start& start : starts_) sum += log_parts(start).exp().sum();
  return std::min(sum, kMostEvidence);
}

std::vector<double> ChangeDetector::shares() const {
  const auto effects = static_cast<std::size_t>(usual_.size());
  std::vector<double> logs(effects);
  for (std::size_t effect = 0; effect < effects; ++effect) {
    Eigen::ArrayXd parts(static_cast<Eigen::Index>(telling()));
    for (std::size_t k = 0; k < telling(); ++k) {
      parts[static_cast<Eigen::Index>(k)] =
          log_naming(starts_[k])[static_cast<Eigen::Index>(effect)];
    }
    logs[effect] = log_of_sum(parts);
  }
  const double all = log_of_sum(Eigen::Map<const Eigen::ArrayXd>(logs.data(), usual_.size()));
  for (double& one : logs) one = std::exp(one - all);
  return logs;
}

EffectSince ChangeDetector::likeliest(std::size_t effect) const {
  const auto at = static_cast<Eigen::Index>(effect);
  std::size_t best = 0;
  for (std::size_t k = 1; k < telling(); ++k) {
    if (log_naming(starts_[k])[at] > log_naming(starts_[best])[at]) best = k;
  }
  const Start& start = starts_[best];
  const double Q = start.gram(at, at);
  EffectSince since{best, effect, start.leg};
  if (!(Q > 0.0)) return since;
  since.coefficient = start.measured[at] / Q;
  since.sd = options_.margin / std::sqrt(Q);
  return since;
}

std::pair<long, long> ChangeDetector::since(std::size_t effect, double share) const {
  const auto at = static_cast<Eigen::Index>(effect);
  std::vector<std::pair<double, long>> parts;
  for (std::size_t k = 0; k < telling(); ++k) {
    parts.emplace_back(log_naming(starts_[k])[at], starts_[k].leg);
  }
  std::sort(parts.rbegin(), parts.rend());
  double sum = 0.0;
  for (const auto& [part, leg] : parts) sum += std::exp(part - parts.front().first);
  std::pair<long, long> legs{parts.front().second, parts.front().second};
  double taken = 0.0;
  for (const auto& [part, leg] : parts) {
    legs = {std::min(legs.first, leg), std::max(legs.second, leg)};
    taken += std::exp(part - parts.front().first);
    if (taken >= share * sum) break;
  }
  return legs;
}

double ChangeDetector::cosine(std::size_t start, std::size_t a, std::size_t b) const {
  const Eigen::MatrixXd& gram = starts_[start].gram;
  const auto i = static_cast<Eigen::Index>(a);
  const auto j = static_cast<Eigen::Index>(b);
  const double both = std::sqrt(gram(i, i) * gram(j, j));
  return both > 0.0 ? gram(i, j) / both : 0.0;
}

}  // namespace trussmap::monitor
