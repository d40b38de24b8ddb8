// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/builder_state.hpp"

#include "geometry/index.hpp"
#include "map/expected_falls.hpp"
#include "map/heading_reset.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/LU>

namespace trussmap {
using namespace map;

namespace {

constexpr std::size_t kMostUnwritten = 4096;  // then all are written

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

}  // namespace

}  // namespace trussmap

namespace trussmap::map {

StiffnessLaw law_of(const MapBuilderOptions& options) {
  return options.law.value_or(options.method == Method::gauss_markov ? StiffnessLaw::variance
                                                                     : StiffnessLaw::mean_error);
}

bool weighs_each(const MapBuilderOptions& options) {
  return law_of(options) == StiffnessLaw::variance && !options.pooled;
}

}  // namespace trussmap::map

namespace trussmap {

MapBuilder::State::State(const MapBuilderOptions& options, BuilderMemory memory)
    : options_(options), m_(std::move(memory)), mechanics_(scope_of(options), law_of(options)) {
  check_options(options);
  m_.gate.set_gate(options.gate);
  unwritten_.reserve(kMostUnwritten);
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

/// The truss that the memory's averages make, where the memory has the landmarks.
void MapBuilder::State::make_truss() {
  const LandmarkGraph& graph = m_.graph;
  for (int k = 0; k < graph.landmarks(); ++k) {
    const std::vector<int>& routes = graph.routes_at(k);
    mechanics_.add_landmark(graph.landmark(k).position,
                            routes.empty() ? -1 : other_end(graph.route(routes.front()), k));
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
    if (weighs_each(options_)) step.weighed = m_.weighed[idx(number)];
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
}

/// The same map with stiffness 1/variance: its truss's flexibility is the map's covariance.
MapBuilder::State MapBuilder::State::by_variance() const {
  MapBuilderOptions options = options_;
  options.method = Method::gauss_markov;
  options.law.reset();
  options.pooled = !weighs_each(options_);
  return State(options, settled_memory());
}

Matrix2 MapBuilder::State::covariance_between(int a, int b) const {
  return by_variance().mechanics_.flexibility_between(a, b);
}

std::vector<Matrix2> MapBuilder::State::covariances() const {
  return by_variance().mechanics_.flexibilities();
}

/// Mean variance of all corners; 0: there is none.
double MapBuilder::State::usual_corner_variance() const {
  double sum = 0.0;
  for (const CornerAverage& one : m_.corners) sum += one.angle.variance;
  return m_.corners.empty() ? 0.0 : sum / static_cast<double>(m_.corners.size());
}

/// What a drive along a way measures, in the order in which it does.
std::vector<truss::Element> MapBuilder::State::measured_along(const std::vector<int>& way,
                                                              double corner_variance) const {
  std::vector<truss::Element> measured;
  int before = -1;
  if (!way.empty() && way.front() == m_.here && m_.earlier) before = m_.earlier->landmark;
  for (std::size_t n = 1; n < way.size(); ++n) {
    const int i = way[n - 1];
    const int j = way[n];
    const std::optional<int> number = m_.graph.route_between(i, j);
    if (!number) {
      throw std::invalid_argument("expected ways along routes of the map");
    }
    const Route& route = m_.graph.route(*number);
    const int place = reckoned_at_[idx(*number)];
    if (place < 0 || m_.reckoned[idx(place)].length.count == 0) {
      measured.push_back(
          truss::bar_element(route.source, route.target, route.covariance.inverse(), {}));
      before = -1;
      continue;
    }
    const ReckonedRoute& reckoned = m_.reckoned[idx(place)];
    measured.push_back(
        truss::length_element(route.source, route.target, 1.0 / reckoned.length.variance, 0.0));
    if (m_.frame == Frame::axes && reckoned.direction.count > 0) {
      measured.push_back(truss::direction_element(route.source, route.target,
                                                  1.0 / reckoned.direction.variance, 0.0));
    }
    if (before >= 0 && before != j && corner_variance > 0.0) {
      const std::optional<int> known = corner_of(before, i, j);
      const double variance = known ? m_.corners[idx(*known)].angle.variance : corner_variance;
      measured.push_back(
          truss::corner_element(std::min(before, j), i, std::max(before, j), 1.0 / variance, 0.0));
    }
    before = i;
  }
  return measured;
}

std::vector<double> MapBuilder::State::expected_falls(
    const std::vector<std::vector<int>>& ways) const {
  State least_squares = by_variance();
  ExpectedFalls fall(least_squares.mechanics_, m_.frame == Frame::first_heading);
  const double corner_variance = usual_corner_variance();
  std::vector<double> falls;
  for (const std::vector<int>& way : ways) {
    falls.push_back(fall.of(measured_along(way, corner_variance)));
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
    mechanics_.change([&] {
      mechanics_.add_landmark(position, -1);
      m_.graph.add_landmark(landmark, position);
    });
    mechanics_.commit();
  }
  m_.here = m_.said = known.value_or(0);
  m_.chain.restart(m_.here);
  m_.carried.reset();
  m_.carried_motion.reset();
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
  HeadingEstimate read{reading, sd * sd};
  if (m_.carried_motion) {
    m_.carried_motion->reading = with_reading(m_.carried_motion->reading, read);
    if (m_.frame != Frame::axes) return;
    read.heading -= m_.carried_motion->motion.displacement.heading;
    read.variance += m_.carried_motion->motion.covariance(2, 2);
    m_.heading = with_reading(m_.heading, read);
    return;
  }
  if (m_.frame == Frame::first_heading && m_.heading) {
    turn_map(wrap_angle(reading - m_.heading->heading));
    m_.heading.reset();  // was relative to the first one
  }
  m_.heading = with_reading(m_.heading, read);
  m_.frame = Frame::axes;
  m_.reading = with_reading(m_.reading, read);  // several: their weighted mean
}

/// The whole map about its first landmark: no element but those of directions is strained by it.
void MapBuilder::State::turn_map(double angle) {
  const Matrix2 R = rotation(angle);
  mechanics_.change([&] {
    mechanics_.settle();
    for (int k = 1; k < m_.graph.landmarks(); ++k) mechanics_.move(k, at(0) + R * (at(k) - at(0)));
    for (const ReckonedRoute& one : m_.reckoned) {
      const int element = elements_[idx(one.route)].direction;
      if (element < 0) continue;
      truss::Element turned = mechanics_.truss().element(element);
      turned.rest += angle;
      mechanics_.set_element(element, turned);
    }
  });
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
  if (!m_.carried_motion) return estimate;
  const Motion whole = then({estimate.pose, estimate.covariance}, m_.carried_motion->motion);
  return PoseEstimate{whole.displacement, whole.covariance};
}

/// What was moved is written into the graph when somebody asks for it: a landmark there is far from
/// its neighbours in memory.
void MapBuilder::State::note_moves(Arrival& arrival) noexcept {
  const MapMechanics::Moves moves = mechanics_.moves();
  arrival.landmarks_moved = moves.landmarks;
  arrival.largest_move = moves.largest;
  const auto& moved = mechanics_.truss().moved();
  if (mechanics_.groups_move() || unwritten_.size() + moved.size() > unwritten_.capacity()) {
    all_unwritten_ = true;
  }
  if (!all_unwritten_) {
    for (const auto& [landmark, before] : moved) unwritten_.push_back(landmark);
  }
  if (printed()) static_cast<void>(settle_memory());  // it reads the graph
}

void MapBuilder::State::write_positions(LandmarkGraph& graph) const noexcept {
  if (all_unwritten_) {
    for (int k = 0; k < graph.landmarks(); ++k) graph.set_position(k, at(k));
    return;
  }
  for (const int k : unwritten_) graph.set_position(k, at(k));
}

LandmarkGraph MapBuilder::State::map() const {
  LandmarkGraph map = m_.graph;
  write_positions(map);
  return map;
}

BuilderMemory MapBuilder::State::settled_memory() const {
  BuilderMemory memory = m_;
  write_positions(memory.graph);
  return memory;
}

const BuilderMemory& MapBuilder::State::settle_memory() noexcept {
  write_positions(m_.graph);
  unwritten_.clear();
  all_unwritten_ = mechanics_.groups_move();
  return m_;
}

double MapBuilder::State::relax() {
  if (printed() || m_.graph.landmarks() < 2) return 0.0;
  mechanics_.change([this] { mechanics_.relax_all(); });
  Arrival arrival;
  note_moves(arrival);
  mechanics_.commit();
  return arrival.largest_move;
}

}  // namespace trussmap
