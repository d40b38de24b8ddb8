// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/nearest_landmarks.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>

namespace trussmap {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::point<double, 2, bg::cs::cartesian>;
using Entry = std::pair<Point, int>;

Entry entry(int landmark, const Vector2& position) {
  return {Point(position.x(), position.y()), landmark};
}

using Tree = bg::index::rtree<Entry, bg::index::quadratic<16>>;

}  // namespace

struct NearestLandmarks::Index {
  Tree tree;
  bool follows = true;

  template <typename Change>
  void follow(const Change& change) noexcept {
    if (!follows) return;
    try {
      change(tree);
    } catch (...) {
      follows = false;
    }
  }

  void build(const LandmarkGraph& map) {
    std::vector<Entry> entries;
    entries.reserve(static_cast<std::size_t>(map.landmarks()));
    for (int k = 0; k < map.landmarks(); ++k) entries.push_back(entry(k, map.landmark(k).position));
    tree = Tree(entries);
    follows = true;
  }
};

NearestLandmarks::NearestLandmarks() : index_(std::make_unique<Index>()) {}
NearestLandmarks::~NearestLandmarks() = default;

void NearestLandmarks::insert(int landmark, const Vector2& position) noexcept {
  index_->follow([&](Tree& tree) { tree.insert(entry(landmark, position)); });
}

void NearestLandmarks::move(int landmark, const Vector2& from, const Vector2& to) noexcept {
  index_->follow([&](Tree& tree) {
    tree.remove(entry(landmark, from));
    tree.insert(entry(landmark, to));
  });
}

std::vector<int> NearestLandmarks::nearest(const LandmarkGraph& map, const Vector2& to,
                                           int count) const {
  if (!index_->follows) index_->build(map);
  std::vector<Entry> found;
  index_->tree.query(bg::index::nearest(entry(0, to).first, static_cast<unsigned>(count)),
                     std::back_inserter(found));
  std::vector<int> landmarks;
  landmarks.reserve(found.size());
  for (const Entry& one : found) landmarks.push_back(one.second);
  std::sort(landmarks.begin(), landmarks.end());
  return landmarks;
}

}  // namespace trussmap
