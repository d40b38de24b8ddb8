// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Bars and small trusses against dense solves made elsewhere (tests/reference).
#include "geometry/index.hpp"
#include "json_matrix.hpp"
#include "shared_data.hpp"
#include "trussmap/truss.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::reference_test {
namespace {

using nlohmann::json;
using testing::matrix;
using testing::vector2;

constexpr double kTolerance = 1e-10;

TEST(ElementStiffness, BothLawsEqualTheReference) {
  testing::for_each(testing::cases("element_stiffness.json", "cases"), [](const nlohmann::json& c) {
    const auto C = matrix<2, 2>(c["C"]);
    const auto printed = matrix<4, 4>(c["K"]);
    const auto inverse = matrix<4, 4>(c["K_inverse_covariance"]);
    const Eigen::Matrix4d K =
        bar_matrix(bar_stiffness(StiffnessLaw::mean_error, C, c["theta"], c["t"]));
    const Eigen::Matrix4d G =
        bar_matrix(bar_stiffness(StiffnessLaw::variance, C, c["theta"], c["t"]));
    EXPECT_LE((K - printed).cwiseAbs().maxCoeff(), kTolerance * printed.cwiseAbs().maxCoeff());
    EXPECT_LE((G - inverse).cwiseAbs().maxCoeff(), kTolerance * inverse.cwiseAbs().maxCoeff());
  });
}

std::vector<Bar> bars_of(const json& c) {
  std::vector<Bar> bars;
  for (const json& b : c["bars"]) {
    bars.push_back(
        {b["i"], b["j"],
         bar_stiffness(StiffnessLaw::mean_error, matrix<2, 2>(b["C"]), b["theta"], b["t"])});
  }
  return bars;
}

TEST(SmallTruss, DisplacementsAndReactionsEqualTheReference) {
  testing::for_each(testing::cases("small_truss.json", "cases"), [](const nlohmann::json& c) {
    std::vector<Support> supports;
    for (const json& joint : c["fixed"]) supports.push_back({joint, Vector2::Zero()});
    for (const auto& [joint, u] : c["imposed"].items()) {
      supports.push_back({std::stoi(joint), vector2(u)});
    }
    std::vector<Load> loads;
    for (const auto& [joint, f] : c["forces"].items()) {
      loads.push_back({std::stoi(joint), vector2(f)});
    }
    const int joints = static_cast<int>(c["nodes"].size());
    const Deflection found = solve_truss(joints, bars_of(c), supports, loads);
    double largest_reaction = 1.0;
    for (const json& r : c["reactions"]) {
      largest_reaction = std::max(largest_reaction, vector2(r).norm());
    }
    for (int joint = 0; joint < joints; ++joint) {
      const Vector2 u = vector2(c["displacements"][idx(joint)]);
      const Vector2 reaction = vector2(c["reactions"][idx(joint)]);
      EXPECT_LE((found.displacements[idx(joint)] - u).norm(), kTolerance) << "joint " << joint;
      EXPECT_LE((found.reactions[idx(joint)] - reaction).norm(), kTolerance * largest_reaction)
          << "joint " << joint;
    }
  });
}

}  // namespace
}  // namespace trussmap::reference_test
