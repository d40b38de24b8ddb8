// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The command as its users meet it: exit status, one line for a mistake, files whole or absent.
#include "command_path.hpp"
#include "pose_graph/synthetic_graph.hpp"
#include "trussmap/map_files.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sys/wait.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap {
namespace {

struct Outcome {
  int status = 0;
  std::string output;  ///< standard output and standard error
};

Outcome run(const std::string& arguments) {
  const std::string line = testing::command_path() + " adjust " + arguments + " 2>&1";
  FILE* pipe = popen(line.c_str(), "r");
  Outcome outcome;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    outcome.output.append(buffer.data(), n);
  }
  outcome.status = WEXITSTATUS(pclose(pipe));
  return outcome;
}

class AdjustCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        std::filesystem::temp_directory_path() / ("trussmap_adjust_" + std::string(test->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }

  std::filesystem::path folder_;
};

TEST_F(AdjustCommand, WritesTheAdjustedGraphAndItsFigures) {
  const testing::SyntheticGraph world = testing::landmark_walk(80, 4, 9, 3.0, {0.1, 0.02}, 1);
  write_g2o(world.graph, path("in.g2o"));
  const Outcome outcome =
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
  const Outcome outcome =
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
  const Outcome outcome = run(path("parts.g2o") + " --out " + path("out.g2o"));
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
}  // namespace trussmap
