// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Maps from recordings of a robot with a fault: whoever knows the fault must get the sound robot's
// map, by every method. The simulator turns the physics round in formulas of its own.
#include "simulation/tours.hpp"
#include "simulation/wheeled_robot.hpp"
#include "trussmap/build_map.hpp"
#include "trussmap/catalogue.hpp"

#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::map_under_effects_test {
namespace {

constexpr Method kMethods[] = {Method::elastic, Method::elastic_printed, Method::gauss_markov,
                               Method::adjustment};

struct Fault {
  std::string name;  // of the catalogue
  std::vector<double> coefficients;
  bool range_sensor;
  bool compass;
};

void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.name << (fault.range_sensor ? ", range sensor" : "")
       << (fault.compass ? ", compass" : "");
}

Effect effect_of(const Fault& fault) {
  return catalogue_effect(fault.name, fault.coefficients);
}

/// Two tours of a mesh, every landmark sighted in passing; without noise unless wanted.
Recording drive_about(const Fault& fault, bool noise, std::uint64_t seed) {
  const Mesh mesh = mesh_of_lines({0.0, 4.0, 9.0}, {0.0, 3.0, 7.0});
  std::mt19937_64 random(seed);
  const Tours tours = make_tours(mesh, WalkKind::euler, 2, random);
  WheeledRobot robot;
  robot.range_sensor = fault.range_sensor;
  robot.compass = fault.compass;
  DrivingStyle style;
  style.overrun = 0.4;
  if (!noise) {
    robot.noise = kNoiseFree;
    style.standing = 0.0;
  }
  Recording recording =
      simulate_drive(mesh, tours.walk, style, robot, seed, {{effect_of(fault)}}).recording;
  recording.survey = simulation::survey(mesh, 1e-9, seed);
  return recording;
}

double error_of(const Recording& recording, const Model& model, Method method) {
  const BuiltMap built = build_map({recording}, model, {.method = method});
  EXPECT_TRUE(built.on_survey);
  return built.on_survey ? built.on_survey->comparison.rigid.rms : 1e9;
}

Model knowing(const Fault& fault) {
  Model model;
  model.effects.push_back(effect_of(fault));
  return model;
}

class ExactUnderEffects : public ::testing::TestWithParam<Fault> {};

/// What is left is what a printed correction leaves, which is not repeated, and rows that a delayed
/// sighting cuts: the simulator's stops lie on rows.
TEST_P(ExactUnderEffects, TheModelGivesTheExactMapByEveryMethod) {
  const Recording recording = drive_about(GetParam(), false, 3);
  for (const Method method : kMethods) {
    const double most = method == Method::elastic_printed ? 1e-2 : 2.5e-3;
    EXPECT_LE(error_of(recording, knowing(GetParam()), method), most) << name_of(method);
  }
  // It is there to be found.
  const bool spoils = error_of(recording, Model{}, Method::elastic) >= 5e-3;
  EXPECT_TRUE(spoils || !build_map({recording}, Model{}).good());
}

/// Sums of errors over the seeds 1 to 3: with a model that does not know of the fault, and with one
/// that does.
struct ErrorSums {
  double ignored = 0.0;
  double known = 0.0;
};

ErrorSums error_sums(const Fault& fault, Method method) {
  ErrorSums sums;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Recording recording = drive_about(fault, true, seed);
    sums.ignored += error_of(recording, Model{}, method);
    sums.known += error_of(recording, knowing(fault), method);
  }
  return sums;
}

class BetterUnderEffects : public ::testing::TestWithParam<Fault> {};

/// Mean over the seeds 1 to 3. The printed elastic correction is no judge: without a compass noise
/// alone can throw it far off.
TEST_P(BetterUnderEffects, TheModelMakesANoisyMapBetter) {
  for (const Method method : {Method::elastic, Method::gauss_markov, Method::adjustment}) {
    const ErrorSums sums = error_sums(GetParam(), method);
    EXPECT_LT(sums.known, 0.8 * sums.ignored) << name_of(method);
  }
}

class HarmlessEffects : public ::testing::TestWithParam<Fault> {};

/// Errors that nearly every robot has are estimated beside the map, and named: knowing them before
/// gains nothing. Mean over the seeds 1 to 3. A map that grows on the way knows nothing of them.
TEST_P(HarmlessEffects, AreFreedAndNamed) {
  const Method method = Method::adjustment;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Recording recording = drive_about(GetParam(), true, seed);
    const BuiltMap built = build_map({recording}, Model{}, {.method = method});
    EXPECT_FALSE(built.good());
    EXPECT_TRUE(std::any_of(built.freed.begin(), built.freed.end(), [](const FreedError& one) {
      return one.effect.name == GetParam().name &&
             std::abs(one.effect.coefficients[0] - GetParam().coefficients[0]) < 5.0 * one.sd[0];
    }));
    EXPECT_TRUE(build_map({recording}, knowing(GetParam()), {.method = method}).good());
    EXPECT_TRUE(build_map({recording}, Model{}, {.method = Method::elastic}).freed.empty());
  }
  const ErrorSums sums = error_sums(GetParam(), method);
  EXPECT_LT(sums.ignored, 1.25 * sums.known) << name_of(method);
}

std::string name(const ::testing::TestParamInfo<Fault>& info) {
  std::string result;
  for (const char c : info.param.name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) result += c;
  }
  return result + (info.param.range_sensor ? "WithRangeSensor" : "") +
         (info.param.compass ? "WithCompass" : "");
}

// Those that no column of a recording can say, and one of each other kind.
INSTANTIATE_TEST_SUITE_P(Faults, ExactUnderEffects,
                         ::testing::Values(Fault{"sighting delay", {0.4}, false, true},
                                           Fault{"sighting delay", {0.4}, true, false},
                                           Fault{"lever arm", {0.3}, false, true},
                                           Fault{"lever arm to the left", {0.3}, true, true},
                                           Fault{"constant creep", {0.05}, false, true},
                                           Fault{"constant creep", {0.05}, false, false},
                                           Fault{"hard iron", {0.2, 0.1}, false, true},
                                           Fault{"wheelbase", {-0.03}, false, false},
                                           Fault{"range bias", {0.4}, true, true},
                                           Fault{"bearing offset", {0.2}, true, true}),
                         name);

// Those that bend a map by more than its noise. A steady creep only turns it, and the adjustment's
// gate leaves the views out that a biased range or bearing spoils.
INSTANTIATE_TEST_SUITE_P(Faults, BetterUnderEffects,
                         ::testing::Values(Fault{"sighting delay", {0.4}, false, true},
                                           Fault{"sighting delay", {0.4}, true, false},
                                           Fault{"lever arm", {0.3}, false, true},
                                           Fault{"lever arm to the left", {0.3}, true, true}),
                         name);

INSTANTIATE_TEST_SUITE_P(Faults, HarmlessEffects,
                         ::testing::Values(Fault{"hard iron", {0.2, 0.1}, false, true},
                                           Fault{"wheelbase", {-0.03}, false, false}),
                         name);

/// Several at once act side by side, not one on the other's result.
TEST(MapUnderEffectsTogether, SeveralActSideBySide) {
  Model model;
  model.effects.push_back(effect_of({"wheelbase", {-0.1}, false, false}));
  model.effects.push_back(effect_of({"wheel diameter ratio", {0.04}, false, false}));
  model.effects.push_back(effect_of({"sighting delay", {0.3}, false, false}));
  const Mesh mesh = mesh_of_lines({0.0, 4.0, 9.0}, {0.0, 3.0, 7.0});
  std::mt19937_64 random(4);
  const Tours tours = make_tours(mesh, WalkKind::euler, 2, random);
  WheeledRobot robot;
  robot.compass = false;
  robot.noise = kNoiseFree;
  DrivingStyle style;
  style.overrun = 0.4;
  style.standing = 0.0;
  Recording recording =
      simulate_drive(mesh, tours.walk, style, robot, 4, {model.effects}).recording;
  recording.survey = simulation::survey(mesh, 1e-9, 4);
  for (const Method method : kMethods) {
    EXPECT_LE(error_of(recording, model, method), 2e-3) << name_of(method);
  }
}

}  // namespace
}  // namespace trussmap::map_under_effects_test
