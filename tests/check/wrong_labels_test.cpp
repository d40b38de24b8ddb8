// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Sightings under another landmark's name: those that are named are wrong, most are named, and a
// recording without any is not accused.
#include "wrong_labels.hpp"

#include "check/findings.hpp"
#include "trussmap/check.hpp"
#include "trussmap/simulated_recording.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace trussmap::wrong_labels_test {
namespace {

SimulatedRecording hall(std::uint64_t seed, bool compass) {
  SimulationSettings settings = testing::seen_hall("5x5", seed);
  settings.no_compass = !compass;
  settings.gyro = !compass;
  settings.no_survey = seed % 2 == 0;
  return simulate(settings, {});
}

/// "L2_3 at t = 48.1 s", as a finding has it, of each.
std::vector<std::string> named_as(const Recording& recording, const std::set<std::size_t>& rows) {
  std::vector<std::string> texts;
  for (const std::size_t row : rows) {
    const Sighting& one = recording.sightings[row];
    texts.push_back(fmt::format("{} at t = {:g} s", one.landmark, one.t));
  }
  return texts;
}

std::vector<CheckFinding> checked(const Recording& recording, const Model& model) {
  return check_read_recordings({recording}, &model, "model.toml");
}

const CheckFinding* wrong_label_in(const std::vector<CheckFinding>& findings) {
  const auto at = std::ranges::find(findings, std::string("wrong label"), &CheckFinding::kind);
  return at == findings.end() ? nullptr : &*at;
}

/// Seeds 1 to 12, with a compass and with a gyro, two labels in a hundred.
TEST(WrongLabels, AreNamed) {
  std::size_t spoilt = 0;
  std::size_t named = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const SimulatedRecording made = hall(seed, seed % 3 != 0);
    Recording recording = made.drive.recording;
    EXPECT_EQ(wrong_label_in(checked(recording, made.model)), nullptr) << seed;
    const std::set<std::size_t> wrong = testing::spoil_labels(recording, 0.02, seed);
    const std::vector<CheckFinding> findings = checked(recording, made.model);
    const CheckFinding* found = wrong_label_in(findings);
    ASSERT_NE(found, nullptr) << seed;
    spoilt += wrong.size();
    named += std::stoul(found->evidence.substr(std::string("at least ").size()));
    // Each that is named is one of them.
    std::size_t here = 0;
    for (std::size_t at = found->evidence.find(" at t = "); at != std::string::npos;
         at = found->evidence.find(" at t = ", at + 1)) {
      ++here;
    }
    std::size_t right = 0;
    for (const std::string& one : named_as(recording, wrong))
      right += found->evidence.find(one) != std::string::npos;
    EXPECT_EQ(here, right) << seed << ": " << found->evidence;
  }
  EXPECT_GT(static_cast<double>(named), 0.5 * static_cast<double>(spoilt));
  EXPECT_LE(named, spoilt);
}

}  // namespace
}  // namespace trussmap::wrong_labels_test
