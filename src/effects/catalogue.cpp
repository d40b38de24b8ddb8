// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/effects/catalogue.hpp"

#include <stdexcept>

#include <fmt/format.h>

namespace trussmap {
namespace {

std::string replaced(std::string text, std::string_view by) {
  for (std::size_t at = text.find("{}"); at != std::string::npos; at = text.find("{}", at)) {
    text.replace(at, 2, by);
    at += by.size();
  }
  return text;
}

/// "load on both wheels (payload_kg)" -> "load on both wheels", "payload_kg".
struct Named {
  std::string_view name;
  std::string_view covariate;
};

Named taken_apart(std::string_view name) {
  const std::size_t open = name.rfind(" (");
  if (open == std::string_view::npos || !name.ends_with(')')) return {name, {}};
  return {name.substr(0, open), name.substr(open + 2, name.size() - open - 3)};
}

}  // namespace

bool CatalogueEntry::of_covariate() const {
  return !shape.empty() && shape.front().find("{}") != std::string::npos;
}

const std::vector<CatalogueEntry>& catalogue() {
  using enum Channel;
  static const std::vector<CatalogueEntry> entries{
      {"wheel diameter ratio",
       difference,
       {"1"},
       "wheels that are not equally large",
       "multiply each wheel's travel by its factor"},
      {"wheelbase",
       turn,
       {"1"},
       "a wheelbase other than believed, contact points that move",
       "correct the wheelbase in the robot's software"},
      {"travel scale",
       travel,
       {"1"},
       "wheels larger or smaller than believed, as drives show it",
       "correct the distance per tick"},
      {"wheel scale",
       wheels,
       {"1"},
       "both wheels larger or smaller than believed",
       "correct the wheel diameter"},
      {"sighting delay",
       delay,
       {"1"},
       "sightings or truth that are stamped late",
       "synchronise the clocks"},
      {"constant creep", creep, {"1"}, "toe-in, a sensor frame that is turned", "align the wheels"},
      {"cross-slope creep",
       creep,
       {"sin(heading)", "cos(heading)"},
       "a floor that slopes sideways",
       "level the floor, or map its slope"},
      {"centrifugal side-slip",
       creep,
       {"speed*turn_rate"},
       "tyres that slip outwards in bends",
       "drive bends more slowly"},
      {"slope",
       travel,
       {"sin(heading)", "cos(heading)"},
       "a floor that slopes: slip differs up and down",
       "level the floor, or map its slope"},
      {"slip with speed", travel, {"speed"}, "tyres that slip more when fast", "drive more slowly"},
      {"loss per start",
       advance,
       {"starts"},
       "wheels that slip when they start",
       "accelerate gently"},
      {"turn scrub",
       turn,
       {"abs(turn_rate)"},
       "tyres that scrub more when turning fast",
       "turn more slowly"},
      {"turn asymmetry",
       turn,
       {"sign(turn_rate)"},
       "castors or loads that favour one side",
       "look at the castors and the load"},
      {"twist per spin",
       rotate,
       {"spins"},
       "castors that swing at the start of a turn",
       "turn less often, or with a run-up"},
      {"load on both wheels", wheels, {"{}"}, "tyres that give under a load", "inflate the tyres"},
      {"load on one wheel", left, {"{}"}, "a load that lies off the middle", "centre the load"},
      {"tyre drift",
       wheels,
       {"{}"},
       "wear, pressure or temperature of the tyres",
       "calibrate again from time to time"},
      {"tyre drift with time",
       wheels,
       {"t"},
       "pressure or temperature of the tyres",
       "calibrate again from time to time"},
      {"tyre drift with distance",
       wheels,
       {"distance"},
       "wear of the tyres",
       "calibrate again from time to time"},
      {"backlash of the left wheel",
       advance,
       {"reverses_left"},
       "play in the left wheel's gear",
       "tighten the gear"},
      {"backlash of the right wheel",
       advance,
       {"reverses_right"},
       "play in the right wheel's gear",
       "tighten the gear"},
      {"missed ticks",
       wheels,
       {"max(0, abs(speed)-0.5)"},
       "encoders that miss ticks when fast",
       "drive more slowly, or look at the encoder"},
      {"sampling skew",
       difference,
       {"acceleration"},
       "wheels that are read one after the other",
       "read both encoders at once"},
      {"heading drift", drift, {"1"}, "a gyroscope with an offset", "measure its offset at rest"},
      {"compass offset", compass, {"1"}, "declination, mounting", "subtract it"},
      {"hard iron",
       compass,
       {"sin(heading)", "cos(heading)"},
       "magnets and steel on the robot, or a body that is tilted",
       "calibrate the compass by a full turn"},
      {"soft iron",
       compass,
       {"sin(2*heading)", "cos(2*heading)"},
       "iron on the robot that is magnetised by the earth",
       "calibrate the compass by a full turn"},
      {"compass lag", compass, {"turn_rate"}, "a compass that is read late", "stamp its readings"},
      {"motor current",
       compass,
       {"speed*sin(heading)", "speed*cos(heading)"},
       "the motors' currents",
       "move the compass away from the motors"},
      {"compass disturbance",
       compass,
       {"{}"},
       "something that is switched",
       "move the compass away from it"},
      {"lever arm",
       lever,
       {"1"},
       "a sensor that is not where it is believed, ahead",
       "measure its place"},
      {"lever arm to the left",
       lever_left,
       {"1"},
       "a sensor that is not where it is believed, sideways",
       "measure its place"},
      {"range bias", range, {"1"}, "a range sensor with an offset", "subtract it"},
      {"range scale", range_scale, {"1"}, "a range sensor with a wrong scale", "correct the scale"},
      {"bearing offset", bearing, {"1"}, "a sensor that is mounted askew", "subtract it"}};
  return entries;
}

const CatalogueEntry* find_entry(std::string_view name) {
  for (const CatalogueEntry& entry : catalogue()) {
    if (entry.name == name || (entry.of_covariate() && entry.name == taken_apart(name).name)) {
      return &entry;
    }
  }
  return nullptr;
}

Effect resolved(const Effect& effect) {
  Effect result = effect;
  if (effect.channel.empty()) {
    const CatalogueEntry* entry = find_entry(effect.name);
    if (entry == nullptr) {
      throw std::invalid_argument(fmt::format(
          "effect \"{}\" is not in the catalogue, expected a channel and a shape", effect.name));
    }
    const std::string_view covariate = taken_apart(effect.name).covariate;
    if (entry->of_covariate() && covariate.empty()) {
      throw std::invalid_argument(fmt::format(
          "effect \"{}\" needs a covariate, expected \"{} (COLUMN)\"", effect.name, entry->name));
    }
    result.channel = facts_of(entry->channel).name;
    for (const std::string& shape : entry->shape)
      result.shape.push_back(replaced(shape, covariate));
  }
  if (!parse_channel(result.channel)) {
    throw std::invalid_argument(
        fmt::format("effect \"{}\" has channel \"{}\", which is unknown, "
                    "expected one of {}",
                    effect.name, result.channel, channel_names()));
  }
  if (!effect.per_session && !effect.coefficients.empty() &&
      effect.coefficients.size() != result.shape.size()) {
    throw std::invalid_argument(
        fmt::format("effect \"{}\" has {} coefficients, expected {}, one "
                    "per shape",
                    effect.name, effect.coefficients.size(), result.shape.size()));
  }
  return result;
}

}  // namespace trussmap
