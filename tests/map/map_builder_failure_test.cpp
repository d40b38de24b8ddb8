// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A call of the map builder that throws leaves it as it was: in all that can be asked of it, and in
// all that it does afterwards. Its twin, which made the same calls but for the failed ones, is the
// judge.
#include "failing_allocation.hpp"
#include "geometry/index.hpp"
#include "trussmap/error.hpp"
#include "trussmap/map_builder.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <new>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::map_builder_failure_test {
namespace {

// A factor that was built anew rounds otherwise than one that was updated.
constexpr double kRounding = 1e-10;  // m

void expect_alike(const MapBuilder& a, const MapBuilder& b, const std::string& when) {
  const LandmarkGraph left = a.map();
  const LandmarkGraph right = b.map();
  EXPECT_EQ(a.here(), b.here()) << when;
  ASSERT_EQ(left.landmarks(), right.landmarks()) << when;
  ASSERT_EQ(left.routes(), right.routes()) << when;
  for (int k = 0; k < left.landmarks(); ++k) {
    EXPECT_EQ(left.landmark(k).name, right.landmark(k).name) << when;
    EXPECT_EQ(a.find(left.landmark(k).name), k) << when;
    EXPECT_LE((left.landmark(k).position - right.landmark(k).position).norm(), kRounding) << when;
    EXPECT_EQ(left.routes_at(k), right.routes_at(k)) << when;
  }
  for (int k = 0; k < left.routes(); ++k) {
    const Route& one = left.route(k);
    const Route& other = right.route(k);
    EXPECT_EQ(one.source, other.source) << when;
    EXPECT_EQ(one.target, other.target) << when;
    EXPECT_EQ(one.traversals, other.traversals) << when;
    EXPECT_EQ(one.displacement, other.displacement) << when;
    EXPECT_EQ(one.covariance, other.covariance) << when;
    EXPECT_EQ(one.stretch, other.stretch) << when;
    EXPECT_EQ(one.orientation, other.orientation) << when;
    EXPECT_EQ(a.route_between(one.source, one.target)->traversals, one.traversals) << when;
  }
}

Traversal leg(double x, double y, double sd = 0.1) {
  return {{x, y}, sd * sd * (Matrix2() << 1.0, 0.3, 0.3, 2.0).finished()};
}

/// A street of blocks, driven so that there is a settled loop, a known route and an open chain.
void drive_about(MapBuilder& builder) {
  builder.start("A");
  builder.arrive("B", leg(10.0, 0.2));
  builder.arrive("C", leg(0.1, 9.7));
  builder.arrive("D", leg(-10.2, 0.1));
  builder.arrive("A", leg(0.2, -10.1));  // a loop
  builder.arrive("B", leg(9.9, -0.1));   // a known route
  builder.arrive("E", leg(10.3, 0.3));   // an open chain
  builder.arrive("F", leg(0.2, 10.1));
  builder.observe("C", leg(-9.8, 0.1));
  builder.arrive("G", leg(10.0, 0.0));
  builder.arrive("H", leg(0.1, -10.0));
}

void drive_on(MapBuilder& builder) {
  builder.arrive("E", leg(-9.8, 0.1));
  builder.arrive("F", leg(0.0, 10.4));
  builder.arrive("I", leg(0.1, 9.0));
  builder.arrive("C", leg(-10.1, -9.2));
  builder.arrive("D", leg(-9.9, 0.1));
  builder.relax();
}

std::vector<MapBuilderOptions> every_kind_of_builder() {
  std::vector<MapBuilderOptions> kinds;
  using Kind = RefinementScope::Kind;
  for (const Kind kind : {Kind::nearest, Kind::all, Kind::estimated}) {
    for (const Method method : {Method::elastic, Method::elastic_printed}) {
      kinds.push_back({.method = method, .scope = {kind, 4}});
    }
  }
  kinds.push_back({.scope = {Kind::nearest, 4, false}});
  kinds.push_back({.law = StiffnessLaw::variance});
  kinds.push_back({.method = Method::gauss_markov});
  kinds.push_back({.method = Method::gauss_markov, .pooled = true});
  kinds.push_back({.refine = false});
  return kinds;
}

std::string words(const MapBuilderOptions& options) {
  return name_of(options.method) + ", scope " +
         std::to_string(static_cast<int>(options.scope.kind)) + (options.pooled ? ", pooled" : "") +
         (options.refine ? "" : ", first sight only");
}

struct Call {
  const char* what;
  std::function<void(MapBuilder&)> make;
};

std::vector<Call> every_call() {
  return {
      {"a new landmark", [](MapBuilder& b) { b.arrive("J", leg(9.0, 1.0)); }},
      {"a new route", [](MapBuilder& b) { b.arrive("C", leg(-20.0, 10.3)); }},
      {"a known route", [](MapBuilder& b) { b.arrive("G", leg(0.3, 10.2)); }},
      {"a sighting of a new one", [](MapBuilder& b) { b.observe("J", leg(9.0, 1.0)); }},
      {"all at once", [](MapBuilder& b) { b.relax(); }},
      {"a new session", [](MapBuilder& b) { b.start("C"); }},
  };
}

/// Memory runs out at the first allocation of a call, at the second, and so on, until the call has
/// no further one.
TEST(MapBuilderFailure, MemoryThatRunsOutAnywhereChangesNothing) {
  for (const MapBuilderOptions& options : every_kind_of_builder()) {
    int in_all = 0;
    for (const Call& call : every_call()) {
      const std::string when = words(options) + ": " + call.what;
      MapBuilder victim(options);
      MapBuilder twin(options);
      drive_about(victim);
      drive_about(twin);
      int thrown = 0;
      for (int nth = 1;; ++nth) {
        bool threw = false;
        bool happened = false;
        {
          const testing::FailingAllocation failing(nth);
          try {
            call.make(victim);
          } catch (const std::bad_alloc&) {
            threw = true;
          }
          happened = failing.happened();
        }
        if (!happened) break;
        if (threw) {
          ++thrown;
          if (nth % 7 == 1) expect_alike(victim, twin, when);
        } else {  // it could do without: begin again
          victim = MapBuilder(options);
          drive_about(victim);
        }
        ASSERT_LT(nth, 5000) << when;
        if (HasFailure()) return;
      }
      call.make(twin);
      expect_alike(victim, twin, when);
      in_all += thrown;
      if (victim.here() != *victim.find("H")) {
        for (MapBuilder* builder : {&victim, &twin}) builder->start("H");
      }
      drive_on(victim);
      drive_on(twin);
      expect_alike(victim, twin, when + ", and on");
      if (HasFailure()) return;
    }
    EXPECT_GT(in_all, 20) << words(options);
  }
}

/// Covariances out of all proportion, each refused somewhere else on the way.
TEST(MapBuilderFailure, NumbersThatCannotBeSolvedChangeNothing) {
  const double nan = std::nan("");
  const double inf = std::numeric_limits<double>::infinity();
  const Matrix2 one = 0.01 * Matrix2::Identity();
  const std::vector<Traversal> legs{
      {{nan, 0.0}, one},
      {{inf, 0.0}, one},
      {{0.0, 0.0}, one},
      {{1e200, 0.0}, one},
      {{9.0, 1.0}, -one},
      {{9.0, 1.0}, 1e-200 * one},
      {{9.0, 1.0}, 1e200 * one},
      {{9.0, 1.0}, (Matrix2() << 1.0, 1.0, 1.0, 1.0).finished()},
      {{9.0, 1.0}, (Matrix2() << 1.0, 1.0, 1.0, 1.0 + 1e-15).finished()},
      {{9.0, 1.0}, (Matrix2() << 1.0, 0.5, -0.5, 1.0).finished()},
      {{9.0, 1.0}, nan * one},
      // Sound by themselves, but not beside the others:
      {{9.0, 1.0}, 1e-60 * one},
      {{9.0, 1.0}, 1e60 * one},
      {{9.0, 1.0}, 1e-150 * one},
      {{1e154, 0.0}, 1e-150 * one},
      {{1e154, 1e153}, 1e150 * one},
      {{1e154, 1e153}, one},
  };
  int thrown = 0;
  int beside = 0;
  for (MapBuilderOptions options : every_kind_of_builder()) {
    options.gate = inf;
    MapBuilder victim(options);
    MapBuilder twin(options);
    drive_about(victim);
    drive_about(twin);
    for (std::size_t k = 0; k < legs.size(); ++k) {
      for (const char* landmark : {"J", "C", "G", "H"}) {
        const std::string when = words(options) + ": leg " + std::to_string(k) + " to " + landmark;
        try {
          victim.arrive(landmark, legs[k]);
          victim = MapBuilder(options);  // it could be solved: begin again
          drive_about(victim);
          continue;
        } catch (const std::invalid_argument&) {
        } catch (const SolveError&) {
          ++beside;
        }
        ++thrown;
        expect_alike(victim, twin, when);
        if (HasFailure()) return;
      }
    }
    for (MapBuilder* builder : {&victim, &twin}) drive_on(*builder);
    expect_alike(victim, twin, words(options) + ", and on");
  }
  EXPECT_GT(thrown, 400);
  EXPECT_GT(beside, 10);
}

TEST(MapBuilderFailure, AStartThatIsRefusedChangesNothing) {
  MapBuilder builder;
  EXPECT_THROW(builder.start("A", {std::nan(""), 0.0}), std::invalid_argument);
  EXPECT_THROW(builder.start(""), std::invalid_argument);
  EXPECT_EQ(builder.landmarks(), 0);
  EXPECT_EQ(builder.here(), -1);
  builder.start("A", {1.0, 2.0});
  EXPECT_THROW(builder.start("B"), SolveError);
  EXPECT_EQ(builder.here(), 0);
  EXPECT_EQ(builder.landmarks(), 1);
}

/// The message names the landmark, not a joint of some structure.
TEST(MapBuilderFailure, NamesTheLandmarkThatCannotBeSolved) {
  MapBuilder builder({.method = Method::elastic_printed});
  builder.start("dock");
  builder.arrive("door", leg(10.0, 0.0, 1e-9));
  builder.arrive("shed", leg(10.0, 0.0, 1e9));
  try {
    builder.start("dock");
    builder.arrive("door", leg(10.1, 0.0, 1e-9));
    FAIL() << "nothing was thrown";
  } catch (const SolveError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("landmark ", 0), 0U) << error.what();
  }
}

}  // namespace
}  // namespace trussmap::map_builder_failure_test
