// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Robots with a gyro, from the simulator that turns the physics round.
#include "driven.hpp"
#include "estimation/recording_problem.hpp"
#include "estimation/recording_system.hpp"
#include "fit/effect_columns.hpp"
#include "fit/fit_state.hpp"
#include "odometry/wheels_and_gyro.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/corrected_odometry.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/noise_fit.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/wording.hpp"

#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::gyro_test {
using namespace fitting;
using namespace estimation;
namespace {

struct World {
  SensorNoise noise;
  bool compass = false;
  bool survey = true;
  double spacing = 4.0;
  int tours = 1;
};

SimulatedDrive simulated(const World& world, const std::vector<Effect>& effects,
                         std::uint64_t seed) {
  const Mesh mesh = mesh_of_lines({0.0, world.spacing, 2.2 * world.spacing},
                                  {0.0, 0.8 * world.spacing, 1.9 * world.spacing});
  std::mt19937_64 random = random_stream(seed, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, world.tours, random);
  WheeledRobot robot;
  robot.compass = world.compass;
  robot.gyro = true;
  robot.noise = world.noise;
  DrivingStyle style;
  style.standing = world.noise.survey > 0.0 ? 0.005 : 0.0;
  style.rest_share = 0.3;
  style.full_spins = 1;
  SimulatedDrive drive = simulate_drive(mesh, tours.walk, style, robot, seed, {effects});
  if (!world.survey) drive.recording.survey.clear();
  return drive;
}

Model model_with(const std::vector<std::string>& effects) {
  Model model;
  for (const std::string& name : effects) model.effects.push_back(catalogue_effect(name));
  return model;
}

struct Given {
  const char* name;
  std::vector<double> coefficients;
};

class Exactly : public ::testing::TestWithParam<Given> {};

TEST_P(Exactly, WithoutNoiseAFitFindsTheEffectAndLeavesNothing) {
  World world;
  world.noise = kNoiseFree;
  const Effect effect = catalogue_effect(GetParam().name, GetParam().coefficients);
  const DrivenRecording recording = testing::driven(simulated(world, {effect}, 4).recording);
  const ModelFit fit = fit_model({recording}, model_with({GetParam().name}));
  EXPECT_LT(fit.chi2, 1e-6);
  ASSERT_TRUE(fit.effects.front().not_fitted.empty());
  for (std::size_t k = 0; k < GetParam().coefficients.size(); ++k) {
    EXPECT_NEAR(fit.effects.front().effect.coefficients[k], GetParam().coefficients[k],
                1e-4 * fit.effects.front().sd[k]);
  }
  // And without the effect there is something left to find.
  EXPECT_GT(fit_model({recording}, Model()).chi2, 20.0);
}

INSTANTIATE_TEST_SUITE_P(
    Gyro, Exactly,
    ::testing::Values(Given{"gyro bias", {0.004}}, Given{"gyro warm-up", {2e-5}},
                      Given{"gyro temperature drift (temperature_C)", {2e-4}},
                      Given{"gyro scale", {0.02}}, Given{"gyro asymmetry", {0.01}},
                      Given{"wheelbase", {0.03}}, Given{"wheel diameter ratio", {0.01}},
                      Given{"travel scale", {0.01}}, Given{"twist per spin", {0.03}}),
    [](const auto& which) {
      std::string name;
      for (const char c : std::string(which.param.name)) {
        if (std::isalpha(static_cast<unsigned char>(c)) != 0) name += c;
      }
      return name;
    });

/// What a column says against the residuals of a recording whose yaw rates are other.
TEST(Gyro, ColumnsAreThoseOfOtherReadings) {
  World world;
  world.noise = kNoiseFree;
  const Model model;
  const DrivenRecording exact = testing::driven(simulated(world, {}, 7).recording);
  const auto taken = [&](double bias, double scale) {
    DrivenRecording other = exact;
    for (double& rate : other.drive.yaw_rate) rate = rate / (1.0 + scale) + bias;
    return odometry::with_gyro({other}, model.robot, model.noise);
  };
  const auto residuals = [&](const std::vector<DrivenRecording>& recordings,
                             const RecordingState& state) {
    const RecordingProblem problem = make_problem(recordings, model);
    const EffectParameters none;
    RecordingSystem system(problem, none);
    system.linearise(state, Eigen::VectorXd());
    return system.residuals();
  };
  const std::vector<DrivenRecording> recordings = taken(0.0, 0.0);
  const FitState fit = fit_recordings(recordings, model);
  const ShapeContext context(recordings, model.robot, fit.paths);
  for (const Channel channel : {Channel::gyro, Channel::gyro_scale}) {
    const EffectParameters border = {effect_column(channel, "1", -1, context)};
    RecordingSystem system(fit.problem, border);
    system.linearise(fit.adjustment.state, Eigen::VectorXd::Zero(1));
    constexpr double kStep = 1e-6;
    const bool bias = channel == Channel::gyro;
    const Eigen::VectorXd more =
        residuals(taken(bias ? kStep : 0.0, bias ? 0.0 : kStep), fit.adjustment.state);
    const Eigen::VectorXd less =
        residuals(taken(bias ? -kStep : 0.0, bias ? 0.0 : -kStep), fit.adjustment.state);
    // A coefficient explains what the reading has: its column is the opposite.
    const Eigen::VectorXd expected = (less - more) / (2.0 * kStep);
    const Eigen::VectorXd found = system.border().col(0);
    EXPECT_GT(expected.norm(), 1.0);
    EXPECT_LT((found - expected).norm(), 1e-6 * expected.norm()) << name_of(channel);
  }
}

struct Statistics {
  double chi2_per_dof = 0.0;
  double sd = 0.0;       ///< of that mean
  double covered = 0.0;  ///< share of 95 % intervals that hold the truth
};

Statistics statistics(const World& world, int count, std::uint64_t first) {
  const std::vector<std::pair<std::string, double>> given{
      {"gyro bias", 0.003}, {"gyro scale", 0.01}, {"wheelbase", 0.02}};
  std::vector<Effect> effects;
  std::vector<std::string> names;
  for (const auto& [name, value] : given) {
    effects.push_back(catalogue_effect(name, {value}));
    names.push_back(name);
  }
  Statistics result;
  double squares = 0.0;
  int inside = 0;
  Model model = model_with(names);
  model.noise.gyro = world.noise.gyro;
  for (int k = 0; k < count; ++k) {
    const DrivenRecording recording =
        testing::driven(simulated(world, effects, first + static_cast<std::uint64_t>(k)).recording);
    const ModelFit fit = fit_model({recording}, model);
    const double ratio = fit.chi2 / fit.dof;
    result.chi2_per_dof += ratio / count;
    squares += ratio * ratio / count;
    for (std::size_t e = 0; e < given.size(); ++e) {
      const EffectEstimate& one = fit.effects[e];
      if (std::abs(one.effect.coefficients[0] - given[e].second) < 1.959964 * one.sd[0]) ++inside;
    }
  }
  result.sd =
      std::sqrt((squares - result.chi2_per_dof * result.chi2_per_dof) / std::max(1, count - 1));
  result.covered = static_cast<double>(inside) / (count * static_cast<double>(given.size()));
  return result;
}

/// Seeds 100 to 124.
TEST(Gyro, NoiseIsWhatIsStated) {
  World world;
  world.noise.gyro = 0.0008;
  const Statistics found = statistics(world, 25, 100);
  EXPECT_NEAR(found.chi2_per_dof, 1.0, 3.5 * found.sd);
  EXPECT_LT(found.sd, 0.04);
  EXPECT_GT(found.covered, 0.88);
}

/// Seeds 1000 to 1499, two tours each.
TEST(SlowGyro, NoiseIsWhatIsStated) {
  World world;
  world.noise.gyro = 0.0008;
  world.tours = 2;
  const Statistics found = statistics(world, 500, 1000);
  std::printf("gyro: chi^2/dof %.4f +- %.4f, covered %.3f\n", found.chi2_per_dof, found.sd,
              found.covered);
  EXPECT_NEAR(found.chi2_per_dof, 1.0, 0.01);
  EXPECT_NEAR(found.covered, 0.95, 0.02);
}

TEST(Gyro, LeadsDeadReckoningBetterThanWheelsAlone) {
  World world;
  world.noise.left = world.noise.right = 0.006;
  world.noise.gyro = 0.0005;
  Model model;
  model.noise.left = model.noise.right = 0.006;
  model.noise.gyro = 0.0005;
  double with = 0.0;
  double without = 0.0;
  double expected = 0.0;
  constexpr int kDrives = 20;  // seeds 30 to 49
  for (std::uint64_t seed = 30; seed < 30 + kDrives; ++seed) {
    const SimulatedDrive drive = simulated(world, {}, seed);
    const Pose& start = drive.motion.start;
    const Pose end = relative(start, drive.motion.rows.back().pose);
    const TimedPose reckoned = dead_reckoned_poses(drive.recording, model).back();
    DrivenRecording wheels = testing::driven(drive.recording);
    wheels.drive.yaw_rate.clear();
    const TimedPose alone = dead_reckoned_poses(wheels, model).back();
    with += (reckoned.estimate.pose.position() - end.position()).squaredNorm();
    without += (alone.estimate.pose.position() - end.position()).squaredNorm();
    expected += reckoned.estimate.covariance.topLeftCorner<2, 2>().trace();
  }
  EXPECT_LT(with, 0.2 * without);
  EXPECT_NEAR(with / expected, 1.0, 0.6);
}

TEST(Gyro, TheRobotReckonsAsOneDoesAfterwards) {
  World world;
  world.noise.gyro = 0.0008;
  for (const bool compass : {false, true}) {
    world.compass = compass;
    const DrivenRecording recording = testing::driven(simulated(world, {}, 12).recording);
    Model model;
    model.effects = {catalogue_effect("gyro bias", {0.003}), catalogue_effect("gyro scale", {0.01}),
                     catalogue_effect("wheelbase", {-0.02})};
    const std::vector<TimedPose> after = dead_reckoned_poses(recording, model);
    const MotionRows& drive = recording.drive;
    OdometryInputs inputs;
    inputs.gyro = true;
    inputs.compass = compass;
    CorrectedOdometry odometry(model, inputs);
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      const PoseEstimate now =
          odometry
              .drive({drive.duration(row), drive.pair.left[row], drive.pair.right[row],
                      compass ? drive.heading[row] : kAbsent, drive.yaw_rate[row]})
              .pose;
      const PoseEstimate& then = after[row + 1].estimate;
      ASSERT_LT((now.pose.position() - then.pose.position()).norm(), 1e-9) << row;
      ASSERT_LT(std::abs(wrap_angle(now.pose.heading - then.pose.heading)), 1e-11) << row;
      ASSERT_LT((now.covariance - then.covariance).norm(), 1e-9 * (1e-6 + then.covariance.norm()))
          << row;
    }
  }
}

/// A bias that walks, stated as noise: the fit then is as good as it says.
TEST(Gyro, ABiasThatWalksIsAProcess) {
  World world;
  world.noise.gyro = 0.0005;
  world.noise.gyro_walk = 0.00015;
  Model white;
  white.noise.gyro = 0.0005;
  Model walks = white;
  NoiseProcess walk;
  walk.channel = Channel::gyro;
  walk.process = ProcessKind::walk_in_t;
  walk.sd = 0.00015;
  walks.noise.processes = {walk};
  double plain = 0.0;
  double stated = 0.0;
  constexpr int kDrives = 8;  // seeds 60 to 67
  for (std::uint64_t seed = 60; seed < 60 + kDrives; ++seed) {
    const DrivenRecording recording = testing::driven(simulated(world, {}, seed).recording);
    const ModelFit a = fit_model({recording}, white);
    const ModelFit b = fit_model({recording}, walks);
    plain += a.chi2 / a.dof / kDrives;
    stated += b.chi2 / b.dof / kDrives;
  }
  EXPECT_GT(plain, 1.3);
  EXPECT_NEAR(stated, 1.0, 0.1);
}

TEST(Gyro, AMissingBiasIsNamed) {
  World world;
  world.noise.gyro = 0.0005;
  world.tours = 2;
  Model model;
  model.noise.gyro = 0.0005;
  for (const auto& [name, value] : {std::pair("gyro bias", 0.0008), std::pair("gyro scale", 0.008),
                                    std::pair("wheelbase", 0.015)}) {
    const DrivenRecording recording =
        testing::driven(simulated(world, {catalogue_effect(name, {value})}, 21).recording);
    EXPECT_EQ(diagnose({recording}, model).missing, name);
  }
}

/// Three tours without rests, with a compass.
DrivenRecording toured(const std::vector<Effect>& effects, double walk, std::uint64_t seed) {
  const Mesh mesh = mesh_of_lines({0.0, 5.5, 10.0, 15.5}, {0.0, 4.5, 10.0, 14.5});
  std::mt19937_64 random = random_stream(seed, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, 3, random);
  WheeledRobot robot;
  robot.gyro = true;
  robot.noise.gyro = 0.0005;
  robot.noise.gyro_walk = walk;
  return testing::driven(simulate_drive(mesh, tours.walk, {}, robot, seed, {effects}).recording);
}

/// How often what is missing first acts on the channel gyro, or is this effect.
int named(const std::vector<Effect>& effects, double walk, std::uint64_t first,
          std::uint64_t count) {
  Model model;
  model.noise.gyro = 0.0005;
  int named = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const Diagnosis found = diagnose({toured(effects, walk, seed)}, model);
    if (found.verdict != Diagnosis::Verdict::missing) continue;
    const Effect& one = found.findings.front().effect;
    if (effects.empty() ? one.channel == Channel::gyro : one.name == effects.front().name) ++named;
  }
  return named;
}

/// Three times what is detectable, where a bias that walks would explain the readings almost as
/// well. Seeds 600 to 607.
TEST(SlowGyro, ABiasIsNamedWhereAWalkCouldStandForIt) {
  EXPECT_GE(named({catalogue_effect("gyro bias", {0.00023})}, 0.0, 600, 8), 6);
}

/// The same of a drift with temperature.
TEST(SlowGyro, ADriftIsNamedWhereAWalkCouldStandForIt) {
  const Effect drift = catalogue_effect("gyro temperature drift (temperature_C)", {1.2e-5});
  EXPECT_GE(named({drift}, 0.0, 600, 8), 6);
}

/// A bias that does walk, from 0: so little that chi^2 does not show it, and more. At 5 %, three of
/// eight have p = 0.006. Seeds 700 to 707.
TEST(SlowGyro, AWalkIsNotOftenCalledADrift) {
  for (const double walk : {3e-6, 1e-5}) EXPECT_LE(named({}, walk, 700, 8), 2) << walk;
}

/// By the model that says so: a way straight ahead reads as a turn on the spot, whose travel is
/// the noise of the turn.
TEST(Gyro, BesideAWheelThatCountsBackwardsItIsAsNoisyAsStated) {
  World world;
  world.tours = 3;
  for (const Channel wheel : {Channel::left, Channel::right}) {
    Recording recording = simulated(world, {}, 41).recording;
    for (double& travel : wheel == Channel::left ? recording.drive.left : recording.drive.right) {
      travel = -travel;
    }
    Effect backwards;
    backwards.name = "backwards";
    backwards.channel = wheel;
    backwards.shape = {Shape("1")};
    backwards.coefficients = {-2.0};
    Model model;
    model.effects = {backwards};
    FitOptions options;
    options.fit_effects = false;
    const ModelFit fit = fit_model({recording}, model, options);
    EXPECT_GT(fit.dof, 200);
    EXPECT_GT(fit.p_value, 1e-3) << fit.chi2 << " of " << fit.dof;
    EXPECT_LT(fit.p_value, 1.0 - 1e-3) << fit.chi2 << " of " << fit.dof;
  }
}

/// A heading that a robot integrated from its gyro, given as a compass.
TEST(Gyro, AHeadingThatWasIntegratedIsNoCompass) {
  World world;
  world.noise.gyro = 0.003;
  world.tours = 2;
  for (const std::uint64_t seed : {31U, 32U, 33U}) {
    DrivenRecording recording = testing::driven(simulated(world, {}, seed).recording);
    MotionRows& drive = recording.drive;
    double heading = 0.0;
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      heading += drive.yaw_rate[row] * drive.duration(row);
      drive.heading.push_back(wrap_angle(heading));
    }
    drive.yaw_rate.clear();
    const std::string words = in_words(fit_model_and_noise({recording}, Model()).noise);
    EXPECT_NE(words.find("integrated from a gyro"), std::string::npos) << words;
    // One that reads north is a compass.
    world.compass = true;
    DrivenRecording other = testing::driven(simulated(world, {}, seed).recording);
    other.drive.yaw_rate.clear();
    EXPECT_EQ(in_words(fit_model_and_noise({other}, Model()).noise).find("gyro"),
              std::string::npos);
    world.compass = false;
  }
}

}  // namespace
}  // namespace trussmap::gyro_test
