// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/effect_gains.hpp"

#include "effects/channel_physics.hpp"
#include "simulation/true_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

namespace trussmap::simulation {
namespace {

constexpr int kMostPasses = 60;
constexpr double kSettled = 1e-14;

bool is_reading(Channel channel) {
  return channel == Channel::compass || channel == Channel::range ||
         channel == Channel::range_scale || channel == Channel::bearing ||
         channel == Channel::sighting_yaw;
}

/// The largest change of any gain.
double change(const ChannelGains& a, const ChannelGains& b) {
  double largest = 0.0;
  for (const auto& [channel, values] : a) {
    const std::vector<double>& others = b.at(channel);
    if (others.size() != values.size()) return std::numeric_limits<double>::infinity();
    for (std::size_t row = 0; row < values.size(); ++row) {
      largest = std::max(largest, std::abs(values[row] - others[row]));
    }
  }
  return largest;
}

/// What the path has to know of its effects.
PathBias bias_of(const ChannelGains& gains, const TrueMotion& motion) {
  PathBias bias;
  bias.segments = motion.segments;
  bias.turns = motion.turns;
  const auto creep = gains.find(Channel::creep);
  if (creep != gains.end()) bias.slip = creep->second;
  // An event in a spin moves the robot, not its wheels: they would have to turn back for it, which
  // were an event of its own.
  const auto advance = gains.find(Channel::advance);
  if (advance != gains.end()) {
    for (std::size_t row = 0; row < motion.rows.size(); ++row) {
      const bool spins = motion.rows[row].activity == Activity::spin;
      bias.jump.push_back(spins ? advance->second[row] : 0.0);
    }
  }
  for (const TrueStop& stop : motion.stops) {
    const std::size_t row = stop.rows == 0 ? 0 : stop.rows - 1;
    bias.sensor.emplace_back(gain(gains, Channel::lever, row),
                             gain(gains, Channel::lever_left, row));
  }
  return bias;
}

std::vector<RowRates> rates_shown(const TrueMotion& motion, const ChannelGains& gains,
                                  const Robot& robot) {
  std::vector<RowRates> rates;
  for (const ShownRow& row : readings_under(motion, gains, robot)) rates.push_back(row.rates);
  return rates;
}

}  // namespace

ChannelGains channel_gains(const std::vector<Effect>& effects, const MotionVariables& variables) {
  ChannelGains gains;
  for (const Effect& effect : effects) {
    try {
      const RowVariables& table = is_reading(effect.channel) ? variables.instant : variables.middle;
      const std::size_t rows = table.at("t").size();
      std::vector<double>& g = gains.try_emplace(effect.channel, rows, 0.0).first->second;
      if (effect.coefficients.empty()) continue;
      if (effect.coefficients.size() != effect.shape.size()) {
        throw std::invalid_argument(fmt::format("has {} coefficients, expected {}, one per shape",
                                                effect.coefficients.size(), effect.shape.size()));
      }
      for (std::size_t k = 0; k < effect.shape.size(); ++k) {
        const std::vector<double> f = effect.shape[k].values(table);
        for (std::size_t row = 0; row < rows; ++row) g[row] += effect.coefficients[k] * f[row];
      }
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("effect \"" + effect.name + "\": " + error.what());
    }
  }
  return gains;
}

MotionUnderEffects lay_path_under(const Mesh& mesh, const std::vector<int>& walk,
                                  const DrivingStyle& style, const Robot& robot,
                                  const std::vector<Effect>& effects, Rates rates,
                                  std::uint64_t seed) {
  for (const Effect& effect : effects) effects::require_of_drive(effect, robot);
  const DrivingManner manner = manner_of(robot);
  MotionUnderEffects result;
  result.motion = lay_path(mesh, walk, style, seed, {}, manner);
  if (effects.empty()) return result;
  const auto gains_now = [&] {
    const bool recorded = rates == Rates::as_recorded && !result.gains.empty() &&
                          result.gains.begin()->second.size() == result.motion.rows.size();
    return channel_gains(effects,
                         motion_variables(result.motion,
                                          recorded ? rates_shown(result.motion, result.gains, robot)
                                                   : true_rates(result.motion),
                                          robot.wheelbase));
  };
  result.gains = gains_now();
  const bool bends_path =
      std::any_of(result.gains.begin(), result.gains.end(), [](const auto& one) {
        return one.first == Channel::creep || one.first == Channel::advance ||
               one.first == Channel::lever || one.first == Channel::lever_left;
      });
  if (!bends_path && rates == Rates::true_motion) return result;
  // Rows keep their number and times from pass to pass, so that gains can be carried over.
  for (int pass = 0; pass < kMostPasses; ++pass) {
    if (bends_path) {
      result.motion =
          lay_path(mesh, walk, style, seed, bias_of(result.gains, result.motion), manner);
    }
    ChannelGains next = gains_now();
    const double changed = change(next, result.gains);
    if (changed < kSettled) break;
    result.gains = std::move(next);
  }
  return result;
}

}  // namespace trussmap::simulation
