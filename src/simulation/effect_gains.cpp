// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/effect_gains.hpp"

#include "geometry/index.hpp"
#include "simulation/true_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr int kMostPasses = 60;
constexpr double kSettled = 1e-14;

bool is_reading(Channel channel) {
  return channel == Channel::compass || channel == Channel::range ||
         channel == Channel::range_scale || channel == Channel::bearing ||
         channel == Channel::sighting_yaw;
}

double gain(const ChannelGains& gains, Channel channel, std::size_t row) {
  const auto found = gains.find(channel);
  return found == gains.end() ? 0.0 : found->second[row];
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
                                  double wheelbase) {
  const std::vector<WheelTravels> wheels = wheels_under(motion, gains, wheelbase);
  std::vector<RowRates> rates;
  for (std::size_t row = 0; row < wheels.size(); ++row) {
    const double duration = motion.rows[row].duration;
    rates.push_back({0.5 * (wheels[row].left + wheels[row].right) / duration,
                     (wheels[row].right - wheels[row].left) / (wheelbase * duration)});
  }
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

std::vector<WheelTravels> wheels_under(const TrueMotion& motion, const ChannelGains& gains,
                                       double wheelbase) {
  std::vector<WheelTravels> result;
  result.reserve(motion.rows.size());
  for (std::size_t k = 0; k < motion.rows.size(); ++k) {
    const TrueRow& row = motion.rows[k];
    const auto g = [&](Channel channel) { return gain(gains, channel, k); };
    // Each wheel's own share of what it shows, whatever the other does.
    const double left = 1.0 + g(Channel::wheels) + g(Channel::left) - 0.5 * g(Channel::difference);
    const double right =
        1.0 + g(Channel::wheels) + g(Channel::right) + 0.5 * g(Channel::difference);
    // Twice the travel and B times the turn, freed from what is added per row:
    //   (left + travel) L + (right + travel) R = sum,   (right + turn) R - (left + turn) L = skew
    const double travel = g(Channel::travel);
    const double turn = g(Channel::turn);
    const double sum = 2.0 * (row.speed * row.duration + row.jump - g(Channel::advance));
    const double skew = wheelbase * (row.turn_rate * row.duration - g(Channel::rotate) -
                                     g(Channel::drift) * row.duration);
    const double determinant = (left + travel) * (right + turn) + (right + travel) * (left + turn);
    if (!(std::abs(determinant) > 1e-6)) {
      throw std::invalid_argument(fmt::format(
          "the effects leave no wheel travels that could be shown at t = {:g} s, expected gains "
          "above -1",
          row.t));
    }
    result.push_back({((right + turn) * sum - (right + travel) * skew) / determinant,
                      ((left + turn) * sum + (left + travel) * skew) / determinant});
  }
  return result;
}

MotionUnderEffects lay_path_under(const Mesh& mesh, const std::vector<int>& walk,
                                  const DrivingStyle& style, double wheelbase,
                                  const std::vector<Effect>& effects, Rates rates,
                                  std::uint64_t seed) {
  MotionUnderEffects result;
  result.motion = lay_path(mesh, walk, style, seed);
  if (effects.empty()) return result;
  const auto gains_now = [&] {
    const bool recorded = rates == Rates::as_recorded && !result.gains.empty() &&
                          result.gains.begin()->second.size() == result.motion.rows.size();
    return channel_gains(
        effects, motion_variables(result.motion,
                                  recorded ? rates_shown(result.motion, result.gains, wheelbase)
                                           : true_rates(result.motion),
                                  wheelbase));
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
      result.motion = lay_path(mesh, walk, style, seed, bias_of(result.gains, result.motion));
    }
    ChannelGains next = gains_now();
    const double changed = change(next, result.gains);
    if (changed < kSettled) break;
    result.gains = std::move(next);
  }
  return result;
}

}  // namespace trussmap
