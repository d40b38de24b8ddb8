// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How a map keeps its landmarks and routes: LandmarkGraph beside boost::adjacency_list with the
// same landmarks and routes as bundled properties, on what a map builder does.
//
//   grow            a robot ploughs a square mesh: every landmark by the route that leads to it,
//                   and a route to the row before; no name and no route comes twice
//   neighbourhood   all fields of all routes at 50 landmarks beside each other, anywhere in the map
//   fetched         the same, after memory was asked for all of it at once, as refinement does
//   route_between   two landmarks: half of the pairs are joined, half are diagonal neighbours
//   names alone     of grow: the table of names, which all have
//
// Boost's lists of edges have no numbers of routes (edges vecS: their places), and a call that
// throws halfway leaves Boost's graphs halfway; LandmarkGraph gives both in these figures. "with
// routes_at" has what LandmarkGraph's callers need: a route by its number, and the numbers of the
// routes at a landmark.
//
// Every rival is in a process of its own, they take turns; of each round's ratios the
// median, the least and the most.
#include "scale/measure.hpp"
#include "trussmap/landmark_map.hpp"

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <boost/graph/adjacency_list.hpp>
#include <fmt/format.h>

namespace trussmap::bench {
namespace {

constexpr int kColumns = 10;  // of a neighbourhood, and
constexpr int kRows = 5;
constexpr std::size_t kMembers = 50;

struct Options {
  int side = 1000;
  int neighbourhoods = 20000;
  int pairs = 1000000;
  int rounds = 7;
};

/// Landmarks of a square mesh, numbered as the robot meets them: there and back, row after row.
struct Ploughed {
  int side;

  [[nodiscard]] int number(int column, int row) const {
    return row * side + (row % 2 == 0 ? column : side - 1 - column);
  }
  [[nodiscard]] int column(int number) const {
    const int along = number % side;
    return number / side % 2 == 0 ? along : side - 1 - along;
  }
};

/// What all rivals answer.
double read(const Route& route, int other) {
  return route.stretch + route.orientation + route.displacement.sum() + route.covariance.sum() +
         route.traversals + other;
}

class Ours {
 public:
  void add_first(const std::string& name) { map_.add_landmark(name, Vector2::Zero()); }
  void add_landmark(const std::string& name, int from, const Traversal& traversal) {
    map_.add_landmark(name, from, traversal);
  }
  void add_traversal(int from, int to, const Traversal& traversal) {
    map_.add_traversal(from, to, traversal);
  }
  [[nodiscard]] double read_at(int landmark) const {
    double sum = 0.0;
    for (const int number : map_.routes_at(landmark)) {
      const Route& route = map_.route(number);
      sum += read(route, other_end(route, landmark));
    }
    return sum;
  }
  void fetch(const std::vector<int>& members) const {
    for (const int landmark : members) __builtin_prefetch(&map_.routes_at(landmark));
    for (const int landmark : members) __builtin_prefetch(map_.routes_at(landmark).data());
    for (const int landmark : members) {
      for (const int number : map_.routes_at(landmark)) {
        __builtin_prefetch(&map_.route(number).source);
        __builtin_prefetch(&map_.route(number).covariance);
      }
    }
  }
  [[nodiscard]] bool joined(int a, int b) const { return map_.route_between(a, b).has_value(); }

 private:
  LandmarkGraph map_;
};

template <typename OutEdges, typename Edges, bool kNumbered = false>
class Listed {
 public:
  using Graph = boost::adjacency_list<OutEdges, boost::vecS, boost::undirectedS, Landmark, Route,
                                      boost::no_property, Edges>;

  void add_first(const std::string& name) { add(name, Vector2::Zero()); }
  void add_landmark(const std::string& name, int from, const Traversal& traversal) {
    const auto begin = at(from);
    const std::size_t number = add(name, graph_[begin].position + traversal.displacement);
    join(begin, number, averaged(from, static_cast<int>(number), traversal));
  }
  void add_traversal(int from, int to, const Traversal& traversal) {
    const auto [known, there] = edge(at(from), at(to), graph_);
    if (there) {
      Route& route = graph_[known];
      average_in(route, route.source == from ? traversal : reversed(traversal));
    } else {
      join(at(from), at(to), averaged(from, to, traversal));
    }
  }
  [[nodiscard]] double read_at(int landmark) const {
    double sum = 0.0;
    const auto [begin, end] = out_edges(at(landmark), graph_);
    for (auto one = begin; one != end; ++one) {
      sum += read(graph_[*one], static_cast<int>(target(*one, graph_)));
    }
    return sum;
  }
  void fetch(const std::vector<int>& members) const {
    for (const int landmark : members) __builtin_prefetch(&graph_.out_edge_list(at(landmark)));
    if constexpr (std::is_same_v<OutEdges, boost::vecS>) {
      for (const int landmark : members) {
        __builtin_prefetch(graph_.out_edge_list(at(landmark)).data());
      }
      for (const int landmark : members) {
        const auto [begin, end] = out_edges(at(landmark), graph_);
        for (auto one = begin; one != end; ++one) {
          __builtin_prefetch(&graph_[*one].source);
          __builtin_prefetch(&graph_[*one].covariance);
        }
      }
    }
  }
  [[nodiscard]] bool joined(int a, int b) const { return edge(at(a), at(b), graph_).second; }

 private:
  static std::size_t at(int landmark) { return static_cast<std::size_t>(landmark); }

  std::size_t add(const std::string& name, const Vector2& position) {
    const auto number = static_cast<int>(num_vertices(graph_));
    if (name.empty() || !numbers_.emplace(name, number).second) {
      throw std::invalid_argument("no name, or taken");
    }
    if constexpr (kNumbered) routes_at_.emplace_back();
    return add_vertex(Landmark{name, position, std::nullopt}, graph_);
  }
  void join(std::size_t from, std::size_t to, const Route& route) {
    const auto added = add_edge(from, to, route, graph_).first;
    if constexpr (kNumbered) {
      const auto number = static_cast<int>(routes_.size());
      routes_.push_back(added);
      routes_at_[from].push_back(number);
      routes_at_[to].push_back(number);
    }
  }
  static Route averaged(int from, int to, const Traversal& traversal) {
    Route route;
    route.source = from;
    route.target = to;
    average_in(route, traversal);
    return route;
  }

  Graph graph_;
  std::vector<typename Graph::edge_descriptor> routes_;  ///< by number
  std::vector<std::vector<int>> routes_at_;
  std::unordered_map<std::string, int> numbers_;
};

template <typename Map>
void grow(Map& map, const Ploughed& mesh) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0.9, 1.1);
  const auto measure = [&](double x, double y) {
    return Traversal{uniform(random) * Vector2(x, y), 0.01 * Matrix2::Identity()};
  };
  map.add_first("L0");
  for (int k = 1; k < mesh.side * mesh.side; ++k) {
    const int row = k / mesh.side;
    const bool turns = k % mesh.side == 0;
    const double along = row % 2 == 0 ? 1.0 : -1.0;
    map.add_landmark("L" + std::to_string(k), k - 1,
                     turns ? measure(0.0, 1.0) : measure(along, 0.0));
    if (row > 0 && !turns) {
      map.add_traversal(k, mesh.number(mesh.column(k), row - 1), measure(0.0, -1.0));
    }
  }
}

template <typename Map>
double read_neighbourhoods(const Map& map, const Ploughed& mesh, int count, bool fetched) {
  std::mt19937_64 random(2);
  std::uniform_int_distribution<int> columns(0, mesh.side - kColumns);
  std::uniform_int_distribution<int> rows(0, mesh.side - kRows);
  std::vector<int> members(kMembers);
  double sum = 0.0;
  for (int n = 0; n < count; ++n) {
    const int column = columns(random);
    const int row = rows(random);
    for (std::size_t k = 0; k < members.size(); ++k) {
      const int place = static_cast<int>(k);
      members[k] = mesh.number(column + place % kColumns, row + place / kColumns);
    }
    if (fetched) map.fetch(members);
    for (const int landmark : members) sum += map.read_at(landmark);
  }
  return sum;
}

template <typename Map>
double look_up(const Map& map, const Ploughed& mesh, int count) {
  std::mt19937_64 random(3);
  std::uniform_int_distribution<int> place(0, mesh.side - 2);
  int found = 0;
  for (int k = 0; k < count; ++k) {
    const int column = place(random);
    const int row = place(random);
    const int a = mesh.number(column, row);
    found += map.joined(a, mesh.number(column + 1, row + k % 2)) ? 1 : 0;
  }
  return found;
}

template <typename Map>
double work(const Options& options, Stages& stages) {
  const Ploughed mesh{options.side};
  Map map;
  grow(map, mesh);
  stages.end("grow");
  double answer = read_neighbourhoods(map, mesh, options.neighbourhoods, false);
  stages.end("neighbourhood");
  answer += read_neighbourhoods(map, mesh, options.neighbourhoods, true);
  stages.end("fetched");
  answer += look_up(map, mesh, options.pairs);
  stages.end("route_between");
  return answer;
}

double names_alone(const Options& options, Stages& stages) {
  std::unordered_map<std::string, int> numbers;
  for (int k = 0; k < options.side * options.side; ++k) {
    numbers.emplace("L" + std::to_string(k), k);
  }
  stages.end("grow");
  return static_cast<double>(numbers.size());
}

void compare(const Options& options) {
  using boost::hash_setS, boost::listS, boost::setS, boost::vecS;
  const auto rival = [&options](const std::string& name, auto run) {
    return Rival{name, [=](Stages& stages) { return run(options, stages); }};
  };
  const std::vector<Rival> rivals{
      rival("LandmarkGraph", work<Ours>),
      rival("vecS, edges listS (default)", work<Listed<vecS, listS>>),
      rival("vecS, edges vecS", work<Listed<vecS, vecS>>),
      rival("vecS, edges vecS, with routes_at", work<Listed<vecS, vecS, true>>),
      rival("setS, edges listS", work<Listed<setS, listS>>),
      rival("hash_setS, edges listS", work<Listed<hash_setS, listS>>),
      rival("names alone", names_alone)};
  std::vector<std::vector<Run>> rounds;
  for (int round = 0; round < options.rounds; ++round) rounds.push_back(race(rivals, 1));
  fmt::print("over LandmarkGraph:\n");
  for (std::size_t k = 1; k < rivals.size(); ++k) {
    std::string line = fmt::format("  {:<33}", rivals[k].name);
    for (const auto& stage : rounds.front()[k].stages.stages) {
      std::vector<double> ratios;
      for (const std::vector<Run>& runs : rounds) {
        ratios.push_back(runs[k].stages.of(stage.name) / runs.front().stages.of(stage.name));
      }
      line += fmt::format(" {} {:.2f} ({:.2f} to {:.2f})", stage.name, percentile(ratios, 0.5),
                          percentile(ratios, 0.0), percentile(ratios, 1.0));
    }
    const std::vector<Run>& last = rounds.back();
    fmt::print("{} memory {:.2f}\n", line, last[k].megabytes / last.front().megabytes);
    const double ours = last.front().answer;
    if (last[k].stages.stages.size() > 1 &&
        !(std::abs(last[k].answer - ours) <= 1e-9 * std::abs(ours))) {
      throw std::runtime_error(rivals[k].name + " answers otherwise");
    }
  }
}

}  // namespace
}  // namespace trussmap::bench

int main(int argc, char** argv) {
  try {
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
    CLI::App app("LandmarkGraph beside boost::adjacency_list");
    trussmap::bench::Options options;
    app.add_option("--side", options.side, "landmarks along a side of the mesh, at least 10")
        ->check(CLI::Range(10, 10000))
        ->capture_default_str();
    app.add_option("--neighbourhoods", options.neighbourhoods)->capture_default_str();
    app.add_option("--pairs", options.pairs)->capture_default_str();
    app.add_option("--rounds", options.rounds)->check(CLI::PositiveNumber)->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    trussmap::bench::compare(options);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
