// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/well_formed.hpp"

#include "driven.hpp"
#include "trussmap/build_map.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/fit_model.hpp"

#include <functional>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::well_formed_test {
namespace {

/// Ten rows straight ahead, from landmark A to landmark B.
DrivenRecording straight() {
  DrivenRecording recording;
  recording.name = "mine";
  for (int row = 1; row <= 10; ++row) {
    recording.drive.t.push_back(row);
    testing::add_travels(recording.drive, 0.5, 0.5);
    recording.drive.heading.push_back(row == 4 ? kAbsent : 0.0);
  }
  recording.drive.covariates = {{"load", std::vector<double>(10, 1.0)}};
  recording.sightings = {{0.0, "A"}, {5.0, "C", 2.0, 0.1}, {10.0, "B"}};
  recording.truth = {{1.0, 0.0, 0.0, 0.0}, {9.0, 4.0, 0.0, 0.0}};
  return recording;
}

std::string refusal(const std::function<void(DrivenRecording&)>& spoil) {
  DrivenRecording recording = straight();
  spoil(recording);
  try {
    drive::require_well_formed(recording, Robot());
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(WellFormed, ARecordingAsDescribedIs) {
  EXPECT_EQ(refusal([](DrivenRecording&) {}), "accepted");
  EXPECT_EQ(refusal([](DrivenRecording& r) { r.drive.heading.clear(); }), "accepted");
  EXPECT_EQ(refusal([](DrivenRecording& r) {
              r.truth = {{-5.0, 0.0, 0.0, 0.0}, {99.0, 4.0, 0.0, 0.0}};
            }),
            "accepted");
}

TEST(WellFormed, WhatIsWrongIsNamed) {
  struct Spoilt {
    const char* expected;
    std::function<void(DrivenRecording&)> by;
  };
  const std::vector<Spoilt> all = {
      {"column left of the drive has 9 rows, expected 10",
       [](DrivenRecording& r) { r.drive.pair.left.pop_back(); }},
      {"column right of the drive has 0 rows",
       [](DrivenRecording& r) { r.drive.pair.right.clear(); }},
      {"column heading of the drive has 3 rows",
       [](DrivenRecording& r) { r.drive.heading.resize(3); }},
      {"column load of the drive has 11 rows",
       [](DrivenRecording& r) { r.drive.covariates[0].values.push_back(1.0); }},
      {"column left of the drive is not finite in row 2",
       [](DrivenRecording& r) { r.drive.pair.left[2] = kAbsent; }},
      {"column forward of the drive has 9 rows",
       [](DrivenRecording& r) { r.drive.forward.pop_back(); }},
      {"column turn of the drive is not finite in row 7",
       [](DrivenRecording& r) { r.drive.turn[7] = kAbsent; }},
      {"its wheels turn it otherwise than two that are 0.34 m apart",
       [](DrivenRecording& r) {
         r.drive.pair.right[4] += 0.1;
         testing::retake(r.drive, 0.35);
       }},
      {"t of the drive does not increase in row 6",
       [](DrivenRecording& r) { std::swap(r.drive.t[5], r.drive.t[6]); }},
      {"sightings are not in order of time",
       [](DrivenRecording& r) { std::swap(r.sightings[0], r.sightings[1]); }},
      {"the sighting of A at t = -50 s is outside the drive, expected 0 to 10 s",
       [](DrivenRecording& r) { r.sightings[0].t = -50.0; }},
      {"the sighting of B at t = 1e+06 s is outside the drive",
       [](DrivenRecording& r) { r.sightings[2].t = 1e6; }},
      {"truth rows are not in order of time",
       [](DrivenRecording& r) { r.truth[1].t = std::numeric_limits<double>::quiet_NaN(); }},
      {"the truth at t = 9 s is not finite", [](DrivenRecording& r) { r.truth[1].y = kAbsent; }},
      {"the survey of A is not finite",
       [](DrivenRecording& r) {
         r.survey = {{"A", 1.0, kAbsent}};
       }},
      {"the sighting of C at t = 5 s has a range or a bearing that is negative",
       [](DrivenRecording& r) { r.sightings[1].range = -2.0; }},
      {"the drive has 1 rows, expected two at least",
       [](DrivenRecording& r) {
         r.drive = {};
         r.drive.t = {1.0};
         testing::add_travels(r.drive, 0.5, 0.5);
       }},
  };
  for (const Spoilt& one : all) {
    const std::string said = refusal(one.by);
    EXPECT_EQ(said.rfind("recording \"mine\": ", 0), 0U) << said;
    EXPECT_NE(said.find(one.expected), std::string::npos) << said << "\n" << one.expected;
  }
}

TEST(WellFormed, EveryCallThatReadsRecordingsAsksForIt) {
  DrivenRecording recording = straight();
  recording.drive.pair.left.clear();
  EXPECT_THROW(static_cast<void>(build_map({recording}, Model())), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(build_map({recording}, Model(), {.method = Method::adjustment})),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(fit_model({recording}, Model())), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(calibrate_wheels({recording}, Model())), std::invalid_argument);
}

}  // namespace
}  // namespace trussmap::well_formed_test
