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

}  // namespace

struct NearestLandmarks::Tree {
  bg::index::rtree<Entry, bg::index::quadratic<16>> entries;
};

NearestLandmarks::NearestLandmarks() : tree_(std::make_unique<Tree>()) {}
NearestLandmarks::~NearestLandmarks() = default;

void NearestLandmarks::insert(int landmark, const Vector2& position) {
  tree_->entries.insert(entry(landmark, position));
}

void NearestLandmarks::move(int landmark, const Vector2& from, const Vector2& to) {
  tree_->entries.remove(entry(landmark, from));
  tree_->entries.insert(entry(landmark, to));
}

std::vector<int> NearestLandmarks::nearest(const Vector2& to, int count) const {
  std::vector<Entry> found;
  tree_->entries.query(bg::index::nearest(entry(0, to).first, static_cast<unsigned>(count)),
                       std::back_inserter(found));
  std::vector<int> landmarks;
  landmarks.reserve(found.size());
  for (const Entry& one : found) landmarks.push_back(one.second);
  std::sort(landmarks.begin(), landmarks.end());
  return landmarks;
}

}  // namespace trussmap
