// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Stores of fleets: nothing is lost, and shards merge to the same whatever their order.
#include "child_process.hpp"
#include "scratch_folder.hpp"
#include "store/database.hpp"
#include "trussmap/error.hpp"
#include "trussmap/fleet.hpp"
#include "trussmap/write_files.hpp"

#include <filesystem>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::fleet_store_test {
namespace {

using testing::ScratchFolder;

FleetRow made_row(const std::string& robot, const std::string& date, double seed = 1.0) {
  FleetRow row;
  row.robot = robot;
  row.date = date;
  row.metadata = {{"tyre batch", "A"}};
  row.model = "model";
  row.chi2 = 10.0 + seed;
  row.dof = 10;
  row.columns = {{false, "wheelbase", "turn", "1", 0}, {false, "creep", "creep", "1", 0}};
  row.reference = {0.0, 0.0};
  row.prior_sd = {0.1, 0.1};
  row.largest = {1.0, 1.0};
  row.whole = {4.0, 5.0};
  row.g = Eigen::Vector2d(0.1 * seed, 1.0 / 3.0);
  row.S = (Eigen::Matrix2d() << 3.0, 0.7, 0.7, 4.0).finished();
  return row;
}

void expect_complaint(const std::function<void()>& call, const std::string& said) {
  try {
    call();
    FAIL() << "expected a complaint: " << said;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
  }
}

TEST(FleetStore, KeepsRowsToTheBit) {
  const ScratchFolder scratch;
  const auto file = scratch.path() / "fleet.db";
  const FleetRow row = made_row("R1", "2026-03-01");
  add_to_fleet(file, row);
  const std::vector<FleetRow> rows = read_fleet(file);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].metadata, row.metadata);
  EXPECT_EQ(rows[0].columns, row.columns);
  EXPECT_EQ(rows[0].whole, row.whole);
  EXPECT_TRUE(rows[0].g == row.g);
  EXPECT_TRUE(rows[0].S == row.S);
}

TEST(FleetStore, ADayIsReplacedOnlyOnWish) {
  const ScratchFolder scratch;
  const auto file = scratch.path() / "fleet.db";
  add_to_fleet(file, made_row("R1", "2026-03-01"));
  expect_complaint([&] { add_to_fleet(file, made_row("R1", "2026-03-01", 2.0)); }, "--replace");
  EXPECT_EQ(read_fleet(file)[0].chi2, 11.0);
  add_to_fleet(file, made_row("R1", "2026-03-01", 2.0), true);
  EXPECT_EQ(read_fleet(file)[0].chi2, 12.0);
  FleetRow other = made_row("R2", "2026-03-01");
  other.model = "other";
  expect_complaint([&] { add_to_fleet(file, other); }, "another model");
  EXPECT_EQ(read_fleet(file).size(), 1U);
}

/// What somebody else's SQLite may have put into the file.
TEST(FleetStore, OtherTablesAndDamagedCellsAreRefused) {
  const ScratchFolder scratch;
  const auto file = scratch.path() / "fleet.db";
  add_to_fleet(file, made_row("R1", "2026-03-01"));
  add_to_fleet(file, made_row("R2", "2026-03-02"));
  const std::string whole = read_file(file);
  const auto refused = [&](const std::string& statements, const std::string& said) {
    write_file(file, whole);
    store::Database(file, store::Database::Access::write).run(statements);
    expect_complaint([&] { static_cast<void>(read_fleet(file)); }, file.string() + ": " + said);
    expect_complaint([&] { static_cast<void>(merge_fleets(scratch.path() / "out.db", {file})); },
                     said);
    EXPECT_FALSE(std::filesystem::exists(scratch.path() / "out.db"));
  };
  const std::string tables = "is damaged: its tables are not those of a fleet store";
  refused("CREATE TRIGGER t AFTER INSERT ON days BEGIN DELETE FROM metadata; END", tables);
  refused("ALTER TABLE days RENAME TO mine; CREATE VIEW days AS SELECT * FROM mine", tables);
  refused("CREATE INDEX i ON days(hex(zeroblob(length(robot) * 1000000)))", tables);
  const std::string second = "is a damaged fleet store: row 2 of days: ";
  const auto damaged = [&](const std::string& set, const std::string& said) {
    refused("UPDATE days SET " + set + " WHERE robot = 'R2'", second + said);
  };
  damaged("chi2 = 'many'", "text in column chi2, expected a number");
  damaged("dof = 1.5", "a number that is not whole in column dof");
  damaged("dof = -1", "a count is -1");
  damaged("chi2 = 9e999", "a figure of the day is no number of 0 or more");
  damaged("columns = x'00'", "bytes in column columns");
  damaged("g = 'text'", "text in column g");
  damaged("date = '2026-02-31'", "the day is none");
  damaged("robot = 'R2' || char(27)", "the robot's name holds a control character");
}

TEST(FleetStore, WhatFailsLeavesNoFile) {
  const ScratchFolder scratch;
  const auto file = scratch.path() / "fleet.db";
  EXPECT_THROW(add_to_fleet(file, made_row("a\nb", "2026-03-01")), std::invalid_argument);
  FleetRow row = made_row("R1", "2026-03-01");
  row.g[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(add_to_fleet(file, row), std::invalid_argument);
  expect_complaint([&] { static_cast<void>(read_fleet(file)); }, "is missing");
  EXPECT_TRUE(scratch.contents().empty());
  add_to_fleet(file, made_row("R1", "2026-03-01"));
  EXPECT_EQ(scratch.contents().size(), 1U);  // nothing beside it
}

TEST(FleetStore, WhoAddAtOnceLoseNothing) {
  const ScratchFolder scratch;
  const auto file = scratch.path() / "fleet.db";
  constexpr int kEach = 20;
  std::vector<pid_t> ids;
  for (int child = 0; child < 3; ++child) {
    const pid_t id = ::fork();
    ASSERT_GE(id, 0);
    if (id == 0) {
      try {
        for (int k = 0; k < kEach; ++k) {
          add_to_fleet(file, made_row("R" + std::to_string(child * kEach + k), "2026-03-01"));
        }
      } catch (...) {
        ::_exit(1);
      }
      ::_exit(0);
    }
    ids.push_back(id);
  }
  for (const pid_t id : ids) EXPECT_EQ(testing::wait_for(id), 0);
  EXPECT_EQ(read_fleet(file).size(), 3U * kEach);
}

TEST(FleetStore, ShardsMergeToTheSameInAnyOrder) {
  const ScratchFolder scratch;
  const auto a = scratch.path() / "a.db";
  const auto b = scratch.path() / "b.db";
  add_to_fleet(a, made_row("R2", "2026-03-02"));
  add_to_fleet(a, made_row("R1", "2026-03-01"));
  add_to_fleet(b, made_row("R3", "2026-03-01"));
  add_to_fleet(b, made_row("R1", "2026-03-01"));
  EXPECT_EQ(merge_fleets(scratch.path() / "ab.db", {a, b}), 3U);
  EXPECT_EQ(merge_fleets(scratch.path() / "ba.db", {b, a}), 3U);
  EXPECT_EQ(read_file(scratch.path() / "ab.db"), read_file(scratch.path() / "ba.db"));
  add_to_fleet(b, made_row("R2", "2026-03-02", 2.0));
  expect_complaint(
      [&] {
        static_cast<void>(merge_fleets(scratch.path() / "c.db", {a, b}));
      },
      "other figures for robot R2 on 2026-03-02");
  EXPECT_FALSE(std::filesystem::exists(scratch.path() / "c.db"));
}

TEST(FleetStore, MergingIntoAStoreKeepsWhatItHas) {
  const ScratchFolder scratch;
  const auto fleet = scratch.path() / "fleet.db";
  const auto shard = scratch.path() / "shard.db";
  add_to_fleet(fleet, made_row("R1", "2026-03-01"));
  add_to_fleet(shard, made_row("R1", "2026-03-01"));
  add_to_fleet(shard, made_row("R2", "2026-03-01"));
  EXPECT_EQ(merge_fleets(fleet, {shard}), 2U);
  EXPECT_EQ(merge_fleets(fleet, {shard}), 2U);
  EXPECT_EQ(read_fleet(fleet).size(), 2U);
  add_to_fleet(shard, made_row("R3", "2026-03-01"));
  add_to_fleet(shard, made_row("R1", "2026-03-01", 2.0), true);
  expect_complaint([&] { static_cast<void>(merge_fleets(fleet, {shard})); }, "other figures");
  EXPECT_EQ(read_fleet(fleet).size(), 2U);
}

TEST(FleetStore, WhatIsNoneIsSaidInOneLine) {
  const ScratchFolder scratch;
  const auto file = scratch.path() / "fleet.db";
  write_file(file, std::string(200, 'x'));
  expect_complaint([&] { static_cast<void>(read_fleet(file)); }, "is no fleet store");
  expect_complaint([&] { static_cast<void>(read_fleet(scratch.path() / "none.db")); }, "none.db");
}

}  // namespace
}  // namespace trussmap::fleet_store_test
