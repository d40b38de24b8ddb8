// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/index.hpp"
#include "map/builder_state.hpp"
#include "map/heading_reset.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/LU>

namespace trussmap {
namespace {

Arrival left_out_at(int landmark) {
  Arrival arrival;
  arrival.kind = Arrival::Kind::left_out;
  arrival.landmark = landmark;
  return arrival;
}

}  // namespace

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
  Arrival arrival = travel(landmark, measured);
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
  const bool gated =
      !printed() && !std::isinf(options_.gate) && known.has_value() && leg.chord == nullptr;
  Arrival arrival = gated ? travel_gated(landmark, measured) : take_in(landmark, measured);
  if (leg.chord == nullptr && m_.frame == Frame::open) m_.frame = Frame::axes;
  return arrival;
}

/// What the map knows between two landmarks by one way alone: more uncertain than all it knows.
Matrix2 MapBuilder::State::along_the_surest_way(int i, int j) const {
  if (const std::optional<int> direct = m_.graph.route_between(i, j)) {
    const Route& route = m_.graph.route(*direct);
    return route.covariance / route.traversals;
  }
  Matrix2 sum = Matrix2::Zero();
  const std::vector<int> way = trussmap::path(m_.graph, i, j, PathBy::uncertainty);
  for (std::size_t k = 1; k < way.size(); ++k) {
    const Route& route = m_.graph.route(*m_.graph.route_between(way[k - 1], way[k]));
    sum += route.covariance / route.traversals;
  }
  return sum;
}

/// Squared misfit of a traversal between two landmarks, in standard deviations of it and the map.
double MapBuilder::State::squared_misfit(int i, int j, const Traversal& leg) {
  const Vector2 misfit = leg.displacement - (at(j) - at(i));
  const double of_leg = misfit.dot(leg.covariance.inverse() * misfit);
  if (m_.gate.lets_in(of_leg)) return of_leg;  // the map's own uncertainty makes it less still
  const Matrix2 of_map = options_.method == Method::gauss_markov
                             ? mechanics_.flexibility_between(i, j)
                             : along_the_surest_way(i, j);
  return misfit.dot((leg.covariance + of_map).inverse() * misfit);
}

Arrival MapBuilder::State::travel_gated(const std::string& landmark, const MeasuredLeg& leg) {
  m_.left_out.reserve(m_.left_out.size() + 1);
  const int to = *m_.graph.find(landmark);
  const double misfit =
      std::min(squared_misfit(leg.from, to, leg.in_map), std::numeric_limits<double>::max());
  ArrivalGate gate = m_.gate;
  gate.remember(misfit);
  Arrival arrival;
  if (gate.lets_in(misfit)) {
    arrival = take_in(landmark, leg);
  } else {
    arrival = left_out_at(to);
    arrival.misfit = leg.in_map.displacement - (at(to) - at(leg.from));
    m_.left_out.push_back(
        {m_.graph.landmark(leg.from).name, landmark, leg.in_map, std::sqrt(misfit)});
  }
  m_.gate = std::move(gate);
  try {
    take_back_in(arrival);
  } catch (const std::exception&) {
    // The arrival is in; what could not come back stays out for now.
  }
  return arrival;
}

/// Order does not matter to least squares: what fits by now is taken in late. Beside an elastic
/// map, whose corrections are to cost little, one is tried at a time.
void MapBuilder::State::take_back_in(Arrival& arrival) {
  const bool one_alone = options_.method != Method::gauss_markov;
  const std::size_t count = m_.left_out.size();
  const std::size_t first = one_alone && count > 0 ? idx(arrival.landmark) % count : 0;
  std::size_t tried = 0;
  for (std::size_t k = first; k < m_.left_out.size();) {
    if (one_alone && tried++ > 0) return;
    const LeftOutArrival one = m_.left_out[k];
    MeasuredLeg late;
    late.from = *m_.graph.find(one.from);
    late.in_map = one.leg;
    const bool this_one = arrival.kind == Arrival::Kind::left_out && k + 1 == m_.left_out.size();
    if (this_one || !m_.gate.lets_in(squared_misfit(late.from, *m_.graph.find(one.to), one.leg))) {
      ++k;
      continue;
    }
    const Arrival done = take_in(one.to, late);
    arrival.largest_move = std::max(arrival.largest_move, done.largest_move);
    ++arrival.back;
    m_.left_out.erase(m_.left_out.begin() + static_cast<std::ptrdiff_t>(k));
  }
}

// ---------------------------------------- legs in the robot's own axes

Arrival MapBuilder::State::arrive(const std::string& landmark, const Motion& motion,
                                  const LandmarkOffset& seen) {
  const std::optional<int> known = other_landmark(landmark);
  const Chord chord = chord_of(m_.seen, motion, seen);
  const HeadingEstimate before = heading_for(known, chord);
  Arrival arrival = travel(landmark, reckoned(before, chord, m_.reading.has_value()));
  settle_frame();
  m_.heading = heading_after(known.has_value(), arrival.landmark, chord, before, seen);
  m_.earlier = EarlierChord{m_.here, chord.beta};
  m_.here = m_.said = arrival.landmark;
  m_.seen = seen;
  m_.reading.reset();
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
  const std::optional<int> known = other_landmark(landmark);
  const Chord chord = chord_of(m_.seen, Motion{}, seen);
  const HeadingEstimate heading = heading_for(known, chord);
  const bool takes_reading = !m_.earlier && m_.reading.has_value();
  Arrival arrival = travel(landmark, reckoned(heading, chord, takes_reading));
  settle_frame();
  if (takes_reading) m_.reading.reset();
  if (!m_.heading) m_.heading = heading;
  if (!m_.earlier) {  // the way from there to here
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
