// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Fields over the floor: are they told where there are some, is the map right, and is a circle
// still called a circle?
//
//   clean      nothing differs by place
//   travel, turn, creep, compass
//              that channel is a random field: 30 waves drawn from Matern's spectrum of smoothness
//              1, its length 1.5 to 4 times the shortest route
//   circle     a patch of the catalogue at three times the smallest detectable size
//
// A field's sd is `times` the noise: the median, over squares as wide as the shortest route, of
// the standard error that the driving within one gives its value where all other squares are known.
// `--unsmoothed`: that of a map where each has its own and none knows of its neighbours (their mean
// apart), which is larger.
// The correlation is that of the map's cells with the truth there.
#include "bench_program.hpp"
#include "bench_worlds.hpp"
#include "criticism/place_scores.hpp"
#include "linalg/dense.hpp"
#include "statistics/median.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/fit_model.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace trussmap::bench {
using namespace criticism;
namespace {

struct Options {
  std::uint64_t first = 1;
  int count = 12;
  int clean = 40;
  double times = 3.0;
  bool unsmoothed = false;
  bool verbose = false;
};

/// A field of sd 1 as waves.
struct Waves {
  struct Wave {
    Vector2 k;
    double phase;
  };
  std::vector<Wave> waves;

  [[nodiscard]] double amplitude() const {
    return std::sqrt(2.0 / static_cast<double>(waves.size()));
  }
  [[nodiscard]] double at(const Vector2& place) const {
    double sum = 0.0;
    for (const Wave& one : waves) sum += std::sin(one.k.dot(place) + one.phase);
    return amplitude() * sum;
  }
  [[nodiscard]] Effect as_effect(Channel channel, double sd) const {
    Effect effect;
    effect.name = "field";
    effect.channel = channel;
    for (const Wave& one : waves) {
      effect.shape.emplace_back(
          fmt::format("sin(({})*x+({})*y+{})", one.k.x(), one.k.y(), one.phase));
      effect.coefficients.push_back(sd * amplitude());
    }
    return effect;
  }
};

Waves draw_waves(double length, std::mt19937_64& random) {
  constexpr int kWaves = 30;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Waves field;
  for (int k = 0; k < kWaves; ++k) {
    const double u = uniform(random);
    const double number = std::sqrt(8.0) / length * std::sqrt(u / (1.0 - u));
    const double angle = 2.0 * std::numbers::pi * uniform(random);
    field.waves.push_back({number * Vector2(std::cos(angle), std::sin(angle)),
                           2.0 * std::numbers::pi * uniform(random)});
  }
  return field;
}

/// As the head of this file says; nothing where the channel cannot be seen.
std::optional<double> noise_of(const PlaceScores& scores, Channel channel, double side,
                               bool unsmoothed) {
  const auto found = std::find(scores.channels.begin(), scores.channels.end(), channel);
  if (found == scores.channels.end()) return std::nullopt;
  const Eigen::Index n = scores.count();
  const Eigen::Index first = n * (found - scores.channels.begin());
  std::map<std::pair<int, int>, Eigen::VectorXd> squares;
  for (Eigen::Index k = 0; k < n; ++k) {
    const Vector2 place = scores.grid.place_of(scores.nodes[static_cast<std::size_t>(k)]) / side;
    auto& square =
        squares[{static_cast<int>(std::floor(place.x())), static_cast<int>(std::floor(place.y()))}];
    if (square.size() == 0) square = Eigen::VectorXd::Zero(n);
    square[k] = 1.0;
  }
  Eigen::MatrixXd all(n, std::ssize(squares));
  Eigen::Index count = 0;
  for (const auto& [at, square] : squares) all.col(count++) = square;
  Eigen::MatrixXd G = all.transpose() * scores.G.block(first, first, n, n) * all;
  if (unsmoothed) {
    // The mean of all is held: it is a constant's.
    G.array() += G.diagonal().maxCoeff();
    G = linalg::DenseLdlt(G).inverse();
  } else {
    const Eigen::VectorXd variances = G.diagonal().cwiseInverse();
    G = variances.asDiagonal();
  }
  std::vector<double> errors;
  for (Eigen::Index k = 0; k < count; ++k) errors.push_back(std::sqrt(std::abs(G(k, k))));
  return statistics::median(std::move(errors));
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const Eigen::Map<const Eigen::VectorXd> x(a.data(), std::ssize(a));
  const Eigen::Map<const Eigen::VectorXd> y(b.data(), std::ssize(b));
  const Eigen::VectorXd dx = x.array() - x.mean();
  const Eigen::VectorXd dy = y.array() - y.mean();
  return dx.dot(dy) / std::max(1e-300, dx.norm() * dy.norm());
}

struct Tally {
  int worlds = 0;
  int told = 0;    ///< a field of the right channel
  int rivals = 0;  ///< of another, the right one its rival
  int others = 0;  ///< of another
  int patches = 0;
  std::vector<double> correlations;
  double within = 0.0;
  double cells = 0.0;
  std::vector<double> lengths;  ///< told over true
  double seconds = 0.0;
};

std::string what_is_said(const Diagnosis& result) {
  std::string text;
  for (const FieldOfPlaces& one : result.places) {
    text += fmt::format(" {} {} (sd {:.2g}, length {:.1f}, p {:.1e}, gain {:.0f}, told {:.2f});",
                        name_of(one.channel), one.is_field() ? "field" : "patch", one.size,
                        one.length, one.p_value, one.chi2_decrease, one.told);
  }
  text += " missing:";
  for (const Finding* one : found_by(result)) text += " " + one->effect.name + ";";
  return text;
}

/// The map against the field, both less their means over the map.
void compare_maps(const FieldOfPlaces& map, const Waves& field, double sd, Tally& tally) {
  std::vector<double> told, true_values, errors;
  for (const FieldCell& one : map.cells_driven()) {
    told.push_back(one.mean);
    errors.push_back(one.sd);
    true_values.push_back(sd * field.at(one.centre));
  }
  tally.correlations.push_back(correlation(told, true_values));
  double offset = 0.0;
  for (std::size_t k = 0; k < told.size(); ++k) offset += (true_values[k] - told[k]);
  offset /= static_cast<double>(told.size());
  for (std::size_t k = 0; k < told.size(); ++k) {
    tally.cells += 1.0;
    tally.within += std::abs(told[k] + offset - true_values[k]) < 1.96 * errors[k] ? 1.0 : 0.0;
  }
}

Diagnosis timed_diagnosis(const DrivenRecording& recording, const Model& model, Tally& tally) {
  const std::clock_t begun = std::clock();
  Diagnosis result = diagnose(std::vector<DrivenRecording>{recording}, model);
  tally.seconds += static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  return result;
}

void try_field(std::uint64_t seed, Channel channel, const Options& options, Tally& tally) {
  const World world = draw_world(seed);
  const ModelFit clean = fit_model({record_in(world, {})}, world.model);
  const auto scores = place_scores(*clean.state, ScoreTest(*clean.state), {});
  if (!scores) return;
  const double side = shortest_route(world.mesh);
  const auto noise = noise_of(*scores, channel, side, options.unsmoothed);
  if (!noise || options.times * *noise > facts_of(channel).prior_sd) return;
  std::mt19937_64 random(seed * 7919 + 29);
  const double length = side * std::uniform_real_distribution<double>(1.5, 4.0)(random);
  const Waves field = draw_waves(length, random);
  const double sd = options.times * *noise;
  const Diagnosis result =
      timed_diagnosis(record_in(world, {field.as_effect(channel, sd)}), world.model, tally);
  ++tally.worlds;
  for (const FieldOfPlaces& one : result.places) {
    if (one.channel != channel) {
      ++(std::ranges::find(one.rivals, channel) != one.rivals.end() ? tally.rivals : tally.others);
      continue;
    }
    tally.told += one.is_field() ? 1 : 0;
    tally.patches += one.is_field() ? 0 : 1;
    compare_maps(one, field, sd, tally);
    tally.lengths.push_back(one.length / length);
  }
  if (!options.verbose) return;
  fmt::print("  world {} ({} legs, {}): {} sd {:.2g}, length {:.1f}; r {:.2f};{}\n", seed,
             world.walk.size() - 1, world.surveyed ? "survey" : "none", name_of(channel), sd,
             length, tally.correlations.empty() ? 0.0 : tally.correlations.back(),
             what_is_said(result));
}

void run_field(Channel channel, const Options& options) {
  Tally tally;
  for (std::uint64_t seed = options.first;
       tally.worlds < options.count &&
       seed < options.first + 10U * static_cast<std::uint64_t>(options.count);
       ++seed) {
    try_field(seed, channel, options, tally);
  }
  const auto good = std::ranges::count_if(tally.correlations, [](double r) { return r > 0.8; });
  fmt::print(
      "{}: told in {} of {} (as a patch {}, as a rival {}, another channel's {}); correlation "
      "above .8 in {} of "
      "{}, median {:.2f}, least {:.2f}; within 95 % bands {:.1f} %; length {:.2f} times the true "
      "one (median); {:.2f} s a diagnosis\n",
      name_of(channel), tally.told, tally.worlds, tally.patches, tally.rivals, tally.others, good,
      tally.correlations.size(), statistics::median(tally.correlations),
      tally.correlations.empty() ? 0.0 : *std::ranges::min_element(tally.correlations),
      100.0 * tally.within / std::max(1.0, tally.cells), statistics::median(tally.lengths),
      tally.seconds / std::max(1, tally.worlds));
}

void travel(const Options& options) {
  run_field(Channel::travel, options);
}
void turn(const Options& options) {
  run_field(Channel::turn, options);
}
void creep(const Options& options) {
  run_field(Channel::creep, options);
}
void compass(const Options& options) {
  run_field(Channel::compass, options);
}

void clean(const Options& options) {
  Tally tally;
  for (std::uint64_t seed = options.first;
       seed < options.first + static_cast<std::uint64_t>(options.clean); ++seed) {
    const World world = draw_world(seed);
    const Diagnosis result = timed_diagnosis(record_in(world, {}), world.model, tally);
    ++tally.worlds;
    tally.told += result.places.empty() ? 0 : 1;
    if (options.verbose && !result.places.empty()) {
      fmt::print("  world {}:{}\n", seed, what_is_said(result));
    }
  }
  fmt::print("clean: a field told in {} of {}; {:.2f} s a diagnosis\n", tally.told, tally.worlds,
             tally.seconds / std::max(1, tally.worlds));
}

bool is_circle(const Effect& effect) {
  return effect.name.find("(x=") != std::string::npos;
}

void circle(const Options& options) {
  Tally tally;
  int named = 0;
  for (std::uint64_t seed = options.first;
       tally.worlds < options.count &&
       seed < options.first + 10U * static_cast<std::uint64_t>(options.count);
       ++seed) {
    const World world = draw_world(seed);
    std::vector<Subject> possible;
    for (const Subject& one : subjects(world)) {
      if (is_circle(one.effect) && shows(world, one)) possible.push_back(one);
    }
    if (possible.empty()) continue;
    const Subject& subject = possible[seed % possible.size()];
    const ModelFit fit = fit_model({record_in(world, {})}, world.model);
    Effect effect = subject.effect;
    effect.coefficients = sized(subject, world, ScoreTest(*fit.state), options.times, seed);
    if (effect.coefficients.empty()) continue;
    const Diagnosis result = timed_diagnosis(record_in(world, {effect}), world.model, tally);
    ++tally.worlds;
    const auto found = found_by(result);
    named += std::ranges::any_of(found, [](const Finding* one) { return is_circle(one->effect); });
    for (const FieldOfPlaces& one : result.places) {
      tally.told += one.is_field() ? 1 : 0;
      tally.patches += one.is_field() ? 0 : 1;
    }
    if (options.verbose) {
      fmt::print("  world {} ({} legs): {};{}\n", seed, world.walk.size() - 1, effect.name,
                 what_is_said(result));
    }
  }
  fmt::print(
      "circle: a circle is named in {} of {}; {} maps beside it, {} fields told instead; {:.2f} s "
      "a diagnosis\n",
      named, tally.worlds, tally.patches, tally.told, tally.seconds / std::max(1, tally.worlds));
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("--first", options.first, "First seed")->capture_default_str();
  app.add_option("--count", options.count, "Worlds of each part")->capture_default_str();
  app.add_option("--clean", options.clean, "Worlds without any field")->capture_default_str();
  app.add_option("--times", options.times, "Size of a field, in units of the noise")
      ->capture_default_str();
  app.add_flag("--unsmoothed", options.unsmoothed, "Noise of a map of squares by themselves");
  app.add_flag("--verbose", options.verbose, "Tell of each world");
}

}  // namespace
}  // namespace trussmap::bench

int main(int argc, char** argv) {
  using namespace trussmap::bench;
  return run_bench<Options>(argc, argv, "Fields over the floor",
                            {{"clean", clean},
                             {"travel", travel},
                             {"turn", turn},
                             {"creep", creep},
                             {"compass", compass},
                             {"circle", circle}},
                            add_options);
}
