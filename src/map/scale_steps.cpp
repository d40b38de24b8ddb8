// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Steps of groups by their sums, and the search for what is nearest.
#include "linalg/dense.hpp"
#include "map/scale_sums.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <utility>

namespace trussmap::map {
namespace {

constexpr double kUnheld = 1e-12;  // share of its stiffness that an unknown keeps when held
constexpr int kMostHalvings = 10;
constexpr double kFlattestFrame = 1e-4;  // a frame that can still be gone back from
constexpr int kUnknowns = 6;             // per group

/// A group of landmarks in one line may be pulled out of it without bound.
bool is_modest(const Matrix2& L, double flattest = kFlattestFrame) {
  return L.allFinite() && std::abs(L.determinant()) > flattest * L.squaredNorm();
}

/// Distance from a point to a box that a frame carries, or less.
double least_distance(const Affine& frame, const Vector2& low, const Vector2& high,
                      const Vector2& point) {
  const Vector2 place = inverse_of(frame)(point);
  const Vector2 off = (low - place).cwiseMax(place - high).cwiseMax(0.0);
  const double det = std::abs(frame.L.determinant());
  const double square = frame.L.squaredNorm();
  const double largest =
      std::sqrt(0.5 * (square + std::sqrt(std::max(0.0, square * square - 4.0 * det * det))));
  const double distance = off.norm() * det / largest;
  return std::isfinite(distance) ? distance : 0.0;
}

/// A block of the system, on its diagonal or below.
void add_block(linalg::BandMatrix& K, int row, int column, const Stiffness3& B) {
  K.add(row, column, B[0]);
  K.add(row + 1, column, B[1]);
  K.add(row + 1, column + 1, B[2]);
  if (row > column) K.add(row, column + 1, B[1]);
}

/// A group's own block: moments of its places, or of differences of them.
void add_own(linalg::BandMatrix& K, int rank, const std::array<Stiffness3, 3>& second) {
  const int row = kUnknowns * rank;
  add_block(K, row + 2, row + 2, second[0]);
  add_block(K, row + 4, row + 2, second[1]);
  add_block(K, row + 4, row + 4, second[2]);
}

/// The same of one end of a tie, with how the group is moved.
void add_end(linalg::BandMatrix& K, int rank, const Stiffness3& zeroth,
             const std::array<Stiffness3, 2>& first, const std::array<Stiffness3, 3>& second) {
  const int row = kUnknowns * rank;
  add_block(K, row, row, zeroth);
  add_block(K, row + 2, row, first[0]);
  add_block(K, row + 4, row, first[1]);
  add_own(K, rank, second);
}

/// Block of two free groups, minus the moments of both.
void add_between(linalg::BandMatrix& K, int rank_a, int rank_b, const TieSums& sums) {
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      const Stiffness3& B = i == 0 ? (k == 0 ? sums.n : sums.b[idx(k - 1)])
                                   : (k == 0 ? sums.a[idx(i - 1)] : sums.ab_at(i - 1, k - 1));
      const int a = kUnknowns * rank_a + 2 * i;
      const int b = kUnknowns * rank_b + 2 * k;
      const int row = std::max(a, b);
      const int column = std::min(a, b);
      K.add(row, column, -B[0]);
      K.add(row + 1, column, -B[1]);
      K.add(row, column + 1, -B[1]);
      K.add(row + 1, column + 1, -B[2]);
    }
  }
}

}  // namespace

/// The free groups of a step.
struct ScaleSums::Free {
  std::vector<int> groups;
  // Per free group:
  std::vector<Affine> at;       ///< its places in the map
  std::vector<Vector2> centre;  ///< of its landmarks in the map
  std::vector<Matrix2> axes;    ///< from there to places along and across, 1: a standard deviation
  std::vector<Affine> modes;    ///< the same of places in its frame
  std::vector<int> rank;        ///< its place in the system
  int band = 0;
  Eigen::VectorXd f;

  void pull(std::size_t n, const GroupForce& by_place) {
    GroupForce force;
    force.col(0) = by_place.col(0);
    force.rightCols<2>() =
        by_place.col(0) * modes[n].t.transpose() + by_place.rightCols<2>() * modes[n].L.transpose();
    f.segment<kUnknowns>(Eigen::Index{kUnknowns} * rank[n]) +=
        Eigen::Map<const Eigen::Matrix<double, kUnknowns, 1>>(force.data());
  }
  [[nodiscard]] GroupForce numbers(std::size_t n) const {
    return GroupForce(Eigen::Map<const GroupForce>(f.data() + std::ptrdiff_t{kUnknowns} * rank[n]));
  }
  /// What a share of the step does to a place in the map: linear part.
  [[nodiscard]] Matrix2 change(std::size_t n, double share) const {
    return Matrix2::Identity() + share * numbers(n).rightCols<2>() * axes[n];
  }
  [[nodiscard]] Affine moved(std::size_t n, double share) const {
    const Vector2 shift = centre[n] + share * numbers(n).col(0);
    return after({shift, change(n, share)}, after(shift_by(-centre[n]), at[n]));
  }
};

ScaleSums::Free ScaleSums::free_groups(int level, const std::vector<int>& groups) const {
  Free free;
  free.groups = groups;
  for (const int group : groups) {
    const Group& one = level_at(level).groups[idx(group)];
    const Affine at = frame_of(level, group);
    const Matrix2 spread = at.L * one.spread * at.L.transpose() / std::max(one.landmarks, 1);
    const linalg::PlanarModes modes = linalg::planar_modes(spread);
    const Vector2 sd = modes.eigenvalues.cwiseMax(0.0).cwiseSqrt();  // the larger one last
    Matrix2 axes = Matrix2::Zero();
    if (sd[1] > 0.0) axes.row(0) = modes.eigenvectors.col(1).transpose() / sd[1];
    if (sd[0] > kThinnest * sd[1]) axes.row(1) = modes.eigenvectors.col(0).transpose() / sd[0];
    free.at.push_back(at);
    free.centre.push_back(at(one.mean));
    free.axes.push_back(axes);
    free.modes.push_back({axes * (at.t - free.centre.back()), axes * at.L});
  }
  return free;
}

double ScaleSums::relax(int level, const std::vector<int>& groups,
                        const truss::ElasticTruss& truss) {
  if (groups.empty()) return 0.0;
  held_ = shift_by(truss.position(0));
  const Level& at = level_at(level);
  Free free = free_groups(level, groups);
  place_.resize(std::max(place_.size(), at.groups.size()), -1);
  for (std::size_t n = 0; n < groups.size(); ++n) place_[idx(groups[n])] = static_cast<int>(n);
  double gain = 0.0;
  try {
    assemble(level, free);
    const Eigen::VectorXd force = free.f;
    K_.factorise(kUnheld);
    K_.solve_in_place(free.f);
    gain = 0.5 * force.dot(free.f);
    if (gain > 0.0 && std::isfinite(gain)) {
      gain *= move(level, free);
    } else {
      gain = 0.0;
    }
  } catch (...) {
    for (const int group : groups) place_[idx(group)] = -1;
    throw;
  }
  for (const int group : groups) place_[idx(group)] = -1;
  return gain;
}

/// Along the direction in which they spread most, as a patch of a map is narrow across it.
void ScaleSums::order(const Level& level, Free& free) const {
  Vector2 mean = Vector2::Zero();
  for (const Vector2& at : free.centre) mean += at / static_cast<double>(free.centre.size());
  Matrix2 spread = Matrix2::Zero();
  for (const Vector2& at : free.centre) spread += (at - mean) * (at - mean).transpose();
  const Vector2 axis = linalg::planar_modes(spread).eigenvectors.col(1);
  std::vector<std::pair<double, int>> along;
  for (std::size_t n = 0; n < free.centre.size(); ++n) {
    along.emplace_back(axis.dot(free.centre[n] - mean), static_cast<int>(n));
  }
  std::sort(along.begin(), along.end());
  free.rank.assign(free.groups.size(), 0);
  for (std::size_t r = 0; r < along.size(); ++r) {
    free.rank[idx(along[r].second)] = static_cast<int>(r);
  }
  for (const int group : free.groups) {
    for (const int number : level.groups[idx(group)].ties) {
      const Tie& tie = level.ties[idx(number)];
      const int a = place_[idx(tie.a)];
      const int b = tie.b < 0 ? -1 : place_[idx(tie.b)];
      if (a >= 0 && b >= 0) {
        free.band = std::max(free.band, std::abs(free.rank[idx(a)] - free.rank[idx(b)]));
      }
    }
  }
}

void ScaleSums::assemble(int level, Free& free) {
  const Level& at = level_at(level);
  order(at, free);
  const int unknowns = kUnknowns * static_cast<int>(free.groups.size());
  K_.resize(unknowns, kUnknowns * (free.band + 1) - 1);
  free.f = Eigen::VectorXd::Zero(unknowns);
  for (std::size_t n = 0; n < free.groups.size(); ++n) {
    const Group& one = at.groups[idx(free.groups[n])];
    free.pull(n, pull_within(one.inner, free.at[n].L));
    InnerSums inner;
    inner.add_inner(one.inner, free.modes[n]);
    add_own(K_, free.rank[n], inner.dd);
    for (const int number : one.ties) assemble_tie(level, at.ties[idx(number)], n, free);
  }
}

/// A tie of free group n.
void ScaleSums::assemble_tie(int level, const Tie& tie, std::size_t n, Free& free) {
  const bool near = tie.a == free.groups[n];
  const int other = near ? tie.b : tie.a;
  const int place = other < 0 ? -1 : place_[idx(other)];
  if (place >= 0 && !near) return;  // both are free: once
  const Affine theirs = place >= 0  ? free.at[idx(place)]
                        : other < 0 ? held_
                                    : frame_of(level, other);
  const TiePulls pulls =
      near ? pulls_of(tie.sums, free.at[n], theirs) : pulls_of(tie.sums, theirs, free.at[n]);
  const Affine beyond = place >= 0 ? free.modes[idx(place)] : Affine{};
  const TieSums sums = near ? in_frames(tie.sums, free.modes[n], beyond)
                            : in_frames(tie.sums, beyond, free.modes[n]);
  free.pull(n, near ? pulls.on_a : pulls.on_b);
  if (near) {
    add_end(K_, free.rank[n], sums.n, sums.a, sums.aa);
  } else {
    add_end(K_, free.rank[n], sums.n, sums.b, sums.bb);
  }
  if (place < 0) return;
  free.pull(idx(place), pulls.on_b);
  add_end(K_, free.rank[idx(place)], sums.n, sums.b, sums.bb);
  add_between(K_, free.rank[n], free.rank[idx(place)], sums);
}

/// Returns the share of the step's gain: all, unless a group would be drawn out too far.
double ScaleSums::move(int level, const Free& free) {
  double share = 1.0;
  int halvings = 0;
  for (std::size_t n = 0; n < free.groups.size() && halvings <= kMostHalvings; ++n) {
    while (halvings <= kMostHalvings && !is_modest(free.change(n, share))) {
      share *= 0.5;
      ++halvings;
    }
  }
  if (halvings > kMostHalvings) return 0.0;
  const Level& at = level_at(level);
  int moved = 0;
  double largest = 0.0;
  for (std::size_t n = 0; n < free.groups.size(); ++n) {
    const int group = free.groups[n];
    const int parent = at.frames[idx(group)].parent;
    const Affine now = free.moved(n, share);
    set_frame(level, group, parent < 0 ? now : after(inverse_of(frame_of(level + 1, parent)), now));
    const Group& one = at.groups[idx(group)];
    moved += one.landmarks;
    for (const double x : {one.low.x(), one.high.x()}) {
      for (const double y : {one.low.y(), one.high.y()}) {
        const Vector2 corner(x, y);
        largest = std::max(largest, (now(corner) - free.at[n](corner)).norm());
      }
    }
    if (parent >= 0) touch_group(level + 1, parent);
    if (!is_modest(now.L, 100.0 * kFlattestFrame)) touch_group(level, group);  // for a new frame
  }
  ++now_;
  moved_ = std::max(moved_, moved);
  largest_move_ += largest;
  return share * (2.0 - share);
}

// ---------------------------------------- what is nearest

namespace {

/// A group that may hold something near.
struct Reached {
  double least = 0.0;  ///< m, how near at least
  int level = 0;
  int group = -1;
  Affine frame;

  friend bool operator<(const Reached& a, const Reached& b) { return a.least > b.least; }
};

/// The nearest so far.
class Nearest {
 public:
  Nearest(const Vector2& to, std::size_t count) : to_(to), count_(count) {}

  void take(int landmark, const Vector2& at) {
    const std::pair<double, int> one{(at - to_).norm(), landmark};
    if (found_.size() == count_) {
      if (!(one < found_.front())) return;
      std::pop_heap(found_.begin(), found_.end());
      found_.pop_back();
    }
    found_.push_back(one);
    std::push_heap(found_.begin(), found_.end());
  }
  [[nodiscard]] bool may_take(double distance) const {
    constexpr double kRounding = 1.0 - 1e-12;
    return found_.size() < count_ || kRounding * distance <= found_.front().first;
  }
  [[nodiscard]] std::vector<int> landmarks() const {
    std::vector<int> result;
    result.reserve(found_.size());
    for (const auto& [distance, landmark] : found_) result.push_back(landmark);
    std::sort(result.begin(), result.end());
    return result;
  }

 private:
  Vector2 to_;
  std::size_t count_;
  std::vector<std::pair<double, int>> found_;  ///< a heap, the farthest first
};

}  // namespace

std::vector<int> ScaleSums::nearest(const truss::ElasticTruss& truss, const Vector2& to,
                                    int count) const {
  Nearest nearest(to, idx(count));
  std::priority_queue<Reached> next;
  const auto reach = [&](int level, int group, const Affine& outside) {
    const Group& one = level_at(level).groups[idx(group)];
    if (one.landmarks == 0) return;
    const Affine frame = after(outside, level_at(level).frames[idx(group)].T);
    const double least = least_distance(frame, one.low, one.high, to);
    if (nearest.may_take(least)) next.push({least, level, group, frame});
  };
  // What is in no box: the landmark that is held, new ones, and groups whose landmarks have moved.
  nearest.take(0, truss.position(0));
  for (int landmark = static_cast<int>(home_.size()); landmark < truss.joints(); ++landmark) {
    nearest.take(landmark, truss.position(landmark));
  }
  const Level& finest = level_at(kFinest);
  for (const int group : finest.touched) {
    for (const int member : finest.groups[idx(group)].members) {
      nearest.take(member, position(truss, member));
    }
  }
  for (int group = 0; group < static_cast<int>(level_at(coarsest()).groups.size()); ++group) {
    reach(coarsest(), group, Affine{});
  }
  while (!next.empty()) {
    const Reached at = next.top();
    next.pop();
    if (!nearest.may_take(at.least)) break;
    const Group& one = level_at(at.level).groups[idx(at.group)];
    if (at.level > kFinest) {
      for (const int member : one.members) reach(at.level - 1, member, at.frame);
    } else if (!one.touched) {
      const Affine now = after(at.frame, seen_[idx(at.group)].back);
      for (const int member : one.members) nearest.take(member, now(truss.position(member)));
    }
  }
  return nearest.landmarks();
}

}  // namespace trussmap::map
