// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/nearest_landmarks.hpp"

#include "trussmap/landmark_map.hpp"

#include <algorithm>
#include <random>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace trussmap::nearest_landmarks_test {
namespace {

std::vector<int> nearest_of_all(const LandmarkGraph& map, const Vector2& to, int count) {
  std::vector<std::pair<double, int>> all;
  for (int k = 0; k < map.landmarks(); ++k) {
    all.emplace_back((map.landmark(k).position - to).norm(), k);
  }
  std::sort(all.begin(), all.end());
  std::vector<int> landmarks;
  for (int k = 0; k < std::min(count, map.landmarks()); ++k) {
    landmarks.push_back(all[static_cast<std::size_t>(k)].second);
  }
  std::sort(landmarks.begin(), landmarks.end());
  return landmarks;
}

std::vector<Vector2> places(const LandmarkGraph& map) {
  std::vector<Vector2> all;
  for (int k = 0; k < map.landmarks(); ++k) all.push_back(map.landmark(k).position);
  return all;
}

/// `step`: how far landmarks move at a time, m; on average they are 1 m from each other.
void expect_nearest_of_all(double step) {
  constexpr int kLandmarks = 600;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> anywhere(0.0, 25.0);
  std::normal_distribution<double> normal;
  LandmarkGraph map;
  map::NearestLandmarks nearest;
  for (int k = 0; k < kLandmarks; ++k) {
    const Vector2 position(anywhere(random), anywhere(random));
    map.add_landmark(std::to_string(k), position);
    nearest.insert(k, position);
  }
  for (int round = 0; round < 400; ++round) {
    const Vector2 to(anywhere(random), anywhere(random));
    const int count = 2 + static_cast<int>(random() % 60);
    const std::vector<int> found = nearest.nearest(places(map), to, count);
    ASSERT_EQ(found, nearest_of_all(map, to, count)) << "round " << round;
    for (const int landmark : found) {
      const Vector2 moved =
          map.landmark(landmark).position + step * Vector2(normal(random), normal(random));
      map.set_position(landmark, moved);
      nearest.move(landmark, moved);
    }
  }
}

TEST(NearestLandmarks, AreThoseOfALookAtAllHoweverLittleTheyMove) {
  for (const double step : {0.0, 1e-3, 0.02, 0.1, 1.0}) expect_nearest_of_all(step);
}

TEST(NearestLandmarks, OfThoseEquallyFarTheLowestNumbersAreTaken) {
  LandmarkGraph map;
  map::NearestLandmarks nearest;
  for (int k = 0; k < 40; ++k) {
    const Vector2 position(k % 2 == 0 ? 1.0 : -1.0, 0.0);
    map.add_landmark(std::to_string(k), position);
    nearest.insert(k, position);
  }
  EXPECT_EQ(nearest.nearest(places(map), Vector2::Zero(), 5), (std::vector<int>{0, 1, 2, 3, 4}));
}

}  // namespace
}  // namespace trussmap::nearest_landmarks_test
