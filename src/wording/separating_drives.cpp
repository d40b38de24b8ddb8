// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/wording.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace trussmap {
namespace {

bool has_variable(const Effect& effect, std::string_view name) {
  return std::any_of(effect.shape.begin(), effect.shape.end(),
                     [name](const Shape& shape) { return shape.speaks_of(name); });
}

std::set<std::string> variables_of(const Effect& effect) {
  std::set<std::string> all;
  for (const Shape& shape : effect.shape) {
    all.insert(shape.variables().begin(), shape.variables().end());
  }
  return all;
}

/// One thing that varies makes both; constants go with nothing.
bool go_with_the_same(const Effect& one, const Effect& other) {
  const std::set<std::string> variables = variables_of(one);
  return one.channel != other.channel && !variables.empty() && variables == variables_of(other);
}

bool is_constant(const Effect& effect) {
  return effect.shape.size() == 1 && effect.shape.front().variables().empty();
}

/// What kind of trace an effect leaves, as far as a drive can tell kinds apart.
bool is_turn(const Effect& effect) {
  return effect.channel == Channel::turn || effect.channel == Channel::rotate;
}

bool is_stretch(const Effect& effect) {
  return effect.channel == Channel::travel || effect.channel == Channel::wheels ||
         effect.channel == Channel::advance;
}

struct Separation {
  bool (*one)(const Effect&);
  bool (*other)(const Effect&);
  const char* drive;
};

const Separation kSeparations[] = {
    {[](const Effect& e) { return e.channel == Channel::compass && is_constant(e); },
     [](const Effect& e) { return e.channel == Channel::creep; },
     "no drive between landmarks tells these apart: measure the direction of travel against the "
     "body, or sight landmarks with a bearing sensor fixed to it"},
    {[](const Effect& e) { return e.channel == Channel::lever; }, is_turn,
     "no drive that stands on landmarks tells these apart: measure where the sensor sits"},
    {[](const Effect& e) { return e.channel == Channel::sighting_yaw; },
     [](const Effect& e) { return e.channel == Channel::compass || e.channel == Channel::bearing; },
     "survey where more landmarks are and how their axes point, and meet them on several headings: "
     "positions tell the compass and bearings, headings the yaws"},
    {[](const Effect& e) { return e.channel == Channel::compass; },
     [](const Effect& e) { return e.channel == Channel::compass; },
     "turn on the spot with other loads and at other places, read the compass at rest, then with "
     "the wheels lifted and driven"},
    {[](const Effect& e) { return e.channel == Channel::compass; },
     [](const Effect& e) { return e.channel == Channel::creep; },
     "turn on the spot by two full turns (only the compass shows there), and drive the same routes "
     "elsewhere or with the site turned"},
    {is_turn, is_turn,
     "turn on the spot by two full turns each way, at two clearly different rates, and in several "
     "shorter turns"},
    {[](const Effect& e) { return e.channel == Channel::wheels; },
     [](const Effect& e) { return e.channel == Channel::travel; },
     "drive bends and turn on the spot by two full turns each way, at the speeds and loads of the "
     "legs: wheels that travel too far turn too far as well, travel alone does not"},
    {is_stretch, is_stretch,
     "drive legs of clearly different length, each at two different speeds"},
    {[](const Effect& e) { return e.channel == Channel::difference; }, is_turn,
     "drive squares in both directions"},
    {[](const Effect& e) { return e.channel == Channel::difference; },
     [](const Effect& e) { return e.channel == Channel::drift; },
     "let the robot stand for a minute, several times"},
    {is_turn, [](const Effect& e) { return e.channel == Channel::compass; },
     "turn on the spot by two full turns each way, at two clearly different rates"},
};

/// Where two effects go with different things that all vary slowly.
std::optional<std::string> drive_of_slow(const Effect& one, const Effect& other,
                                         const std::vector<std::string>& slow) {
  const bool timed = has_variable(one, "t") || has_variable(one, "distance") ||
                     has_variable(other, "t") || has_variable(other, "distance");
  bool differ = has_variable(one, "t") != has_variable(other, "t") ||
                has_variable(one, "distance") != has_variable(other, "distance");
  std::string covariates;
  for (const std::string& name : slow) {
    if (has_variable(one, name) == has_variable(other, name)) continue;
    covariates += (covariates.empty() ? "" : " and ") + name;
    differ = true;
  }
  if (!timed || !differ) return std::nullopt;
  return "stand for some minutes between tours, and drive fast and slow ones: time, distance and " +
         (covariates.empty() ? "temperature" : covariates) + " then go apart";
}

}  // namespace

std::string separating_drive(const Effect& one, const Effect& other,
                             const std::vector<std::string>& slow) {
  if (const std::optional<std::string> drive = drive_of_slow(one, other, slow)) return *drive;
  if (has_variable(one, "x") || has_variable(other, "x")) {
    return "visit the place again on other headings, at another time and with another load, and "
           "drive the same headings elsewhere";
  }
  for (const Separation& rule : kSeparations) {
    if ((rule.one(one) && rule.other(other)) || (rule.one(other) && rule.other(one))) {
      return rule.drive;
    }
  }
  if (go_with_the_same(one, other)) {
    return fmt::format(
        "both go with the same: drive long legs, short ones, bends and turns on the spot while it "
        "varies, since \"{}\" acts on the {} and \"{}\" on the {}",
        one.name, facts_of(one.channel).does_what, other.name, facts_of(other.channel).does_what);
  }
  return fmt::format(
      "drive so that what \"{}\" goes with and what \"{}\" goes with vary "
      "independently",
      one.name, other.name);
}

std::string in_words(const std::optional<NextDrive>& drive) {
  return drive ? separating_drive(drive->effect, drive->rival, drive->slow) : "";
}

}  // namespace trussmap
