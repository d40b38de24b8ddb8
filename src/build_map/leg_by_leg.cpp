// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_map/leg_by_leg.hpp"

#include "build_map/session.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <limits>

namespace trussmap {
namespace {

constexpr int kRests = 2;

/// Sessions with a compass first: it gives the map its direction.
std::vector<const SightedDrive*> in_order(const std::vector<SightedDrive>& sessions) {
  std::vector<const SightedDrive*> order;
  order.reserve(sessions.size());
  for (const SightedDrive& session : sessions) order.push_back(&session);
  std::stable_partition(order.begin(), order.end(),
                        [](const SightedDrive* one) { return one->drive().has_compass(); });
  return order;
}

}  // namespace

MapBuilder builder_for(const BuildMapOptions& options) {
  MapBuilderOptions how;
  how.method = options.method;
  how.eta = options.eta;
  how.gate = std::numeric_limits<double>::infinity();  // the best fit has left out what is wrong
  return MapBuilder(how);
}

BuiltMap map_leg_by_leg(const std::vector<SightedDrive>& sessions, const LegByLegOptions& options,
                        MapBuilder& builder) {
  const int before = builder.landmarks();
  BuiltMap result;
  result.method = options.build.method;
  for (const SightedDrive* session : in_order(sessions)) {
    Session(*session, options, builder, result).run();
  }
  // Stiffness follows the routes' directions in the map, which the first rest may change.
  for (int round = 0; round < kRests; ++round) builder.rest();
  result.map = builder.map();
  result.new_landmarks = builder.landmarks() - before;
  if (result.legs == 0) {
    throw InputError(sessions.front().recording().name, 0,
                     "no leg, expected a drive from one landmark to another");
  }
  return result;
}

}  // namespace trussmap
