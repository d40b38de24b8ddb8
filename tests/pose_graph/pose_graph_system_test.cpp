// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The normal equations against Jacobians by central differences of the plain errors.
#include "pose_graph/pose_graph_system.hpp"

#include "pose_graph/pose_graph_gauge.hpp"
#include "pose_graph/synthetic_graph.hpp"

#include <random>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace trussmap::pose_graph_system_test {
using namespace linalg;
using namespace pose_graph;
namespace {

Matrix3 random_information(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Matrix3 a;
  for (double& x : a.reshaped()) x = normal(random);
  return a * a.transpose() + 0.1 * Matrix3::Identity();
}

/// Two poses (or more), two points, all kinds of edges, correlated information.
PoseGraph mixed_graph(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  PoseGraph graph;
  for (int k = 0; k < 6; ++k) {
    graph.vertices.push_back(
        {k, k < 4 ? VertexKind::pose : VertexKind::point, std::nullopt, false});
  }
  for (const NodePair& pair : {NodePair{0, 1}, {1, 2}, {3, 2}, {0, 3}, {2, 0}}) {
    graph.pose_edges.push_back({pair[0],
                                pair[1],
                                {normal(random), normal(random), normal(random)},
                                random_information(random)});
  }
  for (const NodePair& pair : {NodePair{0, 4}, {1, 4}, {3, 5}}) {
    graph.point_edges.push_back({pair[0], pair[1], Vector2(normal(random), normal(random)),
                                 random_information(random).topLeftCorner<2, 2>()});
  }
  graph.displacement_edges.push_back({5, 4, Vector2(normal(random), normal(random)),
                                      random_information(random).topLeftCorner<2, 2>()});
  return graph;
}

std::vector<Pose> random_estimates(double position, double heading, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Pose> estimates;
  for (int k = 0; k < 6; ++k) {
    estimates.push_back({position * normal(random), position * normal(random),
                         k < 4 ? heading * normal(random) : 0.0});
  }
  return estimates;
}

/// All errors, each multiplied by a root of its information.
Eigen::VectorXd whitened(const PoseGraph& graph, const std::vector<Pose>& at) {
  std::vector<double> all;
  const auto append = [&all](const Eigen::VectorXd& e, const Eigen::MatrixXd& information) {
    const Eigen::MatrixXd root = information.llt().matrixU();
    const Eigen::VectorXd w = root * e;
    all.insert(all.end(), w.begin(), w.end());
  };
  for (const PoseEdge& e : graph.pose_edges) {
    append(edge_error(e, at[idx(e.from)], at[idx(e.to)]), e.information);
  }
  for (const PointEdge& e : graph.point_edges) {
    append(edge_error(e, at[idx(e.pose)], at[idx(e.point)].position()), e.information);
  }
  for (const DisplacementEdge& e : graph.displacement_edges) {
    append(at[idx(e.to)].position() - at[idx(e.from)].position() - e.measured, e.information);
  }
  return Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

Eigen::MatrixXd jacobian(const PoseGraph& graph, const PoseGraphSystem& system,
                         const std::vector<Pose>& at) {
  constexpr double kStep = 1e-6;
  const int unknowns = system.normal_equations().unknowns();
  Eigen::MatrixXd J(whitened(graph, at).size(), unknowns);
  for (int k = 0; k < unknowns; ++k) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(unknowns, k);
    J.col(k) =
        (whitened(graph, system.moved(at, step)) - whitened(graph, system.moved(at, -step))) /
        (2.0 * kStep);
  }
  return J;
}

class NormalEquations : public ::testing::TestWithParam<double> {};

TEST_P(NormalEquations, AgreeWithCentralDifferences) {
  const double heading = GetParam();
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const PoseGraph graph = mixed_graph(seed);
    std::vector<std::uint8_t> held(6, estimation::held_nothing);
    held[0] = estimation::held_all;
    PoseGraphSystem system(graph, held);
    const std::vector<Pose> at = random_estimates(3.0, heading, seed + 100);
    const double chi2 = system.linearise(at);
    const Eigen::VectorXd e = whitened(graph, at);
    const Eigen::MatrixXd J = jacobian(graph, system, at);
    const Eigen::MatrixXd H = J.transpose() * J;
    const Eigen::MatrixXd lower(system.normal_equations().matrix());
    const Eigen::MatrixXd expected = H.triangularView<Eigen::Lower>();
    // Differences of step 1e-6 keep about ten digits.
    EXPECT_LT((lower - expected).norm(), 1e-8 * H.norm());
    EXPECT_LT((system.gradient() - J.transpose() * e).norm(), 1e-8 * J.norm() * e.norm());
    EXPECT_NEAR(chi2, e.squaredNorm(), 1e-12 * chi2);
    EXPECT_NEAR(system.chi_squared(at), chi_squared(graph, at), 1e-12 * chi2);
  }
}

// Angles as small as rounding itself, and beyond a turn.
INSTANTIATE_TEST_SUITE_P(Headings, NormalEquations,
                         ::testing::Values(0.0, 1e-12, 1e-8, 1e-3, 1.0, 10.0));

TEST(PoseGraphSystem, PinsHalfHeldPosesByAnEquationOfTheirOwn) {
  const PoseGraph graph = mixed_graph(3);
  const std::vector<Pose> at = random_estimates(3.0, 1.0, 3);
  for (const std::uint8_t half : {estimation::held_position, estimation::held_heading}) {
    std::vector<std::uint8_t> held(6, estimation::held_nothing);
    held[1] = half;
    held[5] = estimation::held_position;
    PoseGraphSystem system(graph, held);
    system.linearise(at);
    Eigen::MatrixXd H = Eigen::MatrixXd(system.normal_equations().matrix());
    H = Eigen::MatrixXd(H.selfadjointView<Eigen::Lower>());
    Eigen::MatrixXd J = jacobian(graph, system, at);
    const Eigen::VectorXd e = whitened(graph, at);
    const int begin =
        system.normal_equations().offset(1) + (half == estimation::held_position ? 0 : 2);
    const int count = half == estimation::held_position ? 2 : 1;
    J.middleCols(begin, count).setZero();
    Eigen::MatrixXd expected = J.transpose() * J;
    expected.diagonal().segment(begin, count).setOnes();
    EXPECT_LT((H - expected).norm(), 1e-8 * expected.norm());
    EXPECT_LT((system.gradient() - J.transpose() * e).norm(), 1e-8 * J.norm() * e.norm());
  }
}

TEST(PoseGraphSystem, WithHeadingsHeldOneStepIsTheBestOfAllPositions) {
  const PoseGraph graph = mixed_graph(4);
  std::vector<std::uint8_t> held(6, estimation::held_nothing);
  held[0] = estimation::held_all;
  PoseGraphSystem system(graph, held);
  std::vector<Pose> at = random_estimates(3.0, 1.0, 4);
  system.linearise(at, true);
  const std::vector<Pose> best = system.moved(at, system.solve_step().nodes);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(best[idx(k)].heading, at[idx(k)].heading);
  system.linearise(best, true);
  EXPECT_LT(system.gradient().norm(), 1e-11);
}

TEST(PoseGraphSystem, StrainEnergyIsTheQuadraticFormOfTheNormalMatrix) {
  const PoseGraph graph = mixed_graph(5);
  std::vector<std::uint8_t> held(6, estimation::held_nothing);
  held[2] = estimation::held_all;
  PoseGraphSystem system(graph, held);
  const std::vector<Pose> at = random_estimates(3.0, 1.0, 5);
  system.linearise(at);
  const Eigen::VectorXd u = Eigen::VectorXd::LinSpaced(system.normal_equations().unknowns(), -1, 2);
  const Eigen::VectorXd Hu = system.normal_equations().matrix().selfadjointView<Eigen::Lower>() * u;
  EXPECT_NEAR(system.strain_energy(at, u), u.dot(Hu), 1e-12 * u.dot(Hu));
}

}  // namespace
}  // namespace trussmap::pose_graph_system_test
