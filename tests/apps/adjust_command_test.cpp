// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The command as its users meet it: exit status, one line for a mistake, files whole or absent.
#include "pose_graph/synthetic_graph.hpp"
#include "scratch_folder.hpp"
#include "trussmap/map_files.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::adjust_command_test {
namespace {

testing::Ran run(const std::string& arguments) {
  return testing::run_trussmap("adjust " + arguments);
}

class AdjustCommand : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return scratch_.path() / name; }

 private:
  testing::ScratchFolder scratch_;
};

TEST_F(AdjustCommand, WritesTheAdjustedGraphAndItsFigures) {
  const testing::SyntheticGraph world = testing::landmark_walk(80, 4, 9, 3.0, {0.1, 0.02}, 1);
  write_g2o(world.graph, path("in.g2o"));
  const testing::Ran outcome =
      run(path("in.g2o") + " --out " + path("out.g2o") + " --json " + path("out.json"));
  ASSERT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_EQ(outcome.output.rfind("adjusted: converged to a minimum\n", 0), 0U) << outcome.output;

  const auto result = nlohmann::json::parse(std::ifstream(path("out.json")));
  EXPECT_EQ(result["poses"], 80);
  EXPECT_EQ(result["landmarks"], count_points(world.graph));
  EXPECT_EQ(result["warnings"].size(), 0U);
  EXPECT_EQ(result["dof"], 2 * static_cast<int>(world.graph.point_edges.size()) -
                               2 * count_points(world.graph));  // odometry only feeds the poses
  EXPECT_GT(result["iterations"], 0);
  EXPECT_LT(result["gradient_norm"], 1e-3);

  const PoseGraph out = read_g2o(path("out.g2o"));
  std::vector<Pose> estimates;
  for (const GraphVertex& vertex : out.vertices) estimates.push_back(*vertex.estimate);
  const double chi2 = result["chi2"];
  EXPECT_NEAR(chi_squared(out, estimates), chi2, 1e-9 * chi2);
}

TEST_F(AdjustCommand, SaysWhereBadInputIsAndWritesNothing) {
  std::ofstream(path("bad.g2o")) << "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 one 0 0\n";
  const testing::Ran outcome =
      run(path("bad.g2o") + " --out " + path("out.g2o") + " --json " + path("out.json"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.output,
            "trussmap: " + path("bad.g2o") + ":2: x is \"one\", expected a number\n");
  EXPECT_FALSE(std::filesystem::exists(path("out.g2o")));
  EXPECT_FALSE(std::filesystem::exists(path("out.json")));
}

TEST_F(AdjustCommand, NamesTheVerticesOfAGraphInParts) {
  std::ofstream(path("parts.g2o"))
      << "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 17 18 1 0 0 1 0 0 1 0 1\n";
  const testing::Ran outcome = run(path("parts.g2o") + " --out " + path("out.g2o"));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.output.find("vertices 17, 18 are tied to nothing that is tied to vertex 0"),
            std::string::npos)
      << outcome.output;
  EXPECT_FALSE(std::filesystem::exists(path("out.g2o")));
}

TEST_F(AdjustCommand, RefusesToStartFromAFileWithoutEstimates) {
  std::ofstream(path("edges.g2o")) << "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n";
  EXPECT_EQ(run(path("edges.g2o")).status, 0);
  EXPECT_EQ(run(path("edges.g2o") + " --start odometry").status, 0);
  EXPECT_EQ(run(path("edges.g2o") + " --start file").status, 2);
  EXPECT_EQ(run(path("edges.g2o") + " --start nowhere").status, 2);
  EXPECT_EQ(run("").status, 2);
}

}  // namespace
}  // namespace trussmap::adjust_command_test
