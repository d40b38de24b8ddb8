// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a map builder remembers between two calls, for those who keep it on a disk: all that cannot
// be derived from something else. The way in is for them alone.
#pragma once

#include "map/arrival_gate.hpp"
#include "map/exact_increments.hpp"
#include "map/first_sight.hpp"
#include "trussmap/landmark_map.hpp"
#include "trussmap/map_builder.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap {

struct BuilderMemory {
  explicit BuilderMemory(double gate_width) : gate(gate_width) {}

  LandmarkGraph graph;               ///< positions short of the map's by `offset`
  Vector2 offset = Vector2::Zero();  ///< so that a shift of the whole map touches no landmark, m
  OpenChain chain;
  ExactIncrements increments;  ///< of `gauss_markov`: bar number = route number
  ArrivalGate gate;
  std::vector<LeftOutArrival> left_out;
  std::optional<Traversal> carried;  ///< driven since `here`, by legs whose ends were left out
  int here = -1;
  int said = -1;  ///< where the robot said it was: `here`, or an arrival that was left out
};

/// A call of a builder that changed it.
struct BuilderCall {
  enum class Kind { start, arrive, observe, settle, rest };
  Kind kind = Kind::start;
  int from = -1;       ///< landmark where the robot said it was; -1: none
  int to = -1;         ///< landmark; -1: none
  Traversal leg = {};  ///< of arrive and observe, as given; of start the displacement: its position
  double gain = 0.0;   ///< of settle
  std::optional<Arrival::Kind> outcome = {};  ///< of arrive and observe
};

class __attribute__((visibility("hidden"))) BuilderAccess {
 public:
  /// A builder with this memory; bars, where `options.method` has them, included.
  [[nodiscard]] static MapBuilder restored(BuilderMemory memory, const MapBuilderOptions& options);

  [[nodiscard]] static const BuilderMemory& memory(const MapBuilder& builder);

  /// From now on every call that succeeds is put into `journal`, which outlives the builder; null:
  /// no longer.
  static void keep_journal(MapBuilder& builder, std::vector<BuilderCall>* journal);
  [[nodiscard]] static bool has_journal(const MapBuilder& builder,
                                        const std::vector<BuilderCall>* journal);
};

}  // namespace trussmap
