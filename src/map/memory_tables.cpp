// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/memory_tables.hpp"

#include "geometry/index.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace trussmap::map {
namespace {

/// Of a covariance of (x, y, turn), in the order in which it is kept.
constexpr std::array<std::pair<int, int>, 6> kUpper{
    {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};
constexpr std::array kMethods{Method::elastic, Method::elastic_printed, Method::gauss_markov};
constexpr std::array kScopes{RefinementScope::Kind::automatic, RefinementScope::Kind::all,
                             RefinementScope::Kind::nearest, RefinementScope::Kind::estimated};
constexpr std::array<std::optional<StiffnessLaw>, 3> kLaws{std::nullopt, StiffnessLaw::mean_error,
                                                           StiffnessLaw::variance};

std::string word_for(Method method) {
  return name_of(method);
}

std::string word_for(RefinementScope::Kind kind) {
  if (kind == RefinementScope::Kind::automatic) return "automatic";
  if (kind == RefinementScope::Kind::all) return "all";
  return kind == RefinementScope::Kind::nearest ? "nearest" : "estimated";
}

std::string word_for(const std::optional<StiffnessLaw>& law) {
  if (!law) return "own";
  return *law == StiffnessLaw::variance ? "variance" : "mean error";
}

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument(what);
}

/// The one that is called so.
template <typename Values>
auto named(const Values& values, const std::string& name, const char* what) {
  std::string all;
  for (const auto& value : values) {
    if (word_for(value) == name) return value;
    all += (all.empty() ? "" : ", ") + word_for(value);
  }
  refuse(text::joined(what, " that is unknown, expected one of ", all));
}

double finite(const text::RowReader& row, int column, const char* what) {
  const double value = row.is_null(column) ? std::nan("") : row.real(column);
  if (!std::isfinite(value))
    refuse(text::joined(what, " that is no number, expected a finite one"));
  return value;
}

Vector2 vector_at(const text::RowReader& row, int column, const char* what) {
  return {finite(row, column, what), finite(row, column + 1, what)};
}

Matrix2 symmetric_at(const text::RowReader& row, int column, const char* what) {
  Matrix2 C;
  C(0, 0) = finite(row, column, what);
  C(0, 1) = C(1, 0) = finite(row, column + 1, what);
  C(1, 1) = finite(row, column + 2, what);
  return C;
}

Matrix2 matrix_at(const text::RowReader& row, int column, const char* what) {
  const Matrix2 C = symmetric_at(row, column, what);
  if (!(C(0, 0) > 0.0) || !(C.determinant() > 0.0)) {
    refuse(text::joined(what, " whose matrix is not positive definite"));
  }
  return C;
}

std::int64_t integer_at(const text::RowReader& row, int column, const char* what) {
  if (row.is_null(column)) refuse(text::joined(what, " that is no number, expected a whole one"));
  return row.integer(column);
}

/// A number from `lowest` to `count` - 1.
int number_at(const text::RowReader& row, int column, int lowest, int count, const char* what) {
  const std::int64_t number = integer_at(row, column, what);
  if (number < lowest || number >= count) {
    refuse(text::joined(what, " of ", number, ", which is not there, expected ", lowest, " to ",
                        count - 1));
  }
  return static_cast<int>(number);
}

void check_place(const text::RowReader& row, std::ptrdiff_t place, const char* what) {
  if (integer_at(row, 0, what) != place) {
    refuse(text::joined(what, " that is misnumbered, expected ", place));
  }
}

/// How often something was measured.
int count_at(const text::RowReader& row, int column, int least, const char* what) {
  constexpr std::int64_t kMost = 1'000'000'000;
  const std::int64_t count = integer_at(row, column, what);
  if (count < least || count > kMost) {
    refuse(text::joined(what, " without traversals, expected ", least, " or more"));
  }
  return static_cast<int>(count);
}

bool flag_at(const text::RowReader& row, int column, const char* what) {
  const std::int64_t flag = integer_at(row, column, what);
  if (flag != 0 && flag != 1) refuse(text::joined(what, " of ", flag, ", expected 0 or 1"));
  return flag == 1;
}

Average average_at(const text::RowReader& row, int column, int least, const char* what) {
  Average average;
  average.count = count_at(row, column, least, what);
  average.mean = finite(row, column + 1, what);
  average.variance = finite(row, column + 2, what);
  if (average.count > 0 && !(average.variance > 0.0)) {
    refuse(text::joined(what, " without variance, expected one above 0"));
  }
  return average;
}

void put_average(text::RowWriter& row, int column, const Average& average) {
  row.bind(column, average.count).bind(column + 1, average.mean);
  row.bind(column + 2, average.variance);
}

/// What loops hang on must end somewhere.
void check_roots(const std::vector<int>& roots) {
  std::vector<bool> ends(roots.size(), false);
  for (std::size_t k = 0; k < roots.size(); ++k) {
    std::vector<int> way;
    for (int at = static_cast<int>(k); at >= 0 && !ends[idx(at)]; at = roots[idx(at)]) {
      way.push_back(at);
      if (way.size() > roots.size()) refuse("loops that hang on themselves");
    }
    for (const int at : way) ends[idx(at)] = true;
  }
}

/// Tables into a memory, one after the other.
class Loading {
 public:
  Loading(MemoryTables& tables, const MapBuilderOptions& options)
      : tables_(tables), weighed_(weighs_each(options)), memory_(options.gate) {}

  BuilderMemory all() {
    load_landmarks();
    load_routes();
    load_corners();
    load_reckoned();
    load_chain();
    load_gate();
    load_state();
    return std::move(memory_);
  }

 private:
  void load_landmarks();
  void load_routes();
  void load_corners();
  void load_reckoned();
  void load_chain();
  void load_gate();
  void load_state();
  void take_state(const text::RowReader& row);
  [[nodiscard]] int landmark_at(const text::RowReader& row, int column, const char* what) const {
    return number_at(row, column, 0, memory_.graph.landmarks(), what);
  }

  MemoryTables& tables_;
  bool weighed_;
  BuilderMemory memory_;
  std::vector<int> roots_;
};

void Loading::load_landmarks() {
  LandmarkGraph& graph = memory_.graph;
  const int count = tables_.rows(kLandmarksTable);
  tables_.each(kLandmarksTable, [&](const text::RowReader& row) {
    check_place(row, graph.landmarks(), "a landmark");
    graph.add_landmark(row.text(1), vector_at(row, 2, "a place"));
    roots_.push_back(number_at(row, 4, -1, count, "a loop"));
  });
  // An index that was damaged counts others than there are.
  if (graph.landmarks() != count) refuse("landmarks that are not all there");
  check_roots(roots_);
}

void Loading::load_routes() {
  LandmarkGraph& graph = memory_.graph;
  tables_.each(kRoutesTable, [&](const text::RowReader& row) {
    Route route;
    route.source = landmark_at(row, 1, "a route");
    route.target = landmark_at(row, 2, "a route");
    check_place(row, graph.routes(), "a route");
    route.traversals = count_at(row, 3, 1, "a route");
    route.stretch = finite(row, 4, "a route");
    route.orientation = finite(row, 5, "a route");
    route.displacement = vector_at(row, 6, "a route");
    route.covariance = matrix_at(row, 8, "a route");
    graph.set_route(graph.add_route(route.source, route.target), route);
    if (weighed_ && row.is_null(11)) {  // of legs in the robot's own axes alone
      memory_.weighed.emplace_back();
    } else if (weighed_) {
      memory_.weighed.push_back({matrix_at(row, 11, "a bar"), vector_at(row, 14, "a bar")});
    }
  });
}

void Loading::load_corners() {
  tables_.each(kCornersTable, [&](const text::RowReader& row) {
    check_place(row, std::ssize(memory_.corners), "a corner");
    CornerAverage one;
    one.i = landmark_at(row, 1, "a corner");
    one.j = landmark_at(row, 2, "a corner");
    one.k = landmark_at(row, 3, "a corner");
    one.angle = average_at(row, 4, 1, "a corner");
    if (one.i >= one.k || !memory_.graph.route_between(one.i, one.j) ||
        !memory_.graph.route_between(one.j, one.k)) {
      refuse("a corner between routes that are not there");
    }
    memory_.corners.push_back(one);
  });
}

void Loading::load_reckoned() {
  const int routes = memory_.graph.routes();
  const int corners = static_cast<int>(memory_.corners.size());
  std::vector<bool> taken(idx(routes), false);
  tables_.each(kReckonedTable, [&](const text::RowReader& row) {
    check_place(row, std::ssize(memory_.reckoned), "a length");
    ReckonedRoute one;
    one.route = number_at(row, 1, 0, routes, "a length");
    if (taken[idx(one.route)]) refuse("two lengths of a route, expected one");
    taken[idx(one.route)] = true;
    one.length = average_at(row, 2, 1, "a length");
    one.direction = average_at(row, 5, 0, "a direction");
    one.corner = number_at(row, 8, -1, corners, "a corner");
    one.bar.source = memory_.graph.route(one.route).source;
    one.bar.target = memory_.graph.route(one.route).target;
    one.bar.traversals = count_at(row, 9, 0, "a bar");
    one.bar.stretch = finite(row, 10, "a bar");
    one.bar.orientation = finite(row, 11, "a bar");
    one.bar.displacement = vector_at(row, 12, "a bar");
    if (one.bar.traversals > 0) one.bar.covariance = matrix_at(row, 14, "a bar");
    memory_.reckoned.push_back(one);
  });
}

void Loading::load_chain() {
  std::vector<int> chain;
  tables_.each(kChainTable, [&](const text::RowReader& row) {
    const int landmark = landmark_at(row, 1, "a chain");
    if (!chain.empty() && !memory_.graph.route_between(chain.back(), landmark)) {
      refuse("a chain along a route that is not there");
    }
    chain.push_back(landmark);
  });
  memory_.chain = OpenChain(std::move(chain), std::move(roots_));
}

void Loading::load_gate() {
  tables_.each(kMisfitsTable, [&](const text::RowReader& row) {
    memory_.gate.remember(finite(row, 1, "a misfit"));
  });
  tables_.each(kLeftOutTable, [&](const text::RowReader& row) {
    LeftOutArrival one;
    one.from = memory_.graph.landmark(landmark_at(row, 1, "a leg")).name;
    one.to = memory_.graph.landmark(landmark_at(row, 2, "a leg")).name;
    one.leg = {vector_at(row, 3, "a leg"), matrix_at(row, 5, "a leg")};
    one.sds = finite(row, 8, "a leg");
    one.own_axes = flag_at(row, 9, "a leg");
    memory_.left_out.push_back(one);
  });
}

void Loading::load_state() {
  bool there = false;
  tables_.each(kStateTable, [&](const text::RowReader& row) {
    if (there) refuse("two states, expected one");
    there = true;
    take_state(row);
  });
  if (!there) refuse("no state, expected one");
}

void Loading::take_state(const text::RowReader& row) {
  const int count = memory_.graph.landmarks();
  memory_.here = number_at(row, 0, -1, count, "a state");
  memory_.said = number_at(row, 1, -1, count, "a state");
  if (!row.is_null(2)) {
    if (memory_.here < 0) refuse("a leg from nowhere");
    memory_.carried = Traversal{vector_at(row, 2, "a leg"), matrix_at(row, 4, "a leg")};
  }
  memory_.frame = static_cast<Frame>(number_at(row, 7, 0, 3, "a frame"));
  memory_.first_direction =
      number_at(row, 8, -1, static_cast<int>(memory_.reckoned.size()), "a direction");
  memory_.seen.offset_robot = vector_at(row, 9, "an offset");
  memory_.seen.covariance_robot = symmetric_at(row, 11, "an offset");
  const auto estimate = [&row](int column, const char* what) {
    return HeadingEstimate{finite(row, column, what), finite(row, column + 1, what)};
  };
  if (!row.is_null(14)) memory_.heading = estimate(14, "a heading");
  if (!row.is_null(16)) {
    EarlierChord earlier;
    earlier.landmark = number_at(row, 16, 0, count, "a chord");
    earlier.beta = {finite(row, 17, "a chord"), finite(row, 18, "a chord"),
                    vector_at(row, 19, "a chord")};
    if (memory_.here < 0 || !memory_.graph.route_between(earlier.landmark, memory_.here)) {
      refuse("a chord without a route");
    }
    memory_.earlier = earlier;
  }
  if (!row.is_null(21)) memory_.reading = estimate(21, "a reading");
  if (row.is_null(23)) return;
  CarriedMotion carried;
  carried.motion.displacement = {finite(row, 23, "a motion"), finite(row, 24, "a motion"),
                                 finite(row, 25, "a motion")};
  for (int k = 0; k < 6; ++k) {
    const auto [r, c] = kUpper[idx(k)];
    carried.motion.covariance(r, c) = carried.motion.covariance(c, r) =
        finite(row, 26 + k, "a motion");
  }
  carried.seen.offset_robot = vector_at(row, 32, "an offset");
  carried.seen.covariance_robot = symmetric_at(row, 34, "an offset");
  if (!row.is_null(37)) carried.reading = estimate(37, "a reading");
  if (memory_.here < 0 || memory_.said < 0) refuse("a motion from nowhere");
  memory_.carried_motion = carried;
}

}  // namespace

BuilderMemory load_memory(MemoryTables& tables, const MapBuilderOptions& options) {
  return Loading(tables, options).all();
}

MapBuilderOptions options_in(const text::RowReader& row) {
  MapBuilderOptions options;
  options.method = named(kMethods, row.text(0), "a method");
  options.scope.kind = named(kScopes, row.text(1), "a scope");
  options.scope.eta = number_at(row, 2, 2, 1'000'000'001, "an eta");
  options.scope.groups = flag_at(row, 3, "groups");
  options.law = named(kLaws, row.text(4), "a law");
  options.refine = flag_at(row, 5, "refine");
  options.pooled = flag_at(row, 6, "pooled");
  options.gate = row.is_null(7) ? 0.0 : row.real(7);
  if (!(options.gate > 0.0)) refuse("a gate that is no number above 0");
  return options;
}

void put_options(text::RowWriter& row, const MapBuilderOptions& options) {
  row.bind(0, word_for(options.method)).bind(1, word_for(options.scope.kind));
  row.bind(2, options.scope.eta).bind(3, options.scope.groups ? 1 : 0);
  row.bind(4, word_for(options.law)).bind(5, options.refine ? 1 : 0);
  row.bind(6, options.pooled ? 1 : 0).bind(7, options.gate);
}

int root_of(const BuilderMemory& memory, int landmark) {
  const std::vector<int>& roots = memory.chain.roots();
  return idx(landmark) < roots.size() ? roots[idx(landmark)] : -1;
}

void put_landmark(text::RowWriter& row, const BuilderMemory& memory, int number) {
  const Landmark& landmark = memory.graph.landmark(number);
  row.bind(0, number).bind(1, landmark.name).bind(2, landmark.position);
  row.bind(4, root_of(memory, number));
}

void put_route(text::RowWriter& row, const BuilderMemory& memory, int number, bool weighed) {
  const Route& route = memory.graph.route(number);
  row.bind(0, number).bind(1, route.source).bind(2, route.target).bind(3, route.traversals);
  row.bind(4, route.stretch).bind(5, route.orientation).bind(6, route.displacement);
  row.bind(8, route.covariance);
  if (!weighed || !(memory.weighed[idx(number)].information(0, 0) > 0.0)) return;
  row.bind(11, memory.weighed[idx(number)].information);
  row.bind(14, memory.weighed[idx(number)].mean);
}

void put_corner(text::RowWriter& row, const BuilderMemory& memory, int number) {
  const CornerAverage& one = memory.corners[idx(number)];
  row.bind(0, number).bind(1, one.i).bind(2, one.j).bind(3, one.k);
  put_average(row, 4, one.angle);
}

void put_reckoned(text::RowWriter& row, const BuilderMemory& memory, int number) {
  const ReckonedRoute& one = memory.reckoned[idx(number)];
  row.bind(0, number).bind(1, one.route);
  put_average(row, 2, one.length);
  put_average(row, 5, one.direction);
  row.bind(8, one.corner).bind(9, one.bar.traversals).bind(10, one.bar.stretch);
  row.bind(11, one.bar.orientation).bind(12, one.bar.displacement).bind(14, one.bar.covariance);
}

void put_link(text::RowWriter& row, const BuilderMemory& memory, int place) {
  row.bind(0, place).bind(1, memory.chain.landmarks()[idx(place)]);
}

void put_misfit(text::RowWriter& row, const BuilderMemory& memory, int place) {
  row.bind(0, place).bind(1, memory.gate.remembered()[idx(place)]);
}

void put_left_out(text::RowWriter& row, const BuilderMemory& memory, int place) {
  const LeftOutArrival& one = memory.left_out[idx(place)];
  row.bind(0, place).bind(1, *memory.graph.find(one.from)).bind(2, *memory.graph.find(one.to));
  row.bind(3, one.leg.displacement).bind(5, one.leg.covariance).bind(8, one.sds);
  row.bind(9, one.own_axes ? 1 : 0);
}

void put_state(text::RowWriter& row, const BuilderMemory& memory) {
  row.bind(0, memory.here).bind(1, memory.said);
  if (memory.carried) {
    row.bind(2, memory.carried->displacement).bind(4, memory.carried->covariance);
  }
  row.bind(7, static_cast<int>(memory.frame)).bind(8, memory.first_direction);
  row.bind(9, memory.seen.offset_robot).bind(11, memory.seen.covariance_robot);
  if (memory.heading) row.bind(14, memory.heading->heading).bind(15, memory.heading->variance);
  if (memory.earlier) {
    const SharedAngle& beta = memory.earlier->beta;
    row.bind(16, memory.earlier->landmark).bind(17, beta.value).bind(18, beta.variance);
    row.bind(19, beta.by_offset);
  }
  if (memory.reading) row.bind(21, memory.reading->heading).bind(22, memory.reading->variance);
  if (!memory.carried_motion) return;
  const auto& [motion, seen, reading] = *memory.carried_motion;
  const Pose& moved = motion.displacement;
  row.bind(23, moved.x).bind(24, moved.y).bind(25, moved.heading);
  for (int k = 0; k < 6; ++k) {
    const auto [r, c] = kUpper[idx(k)];
    row.bind(26 + k, motion.covariance(r, c));
  }
  row.bind(32, seen.offset_robot).bind(34, seen.covariance_robot);
  if (reading) row.bind(37, reading->heading).bind(38, reading->variance);
}

}  // namespace trussmap::map
