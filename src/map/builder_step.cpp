// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/index.hpp"
#include "geometry/make_room.hpp"
#include "map/builder_state.hpp"
#include "map/printed_refinement.hpp"

#include <algorithm>
#include <numbers>

#include <Eigen/LU>

namespace trussmap {
using namespace map;

namespace {

/// L of corners and of directions, m, under the law 1/mean error. As long as their routes they
/// would be stiffer at long ones than they are sure. The map's error over that of least squares, on
/// meshes of 1 to 10 m:
///   corners      no compass: above 1.5 in 11 of 100 worlds; with 1 m in 4, with 0.1 m, too, but
///                groups come to rest slowly
///   directions   readings of 0.03 rad at landmarks, less sure than turns by wheels: 1.5; with 1 m
///                1.05, with 0.3 m 1.0
constexpr double kCornerArm = 1.0;
constexpr double kDirectionArm = 0.3;

}  // namespace

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
  mechanics_.change([&] {
    if (!known) mechanics_.add_landmark(at(leg.from) + leg.in_map.displacement, leg.from);
    put_elements(step);
    if (closes) close_chain(step, closing, leg);
    if (known && options_.refine) arrival.eta = refine(step);
    mechanics_.require_finite();
    remember(step, landmark, leg.in_map);
  });
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
  if (weighs_each(options_)) {
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

/// Between the routes from j to i and to k.
std::optional<int> MapBuilder::State::corner_of(int i, int j, int k) const {
  const auto known = corner_at_.find({std::min(i, k), j, std::max(i, k)});
  if (known == corner_at_.end()) return std::nullopt;
  return known->second;
}

/// The corner between the route that the robot came by and this one; a U-turn says nothing.
void MapBuilder::State::average_corner(Step& step, const MeasuredLeg& leg) const {
  if (!leg.corner || leg.corner_from == step.to) return;
  const bool forward = leg.corner_from < step.to;
  CornerAverage corner{
      std::min(leg.corner_from, step.to), leg.from, std::max(leg.corner_from, step.to), {}};
  const std::optional<int> known = corner_of(corner.i, corner.j, corner.k);
  step.corner_place = known.value_or(static_cast<int>(m_.corners.size()));
  if (known) {
    corner = m_.corners[idx(*known)];
    step.corner_element = corner_elements_[idx(*known)];
  }
  corner.angle.take_angle(forward ? leg.corner->value : -leg.corner->value, leg.corner->variance);
  step.corner = corner;
  if (step.reckoned->corner < 0) step.reckoned->corner = step.corner_place;
}

truss::Element MapBuilder::State::bar_of(const Step& step) const {
  const Route& route = step.reckoned ? step.reckoned->bar : step.average;
  const int i = step.average.source;
  const int j = step.average.target;
  if (step.weighed) return truss::bar_element(i, j, step.weighed->information, step.weighed->mean);
  const Matrix2 B = bar_stiffness(law(), route.covariance, route.orientation, route.traversals);
  return truss::bar_element(
      i, j, B, law() == StiffnessLaw::variance ? route.displacement : route.mean_vector());
}

void MapBuilder::State::put_elements(Step& step) {
  const auto put = [this](int& number, const truss::Element& element) {
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
    const double k = spring_stiffness(law(), one.angle.variance, one.angle.count, kCornerArm);
    put(step.corner_element, truss::corner_element(one.i, one.j, one.k, k, one.angle.mean));
  }
  if (step.route < 0) return;
  const bool has_bar = !step.reckoned || step.reckoned->bar.traversals > 0;
  if (has_bar) put(step.elements.bar, bar_of(step));
  if (!step.reckoned) return;
  const Average& length = step.reckoned->length;
  const Average& direction = step.reckoned->direction;
  if (length.count > 0) {
    const double k = spring_stiffness(law(), length.variance, length.count);
    put(step.elements.length, truss::length_element(i, j, k, length.mean));
  }
  if (direction.count > 0) {
    const double k = spring_stiffness(law(), direction.variance, direction.count, kDirectionArm);
    put(step.elements.direction, truss::direction_element(i, j, k, direction.mean));
  }
  if (step.ends_first_heading && m_.first_direction != step.reckoned_place) {
    int element = elements_[idx(m_.reckoned[idx(m_.first_direction)].route)].direction;
    truss::Element slack = mechanics_.truss().element(element);
    slack.k = 0.0;
    put(element, slack);
  }
}

TurningLeg MapBuilder::State::turning_leg(int from, int to, const RouteElements& elements,
                                          int corner_element) const {
  const truss::ElasticTruss& truss = mechanics_.truss();
  TurningLeg leg;
  leg.from = at(from);
  if (elements.bar >= 0) {
    leg.compliance = truss.element(elements.bar).B.inverse();
    return leg;
  }
  const Vector2 d = at(to) - at(from);
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
  geometry::make_room(m_.reckoned);
  geometry::make_room(m_.corners);
  geometry::make_room(m_.weighed);
  geometry::make_room(elements_);
  geometry::make_room(reckoned_at_);
  geometry::make_room(corner_elements_);
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
  if (step.new_landmark)
    m_.graph.set_position(step.to, at(step.to));  // the other end may be behind
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

}  // namespace trussmap
