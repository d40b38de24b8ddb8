// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/scale_sums.hpp"

#include "geometry/make_room.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace trussmap::map {

void ScaleSums::clear() noexcept {
  levels_.clear();
  home_.clear();
  seen_.clear();
  changes_.clear();
}

// ---------------------------------------- frames and positions

/// A group's places in the map.
Affine ScaleSums::frame_of(int level, int group) const {
  const Frame* frame = &level_at(level).frames[idx(group)];
  Affine result = frame->T;
  while (frame->parent >= 0) {
    frame = &level_at(++level).frames[idx(frame->parent)];
    result = after(frame->T, result);
  }
  return result;
}

void ScaleSums::set_frame(int level, int group, const Affine& T) {
  geometry::make_room(changes_);
  Frame& frame = level_at(level).frames[idx(group)];
  changes_.push_back({level, group, frame.T});
  frame.T = T;
}

void ScaleSums::begin() noexcept {
  changes_.clear();
  moved_ = 0;
  largest_move_ = 0.0;
}

void ScaleSums::roll_back() noexcept {
  for (auto one = changes_.rbegin(); one != changes_.rend(); ++one) {
    level_at(one->level).frames[idx(one->group)].T = one->before;
  }
  ++now_;
  begin();
}

Vector2 ScaleSums::position(const truss::ElasticTruss& truss, int landmark) const {
  const Vector2& stored = truss.position(landmark);
  int group = home(landmark);
  if (group < 0 || seen_[idx(group)].when == now_) return stored;
  Vector2 place = seen_[idx(group)].back(stored);
  for (int level = kFinest; group >= 0; ++level) {
    const Frame& frame = level_at(level).frames[idx(group)];
    place = frame.T(place);
    group = frame.parent;
  }
  return place;
}

void ScaleSums::look(truss::ElasticTruss& truss, int landmark) noexcept {
  const int group = home(landmark);
  if (group < 0) return;
  Seen& seen = seen_[idx(group)];
  if (seen.when == now_) return;
  const Affine at = frame_of(kFinest, group);
  for (const int member : level_at(kFinest).groups[idx(group)].members) {
    truss.place(member, at(seen.back(truss.position(member))));
  }
  seen = {at, inverse_of(at), now_};
}

void ScaleSums::look_round(truss::ElasticTruss& truss, const std::vector<int>& landmarks) noexcept {
  if (empty()) return;
  for (const int landmark : landmarks) {
    look(truss, landmark);
    for (const int number : truss.elements_at(landmark)) {
      const truss::Element& bar = truss.element(number);
      look(truss, bar.joints[0] == landmark ? bar.joints[1] : bar.joints[0]);
    }
  }
}

void ScaleSums::settle(truss::ElasticTruss& truss) noexcept {
  for (int landmark = 0; landmark < static_cast<int>(home_.size()); ++landmark) {
    look(truss, landmark);
  }
  clear();
}

void ScaleSums::touch(int landmark) noexcept {
  const int group = home(landmark);
  if (group >= 0) touch_group(kFinest, group);
}

/// The list has room for every group.
void ScaleSums::touch_group(int level, int group) noexcept {
  Level& at = level_at(level);
  if (at.groups[idx(group)].touched) return;
  at.groups[idx(group)].touched = true;
  at.touched.push_back(group);
}

// ---------------------------------------- what is new

void ScaleSums::follow(const ScaleGroups& groups, truss::ElasticTruss& truss) {
  while (coarsest() < groups.levels() - 1) levels_.emplace_back();
  held_ = shift_by(truss.position(0));
  for (int level = coarsest(); level >= kFinest; --level) follow_level(level, groups, truss);
  follow_landmarks(groups, truss);
}

/// Parents come before their members. What was coarsest has parents from now on.
void ScaleSums::follow_level(int level, const ScaleGroups& groups,
                             const truss::ElasticTruss& truss) {
  Level& at = level_at(level);
  const int before = static_cast<int>(at.groups.size());
  const bool top = level == coarsest();
  const bool orphans = before > 0 && !top && at.frames.front().parent < 0;
  for (int group = orphans ? 0 : before; group < groups.groups(level); ++group) {
    const int parent = top ? -1 : groups.parent(level, group);
    const Affine in_map = group < before ? frame_of(level, group)
                                         : shift_by(position(truss, groups.seed(level, group)));
    if (group >= before) {
      geometry::make_room(at.frames);
      geometry::make_room(at.groups);
      if (at.touched.capacity() <= at.groups.size()) at.touched.reserve(2 * at.groups.size() + 2);
      if (level == kFinest) seen_.push_back({in_map, inverse_of(in_map), 0});
      at.frames.emplace_back();
      at.groups.emplace_back();
    }
    if (parent >= 0) {
      std::vector<int>& siblings = level_at(level + 1).groups[idx(parent)].members;
      geometry::make_room(siblings);
      siblings.push_back(group);
      touch_group(level + 1, parent);
    }
    const Affine T = parent < 0 ? in_map : after(inverse_of(frame_of(level + 1, parent)), in_map);
    at.frames[idx(group)] = {T, parent};
    touch_group(level, group);
  }
}

void ScaleSums::follow_landmarks(const ScaleGroups& groups, truss::ElasticTruss& truss) {
  home_.reserve(idx(truss.joints()));
  for (int landmark = static_cast<int>(home_.size()); landmark < truss.joints(); ++landmark) {
    const int group = landmark > 0 ? groups.group_of(kFinest, landmark) : -1;
    if (group >= 0) {
      std::vector<int>& members = level_at(kFinest).groups[idx(group)].members;
      geometry::make_room(members);
      Seen& seen = seen_[idx(group)];
      if (members.empty()) {  // nothing of it to look at
        const Affine at = frame_of(kFinest, group);
        seen = {at, inverse_of(at), now_};
      } else {
        look(truss, members.front());
      }
      members.push_back(landmark);
    }
    home_.push_back(group);
    touch(landmark);
  }
}

// ---------------------------------------- sums

int ScaleSums::tie_between(Level& level, int a, int b) {
  for (const int number : level.groups[idx(a)].ties) {
    const Tie& tie = level.ties[idx(number)];
    if ((tie.a == a ? tie.b : tie.a) == b) return number;
  }
  geometry::make_room(level.ties);
  geometry::make_room(level.groups[idx(a)].ties);
  if (b >= 0) geometry::make_room(level.groups[idx(b)].ties);
  const int number = static_cast<int>(level.ties.size());
  Tie tie;
  tie.a = a;
  tie.b = b;
  level.ties.push_back(tie);
  level.groups[idx(a)].ties.push_back(number);
  if (b >= 0) level.groups[idx(b)].ties.push_back(number);
  return number;
}

void ScaleSums::clear_sums(Level& level, int group) {
  Group& one = level.groups[idx(group)];
  one.inner.clear();
  for (const int number : one.ties) level.ties[idx(number)].sums.clear();
  one.low.setConstant(std::numeric_limits<double>::infinity());
  one.high = -one.low;
  one.landmarks = 0;
}

void ScaleSums::take_sums(int level, truss::ElasticTruss& truss) {
  Level& at = level_at(level);
  const bool finest = level == kFinest;
  for (const int group : at.touched) {
    if (finest) {
      take_frame(group, truss);
    } else {
      take_frame_of_members(level, group);
    }
    clear_sums(at, group);
  }
  for (const int group : at.touched) {
    if (finest) {
      sum_landmarks(group, truss);
    } else {
      sum_members(level, group);
    }
    const int parent = at.frames[idx(group)].parent;
    if (parent >= 0) touch_group(level + 1, parent);
  }
  for (const int group : at.touched) at.groups[idx(group)].touched = false;
  at.touched.clear();
}

/// So that its axes are the map's again, its origin among its landmarks.
void ScaleSums::take_frame(int group, truss::ElasticTruss& truss) {
  const std::vector<int>& members = level_at(kFinest).groups[idx(group)].members;
  if (members.empty()) return;
  look(truss, members.front());
  Vector2 centre = Vector2::Zero();
  for (const int member : members) centre += truss.position(member);
  const Affine at = shift_by(centre / static_cast<double>(members.size()));
  Frame& frame = level_at(kFinest).frames[idx(group)];
  frame.T = frame.parent < 0 ? at : after(inverse_of(frame_of(kFinest + 1, frame.parent)), at);
  seen_[idx(group)] = {at, inverse_of(at), now_};
}

void ScaleSums::sum_landmarks(int group, truss::ElasticTruss& truss) {
  Level& level = level_at(kFinest);
  Group& one = level.groups[idx(group)];
  one.landmarks = static_cast<int>(one.members.size());
  one.mean.setZero();  // where the frame has its origin
  one.spread.setZero();
  for (const int member : one.members) {
    const Vector2 place = seen_[idx(group)].back(truss.position(member));
    one.low = one.low.cwiseMin(place);
    one.high = one.high.cwiseMax(place);
    one.spread += place * place.transpose();
    for (const int number : truss.elements_at(member)) {
      const truss::Element& bar = truss.element(number);
      const int other = bar.joints[0] == member ? bar.joints[1] : bar.joints[0];
      const int theirs = home(other);
      if (theirs == group) {
        if (bar.joints[0] != member) continue;  // it comes at its other end
        one.inner.add_bar(bar.B, bar.w, seen_[idx(group)].back(truss.position(other)) - place);
        continue;
      }
      if (theirs >= 0 && theirs < group && level.groups[idx(theirs)].touched) continue;
      sum_bar(group, bar, truss);
    }
  }
}

/// From the group to another one, or to what is held.
void ScaleSums::sum_bar(int group, const truss::Element& bar, const truss::ElasticTruss& truss) {
  Level& level = level_at(kFinest);
  const int from = home(bar.joints[0]);
  const int to = home(bar.joints[1]);
  const int number = tie_between(level, group, from == group ? to : from);
  Tie& tie = level.ties[idx(number)];
  const auto place = [&](int end) {
    const int of = home(bar.joints[idx(end)]);
    if (of < 0) return Vector2(Vector2::Zero());
    return seen_[idx(of)].back(truss.position(bar.joints[idx(end)]));
  };
  if (from == tie.a) {
    tie.sums.add_bar(bar.B, bar.w, place(0), place(1));
  } else {
    tie.sums.add_bar(bar.B, -bar.w, place(1), place(0));
  }
}

void ScaleSums::take_frame_of_members(int level, int group) {
  Level& at = level_at(level);
  const Affine before = frame_of(level, group);
  const int parent = at.frames[idx(group)].parent;
  const Affine now = shift_by(before.t);
  const Affine change{Vector2::Zero(), before.L};
  for (const int member : at.groups[idx(group)].members) {
    set_frame(level - 1, member, after(change, level_at(level - 1).frames[idx(member)].T));
  }
  set_frame(level, group, parent < 0 ? now : after(inverse_of(frame_of(level + 1, parent)), now));
}

/// Its box, and how its landmarks' places spread.
void ScaleSums::measure_members(int level, int group) {
  const Level& below = level_at(level - 1);
  Group& one = level_at(level).groups[idx(group)];
  Vector2 sum = Vector2::Zero();
  for (const int member : one.members) {
    const Group& part = below.groups[idx(member)];
    const Affine& T = below.frames[idx(member)].T;
    const Vector2 centre = T(0.5 * (part.low + part.high));
    const Vector2 reach = T.L.cwiseAbs() * (0.5 * (part.high - part.low));
    one.low = one.low.cwiseMin(centre - reach);
    one.high = one.high.cwiseMax(centre + reach);
    one.landmarks += part.landmarks;
    sum += part.landmarks * T(part.mean);
  }
  one.mean = sum / one.landmarks;
  one.spread.setZero();
  for (const int member : one.members) {
    const Group& part = below.groups[idx(member)];
    const Affine& T = below.frames[idx(member)].T;
    const Vector2 off = T(part.mean) - one.mean;
    one.spread += T.L * part.spread * T.L.transpose() + part.landmarks * off * off.transpose();
  }
}

void ScaleSums::sum_members(int level, int group) {
  Level& at = level_at(level);
  const Level& below = level_at(level - 1);
  Group& one = at.groups[idx(group)];
  measure_members(level, group);
  const auto frame = [&](int member) {
    return member < 0 ? Affine{} : below.frames[idx(member)].T;
  };
  for (const int member : one.members) {
    const Group& part = below.groups[idx(member)];
    const Affine T = frame(member);
    one.inner.add_inner(part.inner, T);
    for (const int number : part.ties) {
      const Tie& tie = below.ties[idx(number)];
      const int other = tie.a == member ? tie.b : tie.a;
      const int theirs = other < 0 ? -1 : below.frames[idx(other)].parent;
      if (theirs == group) {
        if (tie.a == member) add_tie(one.inner, in_frames(tie.sums, T, frame(other)));
        continue;
      }
      if (theirs >= 0 && theirs < group && at.groups[idx(theirs)].touched) continue;
      const TieSums sums = in_frames(tie.sums, frame(tie.a), frame(tie.b));
      Tie& whole = at.ties[idx(tie_between(at, group, theirs))];
      const int from = tie.a == member ? group : theirs;
      whole.sums.add(from == whole.a ? sums : turned_round(sums));
    }
  }
}

}  // namespace trussmap::map
