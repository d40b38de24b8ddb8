// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A model's odometry in use: places, sightings, what is refused, and the guide's example.
#include "drive/row_variables.hpp"
#include "fit/online_models.hpp"
#include "policy/source_files.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/corrected_odometry.hpp"

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::corrected_odometry_use_test {
namespace {

using testing::own_effect;
using testing::with;

TEST(CorrectedOdometry, ShapesSeeThePlaceInTheMap) {
  const Model model = with({own_effect(Channel::travel, "x", 0.1)});
  CorrectedOdometry odometry(model);
  odometry.set_map_pose({3.0, 7.0, 0.0});
  EXPECT_NEAR(odometry.drive({0.1, 0.2, 0.2}).pose.pose.x, 0.2 * (1.0 + 0.1 * 3.1), 1e-3);
  odometry.set_map_pose({0.0, 0.0, 0.0});
  EXPECT_NEAR(odometry.drive({0.1, 0.2, 0.2}).motion.displacement.x, 0.2 * (1.0 + 0.1 * 0.1), 1e-4);
  EXPECT_NEAR(odometry.pose().pose.x, 0.4642, 2e-3);
}

/// As a map from recordings takes them (effects of sensors, levers and clocks).
TEST(CorrectedOdometry, SightingsAreFreedFromTheirEffects) {
  OdometryInputs inputs;
  inputs.covariates = {"haze"};
  CorrectedOdometry odometry(
      with({catalogue_effect("range bias", {0.1}), catalogue_effect("range scale", {0.05}),
            own_effect(Channel::bearing, "haze", 0.02), catalogue_effect("lever arm", {0.12}),
            catalogue_effect("lever arm to the left", {-0.03}),
            catalogue_effect("sighting delay", {0.25}), own_effect(Channel::delay, "speed", 0.1)}),
      inputs);
  const Sighting seen{10.0, "A", 2.2, 0.5};
  EXPECT_THROW(static_cast<void>(odometry.corrected(seen)), std::invalid_argument);  // no haze yet
  odometry.drive({0.1, 0.05, 0.05}, std::array{3.0});
  const CorrectedSighting freed = odometry.corrected(seen);
  EXPECT_NEAR(freed.sighting.t, 10.0 - 0.25 - 0.1 * 0.5, 1e-12);
  EXPECT_NEAR(freed.sighting.range, 2.0, 1e-12);
  EXPECT_NEAR(freed.sighting.bearing, 0.44, 1e-12);
  EXPECT_EQ(freed.sensor_robot, Vector2(0.12, -0.03));
  EXPECT_EQ(freed.sighting.landmark, "A");
  EXPECT_EQ(odometry.corrected({10.0, "A", 0.05, 0.5}).sighting.range, 0.0);
  EXPECT_TRUE(odometry.corrected({10.0, "A"}).sighting.standing());
}

std::string message_of(const Model& model, const OdometryInputs& inputs = {}) {
  try {
    const CorrectedOdometry odometry(model, inputs);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(CorrectedOdometry, NamesTheEffectThatCannotBeApplied) {
  const Effect load = catalogue_effect("load on both wheels (payload_kg)", {0.002});
  const std::string message = message_of(with({load}));
  EXPECT_NE(message.find("effect \"load on both wheels (payload_kg)\""), std::string::npos);
  EXPECT_NE(message.find("which the robot does not supply"), std::string::npos);
  EXPECT_NE(message_of(with({load}), {{"load_kg"}, false}).find("distance"), std::string::npos);
  EXPECT_EQ(message_of(with({load}), {{"payload_kg"}, false}), "");
  Effect shapeless;
  shapeless.name = "mine";
  EXPECT_NE(message_of(with({shapeless})).find("\"mine\" has no shape"), std::string::npos);
  Effect sessions = catalogue_effect("wheelbase");
  sessions.per_session = true;
  sessions.coefficients = {0.01, 0.02};
  EXPECT_NE(message_of(with({sessions})).find("2 coefficients"), std::string::npos);
  EXPECT_NE(message_of({}, {{"speed"}, false}).find("\"speed\""), std::string::npos);
  EXPECT_NE(message_of({}, {{"a", "a"}, false}).find("\"a\""), std::string::npos);
  Model flat;
  flat.robot.wheelbase = 0.0;
  EXPECT_NE(message_of(flat).find("wheelbase"), std::string::npos);
}

TEST(CorrectedOdometry, KnowsEveryVariable) {
  for (const std::string& name : recording::reserved_variables()) {
    EXPECT_EQ(message_of(with({own_effect(Channel::travel, name.c_str(), 0.1)})), "") << name;
  }
}

TEST(CorrectedOdometry, ARowThatIsRefusedChangesNothing) {
  CorrectedOdometry odometry(with({own_effect(Channel::travel, "log(load)", 0.1)}),
                             {{"load"}, false});
  odometry.drive({0.1, 0.05, 0.06}, std::array{1.0});
  const Pose before = odometry.pose().pose;
  const auto refuses = [&odometry](const WheelRow& row, double load) {
    EXPECT_THROW(odometry.drive(row, std::array{load}), std::invalid_argument);
  };
  refuses({0.1, 0.05, 0.06}, 0.0);  // no logarithm
  refuses({0.1, 0.05, 0.06}, kAbsent);
  refuses({0.0, 0.05, 0.06}, 1.0);
  refuses({kAbsent, 0.05, 0.06}, 1.0);
  refuses({0.1, kAbsent, 0.06}, 1.0);
  refuses({0.1, 0.05, 0.06, 0.3}, 1.0);  // no compass
  EXPECT_THROW(odometry.drive({0.1, 0.05, 0.06}), std::invalid_argument);
  EXPECT_EQ(odometry.pose().pose.x, before.x);
  EXPECT_EQ(odometry.pose().pose.heading, before.heading);
  try {
    odometry.drive({0.1, 0.05, 0.06}, std::array{0.0});
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("effect \"own\""), std::string::npos);
  }
  CorrectedOdometry other(with({own_effect(Channel::travel, "log(load)", 0.1)}), {{"load"}, false});
  other.drive({0.1, 0.05, 0.06}, std::array{1.0});
  EXPECT_EQ(other.drive({0.1, 0.07, 0.06}, std::array{2.0}).pose.pose.x,
            odometry.drive({0.1, 0.07, 0.06}, std::array{2.0}).pose.pose.x);
}

/// The guide's example, compiled here and the same to the letter.
// guide: begin
Pose drive_home(const Model& model, const std::vector<WheelRow>& rows, double payload_kg) {
  CorrectedOdometry odometry(model, {.covariates = {"payload_kg"}, .compass = false});
  for (const WheelRow& row : rows) odometry.drive(row, std::array{payload_kg});
  return odometry.pose().pose;  // its covariance stands beside it
}
// guide: end

TEST(CorrectedOdometry, TheGuidesExampleRuns) {
  const std::string here = testing::text_of("tests/fit/corrected_odometry_use_test.cpp");
  const std::string begin = "// guide: begin\n";
  const std::size_t from = here.find(begin) + begin.size();
  const std::string example = here.substr(from, here.find("// guide: end\n") - from);
  EXPECT_NE(testing::text_of("docs/real-robots.md").find("```cpp\n" + example + "```\n"),
            std::string::npos);
  const Model model = with({own_effect(Channel::wheels, "payload_kg", 0.01)});
  EXPECT_NEAR(drive_home(model, {{0.1, 0.5, 0.5}, {0.1, 0.5, 0.5}}, 2.0).x, 1.02, 1e-12);
}

}  // namespace
}  // namespace trussmap::corrected_odometry_use_test
