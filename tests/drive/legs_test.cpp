// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Stops and legs as the file format defines them.
#include "drive/legs.hpp"

#include "driven.hpp"

#include <gtest/gtest.h>

namespace trussmap::legs_test {
using namespace drive;
namespace {

/// One metre a second for ten seconds, in rows of one second.
DrivenRecording straight_drive(std::vector<Sighting> sightings) {
  DrivenRecording recording;
  for (int k = 1; k <= 10; ++k) {
    recording.drive.t.push_back(k);
    testing::add_travels(recording.drive, 1.0, 1.0);
  }
  recording.sightings = std::move(sightings);
  return recording;
}

TEST(Stops, ShareATimeAndReferToTheLandmarkStoodOnElseTheNearest) {
  const std::vector<Stop> stops = stops_of({{0.0, "A"},
                                            {2.0, "far", 4.0, 0.1},
                                            {2.0, "near", 1.0, 0.1},
                                            {5.0, "seen", 0.0, 0.0},
                                            {5.0, "stood on"}});
  ASSERT_EQ(stops.size(), 3U);
  EXPECT_EQ(stops[1].count, 2U);
  EXPECT_EQ(stops[1].reference, 2U);
  EXPECT_EQ(stops[2].reference, 4U);
}

TEST(Legs, JoinDifferentReferencesFarEnoughApart) {
  const DrivenRecording recording =
      straight_drive({{0.0, "A"}, {2.0, "A"}, {4.0, "B"}, {4.2, "C"}, {5.0, "C"}, {9.0, "A"}});
  const std::vector<Stop> stops = stops_of(recording.sightings);
  const std::vector<Leg> legs = legs_of(recording, stops);
  ASSERT_EQ(legs.size(), 3U);  // A-B; B-C at 5.0, the sighting at 4.2 is 0.2 m on; C-A
  EXPECT_EQ(legs[0].to, 2U);
  EXPECT_EQ(legs[1].from, 2U);
  EXPECT_EQ(legs[1].to, 4U);
  EXPECT_EQ(legs[2].to, 5U);
  EXPECT_EQ(legs_of(recording, stops, 0.1).size(), 3U);
  EXPECT_EQ(legs_of(recording, stops, 0.1)[1].to, 3U);
}

TEST(Legs, ReverseCountsAsDrivenPathAndRowsAreCutLinearly) {
  DrivenRecording recording = straight_drive({});
  recording.drive.forward[5] = -1.0;
  const std::vector<double> path = driven_path(recording.drive);
  EXPECT_DOUBLE_EQ(path.back(), 10.0);
  EXPECT_DOUBLE_EQ(path_at(recording.drive, path, 0.0), 0.0);
  EXPECT_DOUBLE_EQ(path_at(recording.drive, path, 6.25), 6.25);
  EXPECT_DOUBLE_EQ(path_at(recording.drive, path, 99.0), 10.0);
  EXPECT_TRUE(legs_of(recording, {}).empty());
}

}  // namespace
}  // namespace trussmap::legs_test
