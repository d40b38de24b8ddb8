// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/map_mechanics.hpp"

#include "geometry/make_room.hpp"
#include "map/refinement.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace trussmap::map {
namespace {

constexpr truss::Enough kLocal{.rounds = 2};                  // more comes at the next arrival
constexpr truss::Enough kWhole{.rounds = 12, .gain = 1e-11};  // a further one would gain less
constexpr double kNegligible = 0.1;  // of what a route yields to its own uncertainty
constexpr int kFreeGroups = 25;      // at each scale: they cover several of the next
constexpr int kMostMembers = 6000;   // landmarks in the groups that are free at a scale, visited
constexpr double kMoved = 1e-12;     // m

/// What the call returns, or an error in the user's terms.
template <typename Call>
auto solved(const Call& call) {
  try {
    return call();
  } catch (const linalg::NotPositiveDefinite&) {
    throw too_many_magnitudes();
  }
}

}  // namespace

void MapMechanics::roll_back() noexcept {
  truss_.roll_back();
  if (!sums_.empty()) {
    sums_.roll_back();
    settle();
  }
  equilibrium_.drop();
  if (from_.size() > idx(truss_.joints())) index_.drop();
  from_.resize(idx(truss_.joints()));
  if (grouped_ > truss_.joints() || tied_ > truss_.elements()) {
    groups_.clear();
    grouped_ = tied_ = 0;
  }
  if (others_ == 0) return;
  others_ = 0;
  for (int number = 0; number < truss_.elements(); ++number) {
    others_ += truss_.element(number).kind == truss::Element::Kind::bar ? 0 : 1;
  }
}

void MapMechanics::commit() noexcept {
  if (!at_rest_ && (!truss_.moved().empty() || !sums_.empty())) equilibrium_.disturbed();
  if (exact() || !sums_.empty()) {
    index_.drop();
  } else {
    for (const auto& [landmark, before] : truss_.moved()) {
      index_.move(landmark, truss_.position(landmark));
    }
  }
  touch_moved();
  truss_.commit();
  sums_.begin();
  touched_ = 0;
}

/// What was moved by itself changes the sums of its group.
void MapMechanics::touch_moved() noexcept {
  const auto& moved = truss_.moved();
  if (!sums_.empty()) {
    for (; touched_ < moved.size(); ++touched_) sums_.touch(moved[touched_].first);
  }
  touched_ = moved.size();
}

void MapMechanics::settle() noexcept {
  if (sums_.empty()) return;
  sums_.settle(truss_);
  index_.drop();
}

double MapMechanics::energy() const {
  if (sums_.empty()) return truss_.energy();
  double sum = 0.0;
  for (int number = 0; number < truss_.elements(); ++number) {
    const truss::Element& bar = truss_.element(number);
    const Vector2 strain = position(bar.joints[1]) - position(bar.joints[0]) - bar.w;
    sum += 0.5 * strain.dot(bar.B * strain);
  }
  return sum;
}

MapMechanics::Moves MapMechanics::moves() noexcept {
  Moves moves;
  for (const auto& [landmark, before] : truss_.moved()) {
    if (counted_[idx(landmark)] != 0) continue;  // its first entry has where it was
    counted_[idx(landmark)] = 1;
    const double move = (truss_.position(landmark) - before).norm();
    if (move > kMoved) ++moves.landmarks;
    moves.largest = std::max(moves.largest, move);
  }
  for (const auto& [landmark, before] : truss_.moved()) counted_[idx(landmark)] = 0;
  if (sums_.largest_move() > kMoved) moves.landmarks = std::max(moves.landmarks, sums_.moved());
  moves.largest += sums_.largest_move();
  return moves;
}

void MapMechanics::move(int landmark, const Vector2& to) {
  sums_.look(truss_, landmark);
  truss_.move(landmark, to);
}

int MapMechanics::add_landmark(const Vector2& position, int from) {
  geometry::make_room(from_);
  geometry::make_room(counted_);
  const int number = truss_.add_joint(position);
  from_.push_back(from);
  counted_.resize(idx(number) + 1, 0);
  if (sums_.empty()) index_.insert(number, position);
  return number;
}

int MapMechanics::add_element(const truss::Element& element) {
  const int number = truss_.add_element(element);
  if (element.kind != truss::Element::Kind::bar) {
    ++others_;
    settle();
  }
  element_changed(number);
  return number;
}

void MapMechanics::set_element(int number, const truss::Element& element) {
  truss_.set_element(number, element);
  element_changed(number);
}

void MapMechanics::element_changed(int number) {
  equilibrium_.changed(number);
  const truss::Element& element = truss_.element(number);
  for (int n = 0; n < element.count(); ++n) sums_.touch(element.joints[idx(n)]);
}

bool MapMechanics::exact() const {
  using Kind = RefinementScope::Kind;
  return scope_.kind == Kind::all ||
         (scope_.kind == Kind::automatic && truss_.joints() <= kMostExact);
}

int MapMechanics::relax(int i, int j) {
  if (exact()) {
    relax_all();
    return truss_.joints();
  }
  return relax_nearest(i, j);
}

void MapMechanics::relax_all() {
  settle();
  solved([this] { equilibrium_.relax(truss_, kWhole); });
  at_rest_ = true;
}

std::vector<Vector2> MapMechanics::displacements(
    const std::vector<std::pair<int, Vector2>>& loads) {
  settle();
  return solved([&] { return equilibrium_.displacements(truss_, loads); });
}

Matrix2 MapMechanics::flexibility_between(int i, int j) {
  const auto pulled = [&](const Vector2& force) {
    return displacements({{i, -force}, {j, force}});
  };
  const std::vector<Vector2> by_x = pulled(Vector2::UnitX());
  const std::vector<Vector2> by_y = pulled(Vector2::UnitY());
  Matrix2 F;
  F << by_x[idx(j)] - by_x[idx(i)], by_y[idx(j)] - by_y[idx(i)];
  return 0.5 * (F + F.transpose());
}

std::vector<Matrix2> MapMechanics::flexibilities() const {
  return solved([this] { return trussmap::truss::flexibilities(truss_); });
}

void MapMechanics::require_finite() const {
  for (const auto& [landmark, before] : truss_.moved()) {
    if (!truss_.position(landmark).allFinite()) throw too_many_magnitudes();
  }
}

std::vector<int> MapMechanics::members(int i, int j) const {
  std::vector<int> members;
  const int count =
      scope_.kind == RefinementScope::Kind::estimated ? estimated_eta(i, j) : scope_.eta;
  if (scope_.kind == RefinementScope::Kind::all || count >= truss_.joints()) {
    members.resize(idx(truss_.joints()));
    std::iota(members.begin(), members.end(), 0);
    return members;
  }
  members = nearest(0.5 * (truss_.position(i) + truss_.position(j)), count);
  for (const int end : {i, j}) {  // both may be far from a long one's middle
    const auto place = std::lower_bound(members.begin(), members.end(), end);
    if (place == members.end() || *place != end) members.insert(place, end);
  }
  return members;
}

int MapMechanics::estimated_eta(int i, int j) const {
  std::vector<int> ring{i, j};
  std::set<int> piece{i, j};
  double force = 0.0;
  for (const int end : ring) {
    Vector2 sum = Vector2::Zero();
    for (const int number : truss_.elements_at(end)) {
      const auto& joints = truss_.element(number).joints;
      const auto own = std::find(joints.begin(), joints.end(), end) - joints.begin();
      sum += truss_.tangent(number).force[static_cast<std::size_t>(own)];
    }
    force = std::max(force, sum.norm());
  }
  while (!ring.empty()) {
    double cut = 0.0;
    double stiffest = 0.0;
    std::set<int> next;
    for (const int landmark : ring) {
      for (const int number : truss_.elements_at(landmark)) {
        const truss::Element& one = truss_.element(number);
        if (one.kind == truss::Element::Kind::corner || one.kind == truss::Element::Kind::direction)
          continue;
        const int other = one.joints[0] == landmark ? one.joints[1] : one.joints[0];
        if (piece.contains(other)) continue;
        next.insert(other);
        const double k = one.kind == truss::Element::Kind::bar ? 0.5 * one.B.trace() : one.k;
        cut += k;
        stiffest = std::max(stiffest, k);
      }
    }
    const double yields =
        law_ == StiffnessLaw::variance ? 1.0 / std::sqrt(stiffest) : 1.0 / stiffest;
    if (next.empty() || force < kNegligible * yields * cut) break;
    piece.insert(next.begin(), next.end());
    ring.assign(next.begin(), next.end());
  }
  return static_cast<int>(piece.size());
}

int MapMechanics::relax_nearest(int i, int j) {
  if (!scope_.groups) settle();
  sums_.look_round(truss_, {i, j});
  const Vector2 middle = 0.5 * (truss_.position(i) + truss_.position(j));
  const std::vector<int> near = members(i, j);
  truss_.fetch(near);
  sums_.look_round(truss_, near);
  std::vector<truss::FreeJoint> free;
  free.reserve(near.size());
  for (const int landmark : near) {
    if (landmark > 0) free.push_back({landmark, static_cast<int>(free.size())});
  }
  relaxation_.relax(truss_, free, 1, kLocal);
  const bool whole = static_cast<int>(near.size()) == truss_.joints();
  if (scope_.groups && !whole) relax_scales(i, j, middle);
  return static_cast<int>(near.size());
}

/// From the finest scale to the coarsest.
void MapMechanics::relax_scales(int i, int j, const Vector2& middle) {
  grow_groups();
  int level = 0;
  const bool by_sums = others_ == 0 && groups_.levels() > ScaleSums::kFinest;
  const int visited = by_sums ? ScaleSums::kFinest : groups_.levels();
  for (; level < visited; ++level) {
    if (relax_members(level, nearest_groups(level, i, j, middle)) == 0) break;
  }
  if (!by_sums) return;
  touch_moved();
  sums_.follow(groups_, truss_);
  for (; level < groups_.levels(); ++level) {
    sums_.take_sums(level, truss_);
    sums_.relax(level, nearest_groups(level, i, j, middle), truss_);
  }
}

std::vector<int> MapMechanics::nearest_groups(int level, int i, int j,
                                              const Vector2& middle) const {
  return groups_.nearest(level, i, j, std::min(kFreeGroups, scope_.eta),
                         [&](int landmark) { return (position(landmark) - middle).squaredNorm(); });
}

/// Landmark by landmark. 0: more of them than a correction may move.
int MapMechanics::relax_members(int level, const std::vector<int>& groups) {
  std::vector<truss::FreeJoint> free;
  std::vector<int> members;
  int block = 0;
  for (const int group : groups) {
    members.clear();
    groups_.members(level, group, members);
    if (std::ssize(free) + std::ssize(members) > kMostMembers) return 0;
    sums_.look_round(truss_, members);
    Vector2 centre = Vector2::Zero();
    for (const int landmark : members) centre += truss_.position(landmark);
    centre /= static_cast<double>(members.size());
    double reach = 0.0;
    for (const int landmark : members) {
      reach = std::max(reach, (truss_.position(landmark) - centre).norm());
    }
    if (!(reach > 0.0)) reach = 1.0;
    for (const int landmark : members) {
      const Vector2 at = (truss_.position(landmark) - centre) / reach;
      free.push_back({landmark, block, {1.0, at.x(), at.y()}});
    }
    ++block;
  }
  relaxation_.relax(truss_, free, 3, kLocal);
  return block;
}

void MapMechanics::grow_groups() {
  try {
    for (; grouped_ < truss_.joints(); ++grouped_) groups_.add(grouped_, from_[idx(grouped_)]);
    for (; tied_ < truss_.elements(); ++tied_) {
      const truss::Element& one = truss_.element(tied_);
      if (one.kind != truss::Element::Kind::corner) groups_.tie(one.joints[0], one.joints[1]);
    }
  } catch (...) {
    groups_.clear();
    grouped_ = tied_ = 0;
    throw;
  }
}

}  // namespace trussmap::map
