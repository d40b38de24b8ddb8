// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One refinement step against dense solves made elsewhere (tests/reference/small_truss.json), and
// first-sight chains against the stiffness method.
#include "map/refinement.hpp"

#include "geometry/index.hpp"
#include "json_matrix.hpp"
#include "map/first_sight.hpp"
#include "shared_data.hpp"
#include "trussmap/map_builder.hpp"
#include "trussmap/truss.hpp"

#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::refinement_test {
namespace {

using nlohmann::json;
using testing::matrix;
using testing::vector2;

constexpr double kTolerance = 1e-10;

std::vector<testing::Case> refinements() {
  return testing::cases("small_truss.json", "refinement_cases");
}

Matrix2 stiffness_of(const json& bar) {
  return bar_stiffness(StiffnessLaw::mean_error, matrix<2, 2>(bar["C"]), bar["theta"], bar["t"]);
}

std::optional<Matrix2> adjacent(const json& c, const std::string& key) {
  if (c[key].is_null()) return std::nullopt;
  return stiffness_of(c["bars"][c[key].get<std::size_t>()]);
}

TEST(RefinementStep, ForcesAndDisplacementsEqualTheReference) {
  testing::for_each(refinements(), [](const nlohmann::json& c) {
    const json& bar = c["bars"][c["route"].get<std::size_t>()];
    const int i = bar["i"];
    const int j = bar["j"];
    const Vector2 present = vector2(c["nodes"][idx(j)]) - vector2(c["nodes"][idx(i)]);
    const double s = c["new_stretch"];
    const double angle = c["new_orientation"];
    const map::RefinementLoads loads = map::refinement_loads(
        present, s * Vector2(std::cos(angle), std::sin(angle)), stiffness_of(bar),
        adjacent(c, "adjacent_bar_at_i"), adjacent(c, "adjacent_bar_at_j"));
    EXPECT_LE((loads.desired_i - vector2(c["desired_ui"])).norm(), kTolerance);
    EXPECT_LE((loads.desired_j - vector2(c["desired_uj"])).norm(), kTolerance);
    const double scale = 1.0 + loads.force_i.norm();
    EXPECT_LE((loads.force_i - vector2(c["force_i"])).norm(), kTolerance * scale);
    EXPECT_LE((loads.force_j - vector2(c["force_j"])).norm(), kTolerance * scale);

    std::vector<Bar> bars;
    for (const json& b : c["bars"]) bars.push_back({b["i"], b["j"], stiffness_of(b)});
    const int joints = static_cast<int>(c["nodes"].size());
    const Deflection found =
        solve_truss(joints, bars, {{0, Vector2::Zero()}}, {{i, loads.force_i}, {j, loads.force_j}});
    for (int n = 0; n < joints; ++n) {
      EXPECT_LE((found.displacements[idx(n)] - vector2(c["displacements"][idx(n)])).norm(),
                kTolerance);
    }
  });
}

/// Those whose route was driven before: the others are no refinement to a map builder.
std::vector<testing::Case> driven_routes() {
  std::vector<testing::Case> all = refinements();
  std::erase_if(all, [](const testing::Case& one) {
    const json& c = one.content;
    return c["bars"][c["route"].get<std::size_t>()]["t"] < 2;
  });
  return all;
}

/// A map builder brought into the state before the step must do the whole step by itself: the
/// landmarks at their places, every route driven t times (the refined one t - 1), then one more.
TEST(DrivenRoute, TheMapBuilderChoosesTheSameNeighboursAndMoves) {
  testing::for_each(driven_routes(), [](const nlohmann::json& c) {
    const std::size_t refined = c["route"];
    MapBuilderOptions options;
    options.method = Method::elastic_printed;
    options.scope.kind = RefinementScope::Kind::all;
    options.refine = false;
    const auto node = [&c](int n) { return vector2(c["nodes"][idx(n)]); };
    const auto name = [](int n) { return "n" + std::to_string(n); };
    // Every bar's route begins with its exact displacement, so no first sight moves anything; on
    // the 3x3 grid's bars a landmark is reached before it is left.
    MapBuilder builder(options);
    builder.start(name(0), node(0));
    std::vector<std::size_t> order;
    std::vector<bool> met(c["nodes"].size(), false);
    std::vector<bool> driven(c["bars"].size(), false);
    met[0] = true;
    for (std::size_t done = 0; done < c["bars"].size();) {
      for (std::size_t b = 0; b < c["bars"].size(); ++b) {
        const json& bar = c["bars"][b];
        const int i = bar["i"];
        const int j = bar["j"];
        if (driven[b] || (!met[idx(i)] && !met[idx(j)])) continue;
        const int from = met[idx(i)] ? i : j;
        const int to = met[idx(i)] ? j : i;
        const int before = bar["t"].get<int>() - (b == refined ? 1 : 0);
        for (int t = 0; t < before; ++t) {
          builder.start(name(from));
          builder.arrive(name(to), Traversal{node(to) - node(from), matrix<2, 2>(bar["C"])});
        }
        driven[b] = true;
        met[idx(to)] = true;
        ++done;
      }
    }
    const json& bar = c["bars"][refined];
    const int i = bar["i"];
    const int j = bar["j"];
    const int t = bar["t"];
    // The new traversal that brings the mean (of t, t - 1 of them as the map has it) to the target.
    const Vector2 present = node(j) - node(i);
    const double stretch = t * c["new_stretch"].get<double>() - (t - 1) * present.norm();
    const double orientation =
        t * unwrap_near(c["new_orientation"], direction(present)) - (t - 1) * direction(present);
    // A second builder refines; the state is the same but for the option.
    options.refine = true;
    builder.set_options(options);
    builder.start(name(i));
    const Arrival arrival = builder.arrive(
        name(j), Traversal{stretch * Vector2(std::cos(orientation), std::sin(orientation)),
                           matrix<2, 2>(bar["C"])});
    EXPECT_EQ(arrival.kind, Arrival::Kind::refinement);
    for (int n = 0; n < static_cast<int>(c["nodes"].size()); ++n) {
      const Vector2 expected = node(n) + vector2(c["displacements"][idx(n)]);
      EXPECT_LE((builder.position(*builder.find(name(n))) - expected).norm(), kTolerance) << n;
    }
  });
}

/// The cases whose bars form one chain from the held joint 0 to the displaced last joint.
std::vector<testing::Case> chains() {
  std::vector<testing::Case> all = testing::cases("small_truss.json", "cases");
  std::erase_if(all, [](const testing::Case& one) {
    const json& c = one.content;
    const std::size_t last = c["nodes"].size() - 1;
    bool chain = c["forces"].empty() && c["fixed"].size() == 1 && c["fixed"][0] == 0 &&
                 c["bars"].size() == last && c["imposed"].size() == 1 &&
                 c["imposed"].contains(std::to_string(last));
    for (std::size_t b = 0; chain && b < last; ++b) {
      chain = c["bars"][b]["i"] == b && c["bars"][b]["j"] == b + 1;
    }
    return !chain;
  });
  return all;
}

TEST(FirstSightChain, SeriesCompliancesEqualTheStiffnessMethod) {
  testing::for_each(chains(), [](const nlohmann::json& c) {
    const int joints = static_cast<int>(c["nodes"].size());
    std::vector<Matrix2> stiffnesses;
    for (const json& bar : c["bars"]) stiffnesses.push_back(stiffness_of(bar));
    const auto u =
        map::chain_displacements(stiffnesses, vector2(c["imposed"][std::to_string(joints - 1)]));
    for (int n = 1; n < joints; ++n) {
      EXPECT_LE((u[idx(n - 1)] - vector2(c["displacements"][idx(n)])).norm(), kTolerance);
    }
  });
}

}  // namespace
}  // namespace trussmap::refinement_test
