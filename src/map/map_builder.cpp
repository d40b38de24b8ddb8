// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/map_builder.hpp"

#include "geometry/index.hpp"
#include "linalg/dense.hpp"
#include "map/arrival_gate.hpp"
#include "map/exact_increments.hpp"
#include "map/first_sight.hpp"
#include "map/map_truss.hpp"
#include "map/nearest_landmarks.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"
#include "trussmap/truss.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/LU>

namespace trussmap {
namespace {

constexpr double kMoved = 1e-12;     // m
constexpr double kRounding = 1e-9;   // asymmetry of a covariance, as a share of its size
constexpr double kFlattest = 1e-14;  // determinant of a covariance over its squared trace

void check(const Traversal& leg) {
  const Matrix2& C = leg.covariance;
  const double length2 = leg.displacement.squaredNorm();
  const double size = C.trace();
  const bool symmetric = std::abs(C(0, 1) - C(1, 0)) <= kRounding * size;
  const bool definite = C(0, 0) > 0.0 && C.determinant() > kFlattest * size * size;
  const bool invertible = C.inverse().allFinite() && std::isfinite(C.determinant());
  if (!(length2 > 0.0) || !std::isfinite(length2) || !symmetric || !definite || !invertible) {
    throw std::invalid_argument(
        "a leg needs a finite displacement other than zero and a symmetric, positive definite "
        "covariance whose inverse is finite");
  }
}

}  // namespace

class MapBuilder::State {
 public:
  explicit State(const MapBuilderOptions& options) : options_(options), gate_(options.gate) {
    check_options();
  }

  void set_options(const MapBuilderOptions& options) {
    if (options.method != options_.method || options.eta.kind != options_.eta.kind) {
      throw std::invalid_argument("a map builder keeps its method and its kind of eta");
    }
    State(options).check_options();
    options_ = options;
    gate_.set_gate(options.gate);
  }

  void check_options() const {
    if (!(options_.gate > 0.0)) throw std::invalid_argument("the gate must be above 0");
    if (options_.method == Method::adjustment) {
      throw std::invalid_argument("an adjustment is no method of a map builder, but of build_map");
    }
    if (options_.eta.kind == Eta::Kind::fixed && options_.eta.count < 2) {
      throw std::invalid_argument("eta must be 2 landmarks at least");
    }
    check_gain_limit(options_.gain_limit);
  }

  static void check_gain_limit(double limit) {
    if (!(limit > 0.0 && limit <= 1.0)) {
      throw std::invalid_argument("the gain limit must be in (0, 1]");
    }
  }

  void start(const std::string& landmark, const Vector2& position) {
    const std::optional<int> known = graph_.find(landmark);
    if (!known && graph_.landmarks() > 0) {
      throw SolveError("landmark " + landmark +
                       " is tied to nothing: a session must start on a landmark of the map");
    }
    chain_.reserve(graph_.landmarks() + 1);
    if (!known) {
      if (!std::isfinite(position.squaredNorm())) {
        throw std::invalid_argument("the first landmark needs a finite position");
      }
      graph_.add_landmark(landmark, position);
      if (indexed()) nearest_.insert(0, position);
    }
    here_ = known.value_or(0);
    chain_.restart(here_);
    carried_.reset();
  }

  /// Drives there; the leg goes on from one that was left out.
  Arrival arrive(const std::string& landmark, const Traversal& leg) {
    check(leg);
    const Traversal whole = carried_ ? Traversal{carried_->displacement + leg.displacement,
                                                 carried_->covariance + leg.covariance}
                                     : leg;
    Arrival arrival = travel(landmark, whole);
    if (arrival.kind == Arrival::Kind::left_out) {
      carried_ = whole;
    } else {
      carried_.reset();
      here_ = arrival.landmark;
    }
    return arrival;
  }

  Arrival observe(const std::string& landmark, const Traversal& from_here) {
    if (!carried_) return travel(landmark, from_here);
    return travel(landmark, {carried_->displacement + from_here.displacement,
                             carried_->covariance + from_here.covariance});
  }

  [[nodiscard]] const std::vector<LeftOutArrival>& left_out() const { return left_out_; }

  Arrival travel(const std::string& landmark, const Traversal& leg) {
    if (here_ < 0) throw std::invalid_argument("the robot must start on a landmark first");
    check(leg);
    const std::optional<int> known = graph_.find(landmark);
    if (!known) return discover(landmark, leg);
    if (*known == here_)
      throw std::invalid_argument("the robot stands on " + landmark + " already");
    Arrival arrival;
    arrival.landmark = *known;
    arrival.misfit = leg.displacement - (stored(*known) - stored(here_));
    if (options_.method == Method::gauss_markov) return increment_gated(arrival, leg);
    if (!graph_.route_between(here_, *known)) return close(arrival, leg);
    return refine(arrival, leg);
  }

  double settle(double gain_limit) {
    check_gain_limit(gain_limit);
    std::vector<Vector2> before;
    before.reserve(idx(graph_.landmarks()));
    for (int k = 0; k < graph_.landmarks(); ++k) before.push_back(stored(k));
    const Vector2 offset_before = offset_;
    double largest = 0.0;
    try {
      for (int number = 0; number < graph_.routes(); ++number) {
        Arrival arrival;
        make(truss_.refinement(number, options_.eta, gain_limit), arrival);
        largest = std::max(largest, arrival.largest_move);
      }
    } catch (...) {
      for (int k = 0; k < graph_.landmarks(); ++k) put(k, before[idx(k)]);
      offset_ = offset_before;
      throw;
    }
    return largest;
  }

  double rest() {
    Arrival arrival;
    make(truss_.rest(), arrival);
    return arrival.largest_move;
  }

  [[nodiscard]] Vector2 position(int landmark) const { return stored(landmark) + offset_; }

  [[nodiscard]] LandmarkGraph map() const {
    LandmarkGraph map = graph_;
    for (int k = 0; k < map.landmarks(); ++k) map.set_position(k, position(k));
    return map;
  }

  [[nodiscard]] const MapBuilderOptions& options() const { return options_; }
  [[nodiscard]] const LandmarkGraph& graph() const { return graph_; }
  [[nodiscard]] int here() const { return here_; }

 private:
  // Positions in the graph are short of the map's by offset_, so that a shift of the whole map
  // touches no landmark.
  [[nodiscard]] const Vector2& stored(int landmark) const {
    return graph_.landmark(landmark).position;
  }

  [[nodiscard]] bool indexed() const {
    return options_.eta.kind == Eta::Kind::fixed && options_.method != Method::gauss_markov;
  }

  [[nodiscard]] std::optional<double> gain_limit() const {
    if (options_.method == Method::elastic_printed) return std::nullopt;
    return options_.gain_limit;
  }

  // What may fail comes first in all that follows, what changes the map last.

  Arrival discover(const std::string& name, const Traversal& leg) {
    chain_.reserve(graph_.landmarks() + 1);
    increments_.reserve();
    Arrival arrival;
    arrival.kind = Arrival::Kind::new_landmark;
    arrival.landmark = graph_.add_landmark(name, here_, leg);
    arrival.route = graph_.routes() - 1;
    if (options_.method == Method::gauss_markov) {
      increments_.add_joint(here_, leg.covariance.inverse());  // bar number = route number
    } else {
      chain_.append(here_, arrival.landmark);
    }
    if (indexed()) nearest_.insert(arrival.landmark, stored(arrival.landmark));
    return arrival;
  }

  /// Squared misfit of a traversal between two landmarks, in standard deviations of it and the map.
  [[nodiscard]] double squared_misfit(int i, int j, const Traversal& leg) {
    const Vector2 misfit = leg.displacement - (stored(j) - stored(i));
    const double of_leg = misfit.dot(leg.covariance.inverse() * misfit);
    if (gate_.lets_in(of_leg)) return of_leg;  // the map's own uncertainty makes it less still
    Matrix2 of_map;
    for (Eigen::Index c = 0; c < 2; ++c) {
      const std::vector<Vector2> u = increments_.pull(i, j, Matrix2::Identity().col(c));
      of_map.col(c) = u[idx(j)] - u[idx(i)];
    }
    const Matrix2 both = leg.covariance + 0.5 * (of_map + of_map.transpose());
    return misfit.dot(both.inverse() * misfit);
  }

  Arrival increment_gated(Arrival arrival, const Traversal& leg) {
    if (std::isinf(options_.gate)) return increment(here_, arrival, leg);
    left_out_.reserve(left_out_.size() + 1);
    const double misfit = squared_misfit(here_, arrival.landmark, leg);
    ArrivalGate gate = gate_;
    gate.remember(misfit);
    if (gate.lets_in(misfit)) {
      arrival = increment(here_, arrival, leg);
    } else {
      arrival.kind = Arrival::Kind::left_out;
      left_out_.push_back({graph_.landmark(here_).name, graph_.landmark(arrival.landmark).name, leg,
                           std::sqrt(misfit)});
    }
    gate_ = std::move(gate);
    try {
      take_back_in(arrival);
    } catch (const std::exception&) {
      // The arrival is in; what could not come back stays out for now.
    }
    return arrival;
  }

  /// Order does not matter to least squares: what fits by now is taken in late.
  void take_back_in(Arrival& arrival) {
    for (std::size_t k = 0; k < left_out_.size();) {
      const LeftOutArrival& one = left_out_[k];
      const int from = *graph_.find(one.from);
      Arrival late;
      late.landmark = *graph_.find(one.to);
      late.misfit = one.leg.displacement - (stored(late.landmark) - stored(from));
      const bool this_one = arrival.kind == Arrival::Kind::left_out && k + 1 == left_out_.size();
      if (this_one || !gate_.lets_in(squared_misfit(from, late.landmark, one.leg))) {
        ++k;
        continue;
      }
      late = increment(from, late, one.leg);
      arrival.largest_move = std::max(arrival.largest_move, late.largest_move);
      ++arrival.back;
      left_out_.erase(left_out_.begin() + static_cast<std::ptrdiff_t>(k));
    }
  }

  Arrival increment(int from, Arrival arrival, const Traversal& leg) {
    const std::optional<int> known_route = graph_.route_between(from, arrival.landmark);
    arrival.kind = known_route ? Arrival::Kind::refinement : Arrival::Kind::first_sight;
    Route route = known_route ? graph_.route(*known_route) : Route();
    average_in(route, known_route && route.source != from ? reversed(leg) : leg);
    const Matrix2 one = options_.pooled ? route.covariance.inverse() : leg.covariance.inverse();
    if (!known_route) {
      increments_.add_bar(from, arrival.landmark, one);
    } else {
      increments_.set_stiffness(
          *known_route, options_.pooled ? Matrix2(route.traversals * one)
                                        : Matrix2(increments_.stiffness(*known_route) + one));
    }
    Moves moves;
    try {
      for (int k = 0; k < graph_.landmarks(); ++k) moves.landmarks.push_back(k);
      moves.displacements = increments_.pull(from, arrival.landmark, one * arrival.misfit);
      arrival.route = graph_.add_traversal(from, arrival.landmark, leg);
    } catch (...) {
      increments_.take_back();
      throw;
    }
    make(moves, arrival);
    return arrival;
  }

  Arrival close(Arrival arrival, const Traversal& leg) {
    const OpenChain::Closing closing = chain_.closing(here_, arrival.landmark);
    std::vector<Matrix2> stiffnesses;
    for (std::size_t n = 1; n < closing.landmarks.size(); ++n) {
      const auto route = graph_.route_between(closing.landmarks[n - 1], closing.landmarks[n]);
      stiffnesses.push_back(truss_.stiffness(graph_.route(*route)));
    }
    stiffnesses.push_back(
        bar_stiffness(StiffnessLaw::printed, leg.covariance, direction(leg.displacement), 1.0));
    Moves moves;
    moves.landmarks.assign(closing.landmarks.begin() + 1, closing.landmarks.end());
    moves.displacements = chain_displacements(stiffnesses, -arrival.misfit);
    moves.displacements.pop_back();  // the end is b, which stays
    require_finite(moves);

    arrival.kind = moves.landmarks.empty() ? Arrival::Kind::new_route : Arrival::Kind::first_sight;
    arrival.route = graph_.add_traversal(here_, arrival.landmark, leg);
    make(moves, arrival);
    chain_.settle(closing, arrival.landmark);
    return arrival;
  }

  Arrival refine(Arrival arrival, const Traversal& leg) {
    arrival.kind = Arrival::Kind::refinement;
    arrival.route = *graph_.route_between(here_, arrival.landmark);
    const Route before = graph_.route(arrival.route);
    Route& route = graph_.route(arrival.route);
    average_in(route, route.source == here_ ? leg : reversed(leg));
    if (!options_.refine) return arrival;
    try {
      const Moves moves = truss_.refinement(arrival.route, options_.eta, gain_limit());
      arrival.eta = static_cast<int>(moves.landmarks.size());
      make(moves, arrival);
    } catch (...) {
      route = before;
      throw;
    }
    return arrival;
  }

  void make(const Moves& moves, Arrival& arrival) noexcept {
    for (std::size_t n = 0; n < moves.landmarks.size(); ++n) {
      put(moves.landmarks[n], stored(moves.landmarks[n]) + moves.displacements[n]);
      const double move = (moves.displacements[n] + moves.shift).norm();
      if (move > kMoved) ++arrival.landmarks_moved;
      arrival.largest_move = std::max(arrival.largest_move, move);
    }
    offset_ += moves.shift;
  }

  void put(int landmark, const Vector2& position) noexcept {
    if (indexed()) nearest_.move(landmark, stored(landmark), position);
    graph_.set_position(landmark, position);
  }

  MapBuilderOptions options_;
  LandmarkGraph graph_;
  Vector2 offset_ = Vector2::Zero();
  OpenChain chain_;
  ExactIncrements increments_;
  NearestLandmarks nearest_;
  MapTruss truss_{graph_, nearest_};
  ArrivalGate gate_;
  std::vector<LeftOutArrival> left_out_;
  std::optional<Traversal> carried_;  ///< driven since here_, by legs whose ends were left out
  int here_ = -1;
};

MapBuilder::MapBuilder(const MapBuilderOptions& options)
    : state_(std::make_unique<State>(options)) {}
MapBuilder::~MapBuilder() = default;
MapBuilder::MapBuilder(MapBuilder&&) noexcept = default;
MapBuilder& MapBuilder::operator=(MapBuilder&&) noexcept = default;

void MapBuilder::start(const std::string& landmark, const Vector2& position) {
  state_->start(landmark, position);
}

Arrival MapBuilder::arrive(const std::string& landmark, const Traversal& leg) {
  return state_->arrive(landmark, leg);
}

Arrival MapBuilder::observe(const std::string& landmark, const Traversal& from_here) {
  return state_->observe(landmark, from_here);
}

double MapBuilder::settle(double gain_limit) {
  return state_->options().method == Method::elastic ? state_->settle(gain_limit) : 0.0;
}

double MapBuilder::rest() {
  return state_->options().method == Method::elastic ? state_->rest() : 0.0;
}

const std::vector<LeftOutArrival>& MapBuilder::left_out() const {
  return state_->left_out();
}

const MapBuilderOptions& MapBuilder::options() const {
  return state_->options();
}
void MapBuilder::set_options(const MapBuilderOptions& options) {
  state_->set_options(options);
}

int MapBuilder::here() const {
  return state_->here();
}
int MapBuilder::landmarks() const {
  return state_->graph().landmarks();
}

std::optional<int> MapBuilder::find(const std::string& landmark) const {
  return state_->graph().find(landmark);
}

Vector2 MapBuilder::position(int landmark) const {
  if (landmark < 0 || landmark >= landmarks()) {
    throw std::invalid_argument(
        joined("the map has no landmark number ", landmark, ", expected 0 to ", landmarks() - 1));
  }
  return state_->position(landmark);
}

std::optional<Route> MapBuilder::route_between(int a, int b) const {
  const auto number = state_->graph().route_between(a, b);
  if (!number) return std::nullopt;
  return state_->graph().route(*number);
}

LandmarkGraph MapBuilder::map() const {
  return state_->map();
}

std::string name_of(Method method) {
  switch (method) {
    case Method::elastic:
      return "elastic";
    case Method::elastic_printed:
      return "elastic_printed";
    case Method::gauss_markov:
      return "gauss_markov";
    case Method::adjustment:
      return "adjustment";
  }
  return "unknown";
}

}  // namespace trussmap
