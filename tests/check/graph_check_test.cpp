// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Pose graphs of known truth, spoilt by one mistake, and healthy ones, which have no finding.
#include "geometry/index.hpp"
#include "geometry/units.hpp"
#include "pose_graph/synthetic_graph.hpp"
#include "shared_data.hpp"
#include "trussmap/check.hpp"
#include "trussmap/map_files.hpp"

#include <algorithm>
#include <functional>
#include <random>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::graph_check_test {
namespace {

using testing::Noise;
using testing::SyntheticGraph;

constexpr Noise kNoise{0.02, 0.01};
constexpr std::uint64_t kSeeds = 6;

std::set<std::string> kinds_of(const std::vector<CheckFinding>& findings) {
  const std::vector<std::string>& listed = check_graph_kinds();
  std::set<std::string> kinds;
  for (const CheckFinding& one : findings) {
    EXPECT_NE(std::find(listed.begin(), listed.end(), one.kind), listed.end()) << one.kind;
    kinds.insert(one.kind);
  }
  return kinds;
}

std::set<std::string> kinds_in(const PoseGraph& graph) {
  return kinds_of(check_graph(graph, "x.g2o"));
}

std::string evidence_of(const PoseGraph& graph, const std::string& kind) {
  for (const CheckFinding& one : check_graph(graph, "x.g2o")) {
    if (one.kind == kind) return one.evidence;
  }
  return "";
}

/// Laps of a circle, each pose tied to one of those beside it a lap before.
SyntheticGraph laps(int poses, int count, Noise noise, std::uint64_t seed) {
  SyntheticGraph world;
  testing::Measurer measure(noise, seed);
  for (int k = 0; k < poses * count; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / poses;
    testing::add_vertex(world, VertexKind::pose,
                        {4.0 * std::sin(angle), 4.0 * (1.0 - std::cos(angle)), angle});
    // Each lap a hand's breadth outside the one before.
    world.truth.back().y -= 0.3 * (k / poses);
    if (k > 0) world.graph.pose_edges.push_back(measure.pose_edge(world.truth, k - 1, k));
    const int before = k - poses + (7 * k) % 5 - 2;
    if (before >= 0 && k > poses) {
      world.graph.pose_edges.push_back(measure.pose_edge(world.truth, before, k));
    }
  }
  return world;
}

std::vector<SyntheticGraph> worlds(std::uint64_t seed) {
  return {testing::lattice_walk(300, 5, 0.2, kNoise, seed), laps(40, 3, kNoise, seed),
          testing::landmark_walk(120, 4, 20, 3.0, kNoise, seed)};
}

std::vector<std::size_t> loops_of(const PoseGraph& graph) {
  std::vector<std::size_t> loops;
  for (std::size_t k = 0; k < graph.pose_edges.size(); ++k) {
    if (std::abs(graph.pose_edges[k].from - graph.pose_edges[k].to) > 1) loops.push_back(k);
  }
  return loops;
}

void reverse(PoseEdge& edge) {
  edge.measured = inverse(edge.measured);
}

TEST(GraphCheck, HealthyGraphsHaveNoFinding) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    for (const SyntheticGraph& world : worlds(seed)) {
      EXPECT_EQ(kinds_in(world.graph), std::set<std::string>{}) << seed;
    }
  }
}

/// Loops that are not the same either way round, as one of 180 degrees is.
std::vector<std::size_t> one_way_loops(const PoseGraph& graph) {
  std::vector<std::size_t> loops = loops_of(graph);
  std::erase_if(loops, [&graph](std::size_t k) {
    const Pose& z = graph.pose_edges[k].measured;
    const Pose back = relative(inverse(z), z);
    return std::hypot(back.x, back.y) < 0.3 && std::abs(wrap_angle(back.heading)) < 0.3;
  });
  return loops;
}

TEST(GraphCheck, NamesLoopsTheWrongWayRound) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    for (const SyntheticGraph& world : worlds(seed)) {
      std::vector<std::size_t> loops = one_way_loops(world.graph);
      if (loops.empty()) continue;  // landmarks close the loops
      const std::size_t all = loops_of(world.graph).size();
      std::mt19937_64 random(seed);
      std::shuffle(loops.begin(), loops.end(), random);
      for (const std::size_t count : {std::size_t{1}, loops.size() / 4, loops.size()}) {
        PoseGraph graph = world.graph;
        for (std::size_t k = 0; k < count; ++k) reverse(graph.pose_edges[loops[k]]);
        const std::string evidence = evidence_of(graph, "loops reversed");
        ASSERT_EQ(kinds_in(graph), std::set<std::string>{"loops reversed"}) << seed << " " << count;
        const bool whole = evidence.rfind("reversing all ", 0) == 0;
        const std::size_t named = std::stoul(evidence.substr(whole ? 14 : 10));
        const std::size_t right = whole ? all : count;
        // One whose inverse is nearly as likely may be named with them, or not.
        EXPECT_LE(std::max(named, right) - std::min(named, right), right / 20) << evidence;
        EXPECT_TRUE(!whole || count == loops.size()) << evidence;
      }
    }
  }
}

TEST(GraphCheck, NamesCovarianceForInformation) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    for (SyntheticGraph world : worlds(seed)) {
      for (PoseEdge& edge : world.graph.pose_edges) {
        edge.information = edge.information.inverse().eval();
      }
      for (PointEdge& edge : world.graph.point_edges) {
        edge.information = edge.information.inverse().eval();
      }
      EXPECT_EQ(kinds_in(world.graph), std::set<std::string>{"covariance for information"});
    }
  }
}

TEST(GraphCheck, NamesDegrees) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    for (SyntheticGraph world : worlds(seed)) {
      for (PoseEdge& edge : world.graph.pose_edges) edge.measured.heading *= geometry::kDegrees;
      EXPECT_EQ(kinds_in(world.graph), std::set<std::string>{"angle unit"}) << seed;
    }
    // Steps too small for a turn beyond a whole one: degrees show by what they lead to.
    SyntheticGraph fine = laps(400, 2, {0.002, 0.001}, seed);
    for (PoseEdge& edge : fine.graph.pose_edges) edge.measured.heading *= geometry::kDegrees;
    EXPECT_EQ(kinds_in(fine.graph), std::set<std::string>{"angle unit"}) << seed;
  }
}

TEST(GraphCheck, NamesDegreesOfVerticesAlone) {
  SyntheticGraph world = laps(40, 3, kNoise, 1);
  for (std::size_t v = 0; v < world.truth.size(); ++v) {
    world.graph.vertices[v].estimate = world.truth[v];
  }
  EXPECT_EQ(kinds_in(world.graph), std::set<std::string>{});
  for (GraphVertex& one : world.graph.vertices) one.estimate->heading *= geometry::kDegrees;
  const std::vector<CheckFinding> findings = check_graph(world.graph, "x.g2o");
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings.front().kind, "angle unit");
  EXPECT_EQ(findings.front().column, "theta");
}

TEST(GraphCheck, SaysWhatIdentityMakesOfChi2) {
  SyntheticGraph world = testing::lattice_walk(300, 5, 0.2, kNoise, 3);
  for (PoseEdge& edge : world.graph.pose_edges) edge.information.setIdentity();
  EXPECT_EQ(kinds_in(world.graph), std::set<std::string>{"identity information"});
  for (const std::size_t k : loops_of(world.graph)) reverse(world.graph.pose_edges[k]);
  EXPECT_EQ(kinds_in(world.graph),
            (std::set<std::string>{"identity information", "loops reversed"}));
}

TEST(GraphCheck, CountsEdgesThatStandTwiceEitherWayRound) {
  SyntheticGraph world = testing::landmark_walk(120, 4, 20, 3.0, kNoise, 5);
  PoseEdge back = world.graph.pose_edges[7];
  std::swap(back.from, back.to);
  back.measured = inverse(back.measured);
  world.graph.pose_edges.push_back(back);
  world.graph.pose_edges.push_back(world.graph.pose_edges[3]);
  world.graph.point_edges.push_back(world.graph.point_edges[9]);
  EXPECT_EQ(kinds_in(world.graph), std::set<std::string>{"duplicate edges"});
  const std::string evidence = evidence_of(world.graph, "duplicate edges");
  EXPECT_EQ(evidence.rfind("3 edges say", 0), 0U) << evidence;
  // Measured again is no duplicate.
  world.graph.pose_edges.pop_back();
  world.graph.point_edges.pop_back();
  world.graph.pose_edges.back().measured.x += 0.003;
  EXPECT_EQ(kinds_in(world.graph), std::set<std::string>{});
}

TEST(GraphCheck, NamesWhatNothingTies) {
  SyntheticGraph world = testing::lattice_walk(200, 5, 0.2, kNoise, 6);
  world.graph.vertices.push_back({777, VertexKind::pose, std::nullopt, false});
  EXPECT_EQ(kinds_in(world.graph), std::set<std::string>{"vertex without edges"});
  EXPECT_NE(evidence_of(world.graph, "vertex without edges").find("777"), std::string::npos);

  world = testing::lattice_walk(200, 5, 0.2, kNoise, 6);
  std::erase_if(world.graph.pose_edges,
                [](const PoseEdge& edge) { return (edge.from < 90) != (edge.to < 90); });
  EXPECT_EQ(kinds_in(world.graph), std::set<std::string>{"separate parts"});
  EXPECT_NE(evidence_of(world.graph, "separate parts").find("2 parts"), std::string::npos);
  // What is wrong within a part is found all the same.
  for (const std::size_t k : loops_of(world.graph)) reverse(world.graph.pose_edges[k]);
  EXPECT_EQ(kinds_in(world.graph), (std::set<std::string>{"separate parts", "loops reversed"}));

  world = testing::lattice_walk(50, 5, 0.2, kNoise, 7);
  world.graph.vertices.push_back({600, VertexKind::pose, std::nullopt, false});
  world.graph.vertices.push_back({601, VertexKind::point, std::nullopt, false});
  world.graph.point_edges.push_back({50, 51, {1.0, 2.0}, Matrix2::Identity()});
  world.graph.point_edges.push_back({10, 51, {1.0, 1.0}, Matrix2::Identity()});
  EXPECT_EQ(kinds_in(world.graph), std::set<std::string>{"loose vertex"});
}

TEST(GraphCheck, WrongLoopsAreNotReversedOnes) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SyntheticGraph world = testing::lattice_walk(300, 5, 0.2, kNoise, seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> off(-1.0, 1.0);
    std::vector<std::size_t> loops = loops_of(world.graph);
    std::shuffle(loops.begin(), loops.end(), random);
    for (std::size_t k = 0; k < loops.size() / 5; ++k) {
      world.graph.pose_edges[loops[k]].measured = {off(random), off(random), off(random)};
    }
    EXPECT_EQ(kinds_in(world.graph), std::set<std::string>{}) << seed;
  }
}

TEST(GraphCheck, AGraphThatIsNoneIsRefused) {
  EXPECT_THROW(static_cast<void>(check_graph(PoseGraph{}, "x")), std::invalid_argument);
  PoseGraph graph = testing::lattice_walk(5, 3, 0.0, kNoise, 1).graph;
  graph.pose_edges.front().to = 99;
  EXPECT_THROW(static_cast<void>(check_graph(graph, "x")), std::invalid_argument);
}

TEST(GraphCheck, BenchmarksHaveNoFinding) {
  TRUSSMAP_NEEDS_SHARED("data/posegraph/intel.g2o.xz");
  for (const char* file : {"posegraph/manhattanOlson3500.g2o.xz", "posegraph/intel.g2o.xz",
                           "posegraph/input_INTEL_g2o.g2o.xz", "posegraph/MIT.g2o.xz",
                           "posegraph/FR079_P_toro.graph.xz", "posegraph/kitti_05.g2o.xz"}) {
    const std::string path = testing::shared(std::string("data/") + file).string();
    std::set<std::string> kinds =
        kinds_of(check_graph(read_g2o(path, Edge2::by_name, InformationOrder::either), path));
    EXPECT_EQ(kinds, std::set<std::string>{}) << file;
  }
}

TEST(GraphCheck, ReportedGraphsAreNamed) {
  TRUSSMAP_NEEDS_SHARED("data/reports/graphs/none.g2o");
  const auto kinds = [](const std::string& name) {
    return kinds_of(
        check_graph(read_g2o(testing::shared("data/reports/graphs/" + name + ".g2o").string(),
                             Edge2::by_name, InformationOrder::either),
                    name));
  };
  EXPECT_EQ(kinds("none"), std::set<std::string>{});
  EXPECT_EQ(kinds("one"), std::set<std::string>{"loops reversed"});
  EXPECT_EQ(kinds("all_identity"),
            (std::set<std::string>{"identity information", "loops reversed"}));
  EXPECT_EQ(kinds("covariance_for_information"),
            std::set<std::string>{"covariance for information"});
  EXPECT_EQ(kinds("degrees"), std::set<std::string>{"angle unit"});
  EXPECT_EQ(kinds("b"), std::set<std::string>{"roots beside information"});
}

}  // namespace
}  // namespace trussmap::graph_check_test
