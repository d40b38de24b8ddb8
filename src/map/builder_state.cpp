// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/builder_state.hpp"

#include "geometry/index.hpp"
#include "map/heading_reset.hpp"
#include "map/make_room.hpp"
#include "map/printed_refinement.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <Eigen/LU>

namespace trussmap {
namespace {

constexpr double kMoved = 1e-12;  // m

RefinementScope scope_of(const MapBuilderOptions& options) {
  RefinementScope scope = options.scope;
  if (options.method == Method::gauss_markov) scope.kind = RefinementScope::Kind::all;
  const bool printed = options.method == Method::elastic_printed;
  if (printed && scope.kind == RefinementScope::Kind::automatic) {
    scope.kind = RefinementScope::Kind::nearest;
  }
  return scope;
}

void check_options(const MapBuilderOptions& options) {
  if (!(options.gate > 0.0)) throw std::invalid_argument("the gate must be above 0");
  if (options.method == Method::adjustment) {
    throw std::invalid_argument("an adjustment is no method of a map builder, but of build_map");
  }
  if (options.scope.eta < 2) throw std::invalid_argument("eta must be 2 landmarks at least");
  if (options.method == Method::elastic_printed &&
      options.law.value_or(StiffnessLaw::mean_error) != StiffnessLaw::mean_error) {
    throw std::invalid_argument("elastic_printed has the paper's law, 1/mean error");
  }
}

Arrival left_out_at(int landmark) {
  Arrival arrival;
  arrival.kind = Arrival::Kind::left_out;
  arrival.landmark = landmark;
  return arrival;
}

}  // namespace

/// Averages as a step leaves them, not yet remembered.
struct MapBuilder::State::Step {
  int from = -1;
  int to = -1;
  int route = -1;  ///< its number, now or then
  bool new_landmark = false;
  bool new_route = false;
  bool ends_first_heading = false;  ///< a compass gives the map its direction from now on
  Route average;
  std::optional<ReckonedRoute> reckoned;
  int reckoned_place = -1;
  std::optional<WeighedRoute> weighed;
  RouteElements elements;
  std::optional<CornerAverage> corner;
  int corner_place = -1;
  int corner_element = -1;
};

MapBuilder::State::State(const MapBuilderOptions& options, BuilderMemory memory)
    : options_(options),
      m_(std::move(memory)),
      mechanics_(scope_of(options), options.law.value_or(options.method == Method::gauss_markov
                                                             ? StiffnessLaw::variance
                                                             : StiffnessLaw::mean_error)) {
  check_options(options);
  m_.gate.set_gate(options.gate);
  make_truss();
}

void MapBuilder::State::set_options(const MapBuilderOptions& options) {
  if (options.method != options_.method || options.law != options_.law ||
      options.pooled != options_.pooled) {
    throw std::invalid_argument("a map builder keeps its method and its law");
  }
  check_options(options);
  options_ = options;
  mechanics_.set_scope(scope_of(options));
  m_.gate.set_gate(options.gate);
}

StiffnessLaw MapBuilder::State::law() const {
  if (options_.law) return *options_.law;
  return options_.method == Method::gauss_markov ? StiffnessLaw::variance
                                                 : StiffnessLaw::mean_error;
}

bool MapBuilder::State::weighs_each() const {
  return law() == StiffnessLaw::variance && !options_.pooled;
}

/// The truss that the memory's averages make, where the memory has the landmarks.
void MapBuilder::State::make_truss() {
  const LandmarkGraph& graph = m_.graph;
  for (int k = 0; k < graph.landmarks(); ++k) {
    const std::vector<int>& routes = graph.routes_at(k);
    mechanics_.add_landmark(at(k), routes.empty() ? -1 : other_end(graph.route(routes.front()), k));
  }
  elements_.resize(idx(graph.routes()));
  reckoned_at_.assign(idx(graph.routes()), -1);
  for (std::size_t n = 0; n < m_.reckoned.size(); ++n) {
    reckoned_at_[idx(m_.reckoned[n].route)] = static_cast<int>(n);
  }
  for (int number = 0; number < graph.routes(); ++number) {
    Step step;
    step.route = number;
    step.average = graph.route(number);
    const int place = reckoned_at_[idx(number)];
    if (place >= 0) step.reckoned = m_.reckoned[idx(place)];
    if (weighs_each()) step.weighed = m_.weighed[idx(number)];
    put_elements(step);
    elements_[idx(number)] = step.elements;
  }
  for (std::size_t n = 0; n < m_.corners.size(); ++n) {
    const CornerAverage& one = m_.corners[n];
    corner_at_[{one.i, one.j, one.k}] = static_cast<int>(n);
    Step step;
    step.corner = one;
    put_elements(step);
    corner_elements_.push_back(step.corner_element);
  }
  mechanics_.begin();
}

/// The same map's truss with stiffness 1/variance: its flexibility is the map's covariance.
ElasticTruss MapBuilder::State::by_variance() const {
  MapBuilderOptions options = options_;
  options.method = Method::gauss_markov;
  options.law.reset();
  options.pooled = !weighs_each();
  return State(options, m_).mechanics_.truss();
}

Matrix2 MapBuilder::State::covariance_between(int a, int b) const {
  const ElasticTruss truss = by_variance();
  Equilibrium equilibrium;
  Matrix2 C;
  try {
    for (Eigen::Index c = 0; c < 2; ++c) {
      const std::vector<Vector2> u = equilibrium.pull(truss, a, b, Matrix2::Identity().col(c));
      C.col(c) = u[idx(b)] - u[idx(a)];
    }
  } catch (const NotPositiveDefinite&) {
    throw SolveError("the covariances of the map's traversals span too many magnitudes");
  }
  return 0.5 * (C + C.transpose());
}

std::vector<Matrix2> MapBuilder::State::covariances() const {
  try {
    return flexibilities(by_variance());
  } catch (const NotPositiveDefinite&) {
    throw SolveError("the covariances of the map's traversals span too many magnitudes");
  }
}

/// P becomes P - D S^-1 D', with D the columns of P for the route's vector and S that vector's
/// variance before the measurement and its own together.
std::vector<double> MapBuilder::State::expected_falls() const {
  const ElasticTruss truss = by_variance();
  Equilibrium equilibrium;
  std::vector<double> falls;
  for (int number = 0; number < m_.graph.routes(); ++number) {
    const Route& route = m_.graph.route(number);
    std::array<std::vector<Vector2>, 2> D;
    for (std::size_t c = 0; c < 2; ++c) {
      D[c] = equilibrium.pull(truss, route.source, route.target,
                              Matrix2::Identity().col(static_cast<Eigen::Index>(c)));
    }
    Matrix2 S = route.covariance;
    Matrix2 squares = Matrix2::Zero();
    for (Eigen::Index c = 0; c < 2; ++c) {
      const std::vector<Vector2>& column = D[static_cast<std::size_t>(c)];
      S.col(c) += column[idx(route.target)] - column[idx(route.source)];
      for (Eigen::Index r = 0; r < 2; ++r) {
        for (std::size_t k = 0; k < column.size(); ++k) {
          squares(r, c) += D[static_cast<std::size_t>(r)][k].dot(column[k]);
        }
      }
    }
    falls.push_back((S.inverse() * squares).trace());
  }
  return falls;
}

// ---------------------------------------- where the robot is

void MapBuilder::State::start(const std::string& landmark, const LandmarkOffset& seen,
                              const Vector2& position) {
  const std::optional<int> known = m_.graph.find(landmark);
  if (!known && m_.graph.landmarks() > 0) {
    throw SolveError("landmark " + landmark +
                     " is tied to nothing: a session must start on a landmark of the map");
  }
  m_.chain.reserve(m_.graph.landmarks() + 1);
  if (!seen.offset_robot.allFinite() || !seen.covariance_robot.allFinite()) {
    throw std::invalid_argument("a landmark is seen at a finite offset with a finite covariance");
  }
  if (!known) {
    if (!std::isfinite(position.squaredNorm())) {
      throw std::invalid_argument("the first landmark needs a finite position");
    }
    mechanics_.begin();
    try {
      mechanics_.add_landmark(position, -1);
      m_.graph.add_landmark(landmark, position);
    } catch (...) {
      mechanics_.roll_back();
      throw;
    }
    mechanics_.commit();
  }
  m_.here = m_.said = known.value_or(0);
  m_.chain.restart(m_.here);
  m_.carried.reset();
  m_.seen = seen;
  m_.heading.reset();
  m_.earlier.reset();
  m_.reading.reset();
}

int MapBuilder::State::standing() const {
  if (m_.here < 0) throw std::invalid_argument("the robot must start on a landmark first");
  return m_.here;
}

std::optional<int> MapBuilder::State::other_landmark(const std::string& name) const {
  const int here = standing();
  const std::optional<int> known = m_.graph.find(name);
  if (known && *known == here) {
    throw std::invalid_argument("the robot stands on " + name + " already");
  }
  return known;
}

void MapBuilder::State::compass(double reading, double sd) {
  static_cast<void>(standing());
  if (!std::isfinite(reading) || !(sd > 0.0) || !std::isfinite(sd * sd)) {
    throw std::invalid_argument("a compass reading is finite, its standard deviation above 0");
  }
  const double variance = sd * sd;
  if (m_.frame == Frame::first_heading && m_.heading) {
    turn_map(wrap_angle(reading - m_.heading->heading));
    m_.heading = HeadingEstimate{reading, variance};
  } else if (m_.heading) {
    m_.heading = reset_heading(*m_.heading, reading - m_.heading->heading, variance);
  } else {
    m_.heading = HeadingEstimate{reading, variance};
  }
  m_.frame = Frame::axes;
  if (m_.reading) {  // several: their weighted mean
    const double share = m_.reading->variance / (m_.reading->variance + variance);
    m_.reading->value += share * wrap_angle(reading - m_.reading->value);
    m_.reading->variance *= 1.0 - share;
  } else {
    m_.reading = MeasuredAngle{reading, variance};
  }
}

/// The whole map about its first landmark: no element but those of directions is strained by it.
void MapBuilder::State::turn_map(double angle) {
  const Matrix2 R = rotation(angle);
  mechanics_.begin();
  try {
    for (int k = 1; k < m_.graph.landmarks(); ++k) mechanics_.move(k, at(0) + R * (at(k) - at(0)));
    for (const ReckonedRoute& one : m_.reckoned) {
      const int element = elements_[idx(one.route)].direction;
      if (element < 0) continue;
      Element turned = mechanics_.truss().element(element);
      turned.rest += angle;
      mechanics_.set_element(element, turned);
    }
  } catch (...) {
    mechanics_.roll_back();
    throw;
  }
  for (ReckonedRoute& one : m_.reckoned) one.direction.mean += angle;
  for (int number = 0; number < m_.graph.routes(); ++number) {
    Route& route = m_.graph.route(number);
    route.orientation += angle;
    route.displacement = R * route.displacement;
    route.covariance = R * route.covariance * R.transpose();
  }
  Arrival ignored;
  note_moves(ignored);
  mechanics_.commit();
}

std::optional<PoseEstimate> MapBuilder::State::pose() const {
  if (m_.here < 0 || !m_.heading) return std::nullopt;
  const Matrix2 R = rotation(m_.heading->heading);
  const Vector2 offset = R * m_.seen.offset_robot;
  const Vector2 place = at(m_.here) - offset;
  PoseEstimate estimate;
  estimate.pose = {place.x(), place.y(), m_.heading->heading};
  const Vector2 by_heading = -quarter_turn(offset);
  const double variance = m_.heading->variance;
  estimate.covariance.topLeftCorner<2, 2>() =
      R * m_.seen.covariance_robot * R.transpose() + variance * by_heading * by_heading.transpose();
  estimate.covariance.topRightCorner<2, 1>() = variance * by_heading;
  estimate.covariance.bottomLeftCorner<1, 2>() = variance * by_heading.transpose();
  estimate.covariance(2, 2) = variance;
  return estimate;
}

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
  Matrix2 of_map = Matrix2::Zero();
  if (options_.method != Method::gauss_markov) {
    of_map = along_the_surest_way(i, j);
    return misfit.dot((leg.covariance + of_map).inverse() * misfit);
  }
  for (Eigen::Index c = 0; c < 2; ++c) {
    const std::vector<Vector2> u = mechanics_.pull(i, j, Matrix2::Identity().col(c));
    of_map.col(c) = u[idx(j)] - u[idx(i)];
  }
  const Matrix2 both = leg.covariance + 0.5 * (of_map + of_map.transpose());
  return misfit.dot(both.inverse() * misfit);
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
  MeasuredLeg leg = reckoned(before, chord);
  if (m_.reading) {
    leg.direction =
        MeasuredAngle{m_.reading->value + chord.alpha.value,
                      m_.reading->variance + variance_of(chord.alpha, m_.seen.covariance_robot)};
    leg.by_compass = true;
  }
  Arrival arrival = travel(landmark, leg);
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

MeasuredLeg MapBuilder::State::reckoned(const HeadingEstimate& heading, const Chord& chord) const {
  const Matrix2 R = rotation(heading.heading);
  MeasuredLeg leg;
  leg.chord = &chord;
  leg.in_map.displacement = R * chord.vector;
  const Vector2 lever = quarter_turn(leg.in_map.displacement);
  const Matrix2 C =
      R * chord.covariance * R.transpose() + heading.variance * lever * lever.transpose();
  leg.in_map.covariance = 0.5 * (C + C.transpose());
  if (m_.earlier) {
    leg.corner = corner_between(m_.earlier->beta, chord.alpha, m_.seen.covariance_robot);
    leg.corner_from = m_.earlier->landmark;
  }
  if (m_.frame == Frame::open) {
    leg.direction = MeasuredAngle{heading.heading + chord.alpha.value,
                                  variance_of(chord.alpha, m_.seen.covariance_robot)};
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
  MeasuredLeg leg = reckoned(heading, chord);
  const bool takes_reading = !m_.earlier && m_.reading.has_value();
  if (takes_reading) {
    leg.direction =
        MeasuredAngle{m_.reading->value + chord.alpha.value,
                      m_.reading->variance + variance_of(chord.alpha, m_.seen.covariance_robot)};
    leg.by_compass = true;
  }
  Arrival arrival = travel(landmark, leg);
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

// ---------------------------------------- a step of the map

Arrival MapBuilder::State::take_in(const std::string& landmark, const MeasuredLeg& leg) {
  const std::optional<int> known = m_.graph.find(landmark);
  Arrival arrival;
  arrival.landmark = known.value_or(m_.graph.landmarks());
  if (known) arrival.misfit = leg.in_map.displacement - (at(*known) - at(leg.from));
  Step step = averaged(arrival.landmark, !known, leg);
  average_corner(step, leg);
  arrival.route = step.route;
  OpenChain::Closing closing;
  const bool closes = known && step.new_route;
  if (closes) closing = m_.chain.closing(leg.from, *known);
  mechanics_.begin();
  try {
    if (!known) mechanics_.add_landmark(at(leg.from) + leg.in_map.displacement, leg.from);
    put_elements(step);
    if (closes) close_chain(step, closing, leg);
    if (known && options_.refine) arrival.eta = refine(step);
    for (const auto& [moved, before] : mechanics_.truss().moved()) {
      if (mechanics_.truss().position(moved).allFinite()) continue;
      throw SolveError("the covariances of the map's traversals span too many magnitudes");
    }
    remember(step, landmark, leg.in_map);
  } catch (...) {
    mechanics_.roll_back();
    throw;
  }
  if (!known) {
    m_.chain.append(leg.from, arrival.landmark);
    arrival.kind = Arrival::Kind::new_landmark;
  } else if (!closes) {
    arrival.kind = Arrival::Kind::refinement;
  } else {
    const bool chain = closing.landmarks.size() > 1;
    arrival.kind = chain ? Arrival::Kind::first_sight : Arrival::Kind::new_route;
    m_.chain.settle(closing, arrival.landmark);
  }
  note_moves(arrival);
  mechanics_.commit();
  return arrival;
}

MapBuilder::State::Step MapBuilder::State::averaged(int to, bool is_new,
                                                    const MeasuredLeg& leg) const {
  Step step;
  step.from = leg.from;
  step.to = to;
  step.new_landmark = is_new;
  const std::optional<int> known = is_new ? std::nullopt : m_.graph.route_between(leg.from, to);
  step.new_route = !known;
  step.route = known.value_or(m_.graph.routes());
  if (known) {
    step.average = m_.graph.route(*known);
    step.elements = elements_[idx(*known)];
  } else {
    step.average.source = leg.from;
    step.average.target = to;
  }
  const Route before = step.average;
  const bool turned = before.source != leg.from;
  const Traversal along = turned ? reversed(leg.in_map) : leg.in_map;
  average_in(step.average, along);
  const int place = known ? reckoned_at_[idx(*known)] : -1;
  step.reckoned_place = place >= 0 ? place : static_cast<int>(m_.reckoned.size());
  if (place >= 0) step.reckoned = m_.reckoned[idx(place)];
  if (weighs_each()) {
    step.weighed = known ? m_.weighed[idx(*known)] : WeighedRoute{};
  }
  if (leg.chord == nullptr) {
    if (step.reckoned) average_in(step.reckoned->bar, along);
    if (step.weighed) {
      const Matrix2 one = along.covariance.inverse();
      step.weighed->information += one;
      step.weighed->mean +=
          step.weighed->information.inverse() * (one * (along.displacement - step.weighed->mean));
    }
    return step;
  }
  if (!step.reckoned) {
    step.reckoned.emplace();
    step.reckoned->route = step.route;
    step.reckoned->bar = before;  // all traversals so far were in map axes
  }
  step.reckoned->length.take(leg.chord->vector.norm(), leg.chord->length_variance);
  if (leg.direction) {
    step.ends_first_heading = leg.by_compass && m_.first_direction >= 0;
    if (step.ends_first_heading && m_.first_direction == step.reckoned_place) {
      step.reckoned->direction = {};
    }
    step.reckoned->direction.take_angle(leg.direction->value + (turned ? std::numbers::pi : 0.0),
                                        leg.direction->variance);
  }
  return step;
}

/// The corner between the route that the robot came by and this one; a U-turn says nothing.
void MapBuilder::State::average_corner(Step& step, const MeasuredLeg& leg) const {
  if (!leg.corner || leg.corner_from == step.to) return;
  const bool forward = leg.corner_from < step.to;
  CornerAverage corner{
      std::min(leg.corner_from, step.to), leg.from, std::max(leg.corner_from, step.to), {}, 0.0};
  const auto known = corner_at_.find({corner.i, corner.j, corner.k});
  step.corner_place =
      known == corner_at_.end() ? static_cast<int>(m_.corners.size()) : known->second;
  if (known != corner_at_.end()) {
    corner = m_.corners[idx(known->second)];
    step.corner_element = corner_elements_[idx(known->second)];
  }
  const Route& came_by = m_.graph.route(*m_.graph.route_between(leg.corner_from, leg.from));
  corner.arm = 0.5 * (came_by.stretch + step.average.stretch);
  corner.angle.take_angle(forward ? leg.corner->value : -leg.corner->value, leg.corner->variance);
  step.corner = corner;
  if (step.reckoned->corner < 0) step.reckoned->corner = step.corner_place;
}

Element MapBuilder::State::bar_of(const Step& step) const {
  const Route& route = step.reckoned ? step.reckoned->bar : step.average;
  const int i = step.average.source;
  const int j = step.average.target;
  if (step.weighed) return bar_element(i, j, step.weighed->information, step.weighed->mean);
  const Matrix2 B = bar_stiffness(law(), route.covariance, route.orientation, route.traversals);
  return bar_element(i, j, B,
                     law() == StiffnessLaw::variance ? route.displacement : route.mean_vector());
}

void MapBuilder::State::put_elements(Step& step) {
  const auto put = [this](int& number, const Element& element) {
    if (number < 0) {
      number = mechanics_.add_element(element);
    } else {
      mechanics_.set_element(number, element);
    }
  };
  const int i = step.average.source;
  const int j = step.average.target;
  if (step.corner) {
    const CornerAverage& one = *step.corner;
    const double k = spring_stiffness(law(), one.angle.variance, one.angle.count, one.arm);
    put(step.corner_element, corner_element(one.i, one.j, one.k, k, one.angle.mean));
  }
  if (step.route < 0) return;
  const bool has_bar = !step.reckoned || step.reckoned->bar.traversals > 0;
  if (has_bar) put(step.elements.bar, bar_of(step));
  if (!step.reckoned) return;
  const Average& length = step.reckoned->length;
  const Average& direction = step.reckoned->direction;
  if (length.count > 0) {
    const double k = spring_stiffness(law(), length.variance, length.count);
    put(step.elements.length, length_element(i, j, k, length.mean));
  }
  if (direction.count > 0) {
    const double k =
        spring_stiffness(law(), direction.variance, direction.count, step.average.stretch);
    put(step.elements.direction, direction_element(i, j, k, direction.mean));
  }
  if (step.ends_first_heading && m_.first_direction != step.reckoned_place) {
    int element = elements_[idx(m_.reckoned[idx(m_.first_direction)].route)].direction;
    Element slack = mechanics_.truss().element(element);
    slack.k = 0.0;
    put(element, slack);
  }
}

TurningLeg MapBuilder::State::turning_leg(int from, int to, const RouteElements& elements,
                                          int corner_element) const {
  const ElasticTruss& truss = mechanics_.truss();
  TurningLeg leg;
  leg.from = truss.position(from);
  if (elements.bar >= 0) {
    leg.compliance = truss.element(elements.bar).B.inverse();
    return leg;
  }
  const Vector2 d = truss.position(to) - truss.position(from);
  const Vector2 along = d.normalized();
  leg.compliance = along * along.transpose() / truss.element(elements.length).k;
  if (elements.direction >= 0) {
    const Vector2 lever = quarter_turn(d);
    leg.compliance += lever * lever.transpose() / truss.element(elements.direction).k;
  } else if (corner_element >= 0) {
    leg.turning = 1.0 / truss.element(corner_element).k;
  }
  return leg;
}

/// First sight: what is missing is shared out along the chain; its end, which is known, stays.
void MapBuilder::State::close_chain(const Step& step, const OpenChain::Closing& closing,
                                    const MeasuredLeg& leg) {
  std::vector<TurningLeg> legs;
  legs.reserve(closing.landmarks.size());
  for (std::size_t n = 1; n < closing.landmarks.size(); ++n) {
    const int a = closing.landmarks[n - 1];
    const int b = closing.landmarks[n];
    const int route = *m_.graph.route_between(a, b);
    if (printed()) {
      legs.push_back({at(a), printed_stiffness(m_.graph, m_.graph.route(route)).inverse(), 0.0});
      continue;
    }
    const int place = reckoned_at_[idx(route)];
    const int corner = place < 0 ? -1 : m_.reckoned[idx(place)].corner;
    legs.push_back(
        turning_leg(a, b, elements_[idx(route)], corner < 0 ? -1 : corner_elements_[idx(corner)]));
  }
  const Vector2 end = at(leg.from) + leg.in_map.displacement;
  if (printed()) {
    const Matrix2 B = bar_stiffness(StiffnessLaw::mean_error, leg.in_map.covariance,
                                    direction(leg.in_map.displacement), 1.0);
    legs.push_back({at(leg.from), B.inverse(), 0.0});
  } else {
    legs.push_back(turning_leg(leg.from, step.to, step.elements, step.corner_element));
  }
  const std::vector<Vector2> u = turning_displacements(legs, end, at(step.to) - end);
  for (std::size_t n = 1; n < closing.landmarks.size(); ++n) {
    mechanics_.move(closing.landmarks[n], at(closing.landmarks[n]) + u[n - 1]);
  }
}

int MapBuilder::State::refine(const Step& step) {
  if (!printed()) return mechanics_.relax(step.from, step.to);
  return step.new_route ? 0 : refine_as_printed(step);
}

int MapBuilder::State::refine_as_printed(const Step& step) {
  Route& route = m_.graph.route(step.route);
  const Route before = route;
  route = step.average;
  try {
    const Moves moves =
        printed_refinement(m_.graph, step.route, mechanics_.members(step.from, step.to));
    for (std::size_t n = 0; n < moves.landmarks.size(); ++n) {
      const int landmark = moves.landmarks[n];
      mechanics_.move(landmark, at(landmark) + moves.displacements[n]);
    }
    if (!moves.shift.isZero(0.0)) {
      for (int k = 0; k < m_.graph.landmarks(); ++k) {
        mechanics_.move(k, mechanics_.truss().position(k) + moves.shift);
      }
    }
    route = before;
    return static_cast<int>(moves.landmarks.size());
  } catch (...) {
    route = before;
    throw;
  }
}

/// All that may fail, then what cannot.
void MapBuilder::State::remember(const Step& step, const std::string& landmark,
                                 const Traversal& in_map) {
  make_room(m_.reckoned);
  make_room(m_.corners);
  make_room(m_.weighed);
  make_room(elements_);
  make_room(reckoned_at_);
  make_room(corner_elements_);
  m_.chain.reserve(std::max(m_.graph.landmarks(), step.to) + 1);
  const bool new_corner = step.corner && step.corner_place == static_cast<int>(m_.corners.size());
  std::map<std::array<int, 3>, int>::iterator corner;
  if (new_corner) {
    const CornerAverage& one = *step.corner;
    corner = corner_at_.emplace(std::array<int, 3>{one.i, one.j, one.k}, step.corner_place).first;
  }
  try {
    if (step.new_landmark) {
      m_.graph.add_landmark(landmark, step.from, in_map);
    } else if (step.new_route) {
      m_.graph.add_route(step.from, step.to);
    }
  } catch (...) {
    if (new_corner) corner_at_.erase(corner);
    throw;
  }
  m_.graph.route(step.route) = step.average;
  if (step.new_route) {
    elements_.emplace_back();
    reckoned_at_.push_back(-1);
    if (step.weighed) m_.weighed.emplace_back();
  }
  elements_[idx(step.route)] = step.elements;
  if (step.weighed) m_.weighed[idx(step.route)] = *step.weighed;
  if (step.ends_first_heading) {
    if (m_.first_direction != step.reckoned_place) {
      m_.reckoned[idx(m_.first_direction)].direction.count = 0;
    }
    m_.first_direction = -1;
  }
  if (step.reckoned) {
    if (step.reckoned_place == static_cast<int>(m_.reckoned.size())) m_.reckoned.emplace_back();
    m_.reckoned[idx(step.reckoned_place)] = *step.reckoned;
    reckoned_at_[idx(step.route)] = step.reckoned_place;
  }
  if (step.corner) {
    if (new_corner) {
      m_.corners.emplace_back();
      corner_elements_.push_back(-1);
    }
    m_.corners[idx(step.corner_place)] = *step.corner;
    corner_elements_[idx(step.corner_place)] = step.corner_element;
  }
}

/// The graph's positions follow the truss's.
void MapBuilder::State::note_moves(Arrival& arrival) noexcept {
  for (const auto& [landmark, before] : mechanics_.truss().moved()) {
    const Vector2& now = mechanics_.truss().position(landmark);
    const double move = (now - at(landmark)).norm();
    if (move > kMoved) ++arrival.landmarks_moved;
    arrival.largest_move = std::max(arrival.largest_move, move);
    m_.graph.set_position(landmark, now);
  }
}

double MapBuilder::State::relax() {
  Arrival arrival;
  if (printed() || m_.graph.landmarks() < 2) return 0.0;
  mechanics_.begin();
  try {
    mechanics_.relax_all();
  } catch (...) {
    mechanics_.roll_back();
    throw;
  }
  note_moves(arrival);
  mechanics_.commit();
  return arrival.largest_move;
}

}  // namespace trussmap
