// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/nearest_landmarks.hpp"

#include "geometry/index.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>

namespace trussmap::map {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::point<double, 2, bg::cs::cartesian>;
using Entry = std::pair<Point, int>;

Entry entry(int landmark, const Vector2& position) {
  return {Point(position.x(), position.y()), landmark};
}

using Tree = bg::index::rtree<Entry, bg::index::quadratic<16>>;

constexpr double kRounding = 1.0 + 1e-12;
constexpr double kNear = 0.05;  // of the distance up to which landmarks are asked for

}  // namespace

struct NearestLandmarks::Index {
  Tree tree;
  std::vector<Vector2> places;  ///< per landmark, in the tree
  double farthest = 0.0;        ///< of a landmark from its place in the tree at most, m
  double reach = 0.0;           ///< of the last question: its farthest landmark, m
  bool follows = true;

  template <typename Change>
  void follow(const Change& change) noexcept {
    if (!follows) return;
    try {
      change();
    } catch (...) {
      follows = false;
    }
  }

  void insert(int landmark, const Vector2& position) {
    places.resize(std::max(places.size(), idx(landmark) + 1));
    places[idx(landmark)] = position;
    tree.insert(entry(landmark, position));
  }

  void move(int landmark, const Vector2& to) {
    Vector2& place = places[idx(landmark)];
    const double off = (to - place).norm();
    if (off <= kNear * reach) {
      farthest = std::max(farthest, off);
      return;
    }
    tree.remove(entry(landmark, place));
    tree.insert(entry(landmark, to));
    place = to;
  }

  void build(const std::vector<Vector2>& positions) {
    std::vector<Entry> entries;
    entries.reserve(positions.size());
    places = positions;
    for (std::size_t k = 0; k < positions.size(); ++k) {
      entries.push_back(entry(static_cast<int>(k), positions[k]));
    }
    tree = Tree(entries);
    farthest = 0.0;
    follows = true;
  }
};

NearestLandmarks::NearestLandmarks() : index_(std::make_unique<Index>()) {}
NearestLandmarks::~NearestLandmarks() = default;

void NearestLandmarks::insert(int landmark, const Vector2& position) noexcept {
  index_->follow([&] { index_->insert(landmark, position); });
}

void NearestLandmarks::move(int landmark, const Vector2& to) noexcept {
  index_->follow([&] { index_->move(landmark, to); });
}

void NearestLandmarks::drop() noexcept {
  index_->follows = false;
}

std::vector<int> NearestLandmarks::nearest(const std::vector<Vector2>& positions, const Vector2& to,
                                           int count) const {
  if (!index_->follows) index_->build(positions);
  std::vector<Entry> found;
  index_->tree.query(bg::index::nearest(entry(0, to).first, static_cast<unsigned>(count)),
                     std::back_inserter(found));
  const auto distance = [&](int landmark) { return (positions[idx(landmark)] - to).norm(); };
  double reach = 0.0;
  for (const Entry& one : found) reach = std::max(reach, distance(one.second));
  index_->reach = reach;
  // None that is nearer than these is farther than this from its place in the tree.
  const double beyond = kRounding * (reach + index_->farthest);
  found.clear();
  index_->tree.query(
      bg::index::intersects(bg::model::box<Point>(Point(to.x() - beyond, to.y() - beyond),
                                                  Point(to.x() + beyond, to.y() + beyond))),
      std::back_inserter(found));
  std::vector<std::pair<double, int>> candidates;
  candidates.reserve(found.size());
  for (const Entry& one : found) candidates.emplace_back(distance(one.second), one.second);
  const std::size_t kept = std::min(candidates.size(), idx(count));
  std::nth_element(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(kept),
                   candidates.end());
  std::vector<int> landmarks;
  landmarks.reserve(kept);
  for (std::size_t k = 0; k < kept; ++k) landmarks.push_back(candidates[k].second);
  std::sort(landmarks.begin(), landmarks.end());
  return landmarks;
}

}  // namespace trussmap::map
