// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/hidden_effects.hpp"

#include "effects/catalogue_record.hpp"
#include "effects/channel_physics.hpp"
#include "geometry/index.hpp"
#include "simulation/effect_gains.hpp"
#include "simulation/motion_variables.hpp"
#include "simulation/true_motion.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
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
using namespace simulation;

namespace {

constexpr double kSecondShare = 0.4;  // chance of a second effect
constexpr double kLeastFactor = 3.0;  // of the detectable size
constexpr double kLargestFactor = 6.0;
constexpr double kUsualLegs = 60.0;   // that the detectable sizes are for
constexpr double kLeastShare = 0.02;  // of rows in which an effect of a place must act
constexpr int kMostDraws = 2000;

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
    for (const effects::CatalogueRecord& record : effects::catalogue_records()) {
      // Robots without markers draw from the same list as before there were any.
      const bool of_yaws = record.entry.channel == Channel::sighting_yaw;
      if (of_yaws && !(robot.markers && surveyed)) continue;
      if (effects::is_of_drive(record.entry.channel, robot.geometry)) records_.push_back(&record);
    }
  }

  std::vector<Effect> effects() {
    const std::size_t wanted = uniform(0.0, 1.0) < kSecondShare ? 2 : 1;
    std::vector<Effect> drawn;
    for (int k = 0; k < kMostDraws && drawn.size() < wanted; ++k) {
      std::optional<Effect> effect = draw(*one_of(records_));
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

  [[nodiscard]] bool can_be_shown(const effects::CatalogueRecord& record) const {
    const Channel channel = record.entry.channel;
    const bool of_ranges = channel == Channel::range || channel == Channel::range_scale;
    const bool of_bearings = channel == Channel::bearing;
    const bool of_gyro = channel == Channel::gyro || channel == Channel::gyro_scale;
    const bool needs_compass = channel == Channel::compass || record.hidden.needs_compass;
    return record.entry.detectable > 0.0 && record.hidden.drawn &&
           (robot_.compass || !needs_compass) && (robot_.gyro || !of_gyro) &&
           (robot_.sees_ranges() || !of_ranges) && (robot_.sees_bearings() || !of_bearings) &&
           (surveyed_ || !record.hidden.needs_survey);
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
  Effect closed(const effects::CatalogueRecord& record) {
    const CatalogueEntry& entry = record.entry;
    if (entry.of_covariate()) {
      const std::vector<std::string_view>& columns = record.hidden.columns;
      return catalogue_effect(entry, columns.size() == 1 ? columns.front() : one_of(columns));
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

  std::optional<Effect> draw(const effects::CatalogueRecord& record) {
    if (!can_be_shown(record)) return std::nullopt;
    const CatalogueEntry& entry = record.entry;
    Effect effect = closed(record);
    const double angle = uniform(0.0, 2.0 * std::numbers::pi);
    const double legs = std::max(1.0, static_cast<double>(motion_.stops.size()) - 1.0);
    const double size = entry.detectable * uniform(kLeastFactor, kLargestFactor) *
                        std::max(1.0, std::sqrt(kUsualLegs / legs));
    effect.coefficients = {angle < std::numbers::pi ? -1.0 : 1.0};
    if (record.hidden.sign != 0) effect.coefficients = {static_cast<double>(record.hidden.sign)};
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
  std::vector<const effects::CatalogueRecord*> records_;  ///< of the robot's drive
};

}  // namespace

}  // namespace trussmap

namespace trussmap::simulation {

std::vector<Effect> draw_hidden_effects(const TrueMotion& motion, const Mesh& mesh,
                                        const WheeledRobot& robot, bool surveyed,
                                        std::uint64_t seed) {
  return Draw(motion, mesh, robot, surveyed, seed).effects();
}

}  // namespace trussmap::simulation

namespace trussmap {

std::vector<Effect> draw_hidden_effects(const Mesh& mesh, const std::vector<int>& walk,
                                        const DrivingStyle& style, const WheeledRobot& robot,
                                        bool surveyed, std::uint64_t seed) {
  return draw_hidden_effects(lay_path(mesh, walk, style, seed, {}, manner_of(robot.geometry)), mesh,
                             robot, surveyed, seed);
}

}  // namespace trussmap
