// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/umbmark.hpp"

#include "calibration/square_simulation.hpp"
#include "json_matrix.hpp"
#include "shared_data.hpp"
#include "trussmap/error.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::umbmark_test {
namespace {

using testing::Case;
using testing::centres;
using testing::simulated_clusters;

constexpr double kMillimetre = 1e-3;

/// Relative 1e-12, and as much absolutely for numbers near 0.
void expect_analysis(double value, double expected) {
  EXPECT_NEAR(value, expected, 1e-12 * std::max(1.0, std::abs(expected)));
}

/// One of the reference's simulated robots.
struct Simulated {
  const nlohmann::json& c;
  [[nodiscard]] double number(const char* key) const { return c[key]; }
  [[nodiscard]] double metres(const char* key) const { return kMillimetre * number(key); }
  [[nodiscard]] SquareSetup setup() const { return {metres("side_mm"), metres("b_nominal_mm")}; }
  [[nodiscard]] SquareClusters measured() const {
    const auto end = [&](const char* key) {
      const auto& e = c[key];
      return Eigen::Vector2d(kMillimetre * e[0].get<double>(), kMillimetre * e[1].get<double>());
    };
    return centres(end("err_cw"), end("err_ccw"));
  }
};

TEST(UmbmarkSimulated, RobotEndsWhereTheReferenceHasIt) {
  testing::for_each(testing::cases("umbmark.json", "simulated"), [](const nlohmann::json& c) {
    const Simulated one{c};
    const TapeRobot robot =
        misbuilt_robot(one.metres("b_nominal_mm"), one.number("Ed_true"), one.number("Eb_true"));
    std::mt19937_64 unused;
    for (const auto& [key, direction] :
         {std::pair("err_cw", Direction::cw), std::pair("err_ccw", Direction::ccw)}) {
      const Pose end = drive_once(robot, square_path(one.metres("side_mm"), direction), unused);
      const auto& expected = c[key];
      const Eigen::Vector3d found(end.x, end.y, end.heading);
      const Eigen::Vector3d units(kMillimetre, kMillimetre, 1.0);
      for (int k = 0; k < 3; ++k) {
        const double e = units[k] * expected[static_cast<std::size_t>(k)].get<double>();
        EXPECT_NEAR(found[k], e, std::max(1e-9 * std::abs(e), 1e-12)) << key << " " << k;
      }
      // The calibration's own kinematics, coded apart, agree.
      const PathError own =
          path_error(square_path(one.metres("side_mm"), direction), one.metres("b_nominal_mm"),
                     {one.number("Ed_true"), one.number("Eb_true")});
      EXPECT_LT((own.error - found).norm(), 1e-12);
    }
  });
}

TEST(UmbmarkSimulated, FormulasGiveTheReferencesFigures) {
  testing::for_each(testing::cases("umbmark.json", "simulated"), [](const nlohmann::json& c) {
    const Simulated one{c};
    const SquareClusters clusters = one.measured();
    const SquareAngles angles = square_angles(clusters, one.setup().side);
    const SquareSolution found = umbmark(clusters, one.setup());
    expect_analysis(angles.alpha_x.value, one.number("alpha_x"));
    expect_analysis(angles.alpha_y.value, one.number("alpha_y"));
    expect_analysis(angles.beta_x.value, one.number("beta_x"));
    expect_analysis(angles.beta_y.value, one.number("beta_y"));
    expect_analysis(found.alpha.value, one.number("alpha"));
    expect_analysis(found.beta.value, one.number("beta"));
    expect_analysis(found.diameter_ratio.value, one.number("Ed_recovered"));
    expect_analysis(found.wheelbase_ratio.value, one.number("Eb_recovered"));
    expect_analysis(found.left_factor.value, one.number("cL"));
    expect_analysis(found.right_factor.value, one.number("cR"));
    expect_analysis(clusters.largest_offset.value, one.metres("Emax_mm"));
  });
}

TEST(UmbmarkSimulated, RoundsLeaveWhatTheReferenceSays) {
  testing::for_each(testing::cases("umbmark.json", "simulated"), [](const nlohmann::json& c) {
    const Simulated one{c};
    const SquareSetup square = one.setup();
    const TapeRobot robot =
        misbuilt_robot(square.wheelbase, one.number("Ed_true"), one.number("Eb_true"));
    GeometryErrors in_force;
    SquareClusters clusters = simulated_clusters(robot, square.side);
    for (const char* key : {"Emax_after_1_mm", "Emax_after_2_mm"}) {
      const double wheelbase = square.wheelbase * in_force.wheelbase_ratio;
      in_force = combined(in_force, umbmark(clusters, {square.side, wheelbase}).errors());
      const TapeRobot corrected =
          reprogrammed(robot, in_force.left_factor(), in_force.right_factor(),
                       square.wheelbase * in_force.wheelbase_ratio);
      clusters = simulated_clusters(corrected, square.side);
      const double expected = one.metres(key);
      EXPECT_NEAR(clusters.largest_offset.value, expected, std::max(1e-9 * expected, 1e-12)) << key;
      if (key == std::string("Emax_after_1_mm")) {
        EXPECT_NEAR(corrected.wheelbase_believed, one.metres("b_after_1_mm"), 1e-12);
        EXPECT_NEAR(in_force.left_factor(), one.number("cL_after_1"), 1e-12);
        EXPECT_NEAR(in_force.right_factor(), one.number("cR_after_1"), 1e-12);
      }
    }
  });
}

TEST(UmbmarkMeasured, PublishedCentresGiveTheReferencesFigures) {
  testing::for_each(testing::cases("umbmark.json", "measured"), [](const nlohmann::json& c) {
    const SquareSetup setup{kMillimetre * c["side_mm"].get<double>(),
                            kMillimetre * c["B_assumed_mm"].get<double>()};
    const SquareClusters clusters = centres(kMillimetre * testing::vector2(c["cg_cw"]),
                                            kMillimetre * testing::vector2(c["cg_ccw"]));
    const SquareSolution found = umbmark(clusters, setup);
    expect_analysis(found.alpha.value, c["alpha"]);
    expect_analysis(found.beta.value, c["beta"]);
    expect_analysis(found.diameter_ratio.value, c["Ed"]);
    expect_analysis(found.wheelbase_ratio.value, c["Eb"]);
    expect_analysis(found.left_factor.value, c["cL"]);
    expect_analysis(found.right_factor.value, c["cR"]);
    expect_analysis(clusters.largest_offset.value, kMillimetre * c["Emax_mm"].get<double>());
  });
}

TEST(Umbmark, TwoRoundsLeaveLessThanAHundredth) {
  const SquareSetup square{4.0, 0.34};
  for (const double e_d : {0.995, 0.9975, 0.9999, 1.0001, 1.0025, 1.005}) {
    for (const double e_b : {0.97, 0.985, 0.999, 1.001, 1.015, 1.03}) {
      const TapeRobot robot = misbuilt_robot(square.wheelbase, e_d, e_b);
      GeometryErrors in_force;
      TapeRobot corrected = robot;
      for (int round = 0; round < 2; ++round) {
        const SquareClusters clusters = simulated_clusters(corrected, square.side);
        const SquareSetup now{square.side, corrected.wheelbase_believed};
        in_force = combined(in_force, umbmark(clusters, now).errors());
        corrected = reprogrammed(robot, in_force.left_factor(), in_force.right_factor(),
                                 square.wheelbase * in_force.wheelbase_ratio);
      }
      EXPECT_LT(simulated_clusters(corrected, square.side).largest_offset.value,
                0.01 * simulated_clusters(robot, square.side).largest_offset.value)
          << e_d << " " << e_b;
    }
  }
}

TEST(SolveSquare, RecoversLargeErrorsInOneRound) {
  for (const double side : {1.0, 4.0}) {
    for (const double e_d : {0.95, 0.99, 1.0, 1.001, 1.02, 1.05}) {
      for (const double e_b : {0.85, 0.97, 1.0, 1.03, 1.15}) {
        const SquareSetup setup{side, 0.34};
        const SquareSolution found = solve_square(
            simulated_clusters(misbuilt_robot(setup.wheelbase, e_d, e_b), side), setup);
        EXPECT_NEAR(found.diameter_ratio.value, e_d, 1e-9) << side << " " << e_b;
        EXPECT_NEAR(found.wheelbase_ratio.value, e_b, 1e-9) << side << " " << e_d;
        EXPECT_NEAR(found.wheelbase.value, 0.34 * e_b, 1e-9);
        EXPECT_NEAR(found.right_factor.value / found.left_factor.value, e_d, 1e-9);
        EXPECT_NEAR(found.left_factor.value + found.right_factor.value, 2.0, 1e-12);
      }
    }
  }
}

TEST(SolveSquare, AgreesWithTheFormulasWhereErrorsAreSmall) {
  const SquareSetup setup{4.0, 0.34};
  const SquareClusters clusters = simulated_clusters(misbuilt_robot(0.34, 1.00001, 0.9999), 4.0);
  const SquareSolution exact = solve_square(clusters, setup);
  const SquareSolution small = umbmark(clusters, setup);
  // Second-order terms: the squares of alpha and beta, some 1e-4 each.
  EXPECT_NEAR(exact.alpha.value, small.alpha.value, 1e-6);
  EXPECT_NEAR(exact.beta.value, small.beta.value, 1e-6);
  EXPECT_NEAR(exact.diameter_ratio.value, small.diameter_ratio.value, 1e-8);
}

TEST(SolveSquare, RefusesWhatNoRobotExplains) {
  const SquareSetup setup{4.0, 0.34};
  EXPECT_THROW((void)solve_square(centres({127.0, 31.0}, {-97.0, 94.0}), setup), SolveError);
  EXPECT_THROW((void)solve_square(centres({0.1, 0.1}, {0.1, -0.1}), {0.0, 0.34}),
               std::invalid_argument);
  EXPECT_THROW((void)square_clusters({{{0.1, 0.1}}, {{0.1, -0.1}, {0.1, -0.1}}}),
               std::invalid_argument);
}

TEST(PathError, JacobianAgreesWithDifferences) {
  const TestPath path = {{2.0, 0.0}, {0.0, 1.2}, {-1.5, 0.7}, {0.3, -2.0}, {0.0, -3.0}};
  const GeometryErrors at{1.01, 0.96};
  const PathError here = path_error(path, 0.4, at);
  constexpr double h = 1e-6;
  const Eigen::Vector3d by_d =
      (path_error(path, 0.4, {at.diameter_ratio + h, at.wheelbase_ratio}).error -
       path_error(path, 0.4, {at.diameter_ratio - h, at.wheelbase_ratio}).error) /
      (2 * h);
  const Eigen::Vector3d by_b =
      (path_error(path, 0.4, {at.diameter_ratio, at.wheelbase_ratio + h}).error -
       path_error(path, 0.4, {at.diameter_ratio, at.wheelbase_ratio - h}).error) /
      (2 * h);
  EXPECT_LT((here.jacobian.col(0) - by_d).norm(), 1e-8);
  EXPECT_LT((here.jacobian.col(1) - by_b).norm(), 1e-8);
  EXPECT_EQ(path_error(path, 0.4, {}).error.norm() < 1e-14, true);
}

}  // namespace
}  // namespace trussmap::umbmark_test
