// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_map/leg_by_leg.hpp"

#include "build_map/mapped_session.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"
#include "trussmap/gate.hpp"

#include <algorithm>
#include <limits>

namespace trussmap::map_building {
namespace {

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

MapBuilder builder_for(const LegByLegOptions& options) {
  MapBuilderOptions how;
  how.method = options.build.method;
  how.scope = options.build.scope;
  how.law = options.build.law;
  // The best fit has left out what is wrong, where it guides.
  how.gate = options.guided ? std::numeric_limits<double>::infinity()
                            : options.build.gate.value_or(kMapGate);
  return MapBuilder(how);
}

BuiltMap map_leg_by_leg(const std::vector<SightedDrive>& sessions, const LegByLegOptions& options,
                        MapBuilder& builder) {
  const int before = builder.landmarks();
  BuiltMap result;
  result.method = options.build.method;
  for (const SightedDrive* session : in_order(sessions)) {
    MappedSession(*session, options, builder, result).run();
  }
  result.relaxed = options.build.relax;
  if (options.build.relax) builder.relax();
  result.map = builder.map();
  result.new_landmarks = builder.landmarks() - before;
  if (result.legs == 0) {
    throw InputError(sessions.front().recording().name, 0,
                     "no leg, expected a drive from one landmark to another, " +
                         text::short_text(options.build.min_drive) + " m or more of driven path");
  }
  return result;
}

}  // namespace trussmap::map_building
