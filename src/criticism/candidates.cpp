// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/candidates.hpp"

#include "criticism/bells.hpp"
#include "criticism/driven_variables.hpp"
#include "drive/wheel_kinematics.hpp"
#include "effects/catalogue_record.hpp"
#include "effects/channel_physics.hpp"
#include "effects/place_patterns.hpp"
#include "effects/steering.hpp"
#include "fit/noise_components.hpp"
#include "recording/variable_names.hpp"
#include "text/number_text.hpp"
#include "trussmap/catalogue.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace trussmap::criticism {
namespace {

constexpr double kLeastAcceleration = 0.2;  // m/s^2, from braking to speeding up

bool has_word(const std::string& text, std::initializer_list<const char*> words) {
  std::string low = text;
  std::transform(low.begin(), low.end(), low.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return low.find(word) != std::string::npos; });
}

/// How a column's name speaks for an entry; nothing where the entry asks for another kind of
/// column: a load is no temperature. Any column may go with a channel by itself.
std::optional<double> suits(const CatalogueEntry& entry, const std::string& covariate) {
  const auto& also = entry.also_of;
  if (std::find(also.begin(), also.end(), covariate) != also.end()) return 0.0;
  const bool load = has_word(covariate, {"load", "mass", "weight", "kg", "cargo", "ballast"});
  const bool warmth = has_word(covariate, {"temp", "warm", "heat"});
  const bool tyre = warmth || has_word(covariate, {"press", "wear", "bar"});
  if (entry.name.starts_with("load")) return load ? std::optional(0.2) : std::nullopt;
  if (entry.name.starts_with("tyre")) return tyre ? std::optional(0.2) : std::nullopt;
  if (entry.name.starts_with("gyro temperature")) {
    return warmth ? std::optional(0.2) : std::nullopt;
  }
  return load || tyre ? 0.0 : -0.1;
}

/// What was measured, and so can show an effect.
struct Measured {
  std::set<std::string_view> noises;  ///< noises_in
  bool fixes = false;
  bool points = false;  ///< sightings or truth
  bool loops = false;

  [[nodiscard]] bool has(std::string_view noise) const { return noises.contains(noise); }
};

Measured measured_in(const estimation::RecordingProblem& problem) {
  const auto any = [&problem](const auto& is) {
    return std::any_of(problem.measurements.begin(), problem.measurements.end(), is);
  };
  return {fitting::noises_in(problem), any(estimation::is_position),
          any([](const estimation::Measurement& one) {
            return estimation::is_sighting(one) || estimation::gives_pose(one);
          }),
          any(estimation::is_tie)};
}

bool is_possible(Channel channel, const Measured& measured, const Robot& robot) {
  if (!effects::is_of_drive(channel, robot)) return false;
  if (channel == Channel::compass) return measured.has("compass");
  if (channel == Channel::gyro || channel == Channel::gyro_scale) return measured.has("gyro");
  if (channel == Channel::truth_heading) return measured.has("truth");
  if (effects::acts_on_fixes(channel)) return measured.fixes;
  if (effects::acts_on_loops(channel)) return measured.loops;
  if (channel == Channel::sighting_yaw) return measured.has("yaw");
  if (effects::acts_on(channel) == effects::ActsOn::views && !measured.points) return false;
  if (channel == Channel::bearing) return measured.has("range") || measured.has("bearing");
  if (channel == Channel::range || channel == Channel::range_scale) return measured.has("range");
  return true;
}

bool says_something(const Spread& u) {
  if (u.sorted.empty() || !(u.most > u.least)) return false;
  // Of a robot that never accelerates the acceleration is noise of the wheels, the very noise that
  // an effect of it would explain. So is much of the curvature, always: only what is known of arcs
  // (arc loss) is asked of it.
  return u.name != "acceleration" || !(u.quantile(0.99) - u.quantile(0.01) < kLeastAcceleration);
}

Candidate plain(Channel channel, const Spread& u, Form form, std::vector<Shape> shapes,
                const std::string& said, double log_prior) {
  Candidate one;
  one.effect.name = fmt::format("{} with {}", name_of(channel), said);
  one.effect.channel = channel;
  one.effect.shape = std::move(shapes);
  one.form = form;
  one.variable = u.name;
  one.log_prior = log_prior;
  return one;
}

/// What the recordings have, before any candidate is tried.
struct Grounds {
  const fitting::ShapeContext& context;
  Area area;
  Measured measured;
  std::vector<Spread> variables;
  std::vector<std::string> covariates;

  [[nodiscard]] bool allow(Channel channel) const {
    return is_possible(channel, measured, context.robot());
  }
  [[nodiscard]] bool is_covariate(const std::string& name) const {
    return std::find(covariates.begin(), covariates.end(), name) != covariates.end();
  }
};

Grounds grounds_of(const fitting::FitState& fit, const fitting::ShapeContext& context) {
  Grounds grounds{context, driven_area(fit), measured_in(fit.problem), {}, {}};
  const auto take = [&](const std::string& name) {
    const Spread spread = spread_of(name, context);
    if (says_something(spread)) grounds.variables.push_back(spread);
  };
  for (const char* name : {"speed", "turn_rate", "acceleration", "x", "y", "t", "distance"}) {
    take(name);
  }
  if (context.recordings().size() > 1) take("session");
  for (const std::string& name : covariates_of(context)) {
    take(name);
    if (!grounds.variables.empty() && grounds.variables.back().name == name) {
      grounds.covariates.push_back(name);
    }
  }
  return grounds;
}

using Candidates = std::vector<Candidate>;

void append(Candidates& all, Candidates more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

/// With a place all over the area, radii in its steps.
Candidates at_places(Candidate one, const std::vector<double>& radii, const Area& area) {
  Candidates found;
  if (!(area.step > 0.0)) return found;
  one.search = {{area.step, area.low.x(), area.high.x()},
                {area.step, area.low.y(), area.high.y()},
                {0.5 * area.step, 0.1 * area.step, 4.0 * area.step}};
  for (const double radius : radii) {
    for (const Vector2& centre : area.centres) {
      found.push_back(with_parameters(one, {centre.x(), centre.y(), radius * area.step}));
    }
  }
  return found;
}

Candidates at_thresholds(Candidate one, const Spread& u) {
  Candidates found;
  if (u.distinct < 3) return found;
  const double range = u.most - u.least;
  one.search = {{0.2 * range, u.least + 0.02 * range, u.most - 0.02 * range}};
  std::set<double> tried;
  for (const double share : {0.15, 0.3, 0.5, 0.7, 0.85}) {
    const double c = u.quantile(share);
    if (c > one.search[0].least && c < one.search[0].most && tried.insert(c).second) {
      found.push_back(with_parameters(one, {c}));
    }
  }
  return found;
}

/// Of an entry with parameters.
Candidates of_family(const CatalogueEntry& entry, const Grounds& grounds) {
  Candidate one;
  one.effect.name = std::string(entry.name);
  one.effect.channel = entry.channel;
  one.family = std::string(entry.name);
  one.pattern = entry.pattern;
  for (const OpenParameter& parameter : entry.parameters) {
    one.parameters.push_back({std::string(parameter.name), parameter.usual});
  }
  Candidates found;
  if (entry.parameters.size() == 3) {
    one.variable = "place";
    found = at_places(one, {0.75, 1.5}, grounds.area);
    // A patch may have no sharp edge, an anomaly may have one.
    Candidate other = one;
    const bool disc = entry.pattern.front() != effects::kDiscPattern;
    other.pattern = {disc ? effects::kDiscPattern : effects::kBellPattern};
    other.effect.name =
        fmt::format("{} {}", name_of(entry.channel), disc ? "within a circle" : "at a place");
    other.family = other.effect.name;
    other.form = Form::place;
    other.log_prior = -1.0;
    append(found, at_places(other, {0.75, 1.5}, grounds.area));
  } else {
    one.variable = "speed";
    for (const Spread& u : grounds.variables) {
      if (u.name == "speed") append(found, at_thresholds(one, u));
    }
  }
  return found;
}

/// What every robot has is twice as likely as what few have; a wheel beside the middle comes before
/// a sensor there, where no motion tells which it is.
double prior_of(const CatalogueEntry& entry) {
  constexpr double kEveryRobotHasIt = 0.7;
  constexpr double kBefore = 0.1;
  const effects::CatalogueRecord* record = effects::find_record(entry.name);
  double prior = record != nullptr && record->robot_constant ? kEveryRobotHasIt : 0.0;
  if (effects::is_wheels_place(entry.channel)) prior += kBefore;
  return prior;
}

/// Whether it is of a left and a right wheel that change direction each for itself.
bool is_of_sides(const CatalogueEntry& entry) {
  return std::ranges::any_of(entry.pattern,
                             [](std::string_view one) { return one.starts_with("reverses_"); });
}

Candidates of_catalogue(const Grounds& grounds) {
  Candidates found;
  const bool sides = drive::has_left_and_right(grounds.context.robot());
  for (const CatalogueEntry& entry : catalogue()) {
    if (!grounds.allow(entry.channel)) continue;
    if (!sides && is_of_sides(entry)) continue;
    Candidate one;
    if (entry.of_covariate()) {
      std::vector<std::string> names(entry.also_of.begin(), entry.also_of.end());
      names.insert(names.end(), grounds.covariates.begin(), grounds.covariates.end());
      for (const std::string& name : names) {
        const std::optional<double> log_prior = suits(entry, name);
        if (!log_prior) continue;
        one.effect = catalogue_effect(entry, name);
        one.variable = name;
        one.log_prior = *log_prior;
        found.push_back(one);
      }
    } else if (entry.has_parameters()) {
      append(found, of_family(entry, grounds));
    } else {
      one.effect = catalogue_effect(entry);
      one.log_prior = prior_of(entry);
      found.push_back(one);
    }
  }
  return found;
}

/// In steps and above thresholds, both at values of the variable.
Candidates at_values(Channel channel, const Spread& u, bool covariate) {
  const std::string& n = u.name;
  Candidate step = plain(channel, u, Form::step, {}, "a step in " + n, -2.5);
  step.family = step.effect.name;
  step.pattern = {"(1+sign(" + n + "-{c}))/2"};
  step.parameters = {{"c", 0.0}};
  Candidates found = at_thresholds(step, u);
  if (covariate || n == "speed") {
    Candidate threshold = plain(channel, u, Form::threshold, {}, n + " above a threshold", -2.5);
    threshold.family = threshold.effect.name;
    threshold.pattern = {"max(0, " + n + "-{c})"};
    threshold.parameters = {{"c", 0.0}};
    append(found, at_thresholds(threshold, u));
  }
  return found;
}

Candidates of_variable(Channel channel, const Spread& u, bool covariate) {
  Candidates found;
  const std::string& n = u.name;
  // On a leg that is all but straight the sign of the turn rate is noise of the wheels, the same
  // that a difference between them would explain.
  if (n == "turn_rate" && channel != Channel::turn && channel != Channel::travel &&
      channel != Channel::compass) {
    return found;
  }
  // A covariate that is far from 0 throughout (a temperature) is taken from its mean.
  const double middle = 0.5 * (u.least + u.most);
  const bool centred = covariate && !u.two_sided() && std::abs(middle) > 1.5 * (u.most - u.least);
  const double mean = centred ? text::rounded_within(u.mean, u.most - u.least) : 0.0;
  const std::string v = centred ? filled("(" + n + "-{mean})", {{"mean", mean}}) : n;
  const auto add = [&](Form form, std::vector<Shape> shapes, const std::string& said,
                       double log_prior) {
    found.push_back(plain(channel, u, form, std::move(shapes), said, log_prior));
  };
  add(Form::line, {v}, n, covariate ? -1.0 : -2.0);
  if (channel != Channel::drift && (covariate || n == "speed" || n == "t")) {
    add(Form::with_heading, {v + "*sin(heading)", v + "*cos(heading)"}, n + " and heading", -3.0);
  }
  if (u.distinct < 3) return found;
  const bool signs = u.two_sided() && n != "x" && n != "y";
  if (signs && !covariate) {
    add(Form::magnitude, {"abs(" + n + ")"}, "the size of " + n, -2.5);
    add(Form::sense, {"sign(" + n + ")"}, "the sign of " + n, -2.5);
  }
  if (n == "x" || n == "y" || n == "acceleration") return found;
  add(Form::square, {v + "^2"}, n + " squared", -2.5);
  append(found, at_values(channel, u, covariate));
  if (u.distinct < 6) return found;
  const std::vector<Shape> bells = bells_over(u);
  if (!bells.empty()) add(Form::curve, bells, "a curve of " + n, -3.0);
  return found;
}

Candidates of_heading(Channel channel) {
  Spread heading;
  heading.name = "heading";
  return {plain(channel, heading, Form::curve, {"sin(heading)", "cos(heading)"}, "heading", -2.0),
          plain(channel, heading, Form::curve, {"sin(2*heading)", "cos(2*heading)"},
                "twice the heading", -3.0),
          plain(channel, heading, Form::curve,
                {"sin(heading)", "cos(heading)", "sin(2*heading)", "cos(2*heading)"},
                "a curve of heading", -3.0)};
}

Candidates of_place(Channel channel, const Area& area) {
  Candidate bell;
  bell.effect.channel = channel;
  bell.effect.name = fmt::format("{} at a place", name_of(channel));
  bell.form = Form::place;
  bell.variable = "place";
  bell.family = bell.effect.name;
  bell.pattern = {effects::kBellPattern};
  bell.parameters = {{"x", 0.0}, {"y", 0.0}, {"r", 0.0}};
  bell.log_prior = -3.0;
  return at_places(bell, {1.0}, area);
}

/// Bells all over the floor show that something goes with the place, be it no one place.
Candidates of_floor(Channel channel, const Area& area) {
  const bool shows = channel == Channel::travel || channel == Channel::turn ||
                     channel == Channel::creep || channel == Channel::compass;
  std::vector<Shape> bells = shows ? bells_over(area) : std::vector<Shape>();
  if (bells.size() < 2) return {};
  Spread place;
  place.name = "place";
  return {plain(channel, place, Form::curve, std::move(bells), "a map of the floor", -3.0)};
}

Candidates of_drive_channel(Channel channel, const Grounds& grounds) {
  Candidates found;
  const bool wheel =
      channel == Channel::left || channel == Channel::right || channel == Channel::wheels;
  if (!wheel && channel != Channel::drift) {
    found = of_heading(channel);
    if (channel != Channel::compass) append(found, of_place(channel, grounds.area));
    append(found, of_floor(channel, grounds.area));
  }
  for (const Spread& u : grounds.variables) {
    const bool covariate = grounds.is_covariate(u.name);
    if (wheel && !covariate && u.name != "t" && u.name != "distance" && u.name != "speed") {
      continue;
    }
    if (channel == Channel::drift && !covariate && u.name != "t") continue;
    append(found, of_variable(channel, u, covariate));
  }
  return found;
}

Candidates of_view_channel(Channel channel, const Grounds& grounds) {
  Candidates found;
  Spread heading;
  heading.name = "heading";
  if (channel != Channel::delay) {
    found.push_back(
        plain(channel, heading, Form::curve, {"sin(heading)", "cos(heading)"}, "heading", -3.0));
  }
  for (const Spread& u : grounds.variables) {
    const bool covariate = grounds.is_covariate(u.name);
    if (!covariate && u.name != "t" && u.name != "session" && u.name != "speed" &&
        u.name != "turn_rate") {
      continue;
    }
    // Clocks know nothing of motion.
    if (channel == Channel::delay && recording::is_rate(u.name)) continue;
    found.push_back(plain(channel, u, Form::line, {u.name}, u.name, -2.0));
  }
  if (grounds.context.recordings().size() > 1) {
    Candidate one;
    one.effect.channel = channel;
    one.effect.name = fmt::format("{} of its own in each session", name_of(channel));
    one.effect.shape = {"1"};
    one.effect.per_session = true;
    one.form = Form::curve;
    one.variable = "session";
    one.log_prior = -2.0;
    found.push_back(one);
  }
  return found;
}

/// The catalogue may have two names for one thing; all else is tried once.
Candidates each_once(Candidates all) {
  Candidates kept;
  std::set<std::string> seen;
  for (Candidate& one : all) {
    one.effect.coefficients.clear();
    std::string key(name_of(one.effect.channel));
    for (const Shape& shape : one.effect.shape) key += "|" + shape.text();
    if (one.effect.per_session) key += "|per session";
    if (!seen.insert(key).second && one.form != Form::catalogue) continue;
    kept.push_back(std::move(one));
  }
  return kept;
}

}  // namespace

std::vector<Candidate> candidates_for(const fitting::FitState& fit,
                                      const fitting::ShapeContext& context) {
  const Grounds grounds = grounds_of(fit, context);
  Candidates all = of_catalogue(grounds);
  for (const Channel channel :
       {Channel::travel,  Channel::turn,   Channel::difference, Channel::creep,
        Channel::compass, Channel::drift,  Channel::left,       Channel::right,
        Channel::wheels,  Channel::gyro,   Channel::gyro_scale, Channel::sideways,
        Channel::wheel1,  Channel::wheel2, Channel::wheel3,     Channel::wheel4,
        Channel::wheel5,  Channel::wheel6, Channel::steer,      Channel::steer_gain}) {
    if (grounds.allow(channel)) append(all, of_drive_channel(channel, grounds));
  }
  for (const Channel channel :
       {Channel::lever, Channel::lever_left, Channel::range, Channel::range_scale, Channel::bearing,
        Channel::delay, Channel::truth_heading, Channel::antenna, Channel::antenna_left,
        Channel::fix_delay, Channel::sighting_yaw, Channel::scanner, Channel::scanner_left,
        Channel::scanner_yaw}) {
    if (grounds.allow(channel)) append(all, of_view_channel(channel, grounds));
  }
  return each_once(std::move(all));
}

const effects::CatalogueRecord* record_of(const Candidate& candidate) {
  return candidate.form == Form::catalogue ? effects::find_record(candidate.effect.name) : nullptr;
}

}  // namespace trussmap::criticism
