// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "pose_graph/pose_graph_descent.hpp"
#include "pose_graph/pose_graph_gauge.hpp"
#include "pose_graph/synthetic_graph.hpp"
#include "trussmap/pose_graph.hpp"
#include "trussmap/truss.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::pose_graph_adjustment_test {
namespace {

using testing::landmark_walk;
using testing::lattice_walk;
using testing::ring;
using testing::SyntheticGraph;

void expect_equal(const std::vector<Pose>& found, const std::vector<Pose>& expected,
                  double tolerance) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t v = 0; v < found.size(); ++v) {
    EXPECT_NEAR(found[v].x, expected[v].x, tolerance) << "vertex " << v;
    EXPECT_NEAR(found[v].y, expected[v].y, tolerance) << "vertex " << v;
    EXPECT_NEAR(wrap_angle(found[v].heading - expected[v].heading), 0.0, tolerance)
        << "vertex " << v;
  }
}

/// What a descent from the truth reaches: no start should do worse.
double chi2_from_truth(const SyntheticGraph& world) {
  pose_graph::PoseGraphSystem system(world.graph, pose_graph::choose_gauge(world.graph));
  return pose_graph::descend(system, world.truth, {}).chi2;
}

TEST(Adjust, GivesTheExactGraphWithoutNoise) {
  for (const SyntheticGraph& world : {ring(50, 5.0, {}, 1), lattice_walk(200, 5, 0.2, {}, 2),
                                      landmark_walk(60, 4, 15, 3.0, {}, 3)}) {
    const PoseGraphAdjustment result = adjust(world.graph);
    EXPECT_TRUE(result.converged);
    EXPECT_LT(result.chi2, 1e-20);
    EXPECT_TRUE(result.warnings.empty());
    expect_equal(result.estimates, world.truth, 1e-11);
  }
}

TEST(Adjust, EndsAtAStationaryPointThatThePlainChiSquaredConfirms) {
  const SyntheticGraph world = lattice_walk(300, 8, 0.1, {0.1, 0.05}, 4);
  const PoseGraphAdjustment result = adjust(world.graph);
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.chi2, chi_squared(world.graph, result.estimates), 1e-11 * result.chi2);
  // Curvatures are of the order 1/0.05^2; the gradient of a unit step would be some hundreds.
  EXPECT_LT(result.gradient_norm, 1e-4);
  for (std::size_t v = 1; v < 300; v += 37) {
    for (double Pose::*coordinate : {&Pose::x, &Pose::y, &Pose::heading}) {
      for (const double sign : {-1.0, 1.0}) {
        std::vector<Pose> moved = result.estimates;
        moved[v].*coordinate += sign * 1e-4;
        EXPECT_GT(chi_squared(world.graph, moved), result.chi2);
      }
    }
  }
}

TEST(Adjust, LeavesChiSquaredOverDofNearOneWhereTheNoiseIsAsClaimed) {
  double chi2 = 0.0;
  int dof = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const PoseGraphAdjustment result = adjust(lattice_walk(400, 8, 0.2, {0.05, 0.02}, seed).graph);
    chi2 += result.chi2;
    dof += result.dof;
    EXPECT_TRUE(result.warnings.empty());
  }
  // chi2/dof has standard deviation sqrt(2/dof); four of them.
  EXPECT_NEAR(chi2 / dof, 1.0, 4.0 * std::sqrt(2.0 / dof));
}

TEST(Adjust, FindsTheSameFitWhateverTheGauge) {
  SyntheticGraph world = lattice_walk(150, 5, 0.2, {0.1, 0.05}, 5);
  const PoseGraphAdjustment expected = adjust(world.graph);
  const Pose frame{10.0, -20.0, 2.0};
  world.graph.vertices[70].fixed = true;
  world.graph.vertices[70].estimate = frame;
  const PoseGraphAdjustment result = adjust(world.graph);
  EXPECT_NEAR(result.chi2, expected.chi2, 1e-10 * expected.chi2);
  std::vector<Pose> carried;
  for (const Pose& pose : expected.estimates) {
    carried.push_back(compose(frame, relative(expected.estimates[70], pose)));
  }
  expect_equal(result.estimates, carried, 1e-6);
}

TEST(Adjust, DoesNotDependOnTheOrderOfVerticesAndEdges) {
  SyntheticGraph world = landmark_walk(100, 5, 20, 3.0, {0.1, 0.03}, 6);
  const PoseGraphAdjustment expected = adjust(world.graph);
  std::vector<int> order(world.truth.size());
  std::iota(order.begin(), order.end(), 0);
  std::mt19937_64 random(6);
  std::shuffle(order.begin() + 1, order.end(), random);  // the first one carries the gauge
  PoseGraph shuffled = world.graph;
  std::vector<int> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    shuffled.vertices[k] = world.graph.vertices[idx(order[k])];
    place[idx(order[k])] = static_cast<int>(k);
  }
  for (PoseEdge& edge : shuffled.pose_edges) {
    edge.from = place[idx(edge.from)];
    edge.to = place[idx(edge.to)];
  }
  for (PointEdge& edge : shuffled.point_edges) {
    edge.pose = place[idx(edge.pose)];
    edge.point = place[idx(edge.point)];
  }
  std::shuffle(shuffled.pose_edges.begin(), shuffled.pose_edges.end(), random);
  std::shuffle(shuffled.point_edges.begin(), shuffled.point_edges.end(), random);
  const PoseGraphAdjustment result = adjust(shuffled);
  EXPECT_NEAR(result.chi2, expected.chi2, 1e-10 * expected.chi2);
  for (std::size_t k = 0; k < order.size(); ++k) {
    expect_equal({result.estimates[k]}, {expected.estimates[idx(order[k])]}, 1e-6);
  }
}

/// A truss of points that displacements tie, its bars, and the loads that stand for what was
/// measured: f = B z at the far end.
TEST(Adjust, OfALandmarkGraphIsTheTrussUnderGaussMarkovStiffness) {
  const SyntheticGraph places = landmark_walk(40, 5, 30, 20.0, {}, 7);
  testing::Measurer measure({0.1, 0.0}, 8);
  SyntheticGraph world;
  for (std::size_t v = 40; v < places.truth.size(); ++v) {
    add_vertex(world, VertexKind::point, places.truth[v]);
  }
  const int count = static_cast<int>(world.truth.size());
  std::vector<Bar> bars;
  std::vector<Load> loads;
  for (int i = 0; i < count; ++i) {
    for (int step : {1, 3, 7}) {
      const int j = (i + step) % count;
      DisplacementEdge edge = measure.displacement_edge(world.truth, i, j);
      edge.information = (Matrix2() << 5.0 + i, 1.0, 1.0, 3.0).finished();
      bars.push_back({i, j, edge.information});
      loads.push_back({j, edge.information * edge.measured});
      loads.push_back({i, -edge.information * edge.measured});
      world.graph.displacement_edges.push_back(edge);
    }
  }
  const PoseGraphAdjustment result = adjust(world.graph);
  const Deflection truss = solve_truss(count, bars, {{0, Vector2::Zero()}}, loads);
  EXPECT_EQ(result.iterations, 1);
  EXPECT_TRUE(result.converged);
  for (int k = 0; k < count; ++k) {
    EXPECT_LT((result.estimates[idx(k)].position() - truss.displacements[idx(k)]).norm(), 1e-10);
  }
}

struct Hard {
  std::string name;
  SyntheticGraph world;
};

void PrintTo(const Hard& test, std::ostream* out) {
  *out << test.name;
}

class HardGraph : public ::testing::TestWithParam<Hard> {};

TEST_P(HardGraph, ComesOutNoWorseThanADescentFromTheTruth) {
  const PoseGraphAdjustment result = adjust(GetParam().world.graph);
  const double from_truth = chi2_from_truth(GetParam().world);
  EXPECT_TRUE(result.converged);
  EXPECT_LT(result.chi2, from_truth * (1.0 + 1e-6));
}

/// Dead reckoning is lost after a few metres in all of these.
INSTANTIATE_TEST_SUITE_P(
    Noisy, HardGraph,
    ::testing::Values(Hard{"long_ring", ring(1000, 50.0, {0.02, 0.05}, 1)},
                      Hard{"sparse_lattice", lattice_walk(600, 12, 0.02, {0.05, 0.1}, 102)},
                      Hard{"lattice", lattice_walk(600, 12, 0.1, {0.05, 0.2}, 103)},
                      Hard{"dense_lattice", lattice_walk(400, 8, 0.5, {0.2, 0.3}, 104)},
                      Hard{"landmarks", landmark_walk(600, 12, 40, 4.0, {0.05, 0.1}, 105)},
                      Hard{"few_landmarks", landmark_walk(400, 10, 12, 5.0, {0.2, 0.05}, 106)}),
    [](const auto& hard) { return hard.param.name; });

TEST(Adjust, ComesBackFromAHopelessStartInTheFile) {
  SyntheticGraph world = lattice_walk(300, 8, 0.1, {0.05, 0.02}, 9);
  const double expected = adjust(world.graph).chi2;
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> anything(-20.0, 20.0);
  for (GraphVertex& vertex : world.graph.vertices) {
    vertex.estimate = Pose{anything(random), anything(random), anything(random)};
  }
  for (const StartFrom start : {StartFrom::best, StartFrom::file, StartFrom::odometry}) {
    EXPECT_NEAR(adjust(world.graph, {start}).chi2, expected, 1e-9 * expected);
  }
}

TEST(Adjust, WarnsWhereChiSquaredIsImplausible) {
  SyntheticGraph world = lattice_walk(200, 6, 0.2, {0.05, 0.02}, 10);
  for (std::size_t k = 0; k < world.graph.pose_edges.size(); k += 20) {
    world.graph.pose_edges[k].measured.x += 3.0;  // 60 standard deviations
  }
  const PoseGraphAdjustment result = adjust(world.graph);
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_NE(result.warnings[0].find("far too large"), std::string::npos);
}

TEST(Adjust, AcceptsSemidefiniteInformation) {
  // Every fifth edge knows the way along x only; what is left still determines every pose.
  SyntheticGraph world = lattice_walk(100, 4, 0.5, {}, 11);
  int measured = 0;
  for (std::size_t k = 0; k < world.graph.pose_edges.size(); ++k) {
    Matrix3& information = world.graph.pose_edges[k].information;
    if (k % 5 == 4) information = Eigen::Vector3d(100.0, 0.0, 0.0).asDiagonal();
    measured += k % 5 == 4 ? 1 : 3;
  }
  const PoseGraphAdjustment result = adjust(world.graph);
  EXPECT_EQ(result.dof, measured - 3 * 99);
  EXPECT_LT(result.chi2, 1e-20);
  expect_equal(result.estimates, world.truth, 1e-11);
}

}  // namespace
}  // namespace trussmap::pose_graph_adjustment_test
