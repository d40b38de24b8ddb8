// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/map_builder.hpp"

#include "geometry/index.hpp"
#include "linalg/connected_parts.hpp"
#include "linalg/dense.hpp"
#include "map/builder_memory.hpp"
#include "map/make_room.hpp"
#include "map/map_truss.hpp"
#include "map/nearest_landmarks.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"
#include "trussmap/truss.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
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

/// Symmetric to the last bit, so that three numbers hold the covariance.
Traversal checked(const Traversal& leg) {
  check(leg);
  const Matrix2 C = 0.5 * (leg.covariance + leg.covariance.transpose());
  return {leg.displacement, C};
}

void check_tied(const LandmarkGraph& map) {
  std::vector<NodePair> ties;
  ties.reserve(idx(map.routes()));
  for (int number = 0; number < map.routes(); ++number) {
    ties.push_back({map.route(number).source, map.route(number).target});
  }
  const std::vector<int> part = connected_parts(map.landmarks(), ties);
  for (int k = 1; k < map.landmarks(); ++k) {
    if (part[idx(k)] == part[0]) continue;
    throw SolveError("landmark " + map.landmark(k).name +
                     " is tied to nothing: no chain of routes leads to it from landmark " +
                     map.landmark(0).name);
  }
}

/// All landmarks settled, and the routes' averages as they are.
BuilderMemory memory_of(const LandmarkGraph& map, const MapBuilderOptions& options) {
  BuilderMemory memory(options.gate);
  std::vector<Bar> bars;
  bars.reserve(idx(map.routes()));
  for (int number = 0; number < map.routes(); ++number) {
    const Route& route = map.route(number);
    check({route.displacement, route.covariance});
    if (route.traversals < 1) throw std::invalid_argument("a route has a traversal at least");
    bars.push_back({route.source, route.target, route.traversals * route.covariance.inverse()});
  }
  check_tied(map);
  for (int k = 0; k < map.landmarks(); ++k) {  // without covariances, which would soon be wrong
    memory.graph.add_landmark(map.landmark(k).name, map.landmark(k).position);
  }
  for (int number = 0; number < map.routes(); ++number) {
    const Route& route = map.route(number);
    memory.graph.set_route(memory.graph.add_route(route.source, route.target), route);
  }
  memory.chain.reserve(map.landmarks());
  if (options.method == Method::gauss_markov) {
    memory.increments = ExactIncrements(std::max(map.landmarks(), 1), std::move(bars));
  }
  return memory;
}

}  // namespace

class __attribute__((visibility("hidden"))) MapBuilder::State {
 public:
  explicit State(const MapBuilderOptions& options) : State(options, BuilderMemory(options.gate)) {}

  State(const MapBuilderOptions& options, BuilderMemory memory)
      : options_(options), m_(std::move(memory)) {
    check_options();
    m_.gate.set_gate(options.gate);
    if (!indexed()) return;
    for (int k = 0; k < m_.graph.landmarks(); ++k) nearest_.insert(k, stored(k));
  }

  void set_options(const MapBuilderOptions& options) {
    if (options.method != options_.method || options.eta.kind != options_.eta.kind) {
      throw std::invalid_argument("a map builder keeps its method and its kind of eta");
    }
    State(options).check_options();
    options_ = options;
    m_.gate.set_gate(options.gate);
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
    const std::optional<int> known = m_.graph.find(landmark);
    if (!known && m_.graph.landmarks() > 0) {
      throw SolveError("landmark " + landmark +
                       " is tied to nothing: a session must start on a landmark of the map");
    }
    m_.chain.reserve(m_.graph.landmarks() + 1);
    if (!known) {
      if (!std::isfinite(position.squaredNorm())) {
        throw std::invalid_argument("the first landmark needs a finite position");
      }
      m_.graph.add_landmark(landmark, position);
      if (indexed()) nearest_.insert(0, position);
    }
    m_.here = m_.said = known.value_or(0);
    m_.chain.restart(m_.here);
    m_.carried.reset();
  }

  /// Drives there; the leg goes on from one that was left out.
  Arrival arrive(const std::string& landmark, const Traversal& leg) {
    const Traversal whole = m_.carried ? Traversal{m_.carried->displacement + leg.displacement,
                                                   m_.carried->covariance + leg.covariance}
                                       : leg;
    if (m_.carried && m_.graph.find(landmark) == m_.here) return back_here();
    Arrival arrival = travel(landmark, whole);
    m_.said = arrival.landmark;
    if (arrival.kind == Arrival::Kind::left_out) {
      m_.carried = whole;
    } else {
      m_.carried.reset();
      m_.here = arrival.landmark;
    }
    return arrival;
  }

  Arrival observe(const std::string& landmark, const Traversal& from_here) {
    if (!m_.carried) return travel(landmark, from_here);
    if (m_.graph.find(landmark) == m_.here) return nothing_moved(m_.here);
    return travel(landmark, {m_.carried->displacement + from_here.displacement,
                             m_.carried->covariance + from_here.covariance});
  }

  /// From where the map does not have it to where it still has it.
  Arrival back_here() {
    m_.carried.reset();
    m_.said = m_.here;
    return nothing_moved(m_.here);
  }

  static Arrival nothing_moved(int landmark) {
    Arrival arrival;
    arrival.kind = Arrival::Kind::left_out;
    arrival.landmark = landmark;
    return arrival;
  }

  [[nodiscard]] const std::vector<LeftOutArrival>& left_out() const { return m_.left_out; }

  Arrival travel(const std::string& landmark, const Traversal& leg) {
    if (m_.here < 0) throw std::invalid_argument("the robot must start on a landmark first");
    check(leg);
    const std::optional<int> known = m_.graph.find(landmark);
    if (!known) return discover(landmark, leg);
    if (*known == m_.here)
      throw std::invalid_argument("the robot stands on " + landmark + " already");
    Arrival arrival;
    arrival.landmark = *known;
    arrival.misfit = leg.displacement - (stored(*known) - stored(m_.here));
    if (options_.method == Method::gauss_markov) return increment_gated(arrival, leg);
    if (!m_.graph.route_between(m_.here, *known)) return close(arrival, leg);
    return refine(arrival, leg);
  }

  double settle(double gain_limit) {
    check_gain_limit(gain_limit);
    std::vector<Vector2> before;
    before.reserve(idx(m_.graph.landmarks()));
    for (int k = 0; k < m_.graph.landmarks(); ++k) before.push_back(stored(k));
    const Vector2 offset_before = m_.offset;
    double largest = 0.0;
    try {
      for (int number = 0; number < m_.graph.routes(); ++number) {
        Arrival arrival;
        make(truss_.refinement(number, options_.eta, gain_limit), arrival);
        largest = std::max(largest, arrival.largest_move);
      }
    } catch (...) {
      for (int k = 0; k < m_.graph.landmarks(); ++k) put(k, before[idx(k)]);
      m_.offset = offset_before;
      throw;
    }
    return largest;
  }

  double rest() {
    Arrival arrival;
    make(truss_.rest(), arrival);
    return arrival.largest_move;
  }

  [[nodiscard]] Vector2 position(int landmark) const { return stored(landmark) + m_.offset; }

  [[nodiscard]] LandmarkGraph map() const {
    LandmarkGraph map = m_.graph;
    for (int k = 0; k < map.landmarks(); ++k) map.set_position(k, position(k));
    return map;
  }

  [[nodiscard]] const MapBuilderOptions& options() const { return options_; }
  [[nodiscard]] const LandmarkGraph& graph() const { return m_.graph; }
  [[nodiscard]] int here() const { return m_.here; }
  [[nodiscard]] const BuilderMemory& memory() const { return m_; }

  /// Makes the call and puts it into the journal, if there is one: both or neither.
  template <typename Call>
  auto journaled(BuilderCall entry, const Call& call) {
    if (journal != nullptr) make_room(*journal);
    auto result = call(entry);
    if (journal != nullptr) journal->push_back(entry);
    return result;
  }

  /// An arrival or an observation, journaled.
  Arrival measured(BuilderCall::Kind kind, const std::string& landmark, const Traversal& given) {
    const Traversal leg = checked(given);
    return journaled({kind, m_.said, -1, leg}, [&](BuilderCall& entry) {
      Arrival arrival =
          kind == BuilderCall::Kind::arrive ? arrive(landmark, leg) : observe(landmark, leg);
      entry.to = arrival.landmark;
      entry.outcome = arrival.kind;
      return arrival;
    });
  }

  std::vector<BuilderCall>* journal = nullptr;

 private:
  // Positions in the graph are short of the map's by m_.offset, so that a shift of the whole map
  // touches no landmark.
  [[nodiscard]] const Vector2& stored(int landmark) const {
    return m_.graph.landmark(landmark).position;
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
    m_.chain.reserve(m_.graph.landmarks() + 1);
    m_.increments.reserve();
    Arrival arrival;
    arrival.kind = Arrival::Kind::new_landmark;
    arrival.landmark = m_.graph.add_landmark(name, m_.here, leg);
    arrival.route = m_.graph.routes() - 1;
    if (options_.method == Method::gauss_markov) {
      m_.increments.add_joint(m_.here, leg.covariance.inverse());  // bar number = route number
    } else {
      m_.chain.append(m_.here, arrival.landmark);
    }
    if (indexed()) nearest_.insert(arrival.landmark, stored(arrival.landmark));
    return arrival;
  }

  /// Squared misfit of a traversal between two landmarks, in standard deviations of it and the map.
  [[nodiscard]] double squared_misfit(int i, int j, const Traversal& leg) {
    const Vector2 misfit = leg.displacement - (stored(j) - stored(i));
    const double of_leg = misfit.dot(leg.covariance.inverse() * misfit);
    if (m_.gate.lets_in(of_leg)) return of_leg;  // the map's own uncertainty makes it less still
    Matrix2 of_map;
    for (Eigen::Index c = 0; c < 2; ++c) {
      const std::vector<Vector2> u = m_.increments.pull(i, j, Matrix2::Identity().col(c));
      of_map.col(c) = u[idx(j)] - u[idx(i)];
    }
    const Matrix2 both = leg.covariance + 0.5 * (of_map + of_map.transpose());
    return misfit.dot(both.inverse() * misfit);
  }

  Arrival increment_gated(Arrival arrival, const Traversal& leg) {
    if (std::isinf(options_.gate)) return increment(m_.here, arrival, leg);
    m_.left_out.reserve(m_.left_out.size() + 1);
    const double misfit = std::min(squared_misfit(m_.here, arrival.landmark, leg),
                                   std::numeric_limits<double>::max());
    ArrivalGate gate = m_.gate;
    gate.remember(misfit);
    if (gate.lets_in(misfit)) {
      arrival = increment(m_.here, arrival, leg);
    } else {
      arrival.kind = Arrival::Kind::left_out;
      m_.left_out.push_back({m_.graph.landmark(m_.here).name,
                             m_.graph.landmark(arrival.landmark).name, leg, std::sqrt(misfit)});
    }
    m_.gate = std::move(gate);
    try {
      take_back_in(arrival);
    } catch (const std::exception&) {
      // The arrival is in; what could not come back stays out for now.
    }
    return arrival;
  }

  /// Order does not matter to least squares: what fits by now is taken in late.
  void take_back_in(Arrival& arrival) {
    for (std::size_t k = 0; k < m_.left_out.size();) {
      const LeftOutArrival& one = m_.left_out[k];
      const int from = *m_.graph.find(one.from);
      Arrival late;
      late.landmark = *m_.graph.find(one.to);
      late.misfit = one.leg.displacement - (stored(late.landmark) - stored(from));
      const bool this_one = arrival.kind == Arrival::Kind::left_out && k + 1 == m_.left_out.size();
      if (this_one || !m_.gate.lets_in(squared_misfit(from, late.landmark, one.leg))) {
        ++k;
        continue;
      }
      late = increment(from, late, one.leg);
      arrival.largest_move = std::max(arrival.largest_move, late.largest_move);
      ++arrival.back;
      m_.left_out.erase(m_.left_out.begin() + static_cast<std::ptrdiff_t>(k));
    }
  }

  Arrival increment(int from, Arrival arrival, const Traversal& leg) {
    const std::optional<int> known_route = m_.graph.route_between(from, arrival.landmark);
    arrival.kind = known_route ? Arrival::Kind::refinement : Arrival::Kind::first_sight;
    Route route = known_route ? m_.graph.route(*known_route) : Route();
    average_in(route, known_route && route.source != from ? reversed(leg) : leg);
    const Matrix2 one = options_.pooled ? route.covariance.inverse() : leg.covariance.inverse();
    if (!known_route) {
      m_.increments.add_bar(from, arrival.landmark, one);
    } else {
      m_.increments.set_stiffness(
          *known_route, options_.pooled ? Matrix2(route.traversals * one)
                                        : Matrix2(m_.increments.stiffness(*known_route) + one));
    }
    Moves moves;
    try {
      for (int k = 0; k < m_.graph.landmarks(); ++k) moves.landmarks.push_back(k);
      moves.displacements = m_.increments.pull(from, arrival.landmark, one * arrival.misfit);
      arrival.route = m_.graph.add_traversal(from, arrival.landmark, leg);
    } catch (...) {
      m_.increments.take_back();
      throw;
    }
    make(moves, arrival);
    return arrival;
  }

  Arrival close(Arrival arrival, const Traversal& leg) {
    const OpenChain::Closing closing = m_.chain.closing(m_.here, arrival.landmark);
    std::vector<Matrix2> stiffnesses;
    for (std::size_t n = 1; n < closing.landmarks.size(); ++n) {
      const auto route = m_.graph.route_between(closing.landmarks[n - 1], closing.landmarks[n]);
      stiffnesses.push_back(truss_.stiffness(m_.graph.route(*route)));
    }
    stiffnesses.push_back(
        bar_stiffness(StiffnessLaw::printed, leg.covariance, direction(leg.displacement), 1.0));
    Moves moves;
    moves.landmarks.assign(closing.landmarks.begin() + 1, closing.landmarks.end());
    moves.displacements = chain_displacements(stiffnesses, -arrival.misfit);
    moves.displacements.pop_back();  // the end is b, which stays
    require_finite(moves);

    arrival.kind = moves.landmarks.empty() ? Arrival::Kind::new_route : Arrival::Kind::first_sight;
    arrival.route = m_.graph.add_traversal(m_.here, arrival.landmark, leg);
    make(moves, arrival);
    m_.chain.settle(closing, arrival.landmark);
    return arrival;
  }

  Arrival refine(Arrival arrival, const Traversal& leg) {
    arrival.kind = Arrival::Kind::refinement;
    arrival.route = *m_.graph.route_between(m_.here, arrival.landmark);
    const Route before = m_.graph.route(arrival.route);
    Route& route = m_.graph.route(arrival.route);
    average_in(route, route.source == m_.here ? leg : reversed(leg));
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
    m_.offset += moves.shift;
  }

  void put(int landmark, const Vector2& position) noexcept {
    if (indexed()) nearest_.move(landmark, position);
    m_.graph.set_position(landmark, position);
  }

  MapBuilderOptions options_;
  BuilderMemory m_;
  NearestLandmarks nearest_;
  MapTruss truss_{m_.graph, nearest_};
};

MapBuilder::MapBuilder(const MapBuilderOptions& options)
    : state_(std::make_unique<State>(options)) {}
MapBuilder::MapBuilder(const LandmarkGraph& map, const MapBuilderOptions& options)
    : MapBuilder(std::make_unique<State>(options, memory_of(map, options))) {}
MapBuilder::MapBuilder(std::unique_ptr<State> state) : state_(std::move(state)) {}
MapBuilder::~MapBuilder() = default;
MapBuilder::MapBuilder(MapBuilder&&) noexcept = default;
MapBuilder& MapBuilder::operator=(MapBuilder&&) noexcept = default;

MapBuilder BuilderAccess::restored(BuilderMemory memory, const MapBuilderOptions& options) {
  return MapBuilder(std::make_unique<MapBuilder::State>(options, std::move(memory)));
}

const BuilderMemory& BuilderAccess::memory(const MapBuilder& builder) {
  return builder.state_->memory();
}

bool BuilderAccess::has_journal(const MapBuilder& builder,
                                const std::vector<BuilderCall>* journal) {
  return builder.state_ && builder.state_->journal == journal;
}

void BuilderAccess::keep_journal(MapBuilder& builder, std::vector<BuilderCall>* journal) {
  builder.state_->journal = journal;
}

void MapBuilder::start(const std::string& landmark, const Vector2& position) {
  state_->journaled({BuilderCall::Kind::start, -1, -1, {position, Matrix2::Zero()}},
                    [&](BuilderCall& entry) {
                      state_->start(landmark, position);
                      return entry.to = here();
                    });
}

Arrival MapBuilder::arrive(const std::string& landmark, const Traversal& leg) {
  return state_->measured(BuilderCall::Kind::arrive, landmark, leg);
}

Arrival MapBuilder::observe(const std::string& landmark, const Traversal& from_here) {
  return state_->measured(BuilderCall::Kind::observe, landmark, from_here);
}

double MapBuilder::settle(double gain_limit) {
  if (state_->options().method != Method::elastic) return 0.0;
  return state_->journaled({.kind = BuilderCall::Kind::settle, .gain = gain_limit},
                           [&](BuilderCall&) { return state_->settle(gain_limit); });
}

double MapBuilder::rest() {
  if (state_->options().method != Method::elastic) return 0.0;
  return state_->journaled({.kind = BuilderCall::Kind::rest},
                           [&](BuilderCall&) { return state_->rest(); });
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
