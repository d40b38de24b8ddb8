// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/noise_mix.hpp"

#include "effects/channel_record.hpp"
#include "fit/fit_numbers.hpp"
#include "linalg/dense.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace trussmap::fitting {
namespace {

constexpr double kNear = 5e-7;  // of a logarithm: at its limit

/// More than effects may be, noise is not either.
double scale_of(const NoiseComponent& one) {
  return one.lasts() ? facts_of(one.process.channel).prior_sd : kMostOfALaw;
}

/// Of a matrix that may have slightly negative eigenvalues.
Eigen::MatrixXd square_root(const Eigen::MatrixXd& matrix) {
  const linalg::SymmetricModes modes = linalg::symmetric_modes(matrix);
  return modes.eigenvectors * modes.eigenvalues.cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         modes.eigenvectors.transpose();
}

}  // namespace

bool NoiseMix::has(const std::string& component) const {
  return std::any_of(members.begin(), members.end(),
                     [&](const NoiseMember& member) { return member.component.name == component; });
}

bool NoiseMix::is_beside_a_process(std::size_t member) const {
  return std::any_of(members.begin(), members.end(), [&](const NoiseMember& one) {
    return one.component.lasts() &&
           white_source_of(one.component) == members[member].component.name;
  });
}

std::vector<bool> NoiseMix::free() const {
  std::vector<bool> result;
  result.reserve(members.size());
  for (const NoiseMember& one : members) result.push_back(one.free);
  return result;
}

std::string white_source_of(const NoiseComponent& process) {
  return std::string(effects::record_of(process.process.channel).noise_source);
}

NoiseReml::Sizes sizes_of(const NoiseMix& mix) {
  NoiseReml::Sizes sizes;
  for (const NoiseMember& one : mix.members) {
    sizes.sd.push_back(one.sd);
    sizes.length.push_back(one.length);
  }
  return sizes;
}

void choose(NoiseReml& reml, const NoiseMix& mix) {
  std::vector<NoiseComponent> components;
  components.reserve(mix.members.size());
  for (const NoiseMember& one : mix.members) components.push_back(one.component);
  reml.choose(components);
}

double deviance(NoiseReml& reml, const NoiseReml::Sizes& sizes) {
  try {
    return reml.minus_two_log(sizes);
  } catch (const linalg::NotPositiveDefinite&) {
    return std::numeric_limits<double>::infinity();
  }
}

NoiseExtents extents_of(const FitState& fit) {
  NoiseExtents extents;
  for (const DrivenRecording& one : fit.recordings) {
    extents.time += one.drive.rows() > 0 ? one.drive.t.back() - one.drive.start() : 0.0;
  }
  for (const std::vector<estimation::SegmentRow>& rows : fit.problem.segments) {
    for (const estimation::SegmentRow& row : rows) extents.way += std::abs(row.path);
  }
  return extents;
}

NoiseLogarithms::NoiseLogarithms(const NoiseMix& mix, const NoiseExtents& extents,
                                 const std::vector<bool>& vary)
    : sizes_(sizes_of(mix)) {
  for (std::size_t k = 0; k < mix.members.size(); ++k) {
    if (!vary[k]) continue;
    places_.push_back({k, false});
    ranges_.push_back(range_of_sd(mix, k));
  }
  for (std::size_t k = 0; k < mix.members.size(); ++k) {
    if (!vary[k] || !(mix.members[k].length > 0.0)) continue;
    places_.push_back({k, true});
    ranges_.push_back(range_of_length(mix.members[k], extents));
  }
}

NoiseLogarithms::Range NoiseLogarithms::range_of_length(const NoiseMember& member,
                                                        const NoiseExtents& extents) {
  const NoiseProcess& process = member.component.process;
  const bool in_time = process.process == ProcessKind::correlated_in_t;
  const double limit =
      effects::acts_on(process.channel) == effects::ActsOn::views ? kLongestOfViews : kLongest;
  const double most = std::min(limit, kLongestShare * (in_time ? extents.time : extents.way));
  return {std::log(kShortest), std::log(std::max(most, 2.0 * kShortest))};
}

NoiseLogarithms::Range NoiseLogarithms::range_of_sd(const NoiseMix& mix, std::size_t member) {
  const NoiseComponent& component = mix.members[member].component;
  if (!(component.stated > 0.0)) {
    const double scale = std::log(scale_of(component));
    return {scale - 3.0 * kReach, scale};
  }
  const double stated = std::log(component.stated);
  const bool scattered = component.name == "compass";  // known from readings alone
  const double least =
      std::log(mix.is_beside_a_process(member) ? kLeastBesideAProcess : kLeastOfStated);
  return {stated - (scattered ? kReach : least), stated + kReach};
}

Eigen::VectorXd NoiseLogarithms::values() const {
  Eigen::VectorXd x(static_cast<Eigen::Index>(places_.size()));
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const auto& list = places_[k].length ? sizes_.length : sizes_.sd;
    x[static_cast<Eigen::Index>(k)] = std::log(list[places_[k].member]);
  }
  return x;
}

NoiseReml::Sizes NoiseLogarithms::sizes(const Eigen::VectorXd& values) const {
  NoiseReml::Sizes result = sizes_;
  for (std::size_t k = 0; k < places_.size(); ++k) {
    auto& list = places_[k].length ? result.length : result.sd;
    list[places_[k].member] = std::exp(values[static_cast<Eigen::Index>(k)]);
  }
  return result;
}

Eigen::VectorXd NoiseLogarithms::bounded(Eigen::VectorXd values) const {
  for (std::size_t k = 0; k < ranges_.size(); ++k) {
    double& value = values[static_cast<Eigen::Index>(k)];
    value = std::clamp(value, ranges_[k].least, ranges_[k].most);
  }
  return values;
}

bool NoiseLogarithms::at_largest(std::size_t member) const {
  const Eigen::VectorXd x = values();
  for (std::size_t k = 0; k < places_.size(); ++k) {
    if (places_[k].member != member || places_[k].length) continue;
    if (x[static_cast<Eigen::Index>(k)] + kNear > ranges_[k].most) return true;
  }
  return false;
}

bool NoiseLogarithms::at_limit(std::size_t member) const {
  const Eigen::VectorXd x = values();
  for (std::size_t k = 0; k < places_.size(); ++k) {
    if (places_[k].member != member) continue;
    const double at = x[static_cast<Eigen::Index>(k)];
    if (at - kNear < ranges_[k].least || at + kNear > ranges_[k].most) return true;
  }
  return false;
}

NoiseMix likeliest(NoiseReml& reml, NoiseMix mix, const NoiseExtents& extents,
                   const std::vector<bool>& vary, int most_steps, double least_gain) {
  const NoiseLogarithms logarithms(mix, extents, vary);
  if (logarithms.places().empty()) return mix;
  const NoiseSearch search{
      [&](const Eigen::VectorXd& x) { return deviance(reml, logarithms.sizes(x)); },
      [&](Eigen::VectorXd x) { return logarithms.bounded(std::move(x)); }, most_steps, least_gain};
  const LikeliestNoise found = likeliest_noise(search, logarithms.values());
  const NoiseReml::Sizes sizes = logarithms.sizes(found.x);
  for (std::size_t k = 0; k < mix.members.size(); ++k) {
    mix.members[k].sd = sizes.sd[k];
    mix.members[k].length = sizes.length[k];
  }
  mix.minus_two_log = found.loss;
  return mix;
}

/// The readings' scatter and the adjustment see the same errors of the wheels, each in its own way,
/// and what both say is no more than once true: the scores' covariance is taken as if they went
/// together wherever they can (Godambe 1960; Varin, Reid & Firth 2011, on composite likelihoods),
/// H^-1 J H^-1 with J = A + S + A^(1/2) S^(1/2) + S^(1/2) A^(1/2).
Eigen::VectorXd standard_errors(NoiseReml& reml, const NoiseLogarithms& logarithms) {
  const Eigen::VectorXd x = logarithms.values();
  const auto scatter = [&](const Eigen::VectorXd& at) {
    return reml.scatter(logarithms.sizes(at));
  };
  const auto whole = [&](const Eigen::VectorXd& at) {
    return deviance(reml, logarithms.sizes(at));
  };
  // -2 log is twice the information.
  const Eigen::MatrixXd H = 0.5 * curvatures(whole, x);
  const Eigen::MatrixXd S = 0.5 * curvatures(scatter, x);
  const Eigen::MatrixXd both = square_root(H - S) * square_root(S);
  const Eigen::MatrixXd J = H + both + both.transpose();
  const linalg::SymmetricModes modes = linalg::symmetric_modes(H);
  const Eigen::VectorXd information = modes.eigenvalues.cwiseMax(kLeastInformation);
  const Eigen::MatrixXd inverse =
      modes.eigenvectors * information.cwiseInverse().asDiagonal() * modes.eigenvectors.transpose();
  const Eigen::VectorXd variances = (inverse * J * inverse).diagonal();
  return variances.cwiseMax(inverse.diagonal()).cwiseSqrt();
}

}  // namespace trussmap::fitting
