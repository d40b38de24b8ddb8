// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Healthy recordings of every equipment, each spoilt by one mistake that people make.
#include "trussmap/check.hpp"

#include "datasets/formats.hpp"
#include "shared_data.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

namespace trussmap::check_test {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

struct Equipment {
  bool compass = true;
  bool survey = true;
  bool views = false;
  bool truth = false;
  bool markers = false;

  [[nodiscard]] std::string text() const {
    return std::string("sightings") + (compass ? "Compass" : "") + (survey ? "Survey" : "") +
           (views ? "Views" : "") + (truth ? "Truth" : "");
  }
};

struct World {
  Recording recording;
  Model model;
  Equipment equipment;
  std::mt19937_64 random;

  [[nodiscard]] std::size_t draw(std::size_t from, std::size_t to) {
    return from + static_cast<std::size_t>(random() % (to - from));
  }
};

void add_truth(const TrueMotion& motion, Recording& recording) {
  for (std::size_t row = 0; row < motion.rows.size(); row += 2) {
    const TrueRow& one = motion.rows[row];
    recording.truth.push_back({one.t, one.pose.x, one.pose.y, one.pose.heading});
  }
}

World world_of(const Equipment& equipment, std::uint64_t seed, int effects = 0) {
  World world;
  world.random = random_stream(seed, Stream::walk);
  const std::vector<double> x = random_lines(5, 3.0, 6.5, world.random);
  const std::vector<double> y = random_lines(4, 3.0, 6.5, world.random);
  const Mesh mesh = mesh_of_lines(x, y);
  const Tours tours = make_tours(mesh, WalkKind::euler, 2, world.random);
  WheeledRobot robot;
  robot.compass = equipment.compass;
  robot.range_sensor = equipment.views;
  robot.markers = equipment.markers;
  SimulatedEffects acting;
  if (effects > 0) {
    acting.effects = draw_hidden_effects(mesh, tours.walk, {}, robot, equipment.survey, seed);
  }
  SimulatedDrive drive = simulate_drive(mesh, tours.walk, {}, robot, seed, acting);
  world.recording = std::move(drive.recording);
  world.recording.name = "drive";
  if (equipment.truth) add_truth(drive.motion, world.recording);
  if (!equipment.survey) world.recording.survey.clear();
  world.model.robot.wheelbase = robot.geometry.wheelbase;
  world.equipment = equipment;
  return world;
}

std::vector<Equipment> all_equipment() {
  std::vector<Equipment> result;
  for (int bits = 0; bits < 16; ++bits) {
    result.push_back({(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0});
  }
  return result;
}

bool any_equipment(const Equipment&) {
  return true;
}

struct Mistake {
  std::string name;
  std::set<std::string> kinds;  ///< any of them names it
  std::function<bool(const Equipment&)> shown_by;
  std::function<void(World&)> make;
};

void scale(std::vector<double>& values, double by) {
  for (double& value : values) value *= by;
}

void scale_sightings(World& world, double range, double bearing) {
  for (Sighting& one : world.recording.sightings) {
    one.range *= range;
    one.bearing *= bearing;
  }
}

void scale_times(World& world, double by) {
  Recording& one = world.recording;
  scale(one.drive.t, by);
  for (Sighting& sighting : one.sightings) sighting.t *= by;
  for (TruthRow& row : one.truth) row.t *= by;
}

void scale_survey(World& world, double by) {
  for (SurveyPoint& point : world.recording.survey) {
    point.x *= by;
    point.y *= by;
  }
}

std::size_t moving_row(World& world) {
  const Drive& drive = world.recording.drive;
  for (;;) {
    const std::size_t row = world.draw(1, drive.rows() - 1);
    if (drive.left[row] != 0.0 && drive.right[row] != 0.0) return row;
  }
}

std::vector<Mistake> mistakes() {
  using Kinds = std::set<std::string>;
  const auto has_compass = [](const Equipment& e) { return e.compass; };
  const auto has_survey = [](const Equipment& e) { return e.survey; };
  const auto has_views = [](const Equipment& e) { return e.views; };
  const auto has_truth = [](const Equipment& e) { return e.truth; };
  const auto shows_turns = [](const Equipment& e) {
    return e.compass || e.survey || e.views || e.truth;
  };
  const Kinds exchanged{"wheels exchanged", "turns opposite"};
  std::vector<Mistake> all;
  const auto add = [&](const std::string& name, const Kinds& kinds,
                       std::function<bool(const Equipment&)> shown_by,
                       std::function<void(World&)> make) {
    all.push_back({name, kinds, std::move(shown_by), std::move(make)});
  };
  for (const double unit : {1000.0, 100.0}) {
    add("travels times " + std::to_string(unit), {"travel unit"}, any_equipment,
        [unit](World& world) {
          scale(world.recording.drive.left, unit);
          scale(world.recording.drive.right, unit);
        });
    add("ranges times " + std::to_string(unit), {"range unit"}, has_views,
        [unit](World& world) { scale_sightings(world, unit, 1.0); });
    add("survey times " + std::to_string(unit), {"survey unit"}, has_survey,
        [unit](World& world) { scale_survey(world, unit); });
    add("truth times " + std::to_string(unit), {"truth unit"}, has_truth, [unit](World& world) {
      for (TruthRow& row : world.recording.truth) {
        row.x *= unit;
        row.y *= unit;
      }
    });
  }
  add("milliseconds", {"time unit"}, any_equipment, [](World& world) { scale_times(world, 1e3); });
  add("compass in degrees", {"angle unit"}, has_compass, [](World& world) {
    for (double& heading : world.recording.drive.heading) {
      heading = std::remainder(heading * kDegrees, 360.0);
    }
  });
  add("bearings in degrees", {"angle unit"}, has_views,
      [](World& world) { scale_sightings(world, 1.0, kDegrees); });
  add("truth in degrees", {"angle unit"}, has_truth, [](World& world) {
    for (TruthRow& row : world.recording.truth) row.heading *= kDegrees;
  });
  add("clockwise compass", {"compass clockwise", "turns opposite"}, has_compass,
      [](World& world) { scale(world.recording.drive.heading, -1.0); });
  add("compass from north", {"compass clockwise", "turns opposite"}, has_compass, [](World& world) {
    for (double& heading : world.recording.drive.heading) {
      heading = std::remainder(0.5 * std::numbers::pi - heading, 2.0 * std::numbers::pi);
    }
  });
  add(
      "compass from north, counter-clockwise", {"compass turned"},
      [](const Equipment& e) { return e.compass && (e.survey || e.truth); },
      [](World& world) {
        for (double& heading : world.recording.drive.heading) heading -= 0.5 * std::numbers::pi;
      });
  add("clockwise bearings", {"bearings clockwise", "turns opposite"}, has_views,
      [](World& world) { scale_sightings(world, 1.0, -1.0); });
  add("wheels exchanged", exchanged, shows_turns,
      [](World& world) { std::swap(world.recording.drive.left, world.recording.drive.right); });
  add("wheels negated", {"wheels negated", "turns opposite"}, shows_turns, [](World& world) {
    scale(world.recording.drive.left, -1.0);
    scale(world.recording.drive.right, -1.0);
  });
  add("left negated", {"wheel negated"}, shows_turns,
      [](World& world) { scale(world.recording.drive.left, -1.0); });
  add("right negated", {"wheel negated"}, shows_turns,
      [](World& world) { scale(world.recording.drive.right, -1.0); });
  add(
      "wheels unsigned", {"wheels unsigned"},
      [](const Equipment& e) { return e.compass || e.survey || e.truth; },
      [](World& world) {
        for (double& travel : world.recording.drive.left) travel = std::abs(travel);
        for (double& travel : world.recording.drive.right) travel = std::abs(travel);
      });
  add("axes exchanged", {"survey mirrored", "turns opposite"}, has_survey, [](World& world) {
    for (SurveyPoint& point : world.recording.survey) std::swap(point.x, point.y);
  });
  add("blank", {"blank in a name"}, any_equipment, [](World& world) {
    world.recording.sightings[world.draw(0, world.recording.sightings.size())].landmark += " ";
  });
  add("spike", {"spike"}, any_equipment,
      [](World& world) { world.recording.drive.left[moving_row(world)] += 50.0; });
  add("still wheel", {"still wheel"}, any_equipment,
      [](World& world) { scale(world.recording.drive.right, 0.0); });
  add("wheel stands still from the middle on", {"still wheel"}, any_equipment, [](World& world) {
    Drive& drive = world.recording.drive;
    for (std::size_t row = drive.rows() / 2; row < drive.rows(); ++row) drive.left[row] = 0.0;
  });
  add("rows lost", {"gap"}, any_equipment, [](World& world) {
    Drive& drive = world.recording.drive;
    const std::size_t from = world.draw(drive.rows() / 4, drive.rows() / 2);
    const auto erase = [from](std::vector<double>& column) {
      if (column.empty()) return;
      const auto at = column.begin() + static_cast<std::ptrdiff_t>(from);
      column.erase(at, at + 150);
    };
    erase(drive.t);
    erase(drive.left);
    erase(drive.right);
    erase(drive.heading);
    for (Covariate& one : drive.covariates) erase(one.values);
  });
  add("clock jump", {"gap"}, any_equipment, [](World& world) {
    Recording& one = world.recording;
    const double from = one.drive.t[moving_row(world)];
    for (double& t : one.drive.t) t += t > from ? 3600.0 : 0.0;
    for (Sighting& sighting : one.sightings) sighting.t += sighting.t > from ? 3600.0 : 0.0;
    for (TruthRow& row : one.truth) row.t += row.t > from ? 3600.0 : 0.0;
  });
  add("truth turned", {"truth turned"}, has_truth, [](World& world) {
    for (TruthRow& row : world.recording.truth) row.heading += 0.3;
  });
  add("other landmarks surveyed", {"other landmarks"}, has_survey, [](World& world) {
    for (SurveyPoint& point : world.recording.survey) point.landmark = "pole " + point.landmark;
  });
  add("survey on a line", {"survey on a line"}, has_survey, [](World& world) {
    for (SurveyPoint& point : world.recording.survey) point.y = 0.5 * point.x;
  });
  add("survey at one point", {"survey at one point"}, has_survey, [](World& world) {
    for (SurveyPoint& point : world.recording.survey) point.x = point.y = 3.0;
  });
  add("labels exchanged", {"labels exchanged"}, has_survey, [](World& world) {
    std::vector<SurveyPoint>& survey = world.recording.survey;
    const std::size_t a = world.draw(0, survey.size());
    const std::size_t b = (a + world.draw(1, survey.size())) % survey.size();
    std::swap(survey[a].landmark, survey[b].landmark);
  });
  add("a point 50 m off", {"survey point off"}, has_survey, [](World& world) {
    world.recording.survey[world.draw(0, world.recording.survey.size())].x += 50.0;
  });
  add("one name at two places", {"one name at two places"}, any_equipment, [](World& world) {
    std::set<std::string> names;
    for (const Sighting& one : world.recording.sightings) names.insert(one.landmark);
    const std::vector<std::string> all_names(names.begin(), names.end());
    const std::size_t a = world.draw(0, all_names.size());
    const std::size_t b = (a + world.draw(1, all_names.size())) % all_names.size();
    for (Sighting& one : world.recording.sightings) {
      if (one.landmark == all_names[b]) one.landmark = all_names[a];
    }
  });
  add("wheelbase in mm", {"impossible wheelbase"}, any_equipment,
      [](World& world) { world.model.robot.wheelbase *= 1000.0; });
  add("three times the wheelbase", {"impossible wheelbase"}, has_compass,
      [](World& world) { world.model.robot.wheelbase *= 3.0; });
  add("no wheelbase", {"no wheelbase"}, any_equipment,
      [](World& world) { world.model.robot.wheelbase_stated = false; });
  return all;
}

std::string text_of(const std::vector<CheckFinding>& findings) {
  std::string text;
  for (const CheckFinding& one : findings) text += in_words(one) + "\n";
  return text;
}

void expect_every_mistake_found(const Equipment& equipment, int worlds) {
  const std::vector<Mistake> all = mistakes();
  std::vector<int> found(all.size(), 0);
  std::vector<std::string> missed(all.size());
  for (int k = 0; k < worlds; ++k) {
    const std::uint64_t seed = 100 + static_cast<std::uint64_t>(k);
    const World healthy = world_of(equipment, seed);
    for (std::size_t m = 0; m < all.size(); ++m) {
      if (!all[m].shown_by(equipment)) continue;
      World world = healthy;
      all[m].make(world);
      const std::vector<CheckFinding> findings =
          check_recordings({world.recording}, &world.model, "model.toml");
      const bool named =
          std::any_of(findings.begin(), findings.end(),
                      [&](const CheckFinding& one) { return all[m].kinds.contains(one.kind); });
      found[m] += named ? 1 : 0;
      if (!named) missed[m] += "seed " + std::to_string(seed) + "\n" + text_of(findings);
    }
  }
  for (std::size_t m = 0; m < all.size(); ++m) {
    if (!all[m].shown_by(equipment)) continue;
    EXPECT_EQ(found[m], worlds) << all[m].name << "\n" << missed[m];
  }
}

class EveryMistake : public ::testing::TestWithParam<Equipment> {};
class SlowEveryMistake : public EveryMistake {};

TEST_P(EveryMistake, IsFoundByWhatCanShowIt) {
  expect_every_mistake_found(GetParam(), 1);
}

TEST_P(SlowEveryMistake, IsFoundByWhatCanShowIt) {
  expect_every_mistake_found(GetParam(), 20);
}

INSTANTIATE_TEST_SUITE_P(Check, SlowEveryMistake, ::testing::ValuesIn(all_equipment()),
                         [](const auto& one) { return one.param.text(); });
INSTANTIATE_TEST_SUITE_P(Check, EveryMistake, ::testing::ValuesIn(all_equipment()),
                         [](const auto& one) { return one.param.text(); });

TEST(Check, KindsAreListed) {
  const std::vector<std::string>& kinds = check_kinds();
  for (const Mistake& mistake : mistakes()) {
    for (const std::string& kind : mistake.kinds) {
      EXPECT_NE(std::find(kinds.begin(), kinds.end(), kind), kinds.end()) << kind;
    }
  }
}

void expect_no_finding(std::uint64_t worlds) {
  for (const Equipment& equipment : all_equipment()) {
    for (std::uint64_t seed = 200; seed < 200 + worlds; ++seed) {
      const World world = world_of(equipment, seed, seed % 2 == 0 ? 1 : 0);
      const std::vector<CheckFinding> findings =
          check_recordings({world.recording}, &world.model, "model.toml");
      EXPECT_TRUE(findings.empty()) << "seed " << seed << ", " << equipment.text() << "\n"
                                    << text_of(findings);
      const std::vector<CheckFinding> without = check_recordings({world.recording});
      EXPECT_TRUE(without.empty()) << "no model, seed " << seed << ", " << equipment.text() << "\n"
                                   << text_of(without);
    }
  }
}

TEST(Check, HealthyRecordingsHaveNoFinding) {
  expect_no_finding(2);
}

TEST(SlowCheck, FiveHundredHealthyRecordingsHaveNoFinding) {
  expect_no_finding(32);
}

/// With markers, seeds 300 to 304; with and without a compass, standing on them or seeing them.
TEST(Check, YawsThatAreWrongAreNamed) {
  const auto kinds_of = [](const World& world) {
    std::set<std::string> kinds;
    for (const CheckFinding& one : check_recordings({world.recording}, &world.model, "model")) {
      kinds.insert(one.kind);
    }
    return kinds;
  };
  for (const bool compass : {false, true}) {
    for (std::uint64_t seed = 300; seed < 305; ++seed) {
      const bool views = seed % 2 == 0;
      const World healthy = world_of({compass, true, views, false, true}, seed);
      EXPECT_TRUE(kinds_of(healthy).empty()) << seed;
      World world = healthy;
      for (Sighting& one : world.recording.sightings) one.yaw = -one.yaw;
      const std::set<std::string> clockwise = kinds_of(world);
      EXPECT_TRUE(clockwise.contains("yaws clockwise") || clockwise.contains("turns opposite"))
          << seed;
      for (Sighting& one : world.recording.sightings) one.yaw *= -kDegrees;
      EXPECT_EQ(kinds_of(world), std::set<std::string>{"angle unit"}) << seed;
      for (Sighting& one : world.recording.sightings) one.yaw *= -1.0;
      EXPECT_TRUE(kinds_of(world).contains("angle unit")) << seed;
      world = healthy;
      for (SurveyPoint& one : world.recording.survey) one.heading *= kDegrees;
      EXPECT_EQ(kinds_of(world), std::set<std::string>{"angle unit"}) << seed;
      world = healthy;
      std::swap(world.recording.drive.left, world.recording.drive.right);
      EXPECT_TRUE(kinds_of(world).contains("wheels exchanged")) << seed;
    }
  }
}

/// A gyro of 0.01 rad/s white noise beside two wheels, as recorded and spoilt.
TEST(Check, GyrosThatCountClockwiseOrInDegrees) {
  std::normal_distribution<double> normal;
  for (const bool compass : {false, true}) {
    World world = world_of({compass, true, false, false}, 4);
    Drive& drive = world.recording.drive;
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      drive.yaw_rate.push_back((drive.right[row] - drive.left[row]) / (0.34 * drive.duration(row)) +
                               0.01 * normal(world.random));
    }
    EXPECT_TRUE(check_recordings({world.recording}, &world.model).empty());
    World clockwise = world;
    scale(clockwise.recording.drive.yaw_rate, -1.0);
    std::vector<CheckFinding> findings =
        check_recordings({clockwise.recording}, &world.model, "model.toml");
    ASSERT_EQ(findings.size(), 1U) << text_of(findings);
    EXPECT_EQ(findings[0].kind, "gyro clockwise") << text_of(findings);
    scale(drive.yaw_rate, kDegrees);
    findings = check_recordings({world.recording}, &world.model, "model.toml");
    ASSERT_EQ(findings.size(), 1U) << text_of(findings);
    EXPECT_EQ(findings[0].kind, "angle unit");
    EXPECT_EQ(findings[0].column, "yaw_rate");
  }
}

TEST(Check, TheSameSessionTwice) {
  const World world = world_of({}, 1);
  Recording again = world.recording;
  again.name = "copy";
  const std::vector<CheckFinding> findings =
      check_recordings({world.recording, world_of({}, 2).recording, again}, &world.model, "m");
  ASSERT_EQ(findings.size(), 1U) << text_of(findings);
  EXPECT_EQ(findings[0].kind, "same session twice");
  EXPECT_EQ(findings[0].file, "copy/drive.csv");
}

TEST(Check, NothingToTest) {
  World world = world_of({false, false, false, false}, 3);
  world.recording.sightings.resize(3);
  const std::vector<CheckFinding> findings =
      check_recordings({world.recording}, &world.model, "model.toml");
  ASSERT_EQ(findings.size(), 1U) << text_of(findings);
  EXPECT_EQ(findings[0].kind, "nothing to test");
}

/// Dataset 4, robot 1, reads 9 once where 15 is, 0.5 s before it reads 15 there; a map of all
/// sightings leaves out this one alone.
TEST(Check, RealRobotsHaveNoFindingButTheExchangedLabelsOfOneSurveyAndOneMisread) {
  TRUSSMAP_NEEDS_SHARED("data/mrclam");
  for (const int set : {1, 4, 6}) {
    for (const int robot : {1, 4}) {
      const std::string prefix =
          "data/mrclam/MRCLAM_Dataset" + std::to_string(set) + "/Robot" + std::to_string(robot);
      const Dataset read = datasets::read_mrclam(testing::shared(prefix));
      const std::vector<CheckFinding> findings = check_recordings({read.recording}, &read.model);
      if (set == 4 && robot == 1) {
        ASSERT_EQ(findings.size(), 1U) << prefix << "\n" << text_of(findings);
        EXPECT_EQ(findings[0].kind, "wrong label");
        EXPECT_NE(findings[0].evidence.find("9 at t = 885.625 s"), std::string::npos);
        EXPECT_NE(findings[0].evidence.find("where 15 is"), std::string::npos);
        continue;
      }
      if (set != 1) {
        EXPECT_TRUE(findings.empty()) << prefix << "\n" << text_of(findings);
        continue;
      }
      ASSERT_EQ(findings.size(), 1U) << prefix << "\n" << text_of(findings);
      EXPECT_EQ(findings[0].kind, "labels exchanged");
      EXPECT_NE(findings[0].evidence.find("17"), std::string::npos) << findings[0].evidence;
      EXPECT_NE(findings[0].evidence.find("11"), std::string::npos) << findings[0].evidence;
    }
  }
}

}  // namespace
}  // namespace trussmap::check_test
