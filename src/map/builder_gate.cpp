// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Which arrivals and sightings are left out of the map, and how they come back.
#include "geometry/index.hpp"
#include "map/builder_state.hpp"
#include "map/heading_reset.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <Eigen/LU>

namespace trussmap::map {

Arrival left_out_at(int landmark) {
  Arrival arrival;
  arrival.kind = Arrival::Kind::left_out;
  arrival.landmark = landmark;
  return arrival;
}

}  // namespace trussmap::map

namespace trussmap {
using namespace map;

/// What the map knows between two landmarks by one way alone: more uncertain than all it knows.
Matrix2 MapBuilder::State::along_the_surest_way(int i, int j) const {
  std::vector<int> way{i, j};
  if (!m_.graph.route_between(i, j)) way = trussmap::path(m_.graph, i, j, PathBy::uncertainty);
  Matrix2 sum = Matrix2::Zero();
  for (std::size_t k = 1; k < way.size(); ++k) {
    sum += known_of_route(*m_.graph.route_between(way[k - 1], way[k]));
    if (m_.frame == Frame::axes || k + 1 == way.size()) continue;
    // Without a compass an angle at a landmark turns all that is beyond.
    const Vector2 turned = quarter_turn(at(i) - at(way[k]));
    sum += angle_variance(way[k - 1], way[k], way[k + 1]) * turned * turned.transpose();
  }
  return sum;
}

Matrix2 MapBuilder::State::known_of_route(int number) const {
  const Route& route = m_.graph.route(number);
  const int reckoned = reckoned_at_[idx(number)];
  if (m_.frame == Frame::axes || reckoned < 0) return route.covariance / route.traversals;
  const Average& length = m_.reckoned[idx(reckoned)].length;
  const Vector2 along = route.displacement.normalized();
  return length.variance / length.count * along * along.transpose();
}

/// Of the angle between two routes of the map: the corner's, or where the robot has never gone from
/// the one to the other, that of both directions.
double MapBuilder::State::angle_variance(int i, int j, int k) const {
  if (const std::optional<int> known = corner_of(i, j, k)) {
    const Average& angle = m_.corners[idx(*known)].angle;
    return angle.variance / angle.count;
  }
  double sum = 0.0;
  for (const int end : {i, k}) {
    const Route& route = m_.graph.route(*m_.graph.route_between(j, end));
    sum += direction_variance(route.displacement, route.covariance) / route.traversals;
  }
  return sum;
}

Matrix2 MapBuilder::State::known_between(int i, int j) {
  if (options_.method != Method::gauss_markov) return along_the_surest_way(i, j);
  try {
    return mechanics_.flexibility_between(i, j);
  } catch (const SolveError&) {  // stiffnesses span too many magnitudes for it
    return along_the_surest_way(i, j);
  }
}

/// Squared misfit of a traversal between two landmarks, in standard deviations of it and the map;
/// finite.
double MapBuilder::State::squared_misfit(int i, int j, const Traversal& leg) {
  const Vector2 misfit = leg.displacement - (at(j) - at(i));
  constexpr double kMost = std::numeric_limits<double>::max();
  const double of_leg = std::min(misfit.dot(leg.covariance.inverse() * misfit), kMost);
  if (m_.gate.lets_in(of_leg)) return of_leg;  // the map's own uncertainty makes it less still
  const Matrix2 of_map = known_between(i, j);
  return std::min(misfit.dot((leg.covariance + of_map).inverse() * misfit), kMost);
}

Arrival MapBuilder::State::travel_gated(const std::string& landmark, const MeasuredLeg& leg) {
  m_.left_out.reserve(m_.left_out.size() + 1);
  const int to = *m_.graph.find(landmark);
  const double misfit = squared_misfit(leg.from, to, leg.in_map);
  ArrivalGate gate = m_.gate;
  gate.remember(misfit);
  Arrival arrival;
  if (gate.lets_in(misfit)) {
    arrival = take_in(landmark, leg);
  } else {
    arrival = left_out_at(to);
    arrival.misfit = leg.in_map.displacement - (at(to) - at(leg.from));
    m_.left_out.push_back({m_.graph.landmark(leg.from).name, landmark, leg.in_map,
                           std::sqrt(misfit), leg.chord != nullptr});
  }
  m_.gate = std::move(gate);
  try {
    take_back_in(arrival);
  } catch (const std::exception&) {
    // The arrival is in; what could not come back stays out for now.
  }
  return arrival;
}

/// An arrival, perhaps past a landmark that was left out. Then nobody drove from here to there: the
/// map gets no route that it does not have.
Arrival MapBuilder::State::reach(const std::string& landmark, const MeasuredLeg& leg,
                                 bool past_left_out) {
  const std::optional<int> to = m_.graph.find(landmark);
  const bool lacks_route = to && *to != m_.here && !m_.graph.route_between(m_.here, *to);
  return past_left_out && lacks_route ? pass_to(*to, leg) : travel(landmark, leg);
}

/// Without a route, but where the robot is it knows again, if that fits.
Arrival MapBuilder::State::pass_to(int landmark, const MeasuredLeg& leg) {
  const double misfit = squared_misfit(m_.here, landmark, leg.in_map);
  ArrivalGate gate = m_.gate;
  gate.remember(misfit);
  Arrival arrival = left_out_at(landmark);
  if (gate.lets_in(misfit)) arrival.kind = Arrival::Kind::found_again;
  arrival.misfit = leg.in_map.displacement - (at(landmark) - at(m_.here));
  m_.gate = std::move(gate);
  return arrival;
}

/// Of those left out the one at this place comes in, by `leg`.
void MapBuilder::State::bring_back(std::size_t place, const MeasuredLeg& leg, Arrival& arrival) {
  const Arrival done = take_in(m_.left_out[place].to, leg);
  arrival.largest_move = std::max(arrival.largest_move, done.largest_move);
  ++arrival.back;
  m_.left_out.erase(m_.left_out.begin() + static_cast<std::ptrdiff_t>(place));
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
    const LeftOutArrival& one = m_.left_out[k];
    MeasuredLeg late;
    late.from = *m_.graph.find(one.from);
    late.in_map = one.leg;
    Chord length;  // of a leg in the robot's own axes: the map's may have turned since
    length.vector = one.leg.displacement;
    const Vector2 along = length.vector.normalized();
    length.length_variance = along.dot(one.leg.covariance * along);
    if (one.own_axes) late.chord = &length;
    const bool this_one = arrival.kind == Arrival::Kind::left_out && k + 1 == m_.left_out.size();
    if (this_one || !m_.gate.lets_in(squared_misfit(late.from, *m_.graph.find(one.to), one.leg))) {
      ++k;
      continue;
    }
    bring_back(k, late, arrival);
  }
}

/// The length as sure as it is said to be; the direction roughly: on the way to there the robot may
/// have been turned more than it knows.
bool MapBuilder::State::fits_from_said(int to, const Motion& motion,
                                       const LandmarkOffset& seen) const {
  constexpr double kOfLength = 3.0;  // standard deviations
  constexpr double kTelling = 0.25;  // of the way: what is less sure fits by chance
  constexpr double kTurned = 0.35;   // rad
  if (!m_.heading) return false;
  const auto& [there, seen_there, reading] = *m_.carried_motion;
  const Chord chord = chord_of(seen_there, motion, seen);
  const Vector2 in_map = at(to) - at(m_.said);
  const double length = in_map.norm();
  if (!(length > 0.0)) return false;
  const Vector2 along = in_map / length;
  const Matrix2 of_map = along_the_surest_way(m_.said, to);
  const double reach =
      kOfLength * m_.gate.scale() * std::sqrt(chord.length_variance + along.dot(of_map * along));
  if (std::abs(chord.vector.norm() - length) > reach || reach > kTelling * length) return false;
  const double off = wrap_angle(m_.heading->heading + there.displacement.heading +
                                chord.alpha.value - direction(in_map));
  return std::abs(off) <= kTurned;
}

/// An arrival that was left out comes back whole, where it can.
void MapBuilder::State::take_late(const std::string& landmark, const MeasuredLeg& leg,
                                  Arrival& arrival) {
  const std::string& from = m_.graph.landmark(leg.from).name;
  const auto one = std::find_if(m_.left_out.rbegin(), m_.left_out.rend(), [&](const auto& each) {
    return each.from == from && each.to == landmark;
  });
  if (one == m_.left_out.rend()) return;
  try {
    bring_back(static_cast<std::size_t>(m_.left_out.rend() - one) - 1, leg, arrival);
  } catch (const std::exception&) {
    // The arrival is in; what could not come back stays out.
  }
}

}  // namespace trussmap
