// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a map builder remembers between two calls, for those who keep it on a disk: all that cannot
// be derived from something else. The way in is for them alone.
#pragma once

#include "map/arrival_gate.hpp"
#include "map/first_sight.hpp"
#include "map/reckoned_leg.hpp"
#include "trussmap/landmark_map.hpp"
#include "trussmap/map_builder.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap::map {

/// What legs in the robot's own axes say of a route, beside the graph's averages.
struct ReckonedRoute {
  int route = -1;
  Average length;     ///< m
  Average direction;  ///< rad, source -> target: by a compass, or the first of a map without
  Route bar;          ///< averages of the traversals in map axes alone
  int corner = -1;    ///< the first that its legs made, with the route they came by; -1: none
};

/// Angle from direction i -> j to direction j -> k; i < k.
struct CornerAverage {
  int i = -1;
  int j = -1;
  int k = -1;
  Average angle;  ///< rad
};

/// Of law `variance`, not pooled: all traversals of a route, each with its own weight.
struct WeighedRoute {
  Matrix2 information = Matrix2::Zero();  ///< sum of C^-1, 1/m^2
  Vector2 mean = Vector2::Zero();         ///< m, source -> target
};

/// A chord that ends where the robot is: the next one makes a corner with it.
struct EarlierChord {
  int landmark = -1;  ///< where it began
  SharedAngle beta;
};

/// What the robot drove in its own axes since it stood on `here`, by legs whose ends were left out.
struct CarriedMotion {
  Motion motion;
  LandmarkOffset seen;                     ///< of the landmark that it was said to be at
  std::optional<HeadingEstimate> reading;  ///< of the compass, there
};

/// What gives the map its axes.
enum class Frame {
  open,           ///< nothing yet
  first_heading,  ///< the first heading is 0
  axes            ///< a compass, or legs that are given in map axes
};

struct BuilderMemory {
  explicit BuilderMemory(double gate_width) : gate(gate_width) {}

  LandmarkGraph graph;
  OpenChain chain;
  std::vector<ReckonedRoute> reckoned;
  std::vector<CornerAverage> corners;
  std::vector<WeighedRoute> weighed;  ///< per route, where weights are each traversal's own
  Frame frame = Frame::open;
  int first_direction = -1;  ///< of `reckoned`: the route that stands for the first heading
  ArrivalGate gate;
  std::vector<LeftOutArrival> left_out;
  std::optional<Traversal> carried;  ///< driven since `here`, by legs whose ends were left out
  std::optional<CarriedMotion> carried_motion;
  int here = -1;
  int said = -1;        ///< where the robot said it was: `here`, or an arrival that was left out
  LandmarkOffset seen;  ///< of `here`
  std::optional<HeadingEstimate> heading;  ///< of the robot, where it is known
  std::optional<EarlierChord> earlier;
  std::optional<HeadingEstimate> reading;  ///< of the compass, here
};

/// Of a map builder's truss: the one that is asked for, or the method's own.
[[nodiscard]] StiffnessLaw law_of(const MapBuilderOptions& options);
/// Each traversal of a route has its own weight: the memory has WeighedRoutes.
[[nodiscard]] bool weighs_each(const MapBuilderOptions& options);

/// A call of a builder that changed it.
struct BuilderCall {
  enum class Kind { start, arrive, observe, compass, relax };
  Kind kind = Kind::start;
  int from = -1;       ///< landmark where the robot said it was; -1: none
  int to = -1;         ///< landmark; -1: none
  Traversal leg = {};  ///< of arrive and observe in map axes; of start the displacement: position
  bool reckoned = false;     ///< of arrive and observe: in the robot's own axes
  Motion motion = {};        ///< of arrive, reckoned; of compass its heading: reading and variance
  LandmarkOffset seen = {};  ///< of start, and of arrive and observe, reckoned
  std::optional<Arrival::Kind> outcome = {};  ///< of arrive and observe
};

}  // namespace trussmap::map

namespace trussmap {

class __attribute__((visibility("hidden"))) BuilderAccess {
 public:
  /// A builder with this memory.
  [[nodiscard]] static MapBuilder restored(map::BuilderMemory memory,
                                           const MapBuilderOptions& options);

  /// All but where the landmarks are: of a large map some may be behind.
  [[nodiscard]] static const map::BuilderMemory& memory(const MapBuilder& builder);
  /// A copy with the landmarks where they are, and the memory itself after it has been told. Cost:
  /// all landmarks.
  [[nodiscard]] static map::BuilderMemory settled_memory(const MapBuilder& builder);
  static const map::BuilderMemory& settle_memory(MapBuilder& builder);

  /// From now on every call that succeeds is put into `journal`, which outlives the builder; null:
  /// no longer.
  static void keep_journal(MapBuilder& builder, std::vector<map::BuilderCall>* journal);
  [[nodiscard]] static bool has_journal(const MapBuilder& builder,
                                        const std::vector<map::BuilderCall>* journal);
};

}  // namespace trussmap
