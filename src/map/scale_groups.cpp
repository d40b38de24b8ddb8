// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/scale_groups.hpp"

#include <algorithm>
#include <queue>
#include <set>
#include <utility>

namespace trussmap::map {
namespace {

int at_or_none(const std::vector<int>& groups, int member) {
  return member >= 0 && idx(member) < groups.size() ? groups[idx(member)] : -1;
}

}  // namespace

void ScaleGroups::add(int landmark, int from) {
  if (landmark == 0) return;
  int fresh = landmark;
  int beside = from;
  for (std::size_t l = 0;; ++l) {
    // A level more once the one below has groups to be grouped.
    if (l == levels_.size()) {
      if (l > 0 && levels_[l - 1].members.size() < 2) return;
      levels_.emplace_back();
    }
    Level& level = levels_[l];
    if (level.group.size() <= idx(fresh)) level.group.resize(idx(fresh) + 1, -1);
    if (level.group[idx(fresh)] >= 0) return;
    int group = at_or_none(level.group, beside);
    const bool full =
        group < 0 || std::ssize(level.members[idx(group)]) >= static_cast<std::ptrdiff_t>(kSize);
    if (full) {
      const int before = group;
      group = static_cast<int>(level.members.size());
      level.members.emplace_back();
      level.ties.emplace_back();
      level.seed.push_back(landmark);
      beside = before;
    } else {
      beside = group;
    }
    level.group[idx(fresh)] = group;
    level.members[idx(group)].push_back(fresh);
    fresh = group;
    // A new level starts with the groups that were there before.
    if (l + 1 == levels_.size() && level.members.size() == 2) {
      Level next;
      next.group = {0, 0};
      next.members = {{0, 1}};
      next.ties.emplace_back();
      next.seed = {level.seed.front()};
      levels_.push_back(std::move(next));
      return;
    }
  }
}

void ScaleGroups::tie(int a, int b) {
  for (Level& level : levels_) {
    a = at_or_none(level.group, a);
    b = at_or_none(level.group, b);
    if (a < 0 || b < 0 || a == b) return;
    std::vector<int>& of_a = level.ties[idx(a)];
    if (std::find(of_a.begin(), of_a.end(), b) != of_a.end()) continue;
    of_a.push_back(b);
    level.ties[idx(b)].push_back(a);
  }
}

int ScaleGroups::group_of(int level, int landmark) const {
  int member = landmark;
  for (int l = 0; l <= level; ++l) member = at_or_none(levels_[idx(l)].group, member);
  return member;
}

void ScaleGroups::members(int level, int group, std::vector<int>& landmarks) const {
  for (const int member : levels_[idx(level)].members[idx(group)]) {
    if (level == 0) {
      landmarks.push_back(member);
    } else {
      members(level - 1, member, landmarks);
    }
  }
}

std::vector<int> ScaleGroups::nearest(int level, int a, int b, int count,
                                      const std::function<double(int)>& distance) const {
  using Reached = std::pair<double, int>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
  std::set<int> seen;
  const auto reach = [&](int group) {
    if (group < 0 || !seen.insert(group).second) return;
    next.emplace(distance(seed(level, group)), group);
  };
  reach(group_of(level, a));
  reach(group_of(level, b));
  std::vector<int> found;
  while (!next.empty() && std::ssize(found) < count) {
    found.push_back(next.top().second);
    next.pop();
    for (const int other : levels_[idx(level)].ties[idx(found.back())]) reach(other);
  }
  return found;
}

}  // namespace trussmap::map
