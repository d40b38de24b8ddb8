// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/hidden_effects.hpp"

#include "effects/channel_physics.hpp"
#include "geometry/index.hpp"
#include "simulation/effect_gains.hpp"
#include "simulation/motion_variables.hpp"
#include "simulation/true_motion.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr double kSecondShare = 0.4;  // chance of a second effect
constexpr double kLeastFactor = 3.0;  // of the detectable size
constexpr double kLargestFactor = 6.0;
constexpr double kUsualLegs = 60.0;   // that the detectable sizes are for
constexpr double kLeastShare = 0.02;  // of rows in which an effect of a place must act
constexpr int kMostDraws = 2000;

/// A recording's own scale, rotation or spacing takes these up where no survey fixes them.
constexpr std::array<std::string_view, 5> kNeedSurvey = {
    "travel scale", "wheel scale", "compass offset", "constant creep", "loss per start"};

/// Effects whose own traces name something else: tilt looks like hard iron, and a loss larger than
/// a row's travel makes wheels look as if they had turned round more often.
constexpr std::array<std::string_view, 5> kMisleading = {"body tilt", "backlash", "backlash twist",
                                                         "backlash of the left wheel",
                                                         "backlash of the right wheel"};

template <std::size_t count>
bool is_among(const std::array<std::string_view, count>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

double four_digits(double value) {
  return std::stod(fmt::format("{:.4g}", value));
}

class Draw {
 public:
  Draw(const TrueMotion& motion, const Mesh& mesh, const WheeledRobot& robot, bool surveyed,
       std::uint64_t seed)
      : motion_(motion),
        mesh_(mesh),
        robot_(robot),
        surveyed_(surveyed),
        variables_(motion_variables(motion, true_rates(motion), robot.geometry.wheelbase)),
        random_(random_stream(seed, Stream::hidden)) {
    for (const CatalogueEntry& entry : catalogue()) {
      // Robots without markers draw from the same list as before there were any.
      const bool of_yaws = entry.channel == Channel::sighting_yaw;
      if (of_yaws && !(robot.markers && surveyed)) continue;
      if (is_of_drive(entry.channel, robot.geometry)) entries_.push_back(entry);
    }
  }

  std::vector<Effect> effects() {
    const std::size_t wanted = uniform(0.0, 1.0) < kSecondShare ? 2 : 1;
    std::vector<Effect> drawn;
    for (int k = 0; k < kMostDraws && drawn.size() < wanted; ++k) {
      const CatalogueEntry& entry = one_of(entries_);
      std::optional<Effect> effect = draw(entry);
      if (effect && fits(*effect, drawn)) drawn.push_back(std::move(*effect));
    }
    if (drawn.empty()) throw std::invalid_argument("the recording could show no effect");
    return drawn;
  }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  template <typename List>
  const typename List::value_type& one_of(const List& list) {
    const auto at = static_cast<std::size_t>(uniform(0.0, static_cast<double>(list.size())));
    return list[std::min(at, list.size() - 1)];
  }

  [[nodiscard]] bool can_be_shown(const CatalogueEntry& entry) const {
    const bool of_ranges = entry.channel == Channel::range || entry.channel == Channel::range_scale;
    const bool of_bearings = entry.channel == Channel::bearing;
    const bool of_gyro = entry.channel == Channel::gyro || entry.channel == Channel::gyro_scale;
    const bool needs_survey = is_among(kNeedSurvey, entry.name);
    const bool needs_compass = entry.channel == Channel::compass || entry.name == "constant creep";
    // A robot that stands still as it looks shows no delay, and a late stamp shows at a glance.
    const bool of_fixes = entry.channel == Channel::antenna ||
                          entry.channel == Channel::antenna_left ||
                          entry.channel == Channel::fix_delay;
    return entry.detectable > 0.0 && entry.channel != Channel::delay && !of_fixes &&
           !is_among(kMisleading, entry.name) && (robot_.compass || !needs_compass) &&
           (robot_.gyro || !of_gyro) && (robot_.sees_ranges() || !of_ranges) &&
           (robot_.sees_bearings() || !of_bearings) && (surveyed_ || !needs_survey);
  }

  /// Two that cannot be told apart, or whose parts cannot, make no fair riddle.
  static bool fits(const Effect& effect, const std::vector<Effect>& drawn) {
    const auto kind = [](const Effect& one) {
      if (one.channel == Channel::steer_gain) return Channel::turn;
      return one.channel == Channel::creep ? Channel::compass : one.channel;
    };
    return std::none_of(drawn.begin(), drawn.end(),
                        [&](const Effect& other) { return kind(other) == kind(effect); });
  }

  /// The entry's effect, what is open in it drawn.
  Effect closed(const CatalogueEntry& entry) {
    if (entry.of_covariate()) {
      if (entry.channel == Channel::compass) return catalogue_effect(entry, "lights");
      if (entry.also_of.empty()) return catalogue_effect(entry, "payload_kg");
      std::vector<std::string_view> names = entry.also_of;
      names.emplace_back("temperature_C");
      return catalogue_effect(entry, one_of(names));
    }
    if (!entry.has_parameters()) return catalogue_effect(entry);
    std::vector<ShapeParameter> parameters;
    const Vector2 place = one_of(mesh_.positions);
    const double reach = shortest_route(mesh_);
    for (const OpenParameter& one : entry.parameters) {
      double value = uniform(0.8 * one.usual, 1.2 * one.usual);
      if (one.name == "x") value = place.x() + uniform(-0.3, 0.3) * reach;
      if (one.name == "y") value = place.y() + uniform(-0.3, 0.3) * reach;
      if (one.name == "r") value = std::clamp(uniform(0.5, 0.9) * reach, one.smallest, one.largest);
      parameters.push_back({std::string(one.name), std::round(10.0 * value) / 10.0});
    }
    return catalogue_effect(entry, parameters);
  }

  std::optional<Effect> draw(const CatalogueEntry& entry) {
    if (!can_be_shown(entry)) return std::nullopt;
    Effect effect = closed(entry);
    const double angle = uniform(0.0, 2.0 * std::numbers::pi);
    const double legs = std::max(1.0, static_cast<double>(motion_.stops.size()) - 1.0);
    const double size = entry.detectable * uniform(kLeastFactor, kLargestFactor) *
                        std::max(1.0, std::sqrt(kUsualLegs / legs));
    effect.coefficients = {angle < std::numbers::pi ? -1.0 : 1.0};
    // A loss is one: the wheels turn, the robot does not follow.
    if (entry.channel == Channel::advance) effect.coefficients = {-1.0};
    if (effect.shape.size() == 2) effect.coefficients = {std::cos(angle), std::sin(angle)};
    const std::vector<double> g = channel_gains({effect}, variables_).at(entry.channel);
    const auto [least, most] = std::minmax_element(g.begin(), g.end());
    const double largest =
        entry.of_covariate() ? *most - *least : std::max(std::abs(*least), std::abs(*most));
    const auto acting = std::count_if(
        g.begin(), g.end(), [&](double value) { return std::abs(value) > 0.3 * largest; });
    const bool is_event = entry.channel == Channel::advance || entry.channel == Channel::rotate;
    const auto rows = static_cast<double>(g.size());
    if (!(largest > 0.0) || (!is_event && static_cast<double>(acting) < kLeastShare * rows)) {
      return std::nullopt;
    }
    for (double& coefficient : effect.coefficients) {
      coefficient = four_digits(coefficient * size / largest);
    }
    return effect;
  }

  const TrueMotion& motion_;
  const Mesh& mesh_;
  const WheeledRobot& robot_;
  bool surveyed_;
  MotionVariables variables_;
  std::mt19937_64 random_;
  std::vector<CatalogueEntry> entries_;  ///< of the robot's drive
};

}  // namespace

std::vector<Effect> draw_hidden_effects(const TrueMotion& motion, const Mesh& mesh,
                                        const WheeledRobot& robot, bool surveyed,
                                        std::uint64_t seed) {
  return Draw(motion, mesh, robot, surveyed, seed).effects();
}

std::vector<Effect> draw_hidden_effects(const Mesh& mesh, const std::vector<int>& walk,
                                        const DrivingStyle& style, const WheeledRobot& robot,
                                        bool surveyed, std::uint64_t seed) {
  return draw_hidden_effects(lay_path(mesh, walk, style, seed, {}, manner_of(robot.geometry)), mesh,
                             robot, surveyed, seed);
}

}  // namespace trussmap
