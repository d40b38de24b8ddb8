// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/units.hpp"
#include "trussmap/wording.hpp"

#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

namespace trussmap {
namespace {

/// A law of noise in a sentence, with its size and, where the model has such noise, what it states.
struct LawWords {
  std::string_view law;
  const char* sentence;
  double factor = 1.0;  ///< to the sentence's unit
  bool total = false;   ///< size and stated noise together, then the stated noise
};

constexpr std::array kLaws{
    LawWords{"per metre", "the wheels' noise is {:.2g} m per root metre, not {:.2g}", 1.0, true},
    LawWords{"per metre, left wheel",
             "the left wheel's noise is {:.2g} m per root metre, not {:.2g}", 1.0, true},
    LawWords{"per metre, right wheel",
             "the right wheel's noise is {:.2g} m per root metre, not {:.2g}", 1.0, true},
    LawWords{"per second", "each second adds {:.2g} mm of noise to each wheel, also at rest", 1e3},
    LawWords{"per second, heading", "each second adds {:.2g} deg of heading noise, also at rest",
             geometry::kDegrees},
    LawWords{"per second, travel", "each second adds {:.2g} mm of travel noise, also at rest", 1e3},
    LawWords{"per radian turned", "each radian turned adds {:.2g} deg of heading noise",
             geometry::kDegrees},
    LawWords{"per start", "each start adds {:.2g} mm of travel noise", 1e3},
    LawWords{"per spin", "each turn on the spot adds {:.2g} deg of heading noise",
             geometry::kDegrees},
    LawWords{"compass", "a compass reading is good to {:.2g} deg, not {:.2g}", geometry::kDegrees,
             true},
    LawWords{"sighting", "the robot stands on its landmarks to {:.2g} mm, not {:.2g}", 1e3, true},
    LawWords{"range", "a range is good to {:.2g} mm, not {:.2g}", 1e3, true},
    LawWords{"fix", "a fix is good to {:.2g} cm, not {:.2g}", 100.0, true},
    LawWords{"bearing", "a bearing is good to {:.2g} deg, not {:.2g}", geometry::kDegrees, true},
    LawWords{"yaw", "the yaw of a landmark is good to {:.2g} deg, not {:.2g}", geometry::kDegrees,
             true},
    LawWords{"heavy tails", "a few errors are far larger than the rest"},
    LawWords{"autocorrelation", "each drive errs much as the one before it did"},
};

double cm(double metres) {
  return 100.0 * metres;
}

std::string when_moved(const MovedWhen& when) {
  if (!when.before_t) return fmt::format("between {} and {}", when.session, when.next_session);
  return fmt::format("before t = {:.1f} s{}", *when.before_t,
                     when.session.empty() ? "" : " of " + when.session);
}

std::string wheel_jumped(const char* wheel, const EventTest& event) {
  return fmt::format("the {} wheel said {:.1f} cm too {} at once, in the leg {}", wheel,
                     cm(std::abs(event.size[0])), event.size[0] < 0.0 ? "much" : "little",
                     event.name);
}

std::string session_off(const EventTest& event) {
  std::string words =
      fmt::format("session {} is not like the others: there travel is {:+.2g} %, turns {:+.2g} %,",
                  event.name, 100.0 * event.size[0], 100.0 * event.size[1]);
  if (!std::isnan(event.size[2])) {
    words += fmt::format(" the compass {:+.2g} deg,", geometry::kDegrees * event.size[2]);
  }
  return words + fmt::format(" sightings {:+.2g} ms late", 1e3 * event.size[3]);
}

}  // namespace

std::string in_words(const NoiseTest& test) {
  for (const LawWords& one : kLaws) {
    if (one.law != test.law) continue;
    const double size = one.total ? std::hypot(test.stated, test.size) : test.size;
    return fmt::format(fmt::runtime(one.sentence), one.factor * size, one.factor * test.stated);
  }
  return test.law;
}

std::string in_words(const EventTest& event) {
  const std::vector<double>& size = event.size;
  switch (event.change) {
    case EventChange::left_wheel:
      return wheel_jumped("left", event);
    case EventChange::right_wheel:
      return wheel_jumped("right", event);
    case EventChange::motion:
      return fmt::format(
          "something moved the robot by {:.1f} cm ahead, {:.1f} cm to the left and {:.1f} deg that "
          "its wheels do not say, in the leg {}",
          cm(size[0]), cm(size[1]), geometry::kDegrees * size[2], event.name);
    case EventChange::position_off:
      return fmt::format("{} is off by {:.1f} cm", event.name, cm(std::hypot(size[0], size[1])));
    case EventChange::range_off:
      return fmt::format("{} is off by {:.1f} cm", event.name, cm(size[0]));
    case EventChange::bearing_off:
      return fmt::format("{} is off by {:.1f} deg", event.name, geometry::kDegrees * size[0]);
    case EventChange::view_off:
      return fmt::format("{} is off by {:.1f} cm and {:.1f} deg", event.name, cm(size[0]),
                         geometry::kDegrees * size[1]);
    case EventChange::survey_off:
      return fmt::format(
          "landmark {} is not where the survey has it, but {:.1f} cm along x and {:.1f} cm along y "
          "from there",
          event.name, cm(size[0]), cm(size[1]));
    case EventChange::moved:
      return fmt::format("landmark {} was moved by {:.1f} cm along x and {:.1f} cm along y {}",
                         event.name, cm(size[0]), cm(size[1]), when_moved(event.when));
    case EventChange::session_off:
      return session_off(event);
    case EventChange::left_out:
      return event.name + " contradicts the rest, and is left out";
  }
  return "";
}

}  // namespace trussmap
