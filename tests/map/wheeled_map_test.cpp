// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The chain from wheels to map: a robot on noisy wheels tours a mesh, with a compass or without,
// and hands its motions to a map builder as they are.
#include "geometry/index.hpp"
#include "map/reckoned_leg.hpp"
#include "trussmap/error.hpp"
#include "trussmap/map_builder.hpp"
#include "trussmap/simulation.hpp"
#include "trussmap/survey_comparison.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::wheeled_map_test {
using namespace map;
namespace {

constexpr double kWheelbase = 0.34;  // m

/// A robot on a mesh, by its true motion.
class Robot {
 public:
  Robot(const Mesh& mesh, double k, std::uint64_t seed)
      : mesh_(mesh), noise_(k), random_(random_stream(seed, Stream::wheels)) {}

  [[nodiscard]] double heading() const { return heading_; }

  /// `believed`: the noise that the motion's covariance is made of.
  Motion drive(int from, int to, double believed) {
    const Vector2 way = mesh_.displacement(from, to);
    const double turn = wrap_angle(direction(way) - heading_);
    heading_ += turn;
    Motion motion;
    for (const auto& [left, right] : drive_route(turn, way.norm(), kWheelbase, noise_, random_)) {
      motion = then(motion, arc_motion({left, right}, kWheelbase, {believed, believed}));
    }
    return motion;
  }

 private:
  const Mesh& mesh_;
  double noise_;
  std::mt19937_64 random_;
  double heading_ = 0.0;
};

LandmarkPositions truth_of(const Mesh& mesh) {
  LandmarkPositions truth;
  for (int k = 0; k < mesh.landmarks(); ++k) truth[landmark_name(mesh, k)] = mesh.positions[idx(k)];
  return truth;
}

struct World {
  Mesh mesh = even_mesh({5, 5}, 5.0);
  double noise = 0.003;
  int tours = 3;
  std::uint64_t seed = 1;
};

/// Mean landmark error after the last tour. `compass`: called before each leg.
template <typename Compass>
double error_of(const World& world, const MapBuilderOptions& options, Laid laid,
                const Compass& compass) {
  std::mt19937_64 walk = random_stream(world.seed, Stream::walk);
  const Tours tours = make_tours(world.mesh, WalkKind::euler, world.tours, walk);
  Robot robot(world.mesh, world.noise, world.seed);
  MapBuilder builder(options);
  builder.start(landmark_name(world.mesh, 0));
  for (std::size_t k = 0; k + 1 < tours.walk.size(); ++k) {
    compass(builder, robot, k);
    builder.arrive(landmark_name(world.mesh, tours.walk[k + 1]),
                   robot.drive(tours.walk[k], tours.walk[k + 1], world.noise));
  }
  return *map_errors(builder.map(), truth_of(world.mesh), laid).position;
}

constexpr auto kNone = [](MapBuilder&, const Robot&, std::size_t) {};

TEST(WheeledMap, NoiseFreeMotionsGiveTheExactMap) {
  const Mesh mesh = mesh_of_lines({0, 3, 4, 9}, {0, 2, 7});
  std::mt19937_64 walk = random_stream(3, Stream::walk);
  const Tours tours = make_tours(mesh, WalkKind::euler, 2, walk);
  for (const Method method : {Method::elastic, Method::elastic_printed, Method::gauss_markov}) {
    Robot robot(mesh, 0.0, 3);
    MapBuilder builder({.method = method});
    builder.start(landmark_name(mesh, 0));
    for (std::size_t k = 0; k + 1 < tours.walk.size(); ++k) {
      builder.arrive(landmark_name(mesh, tours.walk[k + 1]),
                     robot.drive(tours.walk[k], tours.walk[k + 1], 0.003));
    }
    EXPECT_LE(*map_errors(builder.map(), truth_of(mesh)).position, 1e-7) << name_of(method);
    ASSERT_TRUE(builder.pose());
    EXPECT_LE(std::abs(wrap_angle(builder.pose()->pose.heading - robot.heading())), 1e-8);
  }
}

/// Seen from afar by range and bearing, to the left of the way; nothing is stood on.
TEST(WheeledMap, LandmarksSeenFromAfarLieWhereTheyAre) {
  const std::vector<Vector2> marks{{1.0, 2.0}, {6.0, 1.5}, {6.5, 6.0}, {0.5, 7.0}, {3.0, 4.0}};
  const std::vector<Vector2> stops{{0.0, 0.0}, {5.0, 0.0}, {5.0, 5.0}, {0.0, 5.0}};
  MapBuilder builder;
  const auto seen_from = [&](int stop, double heading, std::size_t mark) {
    const Vector2 offset = rotation(-heading) * (marks[mark] - stops[idx(stop)]);
    return seen_at(offset.norm(), direction(offset), 0.05, 0.02);
  };
  builder.start("0", seen_from(0, 0.0, 0), marks[0]);
  for (int leg = 0; leg < 8; ++leg) {
    const int from = leg % 4;
    const int to = (leg + 1) % 4;
    const double heading = leg == 0 ? 0.0 : (leg - 1) * std::numbers::pi / 2.0;
    const double next = leg * std::numbers::pi / 2.0;
    Motion motion;
    const Vector2 way = rotation(-heading) * (stops[idx(to)] - stops[idx(from)]);
    motion.displacement = {way.x(), way.y(), next - heading};
    motion.covariance = Matrix3(Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal());
    builder.arrive(std::to_string(to), motion, seen_from(to, next, idx(to)));
    builder.observe("4", seen_from(to, next, 4));
  }
  for (std::size_t k = 0; k < marks.size(); ++k) {
    EXPECT_LE((builder.position(*builder.find(std::to_string(k))) - marks[k]).norm(), 1e-9) << k;
  }
  EXPECT_LE((builder.pose()->pose.position() - stops[0]).norm(), 1e-9);
}

TEST(WheeledMap, WithoutACompassErrorsFallTourByTour) {
  for (const double noise : {0.001, 0.003}) {
    World world{.noise = noise, .tours = 1};
    MapBuilderOptions still;
    still.refine = false;
    double first = 0.0;
    double third = 0.0;
    double uncorrected = 0.0;
    for (world.seed = 1; world.seed <= 8; ++world.seed) {
      world.tours = 1;
      first += error_of(world, {}, Laid::aligned, kNone);
      uncorrected += error_of(world, still, Laid::aligned, kNone);
      world.tours = 3;
      third += error_of(world, {}, Laid::aligned, kNone);
    }
    EXPECT_LT(first, 0.25 * uncorrected);
    EXPECT_LT(third, 0.8 * first);
  }
}

TEST(WheeledMap, EveryScaleIsNearlyAsGoodAsAll) {
  World world{.mesh = even_mesh({8, 8}, 5.0)};
  double all = 0.0;
  double scales = 0.0;
  double nearest = 0.0;
  for (world.seed = 1; world.seed <= 4; ++world.seed) {
    all += error_of(world, {}, Laid::aligned, kNone);
    using Kind = RefinementScope::Kind;
    scales += error_of(world, {.scope = {Kind::nearest, 16}}, Laid::aligned, kNone);
    nearest += error_of(world, {.scope = {Kind::nearest, 16, false}}, Laid::aligned, kNone);
  }
  EXPECT_LT(scales, 1.3 * all);
  EXPECT_LT(scales, 0.7 * nearest);
}

/// Tours on which now and then a landmark is taken for another that the map has.
struct Mistaken {
  double error = 0.0;  ///< m, after the last tour
  int wrong = 0;
  int left_out = 0;  ///< at last
};

Mistaken drive_mistaken(std::uint64_t seed, double share, double gate, bool compass) {
  const Mesh mesh = even_mesh({5, 5}, 5.0);
  std::mt19937_64 walk = random_stream(seed, Stream::walk);
  std::mt19937_64 mistakes(seed);
  const Tours tours = make_tours(mesh, WalkKind::euler, 3, walk);
  Robot robot(mesh, 0.003, seed);
  MapBuilder builder({.gate = gate});
  builder.start(landmark_name(mesh, 0));
  Mistaken result;
  for (std::size_t k = 0; k + 1 < tours.walk.size(); ++k) {
    if (compass) builder.compass(robot.heading(), 0.03);
    const Motion motion = robot.drive(tours.walk[k], tours.walk[k + 1], 0.003);
    std::string name = landmark_name(mesh, tours.walk[k + 1]);
    if (std::uniform_real_distribution<>()(mistakes) < share) {
      const int other = std::uniform_int_distribution<>(0, builder.landmarks() - 1)(mistakes);
      const std::string& taken_for = builder.name(other);
      if (other != builder.here() && taken_for != name) {
        name = taken_for;
        ++result.wrong;
      }
    }
    try {
      builder.arrive(name, motion);
    } catch (const std::invalid_argument&) {  // a mistake that fitted has brought it there
      builder.start(name);
    }
  }
  result.error = *map_errors(builder.map(), truth_of(mesh), Laid::aligned).position;
  result.left_out = static_cast<int>(builder.left_out().size());
  return result;
}

TEST(WheeledMap, LandmarksTakenForOthersStayOut) {
  for (const bool compass : {false, true}) {
    double right = 0.0;
    double gated = 0.0;
    double open = 0.0;
    int wrong = 0;
    int left_out = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const Mistaken none = drive_mistaken(seed, 0.0, kMapGate, compass);
      EXPECT_EQ(none.left_out, 0) << seed;
      right += none.error;
      const Mistaken some = drive_mistaken(seed, 0.03, kMapGate, compass);
      gated += some.error;
      wrong += some.wrong;
      left_out += some.left_out;
      open += drive_mistaken(seed, 0.03, std::numeric_limits<double>::infinity(), compass).error;
    }
    ASSERT_GT(wrong, 15);
    EXPECT_LT(gated, 2.0 * right) << compass;
    EXPECT_LT(gated, 0.2 * open) << compass;
    EXPECT_NEAR(left_out, wrong, 3) << compass;
  }
}

/// Somebody has pushed the robot: the way is wrong, the landmarks are right.
TEST(WheeledMap, AWayThatWasMisjudgedComesInWithTheNextLandmark) {
  const Matrix3 C = Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal();
  const Motion ahead{{5.0, 0.0, 0.5 * std::numbers::pi}, C};  // a square, counter-clockwise
  const Motion misjudged{{3.0, 1.5, 1.3}, C};
  const Motion spoilt{{5.0, 0.0, 0.0}, Matrix3::Constant(std::nan(""))};
  MapBuilder map;
  map.start("0");
  for (int leg = 1; leg <= 8; ++leg) map.arrive(std::to_string(leg % 4), ahead);
  const Vector2 before = map.position(2);
  EXPECT_EQ(map.arrive("1", misjudged).kind, Arrival::Kind::left_out);
  EXPECT_EQ(map.here(), 0);
  ASSERT_TRUE(map.pose());
  EXPECT_NEAR((map.pose()->pose.position() - Vector2(3.0, 1.5)).norm(), 0.0, 0.05);
  EXPECT_EQ(map.position(2), before);
  EXPECT_THROW(map.arrive("2", spoilt), std::invalid_argument);
  EXPECT_EQ(map.here(), 0);
  const Arrival arrival = map.arrive("2", ahead);
  EXPECT_EQ(arrival.kind, Arrival::Kind::refinement);
  EXPECT_EQ(arrival.back, 1);
  EXPECT_TRUE(map.left_out().empty());
  EXPECT_EQ(map.here(), 2);
  EXPECT_EQ(map.map().route(*map.map().route_between(0, 1)).traversals, 3);
}

TEST(WheeledMap, BackWhereTheMapHasItARobotGoesOn) {
  const Matrix3 C = Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal();
  const Motion ahead{{5.0, 0.0, 0.5 * std::numbers::pi}, C};
  MapBuilder map;
  map.start("0");
  for (int leg = 1; leg <= 8; ++leg) map.arrive(std::to_string(leg % 4), ahead);
  EXPECT_EQ(map.arrive("2", ahead).kind, Arrival::Kind::left_out);  // it was 1
  EXPECT_EQ(map.arrive("0", then(then(ahead, ahead), ahead)).kind, Arrival::Kind::left_out);
  EXPECT_EQ(map.here(), 0);
  EXPECT_NEAR(wrap_angle(map.pose()->pose.heading), 0.0, 0.05);
  EXPECT_EQ(map.arrive("1", ahead).kind, Arrival::Kind::refinement);
}

/// Past a landmark that was misread no route is made up, in either kind of legs.
TEST(WheeledMap, PastALandmarkThatIsLeftOutNoRouteIsMadeUp) {
  const Matrix3 C = Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal();
  const Motion ahead{{5.0, 0.0, 0.5 * std::numbers::pi}, C};
  MapBuilder map;
  map.start("0");
  for (int leg = 1; leg <= 8; ++leg) map.arrive(std::to_string(leg % 4), ahead);
  EXPECT_EQ(map.arrive("3", ahead).kind, Arrival::Kind::left_out);  // it was 1
  const Arrival arrival = map.arrive("2", ahead);
  EXPECT_EQ(arrival.kind, Arrival::Kind::found_again);
  EXPECT_EQ(map.here(), 2);
  EXPECT_EQ(map.map().routes(), 4);
  EXPECT_NEAR((map.pose()->pose.position() - Vector2(5.0, 5.0)).norm(), 0.0, 0.05);
  EXPECT_NEAR(wrap_angle(map.pose()->pose.heading - std::numbers::pi), 0.0, 0.05);
  EXPECT_EQ(map.arrive("3", ahead).kind, Arrival::Kind::refinement);

  MapBuilder axes;
  const auto leg = [](double x, double y) {
    return Traversal{{x, y}, Vector2(1e-4, 1e-4).asDiagonal()};
  };
  axes.start("0");
  for (int tour = 0; tour < 2; ++tour) {
    axes.arrive("1", leg(5.0, 0.0));
    axes.arrive("2", leg(0.0, 5.0));
    axes.arrive("3", leg(-5.0, 0.0));
    axes.arrive("0", leg(0.0, -5.0));
  }
  EXPECT_EQ(axes.arrive("3", leg(5.0, 0.0)).kind, Arrival::Kind::left_out);
  EXPECT_EQ(axes.arrive("2", leg(0.0, 5.0)).kind, Arrival::Kind::found_again);
  EXPECT_EQ(axes.here(), 2);
  EXPECT_EQ(axes.map().routes(), 4);
}

/// However often a compass reads, the map is right in its axes, and the better for more readings.
TEST(WheeledMap, CompassReadingsOfAnyRateGiveTheMapItsAxes) {
  World world;
  std::mt19937_64 random(5);
  std::normal_distribution<double> error;
  const auto read = [&](MapBuilder& builder, const Robot& robot, double sd) {
    builder.compass(wrap_angle(robot.heading() + sd * error(random)), sd);
  };
  double always = 0.0;
  double seldom = 0.0;
  double late = 0.0;
  for (world.seed = 1; world.seed <= 6; ++world.seed) {
    always += error_of(world, {}, Laid::as_it_is,
                       [&](MapBuilder& b, const Robot& r, std::size_t) { read(b, r, 0.03); });
    seldom +=
        error_of(world, {}, Laid::as_it_is, [&](MapBuilder& b, const Robot& r, std::size_t k) {
          if (k % 20 == 0) read(b, r, 0.01);
        });
    // The first heading is none until the map has long grown: then it is turned.
    late += error_of(world, {}, Laid::as_it_is, [&](MapBuilder& b, const Robot& r, std::size_t k) {
      if (k >= 40) read(b, r, 0.03);
    });
  }
  EXPECT_LT(always / 6.0, 0.1);
  EXPECT_LT(seldom / 6.0, 0.12);
  EXPECT_LT(late / 6.0, 0.12);
}

TEST(WheeledMap, AMapWithoutCompassIsTurnedByTheFirstReading) {
  MapBuilder builder;
  Motion straight = arc_motion({4.0, 4.0}, kWheelbase, {0.003, 0.003});
  builder.start("A", Vector2(1.0, 1.0));
  builder.arrive("B", straight);
  builder.arrive("C", then(arc_motion({-0.267, 0.267}, kWheelbase, {0.003, 0.003}), straight));
  const double energy = builder.energy();
  const double before = builder.pose()->pose.heading;
  builder.compass(before + 0.7, 0.01);
  EXPECT_EQ(builder.position(0), Vector2(1.0, 1.0));
  EXPECT_LE(
      (builder.position(1) - (Vector2(1.0, 1.0) + 4.0 * Vector2(std::cos(0.7), std::sin(0.7))))
          .norm(),
      1e-9);
  EXPECT_NEAR(builder.energy(), energy, 1e-12);
  EXPECT_NEAR(builder.pose()->pose.heading, before + 0.7, 1e-12);
}

TEST(WheeledMap, AHeadingThatNothingTellsIsAskedFor) {
  const Motion straight = arc_motion({4.0, 4.0}, kWheelbase, {0.003, 0.003});
  MapBuilder builder;
  builder.start("A");
  builder.arrive("B", straight);
  builder.start("A");  // a new session
  EXPECT_FALSE(builder.pose());
  EXPECT_THROW(builder.arrive("C", straight), SolveError);
  EXPECT_EQ(builder.landmarks(), 2);
  EXPECT_THROW(builder.arrive("B", Motion{}), std::invalid_argument);
  EXPECT_THROW(builder.compass(std::nan(""), 0.1), std::invalid_argument);
  EXPECT_THROW(builder.compass(0.1, 0.0), std::invalid_argument);
  builder.arrive("B", straight);  // the route between A and B tells it
  EXPECT_TRUE(builder.pose());
  EXPECT_EQ(builder.arrive("C", straight).kind, Arrival::Kind::new_landmark);
}

/// Gradients of a corner's parts, against differences.
TEST(WheeledMap, AnglesDependOnOffsetsAsTheirGradientsSay) {
  Motion motion;
  motion.displacement = {3.0, 1.0, 0.7};
  motion.covariance = 1e-4 * Matrix3::Identity();
  const LandmarkOffset from = seen_at(2.0, 0.4, 0.05, 0.02);
  const LandmarkOffset to = seen_at(1.5, -0.8, 0.05, 0.02);
  const Chord chord = chord_of(from, motion, to);
  constexpr double kStep = 1e-6;
  for (Eigen::Index c = 0; c < 2; ++c) {
    LandmarkOffset moved = from;
    moved.offset_robot[c] += kStep;
    EXPECT_NEAR((chord_of(moved, motion, to).alpha.value - chord.alpha.value) / kStep,
                chord.alpha.by_offset[c], 1e-5);
    moved = to;
    moved.offset_robot[c] += kStep;
    EXPECT_NEAR((chord_of(from, motion, moved).beta.value - chord.beta.value) / kStep,
                chord.beta.by_offset[c], 1e-5);
  }
}

}  // namespace
}  // namespace trussmap::wheeled_map_test
