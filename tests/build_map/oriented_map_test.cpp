// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Maps whose landmarks have an axis of their own: how it lies, how exact it is, and what it tells
// of where a session joins.
#include "trussmap/build_map.hpp"
#include "trussmap/error.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/survey_comparison.hpp"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

namespace trussmap::oriented_map_test {
namespace {

Mesh small_mesh() {
  return mesh_of_lines({0.0, 4.0, 9.0}, {0.0, 3.0, 7.0});
}

WheeledRobot with_markers(bool compass) {
  WheeledRobot robot;
  robot.compass = compass;
  robot.markers = true;
  return robot;
}

Recording drive_of(const WheeledRobot& robot, std::uint64_t seed, int tours = 1) {
  const Mesh mesh = small_mesh();
  std::mt19937_64 random = random_stream(seed, Stream::walk);
  const Tours walk = make_tours(mesh, WalkKind::euler, tours, random);
  return simulate_drive(mesh, walk.walk, {}, robot, seed).recording;
}

/// The landmarks' true places and axes: what a survey without noise says.
std::vector<SurveyPoint> true_survey() {
  WheeledRobot robot = with_markers(true);
  robot.noise = kNoiseFree;
  return drive_of(robot, 1).survey;
}

Model model_of(const WheeledRobot& robot) {
  Model model;
  model.noise.yaw = robot.noise.yaw;
  return model;
}

/// 20 drives with a compass, seeds 1 to 20: the errors of the axes are as large as is said of them.
/// Those of one drive go together a little, by its compass.
TEST(OrientedMap, AxesAreAsExactAsIsSaid) {
  const std::vector<SurveyPoint> truth = true_survey();
  double squares = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const WheeledRobot robot = with_markers(true);
    const BuiltMap built = build_map({drive_of(robot, seed)}, model_of(robot));
    EXPECT_EQ(built.quality.oriented, 9);
    for (const SurveyPoint& point : truth) {
      const Landmark& one = built.map.landmark(*built.map.find(point.landmark));
      ASSERT_TRUE(one.heading && one.sd_heading);
      EXPECT_LT(*one.sd_heading, 1.5 * robot.noise.yaw);
      squares += std::pow(wrap_angle(*one.heading - point.heading) / *one.sd_heading, 2);
      ++count;
    }
  }
  EXPECT_NEAR(squares / count, 1.0, 0.4) << count;
}

/// Without yaws a map has none, and nothing is written of them.
TEST(OrientedMap, WithoutYawsThereIsNoOrientation) {
  WheeledRobot robot = with_markers(true);
  robot.markers = false;
  const BuiltMap built = build_map({drive_of(robot, 2)}, Model{});
  EXPECT_EQ(built.quality.oriented, 0);
  EXPECT_FALSE(built.map.landmark(0).heading);
  EXPECT_EQ(format_map_graphml(built.map).find("heading"), std::string::npos);
  EXPECT_EQ(format_positions(built.map).rfind("landmark,x,y,c_xx,c_xy,c_yy\n", 0), 0U);
  EXPECT_EQ(map_picture(built, "").find("class=\"axis\""), std::string::npos);
}

/// A tag of which every yaw is wrong, each by something else: the sightings stay, and so does the
/// rest of the map.
TEST(OrientedMap, WrongYawsOfATagLeaveTheMapAsItIs) {
  const WheeledRobot robot = with_markers(true);
  Recording recording = drive_of(robot, 3);
  const std::string name = recording.sightings.front().landmark;
  int turned = 0;
  for (Sighting& one : recording.sightings) {
    if (one.landmark == name) one.yaw = wrap_angle(one.yaw + 1.3 * ++turned);
  }
  const BuiltMap built = build_map({recording}, model_of(robot));
  EXPECT_TRUE(built.rejected.empty());
  for (const SurveyPoint& point : true_survey()) {
    if (point.landmark == name) continue;
    const Landmark& one = built.map.landmark(*built.map.find(point.landmark));
    ASSERT_TRUE(one.heading) << point.landmark;
    EXPECT_NEAR(wrap_angle(*one.heading - point.heading), 0.0, 5.0 * *one.sd_heading);
  }
}

TEST(OrientedMap, ThePictureHasATickForEachAxis) {
  const WheeledRobot robot = with_markers(false);
  const BuiltMap built = build_map({drive_of(robot, 4)}, model_of(robot));
  const std::string svg = map_picture(built, "");
  int ticks = 0;
  for (std::size_t at = 0; (at = svg.find("class=\"axis\"", at)) != std::string::npos; ++at) {
    ++ticks;
  }
  EXPECT_EQ(ticks, 9);
  const Page page = map_page(built, "");
  EXPECT_NE(render_page(page, {}).find("axis of the landmark"), std::string::npos);
}

/// The recording in another place, but for one landmark: two robots that meet at one tag.
Recording elsewhere_but_for(const std::string& tag, Recording recording) {
  recording.name = "elsewhere";
  for (Sighting& one : recording.sightings) {
    if (one.landmark != tag) one.landmark += " too";
  }
  return recording;
}

/// Two sessions without a compass that have one tag in common: its yaw says how they lie to each
/// other, wherever the robots looked as they began; without yaws they cannot be joined.
TEST(OrientedMap, OneTagJoinsTwoSessions) {
  for (std::uint64_t seed = 11; seed < 17; ++seed) {
    WheeledRobot robot = with_markers(false);
    robot.noise.yaw = 0.005;
    const Recording first = drive_of(robot, seed);
    const std::string tag = first.sightings[seed % 9].landmark;
    // Another walk, which begins elsewhere and looks elsewhere.
    const Recording second = elsewhere_but_for(tag, drive_of(robot, seed + 100));
    const BuiltMap built = build_map({first, second}, model_of(robot));
    EXPECT_TRUE(built.fit.converged);
    EXPECT_LT(built.fit.chi2, 1.6 * built.fit.dof) << seed;
    std::vector<SurveyPoint> survey = true_survey();
    for (std::size_t k = 0; k < 9; ++k) {
      SurveyPoint one = survey[k];
      if (one.landmark == tag) continue;
      one.landmark += " too";
      survey.push_back(one);
    }
    const SurveyComparison on_truth = compare_with_survey(positions_of(built.map), survey);
    EXPECT_EQ(on_truth.landmarks, 17);
    EXPECT_LT(on_truth.rigid.rms, 0.3) << seed;
    std::vector<Recording> without{first, second};
    for (Recording& one : without) {
      for (Sighting& sighting : one.sightings) sighting.yaw = kAbsent;
    }
    EXPECT_THROW((void)build_map(without, model_of(robot)), SolveError);
  }
}

/// Leg by leg, with a compass that is poor: good yaws make a better map (seeds 21 to 30).
TEST(OrientedMap, LegsUseYawsBesideACompass) {
  double with = 0.0;
  double without = 0.0;
  for (std::uint64_t seed = 21; seed <= 30; ++seed) {
    WheeledRobot robot = with_markers(true);
    robot.noise.yaw = 0.002;
    robot.noise.compass = 0.6;
    Recording recording = drive_of(robot, seed);
    recording.survey = true_survey();
    Model model = model_of(robot);
    model.noise.compass = robot.noise.compass;
    BuildMapOptions options;
    options.method = Method::gauss_markov;
    const BuiltMap yaws = build_map({recording}, model, options);
    ASSERT_TRUE(yaws.map.landmark(0).heading);
    with += std::pow(yaws.on_survey->comparison.rigid.rms, 2);
    for (Sighting& one : recording.sightings) one.yaw = kAbsent;
    const BuiltMap none = build_map({recording}, model, options);
    without += std::pow(none.on_survey->comparison.rigid.rms, 2);
  }
  EXPECT_LT(with, 0.7 * without);
}

}  // namespace
}  // namespace trussmap::oriented_map_test
