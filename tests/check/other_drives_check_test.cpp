// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Healthy recordings of every drive with other wheels than two, each spoilt by one mistake that
// people make. Worlds are drawn from the seeds 300, 301, ... and 500, 501, ...
#include "check/other_drive_worlds.hpp"
#include "trussmap/check.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::other_drives_check_test {
namespace {

using testing::drive_world;
using testing::DriveWorld;
using testing::Sensors;

constexpr DriveKind kDrives[] = {DriveKind::skid_steer, DriveKind::tricycle, DriveKind::ackermann,
                                 DriveKind::omni3,      DriveKind::mecanum,  DriveKind::wheels};
constexpr double kDegrees = 180.0 / std::numbers::pi;

using Kinds = std::set<std::string>;

struct Mistake {
  std::string name;
  Kinds kinds;  ///< any of them names it
  std::function<bool(const Sensors&)> shown_by;
  std::function<void(DriveWorld&)> make;
  std::string column = {};  ///< that has to be among those named
  std::string remedy = {};  ///< that names it too, where several are that cannot be told apart
};

bool any(const Sensors&) {
  return true;
}
bool by_motion(const Sensors& s) {
  return s.turns() || s.places();
}
bool by_places(const Sensors& s) {
  return s.places();
}

void scale(std::vector<double>& values, double by) {
  for (double& value : values) value *= by;
}

void negate(DriveWorld& world, const std::vector<std::size_t>& columns) {
  for (const std::size_t k : columns) scale(world.column(k), -1.0);
}

class Mistakes {
 public:
  explicit Mistakes(DriveKind kind) : robot_(testing::other_drive(kind).model.robot) {
    kind == DriveKind::tricycle || kind == DriveKind::ackermann ? steered() : unsteered(kind);
    travels(kind);
    sensors();
  }
  [[nodiscard]] const std::vector<Mistake>& all() const { return all_; }

 private:
  void add(const std::string& name, const Kinds& kinds,
           std::function<bool(const Sensors&)> shown_by, std::function<void(DriveWorld&)> make,
           const std::string& column = "") {
    all_.push_back({name, kinds, std::move(shown_by), std::move(make), column, {}});
  }
  void exchanged(std::size_t a, std::size_t b, std::function<bool(const Sensors&)> shown_by) {
    add(
        robot_.columns[a] + " and " + robot_.columns[b] + " exchanged",
        {"wheels exchanged", "turns opposite"}, std::move(shown_by),
        [a, b](DriveWorld& world) { std::swap(world.column(a), world.column(b)); },
        robot_.columns[a]);
    all_.back().remedy = "exchange " + robot_.columns[a] + " and " + robot_.columns[b];
  }

  void steered() {
    add(
        "steering in degrees", {"angle unit"}, by_motion,
        [](DriveWorld& world) { scale(world.column(1), kDegrees); }, "steer");
    add("steering to the right", {"steering clockwise", "turns opposite"}, by_motion,
        [](DriveWorld& world) { negate(world, {1}); });
    add(
        "steering in degrees, to the right", {"angle unit"}, by_motion,
        [](DriveWorld& world) { scale(world.column(1), -kDegrees); }, "steer");
    add("wheel negated", {"wheel negated", "wheels negated", "turns opposite"}, by_motion,
        [](DriveWorld& world) { negate(world, {0}); });
    exchanged(0, 1, by_places);  // turns are hardly changed
    add(
        "steering stands still", {"still steering"}, by_motion,
        [](DriveWorld& world) { scale(world.column(1), 0.0); }, "steer");
    add("wheel stands still", {"no motion"}, any,
        [](DriveWorld& world) { scale(world.column(0), 0.0); });
  }

  void unsteered(DriveKind kind) {
    const std::size_t count = robot_.columns.size();
    const bool spare = kind == DriveKind::skid_steer || kind == DriveKind::mecanum;
    std::vector<std::size_t> every;
    for (std::size_t k = 0; k < count; ++k) {
      every.push_back(k);
      // The wheel across shows nothing of turns that the others do not.
      const bool across = kind == DriveKind::wheels && k == 2;
      add(
          robot_.columns[k] + " negated", {"wheel negated"}, across ? by_places : by_motion,
          [k](DriveWorld& world) { negate(world, {k}); }, robot_.columns[k]);
      add(
          robot_.columns[k] + " stands still", {"still wheel"},
          spare    ? any
          : across ? by_places
                   : by_motion,
          [k](DriveWorld& world) { scale(world.column(k), 0.0); }, robot_.columns[k]);
      add(
          robot_.columns[k] + " stands still from the middle on", {"still wheel"},
          spare    ? any
          : across ? by_places
                   : by_motion,
          [k](DriveWorld& world) {
            std::vector<double>& column = world.column(k);
            std::fill(column.begin() + static_cast<std::ptrdiff_t>(column.size() / 2), column.end(),
                      0.0);
          },
          robot_.columns[k]);
    }
    add("all negated", {"wheels negated", "turns opposite"}, by_motion,
        [every](DriveWorld& world) { negate(world, every); });
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = a + 1; b < count; ++b) {
        const bool one_side = kind == DriveKind::skid_steer && (a < 2) == (b < 2);
        if (!one_side) exchanged(a, b, kind == DriveKind::skid_steer ? by_motion : by_places);
      }
    }
    if (!spare) return;
    const std::vector<std::size_t> left = kind == DriveKind::mecanum
                                              ? std::vector<std::size_t>{0, 2}
                                              : std::vector<std::size_t>{0, 1};
    const std::vector<std::size_t> right = kind == DriveKind::mecanum
                                               ? std::vector<std::size_t>{1, 3}
                                               : std::vector<std::size_t>{2, 3};
    add(
        "left side negated", {"wheels negated"}, by_motion,
        [left](DriveWorld& world) { negate(world, left); }, robot_.columns[left[0]]);
    add(
        "right side negated", {"wheels negated"}, by_motion,
        [right](DriveWorld& world) { negate(world, right); }, robot_.columns[right[0]]);
    add("sides exchanged", {"wheels exchanged", "turns opposite"}, by_motion,
        [left, right](DriveWorld& world) {
          for (std::size_t k = 0; k < 2; ++k) {
            std::swap(world.column(left[k]), world.column(right[k]));
          }
        });
  }

  void travels(DriveKind kind) {
    const bool steers = kind == DriveKind::tricycle || kind == DriveKind::ackermann;
    add(
        "three times the model's distances", {"impossible wheelbase", "impossible length"},
        [](const Sensors& s) { return s.compass; },
        [](DriveWorld& world) {
          Robot& robot = world.model.robot;
          robot.wheelbase *= 3.0;
          robot.length *= 3.0;
          if (robot.drive != DriveKind::wheels) return;
          robot.wheelbase /= 3.0;  // two wheels' that would show the same
          robot.matrix.row(2) /= 3.0;
        });
    add("travels in mm", {"travel unit"}, any, [steers](DriveWorld& world) {
      const std::size_t count = world.model.robot.columns.size();
      for (std::size_t k = 0; k < (steers ? 1 : count); ++k) scale(world.column(k), 1000.0);
    });
  }

  void sensors() {
    const auto compass = [](const Sensors& s) { return s.compass; };
    const auto gyro = [](const Sensors& s) { return s.gyro; };
    const auto truth = [](const Sensors& s) { return s.truth; };
    const auto survey = [](const Sensors& s) { return s.survey; };
    const auto views = [](const Sensors& s) { return s.views; };
    add("clockwise compass", {"compass clockwise", "turns opposite"}, compass,
        [](DriveWorld& world) { scale(world.recording.drive.heading, -1.0); });
    add(
        "compass in degrees", {"angle unit"}, compass,
        [](DriveWorld& world) { scale(world.recording.drive.heading, kDegrees); }, "heading");
    add(
        "compass from north, counter-clockwise", {"compass turned"},
        [](const Sensors& s) { return s.compass && (s.survey || s.truth); },
        [](DriveWorld& world) {
          for (double& heading : world.recording.drive.heading) heading -= 0.5 * std::numbers::pi;
        });
    add("clockwise gyro", {"gyro clockwise", "turns opposite"}, gyro,
        [](DriveWorld& world) { scale(world.recording.drive.yaw_rate, -1.0); });
    add(
        "gyro in degrees", {"angle unit"}, gyro,
        [](DriveWorld& world) { scale(world.recording.drive.yaw_rate, kDegrees); }, "yaw_rate");
    add("truth mirrored", {"truth mirrored", "turns opposite"}, truth, [](DriveWorld& world) {
      for (TruthRow& row : world.recording.truth) {
        row.y = -row.y;
        row.heading = -row.heading;
      }
    });
    add("truth in mm", {"truth unit"}, truth, [](DriveWorld& world) {
      for (TruthRow& row : world.recording.truth) {
        row.x *= 1000.0;
        row.y *= 1000.0;
      }
    });
    add("truth in degrees", {"angle unit"}, truth, [](DriveWorld& world) {
      for (TruthRow& row : world.recording.truth) row.heading *= kDegrees;
    });
    add("truth turned", {"truth turned"}, truth, [](DriveWorld& world) {
      for (TruthRow& row : world.recording.truth) row.heading += 0.3;
    });
    add(
        "fixes mirrored", {"fixes mirrored", "turns opposite"},
        [](const Sensors& s) { return s.fixes; },
        [](DriveWorld& world) {
          for (Fix& fix : world.recording.fixes) std::swap(fix.x, fix.y);
        });
    add("survey mirrored", {"survey mirrored", "turns opposite"}, survey, [](DriveWorld& world) {
      for (SurveyPoint& point : world.recording.survey) std::swap(point.x, point.y);
    });
    add("survey in mm", {"survey unit"}, survey, [](DriveWorld& world) {
      for (SurveyPoint& point : world.recording.survey) {
        point.x *= 1000.0;
        point.y *= 1000.0;
      }
    });
    add("clockwise bearings", {"bearings clockwise", "turns opposite"}, views,
        [](DriveWorld& world) {
          for (Sighting& one : world.recording.sightings) one.bearing *= -1.0;
        });
    add("ranges in mm", {"range unit"}, views, [](DriveWorld& world) {
      for (Sighting& one : world.recording.sightings) one.range *= 1000.0;
    });
  }

  Robot robot_;
  std::vector<Mistake> all_;
};

std::string text_of(const std::vector<CheckFinding>& findings) {
  std::string text;
  for (const CheckFinding& one : findings) text += in_words(one) + "\n";
  return text;
}

bool names(const CheckFinding& finding, const Mistake& mistake) {
  const std::string columns = "," + finding.column + ",";
  if (!mistake.remedy.empty() && finding.remedy.find(mistake.remedy) != std::string::npos) {
    return true;
  }
  return mistake.kinds.contains(finding.kind) &&
         (mistake.column.empty() || finding.kind == "turns opposite" ||
          columns.find("," + mistake.column + ",") != std::string::npos);
}

void expect_every_mistake_found(DriveKind kind, int worlds) {
  const Mistakes mistakes(kind);
  for (const Sensors& sensors : testing::all_sensors()) {
    std::vector<int> found(mistakes.all().size(), 0);
    std::vector<std::string> missed(mistakes.all().size());
    for (int k = 0; k < worlds; ++k) {
      const std::uint64_t seed = 300 + static_cast<std::uint64_t>(k);
      const DriveWorld healthy = drive_world(kind, sensors, seed, k % 2 == 1);
      for (std::size_t m = 0; m < mistakes.all().size(); ++m) {
        const Mistake& mistake = mistakes.all()[m];
        if (!mistake.shown_by(sensors)) continue;
        DriveWorld world = healthy;
        mistake.make(world);
        const std::vector<CheckFinding> findings =
            check_recordings({world.recording}, &world.model, "model.toml");
        const bool named =
            std::any_of(findings.begin(), findings.end(),
                        [&](const CheckFinding& one) { return names(one, mistake); });
        found[m] += named ? 1 : 0;
        if (!named) missed[m] += "seed " + std::to_string(seed) + "\n" + text_of(findings);
      }
    }
    for (std::size_t m = 0; m < mistakes.all().size(); ++m) {
      if (!mistakes.all()[m].shown_by(sensors)) continue;
      EXPECT_EQ(found[m], worlds) << name_of(kind) << ", " << sensors.text() << ": "
                                  << mistakes.all()[m].name << "\n"
                                  << missed[m];
    }
  }
}

class EveryMistakeWithADrive : public ::testing::TestWithParam<DriveKind> {};
class SlowEveryMistakeWithADrive : public EveryMistakeWithADrive {};

TEST_P(EveryMistakeWithADrive, IsFoundByWhatCanShowIt) {
  expect_every_mistake_found(GetParam(), 1);
}

TEST_P(SlowEveryMistakeWithADrive, IsFoundByWhatCanShowIt) {
  expect_every_mistake_found(GetParam(), 20);
}

/// Half of them with a hidden effect.
void expect_no_finding(DriveKind kind, std::uint64_t worlds) {
  for (const Sensors& sensors : testing::all_sensors()) {
    for (std::uint64_t seed = 500; seed < 500 + worlds; ++seed) {
      const DriveWorld world = drive_world(kind, sensors, seed, seed % 2 == 0);
      const std::vector<CheckFinding> findings =
          check_recordings({world.recording}, &world.model, "model.toml");
      EXPECT_TRUE(findings.empty()) << "seed " << seed << ", " << sensors.text() << "\n"
                                    << text_of(findings);
    }
  }
}

TEST_P(EveryMistakeWithADrive, HealthyRecordingsHaveNoFinding) {
  expect_no_finding(GetParam(), 1);
}

TEST_P(SlowEveryMistakeWithADrive, HealthyRecordingsHaveNoFinding) {
  expect_no_finding(GetParam(), 17);
}

std::string name_of_test(const ::testing::TestParamInfo<DriveKind>& one) {
  std::string name(name_of(one.param));
  std::erase(name, '-');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Check, EveryMistakeWithADrive, ::testing::ValuesIn(kDrives), name_of_test);
INSTANTIATE_TEST_SUITE_P(Check, SlowEveryMistakeWithADrive, ::testing::ValuesIn(kDrives),
                         name_of_test);

/// 40 s of a unicycle that says how far it goes and turns, beside a compass that tells neither.
Recording unicycle_drive() {
  Recording recording;
  recording.name = "unicycle";
  Covariate travel{"travel", {}};
  Covariate turn{"turn", {}};
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> any(-std::numbers::pi, std::numbers::pi);
  for (int row = 1; row <= 400; ++row) {
    recording.drive.t.push_back(0.1 * row);
    recording.drive.heading.push_back(any(random));
    travel.values.push_back(0.05 + 0.01 * std::sin(0.1 * row));
    turn.values.push_back(0.06 * std::sin(0.02 * row));
  }
  recording.drive.covariates = {travel, turn};
  return recording;
}

Model unicycle_model() {
  Model model;
  model.robot.drive = DriveKind::unicycle;
  model.robot.columns = {"travel", "turn"};
  return model;
}

TEST(CheckOfDrives, AUnicycleHasNoWheelThatCouldBeNegated) {
  const Model model = unicycle_model();
  for (const CheckFinding& one : check_recordings({unicycle_drive()}, &model, "model.toml")) {
    EXPECT_EQ(one.column.find("left"), std::string::npos) << in_words(one);
    EXPECT_EQ(one.column.find("right"), std::string::npos) << in_words(one);
  }
}

TEST(CheckOfDrives, AGlitchInAUnicyclesTravelIsNamedAndMended) {
  const Model model = unicycle_model();
  const Recording whole = unicycle_drive();
  Recording recording = whole;
  recording.drive.covariates[0].values[200] += 5.0;
  recording.drive.covariates[0].values[201] -= 5.0;
  const std::vector<CheckFinding> findings = check_recordings({recording}, &model, "model.toml");
  EXPECT_TRUE(std::any_of(findings.begin(), findings.end(), [](const CheckFinding& one) {
    return one.kind == "counter glitch" && one.column == "travel";
  })) << text_of(findings);
  const Recording back = mended(recording, &model).recording;
  for (std::size_t row = 0; row < whole.drive.rows(); ++row) {
    EXPECT_NEAR(back.drive.covariates[0].values[row], whole.drive.covariates[0].values[row], 0.01);
  }
}

TEST(CheckOfDrives, KindsAreListed) {
  const std::vector<std::string>& kinds = check_kinds();
  for (const DriveKind kind : kDrives) {
    const Mistakes mistakes(kind);
    for (const Mistake& mistake : mistakes.all()) {
      for (const std::string& one : mistake.kinds) {
        EXPECT_NE(std::find(kinds.begin(), kinds.end(), one), kinds.end()) << one;
      }
    }
  }
}

}  // namespace
}  // namespace trussmap::other_drives_check_test
