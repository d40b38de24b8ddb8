// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/wording.hpp"

#include <fmt/format.h>

namespace trussmap {

Advice advice_on(const DataLack& lack) {
  switch (lack.what) {
    case Lack::positions:
      return {"no survey and no truth", "scale, compass offset and loss per start cannot be seen",
              "measure the distance between two landmarks, better a few positions"};
    case Lack::compass:
      return {
          "no compass",
          "headings come from the landmarks alone, and effects on turning are two to four times "
          "harder to see",
          ""};
    case Lack::headings:
      return {fmt::format("only {} of {} directions are driven", lack.count, lack.total),
              "effects that depend on the heading (iron, slope) stay hidden",
              "drive the routes in other directions too"};
    case Lack::turning_sense:
      return {fmt::format("{:.0f} % of all turning is to the {}", 100.0 * lack.share,
                          lack.to_the_left ? "left" : "right"),
              "wheelbase and turn asymmetry look alike",
              "drive the tour the other way round as well"};
    case Lack::leg_lengths:
      return {"all legs are about equally long", "scale and loss per start look alike",
              "add routes of half and of double the length"};
    case Lack::speeds:
      return {"one speed", "scale and slip with speed look alike", "drive some legs slowly"};
    case Lack::spin_rates:
      return {"turns on the spot at one rate", "wheelbase and turn scrub look alike",
              "turn slowly and fast"};
    case Lack::rests:
      return {"no rests", "heading drift with time looks like unequal wheels",
              "stand still for a minute"};
    case Lack::covariate_range:
      return {fmt::format("{} never changes", lack.name), "its effects cannot be seen", "vary it"};
    case Lack::revisits:
      return {fmt::format("{} of {} landmarks are visited once", lack.count, lack.total),
              "they check nothing", "come back to them by another route"};
  }
  return {};
}

std::string in_words(const Advice& advice) {
  return advice.lack + ": " + advice.why + (advice.drive.empty() ? "" : "; " + advice.drive);
}

std::vector<std::string> in_words(const std::vector<DataLack>& lacks) {
  std::vector<std::string> texts;
  for (const DataLack& one : lacks) texts.push_back(in_words(advice_on(one)));
  return texts;
}

Advice advice_on(const Unobservable& unseen) {
  constexpr const char* kSurvey = "measure the positions of a few landmarks (survey.csv)";
  const bool hides = unseen.why == Unseen::in_the_map || unseen.why == Unseen::absorbed;
  if (unseen.effect.channel == Channel::sighting_yaw && hides) {
    return {"", "without measured headings of landmarks their axes turn with it",
            "measure the headings of a few landmarks (survey.csv, heading)"};
  }
  switch (unseen.why) {
    case Unseen::never_happens:
      return {"", "what it depends on never occurs in these data",
              "drive so that it does: with starts, spins and changes of direction"};
    case Unseen::in_the_map:
      return {"", "without measured positions the map turns, grows and shrinks with it", kSurvey};
    case Unseen::absorbed:
      return {"", "the map and the poses absorb it completely",
              "vary the drive: legs of different length, turns both ways, spins, landmarks met on "
              "several headings"};
    case Unseen::too_small:
      break;
  }
  return {"", "only an implausibly large one would be seen",
          unseen.positions ? "collect more data in which what it depends on varies" : kSurvey};
}

std::string in_words(const EffectEstimate& estimate, const UnfittedCoefficient& one) {
  const Effect& effect = estimate.effect;
  std::string why;
  switch (one.why) {
    case NotFitted::undetermined:
      why = "no measurement tells it from the map, the poses or the rest";
      break;
    case NotFitted::faint:
      why = "the map and the poses absorb it almost completely";
      break;
    case NotFitted::uncertain:
      why =
          fmt::format("these data leave it uncertain by {:.1f} times its prior standard deviation",
                      one.uncertainty);
      break;
  }
  return fmt::format("{} ({}): not fitted, {}", effect.name,
                     effect.shape[one.place % effect.shape.size()].text(), why);
}

}  // namespace trussmap
