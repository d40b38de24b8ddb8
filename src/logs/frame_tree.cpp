// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/frame_tree.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::logs {
namespace {

constexpr std::size_t kDeepest = 100;  // links from a frame to its root

/// ROS of old wrote /base_link.
std::string plain(std::string_view frame) {
  if (frame.starts_with('/')) frame.remove_prefix(1);
  return std::string(frame);
}

std::optional<Eigen::Isometry3d> at_time(const FrameLink& link, std::int64_t t) {
  if (link.samples.empty()) return std::nullopt;
  const auto isometry = [](const Eigen::Vector3d& translation, const Eigen::Quaterniond& rotation) {
    Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
    result.linear() = rotation.toRotationMatrix();
    result.translation() = translation;
    return result;
  };
  if (link.is_static) {
    return isometry(link.samples.back().translation, link.samples.back().rotation);
  }
  const auto after = std::lower_bound(
      link.samples.begin(), link.samples.end(), t,
      [](const FrameSample& sample, std::int64_t time) { return sample.t < time; });
  if (after == link.samples.end()) return std::nullopt;
  if (after->t == t) return isometry(after->translation, after->rotation);
  if (after == link.samples.begin()) return std::nullopt;
  const FrameSample& before = *(after - 1);
  const double share = static_cast<double>(t - before.t) / static_cast<double>(after->t - before.t);
  return isometry(before.translation + share * (after->translation - before.translation),
                  before.rotation.slerp(share, after->rotation));
}

}  // namespace

bool is_like(std::string_view name, std::string_view pattern) {
  // The last * and what it has taken so far: on a mismatch it takes one more.
  std::size_t n = 0;
  std::size_t p = 0;
  std::size_t star = std::string_view::npos;
  std::size_t taken = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      taken = n;
    } else if (p < pattern.size() && pattern[p] == name[n]) {
      ++p;
      ++n;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++taken;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

PlanarAxis planar_axis(const Eigen::Matrix3d& rotation, char axis) {
  const Eigen::Vector3d direction = rotation.col(axis == 'x' ? 0 : axis == 'y' ? 1 : 2);
  return {std::atan2(direction.y(), direction.x()), std::hypot(direction.x(), direction.y())};
}

void FrameTree::wants(const std::string& frame) {
  wanted_.insert(plain(frame));
}

bool FrameTree::add(std::string_view parent, std::string_view child, const FrameSample& sample,
                    bool is_static) {
  constexpr double kUnit = 0.1;  // how far off 1 a quaternion's length may be: floats, rounding
  const double norm = sample.rotation.norm();
  if (!(std::abs(norm - 1.0) < kUnit) || !sample.translation.allFinite() ||
      plain(parent) == plain(child)) {
    return false;
  }
  FrameLink& link = links_[plain(child)];
  link.parent = plain(parent);
  link.is_static = is_static;
  if (is_static) link.samples.clear();
  FrameSample& added = link.samples.emplace_back(sample);
  added.rotation.normalize();
  if (++samples_ >= prune_at_) prune();
  return true;
}

void FrameTree::sort() {
  for (auto& [child, link] : links_) {
    std::stable_sort(link.samples.begin(), link.samples.end(),
                     [](const FrameSample& a, const FrameSample& b) { return a.t < b.t; });
    std::vector<FrameSample> once;
    for (const FrameSample& one : link.samples) {
      if (!once.empty() && once.back().t == one.t) once.pop_back();
      once.push_back(one);
    }
    link.samples = std::move(once);
  }
}

bool FrameTree::knows(const std::string& frame) const {
  if (links_.contains(plain(frame))) return true;
  return std::any_of(links_.begin(), links_.end(),
                     [&](const auto& link) { return link.second.parent == plain(frame); });
}

std::vector<std::string> FrameTree::children_like(std::string_view pattern) const {
  std::vector<std::string> found;
  for (const auto& [child, link] : links_) {
    if (is_like(child, plain(pattern))) found.push_back(child);
  }
  return found;
}

std::vector<std::string> FrameTree::ancestors(const std::string& frame) const {
  std::vector<std::string> chain{plain(frame)};
  while (chain.size() < kDeepest) {
    const auto link = links_.find(chain.back());
    if (link == links_.end()) break;
    chain.push_back(link->second.parent);
  }
  return chain;
}

std::optional<Eigen::Isometry3d> FrameTree::transform(const std::string& parent,
                                                      const std::string& child,
                                                      std::int64_t t) const {
  const std::vector<std::string> up = ancestors(child);
  const std::vector<std::string> down = ancestors(parent);
  const auto common = std::find_first_of(up.begin(), up.end(), down.begin(), down.end());
  if (common == up.end()) return std::nullopt;
  const auto chain = [&](const std::vector<std::string>& frames) {
    std::optional<Eigen::Isometry3d> result = Eigen::Isometry3d::Identity();
    for (const std::string& frame : frames) {
      if (frame == *common) break;
      const auto link = at_time(links_.find(frame)->second, t);
      if (!link) return std::optional<Eigen::Isometry3d>();
      result = *link * *result;
    }
    return result;
  };
  const auto of_child = chain(up);
  const auto of_parent = chain(down);
  if (!of_child || !of_parent) return std::nullopt;
  return of_parent->inverse() * *of_child;
}

bool FrameTree::are_joined(const std::string& parent, const std::string& child) const {
  return knows(parent) && knows(child) && ancestors(parent).back() == ancestors(child).back();
}

std::vector<std::int64_t> FrameTree::times(const std::string& parent,
                                           const std::string& child) const {
  if (!are_joined(parent, child)) return {};
  const std::vector<std::string> up = ancestors(child);
  std::vector<std::string> down = ancestors(parent);
  const auto common = std::find_first_of(up.begin(), up.end(), down.begin(), down.end());
  std::vector<std::string> way(up.begin(), common);
  const auto end = std::find(down.begin(), down.end(), *common);
  way.insert(way.end(), std::make_reverse_iterator(end), down.rend());
  for (const std::string& frame : way) {
    const FrameLink& link = links_.find(frame)->second;
    if (link.is_static) continue;
    std::vector<std::int64_t> found;
    found.reserve(link.samples.size());
    for (const FrameSample& one : link.samples) found.push_back(one.t);
    return found;
  }
  return {};
}

/// Links on chains from the frames that are wanted.
std::set<std::string> FrameTree::needed() const {
  std::set<std::string> needed;
  for (const auto& link : links_) {
    const std::string& child = link.first;
    const bool asked =
        std::any_of(wanted_.begin(), wanted_.end(),
                    [&child](const std::string& one) { return is_like(child, one); });
    if (!asked) continue;
    for (const std::string& frame : ancestors(child)) needed.insert(frame);
  }
  return needed;
}

std::vector<std::string> FrameTree::lost() const {
  std::vector<std::string> found;
  if (pruned_.empty()) return found;
  for (const std::string& frame : needed()) {
    if (pruned_.contains(frame)) found.push_back(frame);
  }
  return found;
}

/// A robot's joints move a hundred times a second: what is on no chain that is asked for goes.
void FrameTree::prune() {
  prune_at_ = 2 * samples_;
  if (wanted_.empty()) return;
  const std::set<std::string> needed = this->needed();
  samples_ = 0;
  for (auto& [child, link] : links_) {
    if (!needed.contains(child) && !link.samples.empty()) {
      if (!link.is_static && link.samples.size() > 1) pruned_.insert(child);
      link.samples.erase(link.samples.begin(), link.samples.end() - 1);
      link.samples.shrink_to_fit();
    }
    samples_ += link.samples.size();
  }
  prune_at_ = std::max<std::size_t>(200000, 2 * samples_);
}

}  // namespace trussmap::logs
