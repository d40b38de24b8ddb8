// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/index.hpp"
#include "map/builder_state.hpp"
#include "map/heading_reset.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include <Eigen/LU>

namespace trussmap {
using namespace map;

// ---------------------------------------- legs in map axes

Arrival MapBuilder::State::arrive(const std::string& landmark, const Traversal& leg) {
  const Traversal whole = m_.carried ? Traversal{m_.carried->displacement + leg.displacement,
                                                 m_.carried->covariance + leg.covariance}
                                     : leg;
  if (m_.carried && m_.graph.find(landmark) == m_.here) {
    // From where the map does not have it to where it still has it.
    m_.carried.reset();
    m_.said = m_.here;
    return left_out_at(m_.here);
  }
  MeasuredLeg measured;
  measured.in_map = whole;
  Arrival arrival = reach(landmark, measured, m_.carried.has_value());
  m_.said = arrival.landmark;
  if (arrival.kind == Arrival::Kind::left_out) {
    m_.carried = whole;
    return arrival;
  }
  m_.carried.reset();
  m_.here = arrival.landmark;
  m_.seen = {};
  m_.heading.reset();
  m_.earlier.reset();
  m_.reading.reset();
  return arrival;
}

Arrival MapBuilder::State::observe(const std::string& landmark, const Traversal& from_here) {
  MeasuredLeg measured;
  measured.in_map = from_here;
  if (!m_.carried) return travel(landmark, measured);
  if (m_.graph.find(landmark) == m_.here) return left_out_at(m_.here);
  measured.in_map.displacement += m_.carried->displacement;
  measured.in_map.covariance += m_.carried->covariance;
  return travel(landmark, measured);
}

Arrival MapBuilder::State::travel(const std::string& landmark, const MeasuredLeg& leg) {
  const std::optional<int> known = other_landmark(landmark);
  MeasuredLeg measured = leg;
  measured.from = m_.here;
  const bool gated = !printed() && !std::isinf(options_.gate) && known.has_value();
  Arrival arrival = gated ? travel_gated(landmark, measured) : take_in(landmark, measured);
  if (leg.chord == nullptr && m_.frame == Frame::open) m_.frame = Frame::axes;
  return arrival;
}

// ---------------------------------------- legs in the robot's own axes

Arrival MapBuilder::State::arrive(const std::string& landmark, const Motion& motion,
                                  const LandmarkOffset& seen) {
  static_cast<void>(standing());
  if (!m_.carried_motion) return drive(landmark, motion, seen);
  const std::optional<int> known = m_.graph.find(landmark);
  const Motion whole = then(m_.carried_motion->motion, motion);
  if (known == m_.here) return drive_back(whole, seen);
  if (known && *known != m_.said && fits_from_said(*known, motion, seen)) {
    return drive_from_said(landmark, motion, seen);
  }
  return drive(landmark, whole, seen);
}

Arrival MapBuilder::State::drive(const std::string& landmark, const Motion& motion,
                                 const LandmarkOffset& seen) {
  const std::optional<int> known = other_landmark(landmark);
  const Chord chord = chord_of(m_.seen, motion, seen);
  const HeadingEstimate before = heading_for(known, chord);
  Arrival arrival = reach(landmark, reckoned(before, chord, m_.reading.has_value()),
                          m_.carried_motion.has_value());
  m_.said = arrival.landmark;
  if (arrival.kind == Arrival::Kind::left_out) {
    m_.carried_motion = CarriedMotion{motion, seen, std::nullopt};
    Matrix3& C = m_.carried_motion->motion.covariance;
    C = 0.5 * (C + C.transpose()).eval();
    return arrival;
  }
  settle_frame();
  m_.heading = heading_after(known.has_value(), arrival.landmark, chord, before, seen);
  if (arrival.kind == Arrival::Kind::found_again) {
    m_.earlier.reset();  // there is no route to make a corner with
  } else {
    m_.earlier = EarlierChord{m_.here, chord.beta};
  }
  m_.here = arrival.landmark;
  m_.seen = seen;
  m_.reading.reset();
  m_.carried_motion.reset();
  return arrival;
}

/// From where the map does not have it to where it still has it.
Arrival MapBuilder::State::drive_back(const Motion& whole, const LandmarkOffset& seen) {
  if (m_.heading) {
    m_.heading->heading += whole.displacement.heading;
    m_.heading->variance += whole.covariance(2, 2);
  }
  m_.said = m_.here;
  m_.seen = seen;
  m_.earlier.reset();
  m_.reading.reset();
  m_.carried_motion.reset();
  return left_out_at(m_.here);
}

/// Two landmarks in a row that lie to each other as the map has them are the landmarks that they
/// were said to be: then the way to the first of them was longer than it was taken for, and is
/// taken in late.
Arrival MapBuilder::State::drive_from_said(const std::string& landmark, const Motion& motion,
                                           const LandmarkOffset& seen) {
  const CarriedMotion there = *m_.carried_motion;
  const std::string said = m_.graph.landmark(m_.said).name;
  const Chord chord = chord_of(m_.seen, there.motion, there.seen);
  MeasuredLeg late = reckoned(heading_for(m_.said, chord), chord, m_.reading.has_value());
  late.from = m_.here;
  const auto before = std::tuple(m_.here, m_.seen, m_.heading, m_.earlier, m_.reading);
  m_.earlier = EarlierChord{m_.here, chord.beta};
  m_.here = m_.said;
  m_.seen = there.seen;
  m_.heading.reset();  // as the map has the two landmarks, it fits
  m_.reading = there.reading;
  m_.carried_motion.reset();
  Arrival arrival;
  try {
    arrival = drive(landmark, motion, seen);
  } catch (...) {
    m_.said = m_.here;
    std::tie(m_.here, m_.seen, m_.heading, m_.earlier, m_.reading) = before;
    m_.carried_motion = there;
    throw;
  }
  take_late(said, late, arrival);
  return arrival;
}

/// The robot's heading before the motion. Where nothing has told it, a route between two landmarks
/// of the map does; without a compass the first heading is 0.
HeadingEstimate MapBuilder::State::heading_for(const std::optional<int>& to,
                                               const Chord& chord) const {
  if (m_.heading) return *m_.heading;
  if (m_.frame == Frame::open) return {};
  if (!to) {
    throw SolveError(
        "the robot's heading is not known yet: expected a compass reading, or a way to a landmark "
        "of the map, before one to a new landmark");
  }
  return {direction(at(*to) - at(m_.here)) - chord.alpha.value,
          variance_of(chord.alpha, m_.seen.covariance_robot)};
}

/// A chord's direction, from the robot's heading where it begins.
MeasuredAngle MapBuilder::State::direction_by(const HeadingEstimate& heading,
                                              const Chord& chord) const {
  return {heading.heading + chord.alpha.value,
          heading.variance + variance_of(chord.alpha, m_.seen.covariance_robot)};
}

MeasuredLeg MapBuilder::State::reckoned(const HeadingEstimate& heading, const Chord& chord,
                                        bool takes_reading) const {
  MeasuredLeg leg;
  leg.chord = &chord;
  leg.in_map = in_map_axes(heading, chord.vector, chord.covariance);
  if (m_.earlier) {
    leg.corner = corner_between(m_.earlier->beta, chord.alpha, m_.seen.covariance_robot);
    leg.corner_from = m_.earlier->landmark;
  }
  leg.by_compass = takes_reading;
  if (takes_reading) {
    leg.direction = direction_by(*m_.reading, chord);
  } else if (m_.frame == Frame::open) {
    leg.direction = direction_by(heading, chord);
  }
  return leg;
}

/// From the route as the map has it where that is more than this leg alone.
HeadingEstimate MapBuilder::State::heading_after(bool was_known, int to, const Chord& chord,
                                                 const HeadingEstimate& before,
                                                 const LandmarkOffset& seen) const {
  HeadingEstimate after{before.heading + chord.turn, before.variance + chord.turn_variance};
  if (!was_known) return after;
  const double lies = direction(at(to) - at(m_.here));
  const double off = wrap_angle(lies - before.heading - chord.alpha.value);
  if (printed()) {
    const Route& route = m_.graph.route(*m_.graph.route_between(m_.here, to));
    const double of_route = direction_variance(route.displacement, route.covariance);
    const HeadingEstimate reset = reset_heading(
        before, off,
        of_route / route.traversals + variance_of(chord.alpha, m_.seen.covariance_robot));
    return {reset.heading + chord.turn, reset.variance + chord.turn_variance};
  }
  return {after.heading + off, variance_of(chord.beta, seen.covariance_robot)};
}

Arrival MapBuilder::State::observe(const std::string& landmark, const LandmarkOffset& seen) {
  if (m_.carried_motion && m_.graph.find(landmark) == m_.here) return left_out_at(m_.here);
  const std::optional<int> known = other_landmark(landmark);
  const Motion since = m_.carried_motion ? m_.carried_motion->motion : Motion{};
  const Chord chord = chord_of(m_.seen, since, seen);
  const HeadingEstimate heading = heading_for(known, chord);
  const bool takes_reading = !m_.earlier && m_.reading.has_value();
  Arrival arrival = travel(landmark, reckoned(heading, chord, takes_reading));
  if (arrival.kind == Arrival::Kind::left_out) return arrival;
  settle_frame();
  if (takes_reading) m_.reading.reset();
  if (!m_.heading) m_.heading = heading;
  if (!m_.earlier && !m_.carried_motion) {  // the way from there to here
    m_.earlier = EarlierChord{
        arrival.landmark,
        {-(chord.alpha.value + std::numbers::pi), chord.alpha.variance, -chord.alpha.by_offset}};
  }
  return arrival;
}

void MapBuilder::State::settle_frame() noexcept {
  if (m_.frame != Frame::open) return;
  m_.frame = Frame::first_heading;
  m_.first_direction = static_cast<int>(m_.reckoned.size()) - 1;
}

}  // namespace trussmap
