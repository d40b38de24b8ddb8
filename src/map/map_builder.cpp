// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/map_builder.hpp"

#include "geometry/index.hpp"
#include "geometry/make_room.hpp"
#include "linalg/connected_parts.hpp"
#include "map/builder_state.hpp"
#include "map/memory_file.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <Eigen/LU>

namespace trussmap {
using namespace map;

namespace {

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
  std::vector<linalg::NodePair> ties;
  ties.reserve(idx(map.routes()));
  for (int number = 0; number < map.routes(); ++number) {
    ties.push_back({map.route(number).source, map.route(number).target});
  }
  const std::vector<int> part = linalg::connected_parts(map.landmarks(), ties);
  for (int k = 1; k < map.landmarks(); ++k) {
    if (part[idx(k)] == part[0]) continue;
    throw SolveError("landmark " + map.landmark(k).name +
                     " is tied to nothing: no chain of routes leads to it from landmark " +
                     map.landmark(0).name);
  }
}

void check_landmark(int number, int count) {
  if (number >= 0 && number < count) return;
  if (count == 0)
    throw std::invalid_argument("the map has no landmark yet, expected start() before");
  throw std::invalid_argument(
      text::joined("the map has no landmark number ", number, ", expected 0 to ", count - 1));
}

/// All landmarks settled, and the routes' averages as they are.
BuilderMemory memory_of(const LandmarkGraph& map, const MapBuilderOptions& options) {
  BuilderMemory memory(options.gate);
  for (int number = 0; number < map.routes(); ++number) {
    const Route& route = map.route(number);
    check({route.displacement, route.covariance});
    if (route.traversals < 1) throw std::invalid_argument("a route has a traversal at least");
  }
  check_tied(map);
  for (int k = 0; k < map.landmarks(); ++k) {  // without covariances, which would soon be wrong
    memory.graph.add_landmark(map.landmark(k).name, map.landmark(k).position);
  }
  for (int number = 0; number < map.routes(); ++number) {
    const Route& route = map.route(number);
    memory.graph.set_route(memory.graph.add_route(route.source, route.target), route);
    const Matrix2 information = route.traversals * route.covariance.inverse();
    memory.weighed.push_back({information, route.displacement});
  }
  memory.chain.reserve(map.landmarks());
  if (map.routes() > 0) memory.frame = Frame::axes;
  return memory;
}

/// Makes the call and puts it into the journal, if there is one: both or neither.
template <typename Call>
auto journaled(std::vector<BuilderCall>* journal, BuilderCall entry, const Call& call) {
  if (journal != nullptr) geometry::make_room(*journal);
  auto result = call(entry);
  if (journal != nullptr) journal->push_back(entry);
  return result;
}

/// An arrival or an observation; the entry learns what became of it.
template <typename Call>
Arrival measured(std::vector<BuilderCall>* journal, const BuilderCall& entry, const Call& call) {
  return journaled(journal, entry, [&](BuilderCall& made) {
    Arrival arrival = call();
    made.to = arrival.landmark;
    made.outcome = arrival.kind;
    return arrival;
  });
}

BuilderCall reckoned(BuilderCall::Kind kind, int from, const Motion& motion,
                     const LandmarkOffset& seen) {
  BuilderCall entry{.kind = kind, .from = from};
  entry.reckoned = true;
  entry.motion = motion;
  entry.seen = seen;
  return entry;
}

std::string content_of(const std::filesystem::path& file) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed)) {
    throw InputError(file.string(), 0,
                     std::filesystem::exists(file, failed)
                         ? "is no file, expected one that a map builder was saved in"
                         : "is not there, expected a file that a map builder was saved in");
  }
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  const bool empty = std::filesystem::file_size(file, failed) == 0;
  if (!stream || (!empty && !(content << stream.rdbuf()))) {
    throw InputError(file.string(), 0, "cannot be read");
  }
  return content.str();
}

}  // namespace

MapBuilder::MapBuilder(const MapBuilderOptions& options)
    : state_(std::make_unique<State>(options, BuilderMemory(options.gate))) {}
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

BuilderMemory BuilderAccess::settled_memory(const MapBuilder& builder) {
  return builder.state_->settled_memory();
}

const BuilderMemory& BuilderAccess::settle_memory(MapBuilder& builder) {
  return builder.state_->settle_memory();
}

bool BuilderAccess::has_journal(const MapBuilder& builder,
                                const std::vector<BuilderCall>* journal) {
  return builder.state_ && builder.state_->journal == journal;
}

void BuilderAccess::keep_journal(MapBuilder& builder, std::vector<BuilderCall>* journal) {
  builder.state_->journal = journal;
}

void MapBuilder::start(const std::string& landmark, const Vector2& position) {
  start(landmark, LandmarkOffset{}, position);
}

void MapBuilder::start(const std::string& landmark, const LandmarkOffset& seen,
                       const Vector2& position) {
  BuilderCall entry{.kind = BuilderCall::Kind::start, .leg = {position, Matrix2::Zero()}};
  entry.seen = seen;
  journaled(state_->journal, entry, [&](BuilderCall& made) {
    state_->start(landmark, seen, position);
    return made.to = here();
  });
}

void MapBuilder::compass(double reading, double sd) {
  BuilderCall entry{.kind = BuilderCall::Kind::compass, .from = state_->memory().said};
  entry.motion.displacement.heading = reading;
  entry.motion.covariance(2, 2) = sd * sd;
  journaled(state_->journal, entry, [&](BuilderCall&) {
    state_->compass(reading, sd);
    return true;
  });
}

Arrival MapBuilder::arrive(const std::string& landmark, const Traversal& given) {
  const BuilderCall entry{
      .kind = BuilderCall::Kind::arrive, .from = state_->memory().said, .leg = checked(given)};
  return measured(state_->journal, entry, [&] { return state_->arrive(landmark, entry.leg); });
}

Arrival MapBuilder::observe(const std::string& landmark, const Traversal& given) {
  const BuilderCall entry{
      .kind = BuilderCall::Kind::observe, .from = state_->memory().said, .leg = checked(given)};
  return measured(state_->journal, entry, [&] { return state_->observe(landmark, entry.leg); });
}

Arrival MapBuilder::arrive(const std::string& landmark, const Motion& motion,
                           const LandmarkOffset& seen) {
  const BuilderCall entry =
      reckoned(BuilderCall::Kind::arrive, state_->memory().said, motion, seen);
  return measured(state_->journal, entry, [&] { return state_->arrive(landmark, motion, seen); });
}

Arrival MapBuilder::observe(const std::string& landmark, const LandmarkOffset& seen) {
  const BuilderCall entry =
      reckoned(BuilderCall::Kind::observe, state_->memory().said, Motion{}, seen);
  return measured(state_->journal, entry, [&] { return state_->observe(landmark, seen); });
}

double MapBuilder::relax() {
  return journaled(state_->journal, {.kind = BuilderCall::Kind::relax},
                   [&](BuilderCall&) { return state_->relax(); });
}

double MapBuilder::energy() const {
  return state_->mechanics().energy();
}

const std::vector<LeftOutArrival>& MapBuilder::left_out() const {
  return state_->memory().left_out;
}

const MapBuilderOptions& MapBuilder::options() const {
  return state_->options();
}
void MapBuilder::set_options(const MapBuilderOptions& options) {
  state_->set_options(options);
}

int MapBuilder::here() const {
  return state_->memory().here;
}
std::optional<PoseEstimate> MapBuilder::pose() const {
  return state_->pose();
}
int MapBuilder::landmarks() const {
  return state_->graph().landmarks();
}

std::optional<int> MapBuilder::find(const std::string& landmark) const {
  return state_->graph().find(landmark);
}

Vector2 MapBuilder::position(int landmark) const {
  check_landmark(landmark, landmarks());
  return state_->position(landmark);
}

const std::string& MapBuilder::name(int landmark) const {
  check_landmark(landmark, landmarks());
  return state_->graph().landmark(landmark).name;
}

std::vector<int> MapBuilder::nearest(const Vector2& point, int count) const {
  if (count < 1) throw std::invalid_argument("expected one nearest landmark at least");
  if (landmarks() == 0) return {};
  std::vector<int> near = state_->mechanics().nearest(point, std::min(count, landmarks()));
  const auto distance = [&](int k) { return (position(k) - point).squaredNorm(); };
  std::stable_sort(near.begin(), near.end(),
                   [&](int a, int b) { return distance(a) < distance(b); });
  return near;
}

std::optional<Route> MapBuilder::route_between(int a, int b) const {
  const auto number = state_->graph().route_between(a, b);
  if (!number) return std::nullopt;
  return state_->graph().route(*number);
}

Matrix2 MapBuilder::covariance_between(int a, int b) const {
  check_landmark(a, landmarks());
  check_landmark(b, landmarks());
  return a == b ? Matrix2(Matrix2::Zero()) : state_->covariance_between(a, b);
}

std::vector<Matrix2> MapBuilder::covariances() const {
  return state_->covariances();
}

std::vector<double> MapBuilder::expected_falls(const std::vector<std::vector<int>>& ways) const {
  return state_->expected_falls(ways);
}

std::vector<int> MapBuilder::path(int from, int to, PathBy by) const {
  return trussmap::path(state_->graph(), from, to, by);
}

LandmarkGraph MapBuilder::map() const {
  return state_->map();
}

void MapBuilder::save(const std::filesystem::path& file) {
  const std::string text = format_memory(state_->settled_memory(), state_->options());
  // As it is read: what cannot be read is not written.
  KeptMemory kept = parse_memory(text, file.string());
  auto next = std::make_unique<State>(kept.options, std::move(kept.memory));
  next->journal = state_->journal;
  write_file(file, text);
  state_ = std::move(next);
}

MapBuilder MapBuilder::load(const std::filesystem::path& file) {
  KeptMemory kept = parse_memory(content_of(file), file.string());
  return BuilderAccess::restored(std::move(kept.memory), kept.options);
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

std::string name_of(Arrival::Kind kind) {
  switch (kind) {
    case Arrival::Kind::new_landmark:
      return "new landmark";
    case Arrival::Kind::first_sight:
      return "loop closed";
    case Arrival::Kind::new_route:
      return "new route";
    case Arrival::Kind::refinement:
      return "known route";
    case Arrival::Kind::left_out:
      return "left out";
    case Arrival::Kind::found_again:
      return "found again";
  }
  return "unknown";
}

}  // namespace trussmap
