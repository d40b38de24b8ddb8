// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A map store holds what its builder would have remembered, and nothing less, whatever happens to
// the program.
#include "trussmap/map_store.hpp"

#include "child_process.hpp"
#include "geometry/index.hpp"
#include "scratch_folder.hpp"
#include "store/database.hpp"
#include "trussmap/error.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <sys/resource.h>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::map_store_test {
using namespace store;
namespace {

namespace fs = std::filesystem;

constexpr double kExact = 0.0;
constexpr double kRefactored = 1e-9;  // m: a factor that was built anew rounds otherwise

std::string name(int k) {
  return "n" + std::to_string(k);
}

struct Step {
  std::string to;
  Traversal leg;
  bool aside = false;  // observed, not driven to
};

/// A random walk over points with noisy legs, now and then a landmark at the side, one label in 40
/// wrong (seed).
std::vector<Step> walk(int landmarks, int legs, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> place(0.0, 20.0);
  std::uniform_int_distribution<int> any(0, landmarks - 1);
  std::vector<Vector2> truth;
  for (int k = 0; k < landmarks; ++k) truth.emplace_back(place(random), place(random));
  std::vector<Step> steps;
  int here = 0;
  int said = 0;
  while (static_cast<int>(steps.size()) < legs) {
    const int next = any(random);
    const bool wrong = steps.size() % 40 == 39;
    const int label = wrong ? any(random) : next;
    if (next == here || label == said || label == here) continue;
    const Matrix2 R = rotation(normal(random));
    const Matrix2 C = R * Vector2(0.04, 0.01).asDiagonal() * R.transpose();
    const Vector2 error = R * Vector2(0.2 * normal(random), 0.1 * normal(random));
    const bool aside = steps.size() % 7 == 6 && !wrong;
    steps.push_back({name(label), {truth[idx(next)] - truth[idx(here)] + error, C}, aside});
    if (aside) continue;
    here = next;
    said = label;
  }
  return steps;
}

template <typename Builder>
Arrival take(Builder& builder, const Step& step) {
  return step.aside ? builder.observe(step.to, step.leg) : builder.arrive(step.to, step.leg);
}

void expect_alike(const MapBuilder& a, const MapBuilder& b, double tolerance) {
  const LandmarkGraph left = a.map();
  const LandmarkGraph right = b.map();
  EXPECT_EQ(a.here(), b.here());
  EXPECT_EQ(a.left_out().size(), b.left_out().size());
  ASSERT_EQ(left.landmarks(), right.landmarks());
  ASSERT_EQ(left.routes(), right.routes());
  for (int k = 0; k < left.landmarks(); ++k) {
    EXPECT_EQ(left.landmark(k).name, right.landmark(k).name);
    EXPECT_LE((left.landmark(k).position - right.landmark(k).position).norm(), tolerance);
  }
  for (int k = 0; k < left.routes(); ++k) {
    const Route& one = left.route(k);
    const Route& other = right.route(k);
    EXPECT_EQ(one.source, other.source);
    EXPECT_EQ(one.target, other.target);
    EXPECT_EQ(one.traversals, other.traversals);
    EXPECT_EQ(one.displacement, other.displacement);
    EXPECT_LE((one.covariance - other.covariance).norm(), 1e-12 * one.covariance.norm());
    EXPECT_EQ(one.stretch, other.stretch);
    EXPECT_EQ(one.orientation, other.orientation);
  }
}

std::vector<MapBuilderOptions> many_options() {
  std::vector<MapBuilderOptions> result;
  for (const Method method : {Method::elastic, Method::elastic_printed, Method::gauss_markov}) {
    for (const RefinementScope::Kind kind :
         {RefinementScope::Kind::all, RefinementScope::Kind::nearest,
          RefinementScope::Kind::estimated}) {
      result.push_back(
          {.method = method, .scope = {kind, 5}, .pooled = kind == RefinementScope::Kind::all});
    }
  }
  return result;
}

class MapStoreTest : public ::testing::Test {
 protected:
  testing::ScratchFolder scratch_;
  fs::path file_ = scratch_.path() / "map.db";
};

/// Whatever a builder knows: its chain, gate, what it carries on, its bars.
using SlowMapStoreTest = MapStoreTest;

TEST_F(SlowMapStoreTest, OneThatIsOpenedBeforeEveryLegIsAsABuilderThatNeverStopped) {
  const std::vector<Step> steps = walk(12, 160, 5);
  for (const MapBuilderOptions& options : many_options()) {
    SCOPED_TRACE(name_of(options.method));
    fs::remove(file_);
    MapBuilder twin(options);
    twin.start(name(0), {1.0, 2.0});
    MapStore(file_, options).start(name(0), {1.0, 2.0});
    const double tolerance = options.method == Method::elastic_printed ? kExact : kRefactored;
    for (std::size_t k = 0; k < steps.size(); ++k) {
      if (k == 100) {
        twin.start(name(3));
        MapStore(file_).start(name(3));
      }
      if (steps[k].to == twin.map().landmark(twin.here()).name) continue;
      const Arrival expected = take(twin, steps[k]);
      MapStore store(file_);
      const Arrival arrival = take(store, steps[k]);
      ASSERT_EQ(arrival.kind, expected.kind) << k;
      ASSERT_EQ(arrival.landmark, expected.landmark) << k;
      ASSERT_EQ(arrival.back, expected.back) << k;
      ASSERT_LE((arrival.misfit - expected.misfit).norm(), tolerance) << k;
    }
    expect_alike(MapStore(file_).builder(), twin, tolerance);
  }
}

TEST_F(MapStoreTest, EveryLegIsKeptAsItWasGiven) {
  const std::vector<Step> steps = walk(10, 120, 6);
  const MapBuilderOptions ungated{.gate = std::numeric_limits<double>::infinity()};
  MapStore store(file_, ungated);
  store.start(name(0), {3.0, -1.0});
  store.append("monday", "Monday's tour", [&](MapBuilder& builder) {
    for (const Step& step : steps) take(builder, step);
    builder.compass(0.1, 0.05);
    builder.relax();
  });
  EXPECT_EQ(store.legs(), 123);
  ASSERT_EQ(store.sessions().size(), 1U);
  EXPECT_EQ(store.sessions()[0].name, "Monday's tour");
  EXPECT_EQ(store.sessions()[0].first_leg, 1);
  EXPECT_EQ(store.sessions()[0].legs, 122);
  EXPECT_TRUE(store.has_session("monday"));
  EXPECT_FALSE(store.has_session("tuesday"));

  MapBuilder again(ungated);  // from what was kept alone
  int in_session = 0;
  store.for_each_leg([&](const StoredLeg& one) {
    if (one.session == 0) ++in_session;
    switch (one.kind) {
      case StoredLeg::Kind::start:
        return again.start(one.to, one.leg.displacement);
      case StoredLeg::Kind::arrive:
        EXPECT_EQ(one.from, again.map().landmark(again.here()).name);
        return static_cast<void>(again.arrive(one.to, one.leg));
      case StoredLeg::Kind::observe:
        return static_cast<void>(again.observe(one.to, one.leg));
      case StoredLeg::Kind::compass:
        return again.compass(one.motion.displacement.heading,
                             std::sqrt(one.motion.covariance(2, 2)));
      case StoredLeg::Kind::relax:
        return static_cast<void>(again.relax());
    }
  });
  EXPECT_EQ(in_session, 122);
  expect_alike(again, store.builder(), kExact);
}

/// Equilibria of corners are found to within 1e-11 of their energy, from wherever one begins:
/// places to within some 3e-6 of the strain.
void expect_near(const MapBuilder& a, const MapBuilder& b) {
  constexpr double kNear = 1e-5;  // m
  EXPECT_EQ(a.here(), b.here());
  ASSERT_EQ(a.landmarks(), b.landmarks());
  for (int k = 0; k < a.landmarks(); ++k) {
    EXPECT_LE((a.position(k) - b.position(k)).norm(), kNear) << k;
  }
  EXPECT_NEAR(a.energy(), b.energy(), kNear * (1.0 + b.energy()));
}

/// Legs in the robot's own axes, a compass, landmarks from afar: opened before every call, and read
/// back from what was kept, it is the builder that never stopped.
TEST_F(MapStoreTest, AMapOfMotionsGoesOnAsItWas) {
  const WheelNoise noise{0.003, 0.003};
  const auto turned = [&](double angle, double way) {
    return then(arc_motion({-0.17 * angle, 0.17 * angle + 1e-4}, 0.34, noise),
                arc_motion({way, way + 0.01}, 0.34, noise));
  };
  MapBuilder twin;
  const auto both = [&](const auto& call) {
    call(twin);
    MapStore store(file_);
    call(store);
  };
  both([](auto& map) { map.start("dock", seen_at(1.0, 0.2, 0.05, 0.02)); });
  const char* const names[] = {"a", "b", "c", "dock"};
  for (int leg = 0; leg < 11; ++leg) {
    const LandmarkOffset seen = seen_at(0.8, 0.1 * leg, 0.05, 0.02);
    both(
        [&](auto& map) { map.arrive(names[leg % 4], turned(leg == 0 ? 0.0 : 1.5708, 5.0), seen); });
    if (leg % 3 == 0) both([&](auto& map) { map.observe("lamp", seen_at(3.0, 1.0, 0.1, 0.03)); });
    if (leg == 6) both([](auto& map) { map.compass(0.3, 0.02); });
    if (leg == 8) both([](auto& map) { map.compass(-2.9, 0.02); });
  }
  both([](auto& map) { map.relax(); });
  expect_near(MapStore(file_).builder(), twin);
  expect_near(read_builder(file_), twin);
  EXPECT_EQ(read_builder(file_).pose()->pose.heading,
            MapStore(file_).builder().pose()->pose.heading);
  MapBuilder again;
  MapStore(file_).for_each_leg([&](const StoredLeg& one) {
    switch (one.kind) {
      case StoredLeg::Kind::start:
        return again.start(one.to, one.seen, one.leg.displacement);
      case StoredLeg::Kind::arrive:
        return static_cast<void>(again.arrive(one.to, one.motion, one.seen));
      case StoredLeg::Kind::observe:
        return static_cast<void>(again.observe(one.to, one.seen));
      case StoredLeg::Kind::compass:
        return again.compass(one.motion.displacement.heading,
                             std::sqrt(one.motion.covariance(2, 2)));
      case StoredLeg::Kind::relax:
        return static_cast<void>(again.relax());
    }
  });
  expect_near(again, twin);
  const fs::path saved = scratch_.path() / "saved.db";
  static_cast<void>(MapStore::create(saved, twin));
  MapBuilder back = read_builder(saved);
  expect_near(back, twin);
  const Motion on = turned(1.5708, 5.0);
  back.arrive("new", on);
  twin.arrive("new", on);
  expect_near(back, twin);
}

TEST_F(MapStoreTest, ASessionThatThrowsIsNotKeptAtAll) {
  const std::vector<Step> steps = walk(10, 60, 7);
  MapBuilder twin;
  MapStore store(file_);
  twin.start(name(0));
  store.start(name(0));
  const auto halfway = [&](MapBuilder& builder) {
    for (std::size_t k = 0; k < 30; ++k) take(builder, steps[k]);
    builder.arrive("nowhere", Traversal{});  // no leg
  };
  EXPECT_THROW(store.append("s", "s", halfway), std::invalid_argument);
  EXPECT_FALSE(store.has_session("s"));
  EXPECT_EQ(store.legs(), 1);
  expect_alike(store.builder(), twin, kExact);
  for (const Step& step : steps) {
    take(twin, step);
    take(store, step);
    EXPECT_THROW(store.arrive("nowhere", Traversal{}), std::invalid_argument);
  }
  expect_alike(store.builder(), twin, kExact);
  EXPECT_EQ(store.legs(), 61);
  EXPECT_THROW(store.append("", "s", [](MapBuilder&) {}), std::invalid_argument);
  store.append("s", "s", [](MapBuilder&) {});
  EXPECT_THROW(store.append("s", "again", [](MapBuilder&) {}), std::invalid_argument);
}

TEST_F(MapStoreTest, OneWriterAtATimeAndReadersMeanwhile) {
  MapStore store(file_);
  store.start("dock");
  store.arrive("door", Traversal{{4.0, 0.3}, 0.01 * Matrix2::Identity()});
  try {
    MapStore second(file_);
    FAIL() << "two writers";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), file_.string() +
                                             ": is being written by another program, "
                                             "expected one at a time");
  }
  const StoredMap read = read_map_store(file_);
  EXPECT_EQ(read.map.landmarks(), 2);
  EXPECT_EQ(read.legs, 2);
  store.arrive("stairs", Traversal{{0.0, 3.0}, 0.01 * Matrix2::Identity()});
  EXPECT_EQ(read_map_store(file_).map.landmarks(), 3);
  store = MapStore(scratch_.path() / "other.db");
  EXPECT_FALSE(fs::exists(file_.string() + "-wal"));
  EXPECT_FALSE(fs::exists(file_.string() + "-lock"));
  EXPECT_EQ(MapStore(file_).legs(), 3);
}

TEST_F(MapStoreTest, AMapGoesInAndOut) {
  const std::vector<Step> steps = walk(12, 200, 8);
  for (const Method method : {Method::elastic, Method::gauss_markov}) {
    fs::remove(file_);
    MapBuilder builder({.method = method});
    builder.start(name(0));
    for (const Step& step : steps) take(builder, step);
    const fs::path graphml = scratch_.path() / "map.graphml";
    write_file(graphml, format_map_graphml(builder.map()));
    const LandmarkGraph map = read_map_graphml(graphml);
    { MapStore store = MapStore::create(file_, map, {.method = method}); }
    const StoredMap read = read_map_store(file_);
    EXPECT_EQ(read.method, method);
    EXPECT_EQ(format_map_graphml(read.map), format_map_graphml(map));
    EXPECT_THROW(static_cast<void>(MapStore::create(file_, map)), InputError);

    // It grows on as a builder does that was given the map.
    MapBuilder twin(map, {.method = method});
    MapStore store(file_);
    twin.start(name(1));
    store.start(name(1));
    for (const Step& step : walk(12, 50, 8)) {
      if (step.to == twin.map().landmark(twin.here()).name) continue;
      take(twin, step);
      take(store, step);
    }
    expect_alike(store.builder(), twin, method == Method::elastic_printed ? kExact : kRefactored);
  }
}

TEST_F(MapStoreTest, OptionsAreKeptOrTaken) {
  {
    MapStore store(file_, MapBuilderOptions{.scope = {RefinementScope::Kind::nearest, 7},
                                            .law = StiffnessLaw::variance});
    store.set_note("axes", "compass");
    store.start("A");
  }
  {
    MapStore store(file_);
    EXPECT_EQ(store.builder().options().scope.eta, 7);
    EXPECT_EQ(store.builder().options().law, StiffnessLaw::variance);
    EXPECT_EQ(store.note("axes"), "compass");
    EXPECT_EQ(store.note("other"), "");
  }
  EXPECT_THROW(MapStore(file_, MapBuilderOptions{.method = Method::gauss_markov}),
               std::invalid_argument);
  EXPECT_THROW(MapStore(file_, MapBuilderOptions{.scope = {RefinementScope::Kind::nearest, 1}}),
               std::invalid_argument);
  MapStore(file_, MapBuilderOptions{.scope = {RefinementScope::Kind::nearest, 8},
                                    .law = StiffnessLaw::variance});
  EXPECT_EQ(MapStore(file_).builder().options().scope.eta, 8);
  const double infinity = std::numeric_limits<double>::infinity();
  const fs::path ungated = scratch_.path() / "ungated.db";
  MapStore(ungated, MapBuilderOptions{.method = Method::gauss_markov, .gate = infinity});
  EXPECT_EQ(MapStore(ungated).builder().options().gate, infinity);
}

TEST_F(MapStoreTest, OtherFilesAreRefusedAndLeftAsTheyAre) {
  const auto refusal = [&](const std::string& content) {
    write_file(file_, content);
    std::string said;
    try {
      MapStore store(file_);
    } catch (const InputError& error) {
      said = error.what();
    }
    EXPECT_EQ(read_file(file_), content);
    EXPECT_THROW(static_cast<void>(read_map_store(file_)), InputError);
    return said.substr(std::min(said.size(), file_.string().size()));
  };
  EXPECT_EQ(refusal("t,left,right\n0.1,0.2,0.3\n" + std::string(5000, 'x')), ": is no map store");
  EXPECT_EQ(refusal("<graphml/>"), ": is no map store");
  EXPECT_EQ(refusal("x"), ": is no map store");
  EXPECT_THROW(MapStore(scratch_.path()), InputError);
  EXPECT_THROW(static_cast<void>(read_map_store(scratch_.path() / "none.db")), InputError);
  EXPECT_FALSE(fs::exists(scratch_.path() / "none.db"));
}

TEST_F(MapStoreTest, NothingIsLeftOfACallWithinACall) {
  const Traversal leg{{1.0, 0.0}, 0.01 * Matrix2::Identity()};
  MapStore store(file_);
  store.start("A");
  store.arrive("B", leg);
  const auto within = [&](MapBuilder& builder) {
    builder.arrive("C", leg);
    EXPECT_THROW(store.set_note("x", "y"), std::logic_error);
    EXPECT_THROW(store.arrive("D", leg), std::logic_error);
    throw std::runtime_error("enough");
  };
  EXPECT_THROW(store.append("s", "s", within), std::runtime_error);
  EXPECT_THROW(store.for_each_leg([&](const StoredLeg&) { store.arrive("D", leg); }),
               std::logic_error);
  const auto exchanged = [&](MapBuilder& builder) {
    builder = MapBuilder(builder.options());
    builder.start("Z");
  };
  EXPECT_THROW(store.append("s", "s", exchanged), std::logic_error);
  const auto set = [](MapBuilder& builder) {
    MapBuilderOptions options = builder.options();
    options.scope.eta = 9;
    builder.set_options(options);
    throw std::runtime_error("enough");
  };
  EXPECT_THROW(store.append("s", "s", set), std::runtime_error);
  EXPECT_EQ(store.builder().options().scope.eta, MapBuilderOptions().scope.eta);
  EXPECT_EQ(store.builder().landmarks(), 2);
  store.arrive("C", leg);
  EXPECT_EQ(store.legs(), 3);
  EXPECT_TRUE(store.sessions().empty());
}

/// A landmark that has moved, and back from there; as absurd as numbers get.
TEST_F(MapStoreTest, WhatIsLeftOutIsKeptAsItWasSaid) {
  const MapBuilderOptions options{.method = Method::gauss_markov};
  const auto leg = [](double x, double y) { return Traversal{{x, y}, 1e-4 * Matrix2::Identity()}; };
  std::vector<StoredLeg> legs;
  {
    MapStore store(file_, options);
    store.start("A");
    for (int lap = 0; lap < 3; ++lap) {
      store.arrive("B", leg(10.0, 0.0));
      store.arrive("A", leg(-10.0, 0.0));
    }
    EXPECT_EQ(store.arrive("B", leg(1.0, 30.0)).kind, Arrival::Kind::left_out);
    EXPECT_EQ(store.observe("A", leg(-1.0, -30.0)).kind, Arrival::Kind::left_out);
    EXPECT_EQ(store.arrive("C", leg(0.0, -29.0)).kind, Arrival::Kind::new_landmark);
    EXPECT_EQ(store.arrive("B", leg(1.0, 30.0)).kind, Arrival::Kind::left_out);
    EXPECT_EQ(store.arrive("C", leg(-1.0, -30.0)).kind, Arrival::Kind::left_out);  // back
    store.arrive("A", leg(-1.0, -1.0));
    EXPECT_EQ(store.arrive("B", leg(1e153, 0.0)).kind, Arrival::Kind::left_out);
    store.for_each_leg([&](const StoredLeg& one) { legs.push_back(one); });
  }
  ASSERT_EQ(legs.size(), 14U);
  EXPECT_EQ(legs[9].from, "B");  // to C, from where it said it was
  EXPECT_EQ(legs[9].outcome, Arrival::Kind::new_landmark);
  EXPECT_EQ(legs[7].outcome, Arrival::Kind::left_out);
  EXPECT_EQ(legs[12].from, "C");
  EXPECT_FALSE(legs[0].outcome);
  const MapStore again(file_);
  const Vector2 c = again.builder().position(*again.builder().find("C"));
  EXPECT_LE((c - Vector2(1.0, 1.0)).norm(), 0.1);
}

TEST_F(MapStoreTest, AStoreWithoutLandmarksMayStillChangeItsMethod) {
  write_file(file_, "");  // as mktemp makes it
  { const MapStore store(file_); }
  const MapStore store(file_, MapBuilderOptions{.method = Method::gauss_markov});
  EXPECT_EQ(store.builder().options().method, Method::gauss_markov);
  const fs::path other = scratch_.path() / "other.db";
  EXPECT_THROW(MapStore(other, MapBuilderOptions{.method = Method::adjustment}),
               std::invalid_argument);
  EXPECT_FALSE(fs::exists(other));
  EXPECT_EQ(MapStore(other, {}, {.method = Method::gauss_markov}).builder().options().method,
            Method::gauss_markov);
}

/// Bytes changed at random (seed): refused in words, or read as something else, but never worse.
TEST_F(MapStoreTest, DamagedFilesAreRefused) {
  {
    MapStore store(file_, MapBuilderOptions{.method = Method::gauss_markov});
    store.start(name(0));
    for (const Step& step : walk(8, 80, 9)) take(store, step);
  }
  const std::string whole = read_file(file_);
  std::mt19937_64 random(10);
  int refused = 0;
  for (int round = 0; round < 60; ++round) {
    std::string content = whole;
    for (int k = 0; k < 20; ++k) content[random() % content.size()] = static_cast<char>(random());
    if (round % 5 == 0) content.resize(random() % content.size());
    write_file(file_, content);
    try {
      static_cast<void>(read_map_store(file_));
      MapStore store(file_);
      store.start(name(0));
      store.arrive(name(1), Traversal{{1.0, 2.0}, 0.01 * Matrix2::Identity()});
    } catch (const InputError&) {
      ++refused;
    } catch (const SolveError&) {
      ++refused;
    } catch (const std::invalid_argument&) {
      ++refused;
    }
    fs::remove(file_.string() + "-wal");
    fs::remove(file_.string() + "-shm");
  }
  EXPECT_GT(refused, 10);
}

/// The first version's files, kept as they were written: their maps can be read for ever.
TEST_F(MapStoreTest, FilesOfTheFirstVersionGoOn) {
  const fs::path kept = fs::path(TRUSSMAP_SOURCE_DIR) / "tests/fuzz/corpus/store";
  const auto gone_on = [&](const char* name) {
    write_file(file_, read_file(kept / name));
    MapStore store(file_);
    const int before = store.builder().landmarks();
    store.start(before > 0 ? "a" : "first");
    store.arrive("another", Traversal{{3.0, 4.0}, 0.01 * Matrix2::Identity()});
    return std::pair(before, store.legs());
  };
  EXPECT_EQ(gone_on("elastic"), std::pair(5, std::int64_t{14}));
  EXPECT_EQ(gone_on("gauss_markov"), std::pair(4, std::int64_t{13}));
  EXPECT_EQ(gone_on("new"), std::pair(0, std::int64_t{2}));
}

/// What somebody else's SQLite may have put into the file: a statement of its own would run with
/// every call, and numbers lead beyond all ends.
TEST_F(MapStoreTest, OnesWithOtherTablesOrMisnumberedRowsAreRefused) {
  {
    MapStore store(file_);
    store.start("a");
    const Traversal leg{{1.0, 2.0}, 0.01 * Matrix2::Identity()};
    store.append("key", "a session", [&](MapBuilder& builder) { builder.arrive("b", leg); });
  }
  const std::string whole = read_file(file_);
  const auto refusal = [&](const std::string& statements) {
    write_file(file_, whole);
    Database(file_, Database::Access::write).run(statements);
    const auto of = [](const auto& call) -> std::string {
      try {
        call();
      } catch (const InputError& error) {
        return std::string(error.what());
      }
      return "";
    };
    const std::string read = of([&] { static_cast<void>(read_map_store(file_)); });
    const std::string gone_on = of([&] {
      MapStore store(file_);
      store.for_each_leg([](const StoredLeg&) {});
    });
    EXPECT_TRUE(read.empty() || read == gone_on) << read;  // no legs are read for a map
    return gone_on.substr(std::min(gone_on.size(), file_.string().size()));
  };
  EXPECT_EQ(refusal("CREATE TABLE mine(x); CREATE VIEW far AS SELECT * FROM map WHERE x > 9"), "");
  const std::string tables = ": is damaged: its tables are not those of a map store";
  EXPECT_EQ(refusal("CREATE TRIGGER t AFTER INSERT ON legs BEGIN DELETE FROM misfits; END"),
            tables);
  EXPECT_EQ(refusal("CREATE TABLE mine(x); CREATE TRIGGER t AFTER INSERT ON mine BEGIN "
                    "DELETE FROM legs; END"),
            tables);
  EXPECT_EQ(refusal("CREATE INDEX long ON Sessions(hex(zeroblob(length(key) * 1000000)))"), tables);
  EXPECT_EQ(refusal("ALTER TABLE sessions RENAME TO mine; CREATE VIEW sessions AS SELECT "
                    "1 AS number, hex(zeroblob(9)) AS key, 'n' AS name, 0 AS first_leg, 0 AS legs"),
            tables);
  EXPECT_EQ(refusal("DROP TABLE misfits"), tables);
  const std::string leg = ": is damaged: it has a leg that is misnumbered";
  EXPECT_EQ(refusal("UPDATE legs SET number = 9223372036854775806 WHERE number = 1"), leg);
  EXPECT_EQ(refusal("UPDATE legs SET number = number - 9"), leg);
  EXPECT_EQ(refusal("UPDATE legs SET number = 7 WHERE number = 1"), leg);
  EXPECT_EQ(refusal("DELETE FROM legs WHERE number = 0"), leg);
  const std::string session = ": is damaged: it has a session that is misnumbered";
  EXPECT_EQ(refusal("UPDATE sessions SET number = 2"), session);
  EXPECT_EQ(refusal("UPDATE sessions SET number = 0"), session);
  EXPECT_EQ(refusal("UPDATE legs SET session = 1"), ": is damaged: it has a leg of no session");
}

TEST_F(MapStoreTest, DamagedCellsAreNamedWithTheirRow) {
  {
    MapStore store(file_);
    store.start("a");
    store.arrive("b", Traversal{{1.0, 2.0}, 0.01 * Matrix2::Identity()});
  }
  const std::string whole = read_file(file_);
  const auto refused = [&](const std::string& statement, const std::string& said) {
    write_file(file_, whole);
    Database(file_, Database::Access::write).run(statement);
    try {
      static_cast<void>(read_map_store(file_));
      FAIL() << "read all the same: " << statement;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()), file_.string() + ": is damaged: it has " + said);
    }
  };
  refused("UPDATE landmarks SET x = 'far' WHERE number = 1",
          "text in column x, expected a number (row 2 of landmarks)");
  refused("UPDATE routes SET traversals = 1.5",
          "a number that is not whole in column traversals, expected a whole number (row 1 of "
          "routes)");
  refused("UPDATE landmarks SET name = 'b' || char(10) WHERE number = 1",
          "a landmark whose name is empty or holds a control character, expected printable text");
}

TEST_F(MapStoreTest, WhatFailsLeavesNoFile) {
  {
    MapStore store(file_);
    store.start("a");
  }
  LandmarkGraph map;
  map.add_landmark("a\nb", {0.0, 0.0});
  const fs::path other = scratch_.path() / "other.db";
  EXPECT_THROW(static_cast<void>(MapStore::create(other, map)), std::invalid_argument);
  EXPECT_FALSE(fs::exists(other));
  EXPECT_FALSE(fs::exists(other.string() + "-wal"));
  // One that is there is left alone.
  EXPECT_THROW(static_cast<void>(MapStore::create(file_, map)), InputError);
  EXPECT_EQ(read_map_store(file_).map.landmarks(), 1);
  EXPECT_FALSE(fs::exists(file_.string() + "-wal"));  // whole without one
}

/// A write that fails when much has been written already, as on a disk that is full.
TEST(SlowMapStore, AFullDiskIsSurvived) {
  const testing::ScratchFolder scratch;
  MapStore store(scratch.path() / "map.db");
  store.start(name(0));
  const std::vector<Step> steps = walk(300, 9000, 15);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1'000'000, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(store.append("s", "s",
                            [&](MapBuilder& builder) {
                              for (const Step& step : steps) take(builder, step);
                            }),
               InputError);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(store.builder().landmarks(), 1);
  for (std::size_t k = 0; k < 50; ++k) take(store, steps[k]);
  EXPECT_EQ(store.legs(), 51);
  EXPECT_TRUE(store.sessions().empty());
}

/// A child adds legs as fast as it can, and counts those that have returned where its parent sees
/// it, until it is killed at a random moment.
void kill_while_it_grows(const fs::path& file, Method method, int kills, unsigned seed) {
  const MapBuilderOptions options{.method = method,
                                  .gate = std::numeric_limits<double>::infinity()};
  const std::vector<Step> steps = walk(12, 40000, 11);
  MapBuilder twin(options);
  std::int64_t twin_legs = 0;
  const testing::SharedCounter acknowledged;
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> some(0, 8);
  std::uniform_int_distribution<int> moment(0, 5000);  // us
  for (int kill = 0; kill < kills; ++kill) {
    const testing::ChildProcess child([&] {
      MapStore store(file, options);
      if (store.legs() == 0) store.start(name(0));
      while (true) {
        acknowledged.set(store.legs());
        take(store, steps[static_cast<std::size_t>(store.legs() - 1)]);
      }
    });
    const std::int64_t wanted = acknowledged.get() + some(random);
    for (int ms = 0; ms < 2000 && acknowledged.get() < wanted; ++ms) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::this_thread::sleep_for(std::chrono::microseconds(moment(random)));
    ASSERT_EQ(child.kill(), SIGKILL) << "the child ended by itself";
    const MapStore store(file, options);
    ASSERT_GE(store.legs(), acknowledged.get());
    ASSERT_LE(store.legs(), acknowledged.get() + 1);
    for (; twin_legs < store.legs(); ++twin_legs) {
      if (twin_legs == 0) {
        twin.start(name(0));
      } else {
        take(twin, steps[static_cast<std::size_t>(twin_legs - 1)]);
      }
    }
    expect_alike(store.builder(), twin, method == Method::elastic_printed ? kExact : kRefactored);
    if (::testing::Test::HasFailure()) return;
  }
  EXPECT_GT(twin_legs, kills) << "killed too early to prove anything";
}

TEST(SlowMapStore, WhatWasAcknowledgedSurvivesKill) {
  const testing::ScratchFolder scratch;
  kill_while_it_grows(scratch.path() / "elastic.db", Method::elastic, 100, 12);
  kill_while_it_grows(scratch.path() / "exact.db", Method::gauss_markov, 100, 13);
}

}  // namespace
}  // namespace trussmap::map_store_test
