// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Loggers that write nothing while the robot is at rest, and rows that are really missing there.
#include "trussmap/check.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

namespace trussmap::gaps_test {
namespace {

/// A drive with rests of up to 20 s at half of its stops; truth from its own clockwork.
SimulatedDrive with_rests(bool compass, std::uint64_t seed) {
  const Mesh mesh = even_mesh({4, 4}, 4.0);
  auto random = random_stream(seed, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, 1, random);
  DrivingStyle style;
  style.rest_share = 0.5;
  style.ramp = 0.6;
  WheeledRobot robot;
  robot.compass = compass;
  return simulate_drive(mesh, tours.walk, style, robot, seed);
}

bool at_rest(const Drive& drive, std::size_t row) {
  return drive.left[row] == 0.0 && drive.right[row] == 0.0;
}

/// Without the rows for which it holds.
void erase_rows(Drive& drive, const std::function<bool(std::size_t row)>& holds) {
  const std::size_t rows = drive.rows();
  const auto erase = [&](std::vector<double>& column) {
    if (column.empty()) return;
    std::vector<double> kept;
    for (std::size_t row = 0; row < rows; ++row) {
      if (!holds(row)) kept.push_back(column[row]);
    }
    column = std::move(kept);
  };
  const Drive whole = drive;
  erase(drive.left);
  erase(drive.right);
  erase(drive.heading);
  for (Covariate& one : drive.covariates) erase(one.values);
  erase(drive.t);
}

/// A logger that is silent at rest, but for the first row of one if it is to tell of that.
void be_silent_at_rest(Recording& recording, bool tells_of_rest) {
  const Drive whole = recording.drive;
  erase_rows(recording.drive, [&](std::size_t row) {
    if (row == 0 || !at_rest(whole, row)) return false;
    return !tells_of_rest || at_rest(whole, row - 1);
  });
}

/// The row after the longest gap.
std::size_t longest_row(const Drive& drive) {
  std::size_t longest = 1;
  for (std::size_t row = 2; row < drive.rows(); ++row) {
    if (drive.duration(row) > drive.duration(longest)) longest = row;
  }
  return longest;
}

void add_truth(const TrueMotion& motion, Recording& recording) {
  for (std::size_t row = 0; row < motion.rows.size(); row += 3) {
    const TrueRow& one = motion.rows[row];
    recording.truth.push_back({one.t, one.pose.x, one.pose.y, one.pose.heading});
  }
}

int gaps_in(const Recording& recording) {
  const std::vector<CheckFinding> findings = check_recordings({recording});
  return static_cast<int>(std::count_if(findings.begin(), findings.end(),
                                        [](const CheckFinding& one) { return one.kind == "gap"; }));
}

TEST(CheckGaps, ALoggerIsSilentAtRest) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const bool tells_of_rest : {false, true}) {
      for (const bool compass : {false, true}) {
        for (const bool truth : {false, true}) {
          SimulatedDrive drive = with_rests(compass, seed);
          if (truth) add_truth(drive.motion, drive.recording);
          be_silent_at_rest(drive.recording, tells_of_rest);
          const Drive& left = drive.recording.drive;
          ASSERT_GT(left.duration(longest_row(left)), 10.0);
          // Without either nothing shows that the robot was at rest.
          EXPECT_EQ(gaps_in(drive.recording), compass || truth ? 0 : 1)
              << seed << ' ' << tells_of_rest << compass << truth;
        }
      }
    }
  }
}

TEST(CheckGaps, ARobotThatIsElsewhereAfterARestHasAGap) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const SimulatedDrive drive = with_rests(true, seed);
    Recording silent = drive.recording;
    be_silent_at_rest(silent, false);
    const std::size_t after = longest_row(silent.drive);
    const double t = silent.drive.t[after] - 0.5;

    Recording turned = silent;
    for (std::size_t row = after; row < turned.drive.rows(); ++row)
      turned.drive.heading[row] += 0.8;
    EXPECT_EQ(gaps_in(turned), 1) << seed;

    Recording moved = silent;
    add_truth(drive.motion, moved);
    for (TruthRow& row : moved.truth) row.x += row.t > t ? 1.0 : 0.0;
    EXPECT_EQ(gaps_in(moved), 1) << seed;

    Recording named = silent;
    named.sightings.push_back({silent.drive.t[after - 1], "here"});
    named.sightings.push_back({silent.drive.t[after], "there"});
    std::stable_sort(named.sightings.begin(), named.sightings.end(),
                     [](const Sighting& a, const Sighting& b) { return a.t < b.t; });
    EXPECT_EQ(gaps_in(named), 1) << seed;
  }
}

/// From a rest to the middle of a drive, and from that to a rest.
TEST(CheckGaps, RowsLostUpToARestAreAGap) {
  const SimulatedDrive drive = with_rests(true, 3);
  const Drive& whole = drive.recording.drive;
  int asked = 0;
  for (std::size_t row = 60; row + 60 < whole.rows(); row += 60) {
    const auto lost = [&](std::size_t k) { return k >= row && k < row + 60; };
    const bool rests = at_rest(whole, row - 1) || at_rest(whole, row + 60);
    double way = 0.0;
    for (std::size_t k = row; k < row + 60; ++k) way += std::abs(whole.left[k] + whole.right[k]);
    if (!rests || way < 4.0) continue;
    Recording cut = drive.recording;
    erase_rows(cut.drive, lost);
    EXPECT_EQ(gaps_in(cut), 1) << row;
    ++asked;
  }
  EXPECT_GT(asked, 2);
}

}  // namespace
}  // namespace trussmap::gaps_test
