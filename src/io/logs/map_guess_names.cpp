// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/logs/map_guess.hpp"
#include "io/logs/units.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace trussmap {
namespace {

bool is_of(const std::optional<Unit>& unit, std::initializer_list<Quantity> quantities) {
  return unit &&
         std::find(quantities.begin(), quantities.end(), unit->quantity) != quantities.end();
}

/// A sum so far has a range of many steps; what is added a row has not.
bool is_cumulative(const LogFieldFacts& facts) {
  if (facts.values < 3) return true;
  const double mean_step = facts.total_step / static_cast<double>(facts.values - 1);
  constexpr double kMany = 12.0;
  const double range = facts.largest - facts.least;
  const bool grows = facts.decreases == 0 || facts.decreases + 1 == facts.values;
  return range > kMany * mean_step || (grows && range > 2.0 * mean_step);
}

class NameGuesser {
 public:
  NameGuesser(const std::vector<NamedFacts>& fields, MapText& text)
      : fields_(fields), text_(text) {}

  Guessed guess(bool table) {
    time(table);
    wheels();
    headings();
    sightings();
    fixes();
    truth();
    covariates();
    return found_;
  }

 private:
  using Words = std::vector<std::string>;

  /// The first field that is not taken yet and has a word of each list, and none of `without`.
  const NamedFacts* pick(const std::vector<Words>& words, const Words& without, bool text) {
    for (const NamedFacts& one : fields_) {
      if (taken_.contains(one.path) || one.facts->is_text != text || one.facts->values == 0)
        continue;
      if (has_word(one.path, without)) continue;
      if (std::all_of(words.begin(), words.end(),
                      [&](const Words& any) { return has_word(one.path, any); })) {
        return &one;
      }
    }
    return nullptr;
  }
  const NamedFacts* take(const std::vector<Words>& words, const Words& without = {},
                         bool text = false) {
    const NamedFacts* found = pick(words, without, text);
    if (found != nullptr) taken_.insert(found->path);
    return found;
  }

  void state() { ++found_.to_state; }

  void time(bool table) {
    text_.table("time");
    if (!table) {
      // A Road Runner's messages have no times of their own.
      const NamedFacts* stamp = nullptr;
      for (const NamedFacts& one : fields_) {
        if (has_word(one.path, {"/timestamp"}) && one.facts->decreases == 0) stamp = &one;
      }
      const bool untimed = std::all_of(fields_.begin(), fields_.end(),
                                       [](const NamedFacts& one) { return one.step != one.step; });
      if (untimed && stamp != nullptr) {
        text_.text("field", stamp->path.substr(stamp->path.rfind('/') + 1));
        text_.text("unit", unit_of_times(*stamp));
      } else {
        text_.text("from", "log", "when it was written");
      }
      return;
    }
    const NamedFacts* column = nullptr;
    for (const NamedFacts& one : fields_) {
      if (!one.facts->is_text && one.facts->decreases == 0 && one.facts->different > 0 &&
          has_word(one.path, {"time", "stamp", "millis", "micros", "clock"})) {
        column = &one;
        break;
      }
    }
    for (const NamedFacts& one : fields_) {
      if (column != nullptr) break;
      if (!one.facts->is_text && one.facts->decreases == 0 && one.facts->different > 0)
        column = &one;
    }
    for (const NamedFacts& one : fields_) {
      if (column != nullptr) break;
      if (one.facts->is_text && has_word(one.path, {"time", "date", "stamp"})) {
        taken_.insert(one.path);
        text_.text("field", one.path);
        text_.text("unit", "calendar", "date and time, UTC");
        return;
      }
    }
    if (column == nullptr) {
      text_.line("field = \"\"", kState);
      state();
      return;
    }
    taken_.insert(column->path);
    text_.text("field", column->path);
    text_.text("unit", unit_of_times(*column));
  }

  static std::string unit_of_times(const NamedFacts& column) {
    const std::optional<Unit> named = unit_in(column.path);
    if (is_of(named, {Quantity::time})) return std::string(named->name);
    const LogFieldFacts& facts = *column.facts;
    // Since 1970, or by the step: no robot writes a row an hour or 100 000 a second.
    if (facts.least > 1e17) return "ns";
    if (facts.least > 1e14) return "us";
    if (facts.least > 1e11) return "ms";
    if (facts.least > 1e8) return "s";
    const double step = facts.total_step / std::max(1.0, static_cast<double>(facts.values - 1));
    if (step >= 1e6) return "ns";
    if (step >= 2e3) return "us";
    return step >= 2.0 ? "ms" : "s";
  }

  /// What both wheels have in common.
  void wheel_constants(const NamedFacts& field) {
    text_.blank();
    text_.table("wheels");
    std::optional<Unit> unit = unit_in(field.path);
    const bool speed = has_word(field.path, {"vel", "speed", "rate"}) ||
                       is_of(unit, {Quantity::speed, Quantity::turn_rate});
    const bool whole = field.facts->is_whole && field.facts->largest - field.facts->least > 50.0;
    const bool ticks = is_of(unit, {Quantity::ticks}) ||
                       (!unit && (whole || has_word(field.path, {"tick", "count"})));
    if (ticks) {
      text_.text("unit", speed ? "tick/s" : "tick");
      text_.number("ticks_per_turn", 1000, kState);
      text_.number("radius", 0.05, std::string("m; ") + kState);
      found_.to_state += 2;
    } else if (is_of(unit, {Quantity::angle, Quantity::turn_rate})) {
      text_.text("unit", std::string(unit->name));
      text_.number("radius", 0.05, std::string("m; ") + kState);
      state();
    } else if (is_of(unit, {Quantity::length, Quantity::speed})) {
      text_.text("unit", std::string(unit->name));
    } else {
      text_.text("unit", speed ? "m/s" : "m", "a guess: its name states none");
    }
    if (!speed) {
      const bool sum = is_cumulative(*field.facts);
      text_.text("kind", sum ? "cumulative" : "per row",
                 sum ? "the sum so far" : "what was added since the row before");
      const double top = field.facts->largest;
      for (const double wraps : {256.0, 65536.0, 4294967296.0}) {
        if (sum && ticks && field.facts->least >= 0.0 && top < wraps && top > 0.98 * wraps) {
          text_.number("wraps", wraps, "where the counter begins again");
        }
      }
    }
  }

  void wheel(const char* name, const NamedFacts& field) {
    text_.blank();
    text_.table(std::string("wheels.") + name);
    text_.text("field", field.path);
    text_.number("sign", 1, "-1 where it counts down ahead");
  }

  void wheels() {
    static const Words kLeft{"left", "l_", "_l", "lf", "enc_l", "encl"};
    static const Words kRight{"right", "r_", "_r", "rf", "enc_r", "encr"};
    static const Words kTravel{"enc", "tick", "count", "dist", "pos", "travel", "odo", "wheel"};
    static const Words kNot{"power", "current", "volt",     "target",  "goal",    "range",
                            "tag",   "temp",    "setpoint", "command", "applied", "output"};
    const auto pair = [&](const Words& what, const Words& without) {
      const NamedFacts* left = pick({kLeft, what}, without, false);
      if (left == nullptr) return false;
      taken_.insert(left->path);
      const NamedFacts* right = pick({kRight, what}, without, false);
      if (right == nullptr) {
        taken_.erase(left->path);
        return false;
      }
      taken_.insert(right->path);
      text_.blank();
      text_.table("robot");
      text_.number("wheelbase", Robot().wheelbase, std::string("m between the wheels; ") + kState);
      state();
      wheel_constants(*left);
      wheel("left", *left);
      wheel("right", *right);
      found_.wheels = true;
      return true;
    };
    Words slow = kNot;
    slow.insert(slow.end(), {"vel", "speed", "rate"});
    if (pair(kTravel, slow)) return;
    if (pair({""}, slow)) return;
    static_cast<void>(pair({"vel", "speed", "rate"}, kNot));
  }

  void angle(const NamedFacts& field, const char* table, bool rate) {
    text_.blank();
    text_.table(table);
    text_.text("field", field.path);
    const std::optional<Unit> unit = unit_in(field.path);
    constexpr double kTurn = 7.0;  // rad; what ranges over more is in degrees
    const double range = field.facts->largest - field.facts->least;
    if (is_of(unit, {rate ? Quantity::turn_rate : Quantity::angle})) {
      text_.text("unit", std::string(unit->name));
    } else if (is_of(unit, {Quantity::angle, Quantity::turn_rate})) {
      const bool degrees = unit->name.starts_with("deg");
      text_.text("unit", std::string(degrees ? "deg" : "rad") + (rate ? "/s" : ""));
    } else {
      text_.text("unit", std::string(range > kTurn ? "deg" : "rad") + (rate ? "/s" : ""),
                 "a guess by its range");
    }
    text_.number("sign", 1, "-1 where it grows clockwise");
  }

  void headings() {
    static const Words kNot{"tag", "target", "goal",  "setpoint", "truth", "temp", "bearing",
                            "gps", "accel",  "pitch", "roll",     "_x",    "_y"};
    if (const NamedFacts* rate = take({{"gyro", "yaw", "heading", "angular"},
                                       {"rate", "vel", "omega", "/s", "dps", "angular"}},
                                      kNot)) {
      angle(*rate, "yaw_rate", true);
    } else if (const NamedFacts* omega =
                   take({{"omega", "yawrate", "gyro_z", "gyroz", "gz"}}, kNot)) {
      angle(*omega, "yaw_rate", true);
    } else if (const NamedFacts* sum = take({{"gyro", "navx", "pigeon", "imu"}}, kNot)) {
      angle(*sum, "yaw_rate",
            !is_cumulative(*sum->facts) && !is_of(unit_in(sum->path), {Quantity::angle}));
    }
    if (const NamedFacts* compass = take({{"compass", "magnet", "heading", "yaw"}}, kNot)) {
      text_.blank();
      text_.comment("If this is a compass; a gyro's sum is [yaw_rate] with the same keys:");
      angle(*compass, "heading", false);
    }
  }

  /// A field below the message that a sighting is in: the column, or what follows the topic.
  void sightings() {
    static const Words kMarks{"tag",      "landmark", "marker",  "code", "beacon",
                              "fiducial", "aruco",    "station", "rfid", "line"};
    const NamedFacts* range =
        pick({{"range", "distance", "dist"}}, {"truth", "left", "right"}, false);
    const NamedFacts* bearing =
        pick({{"bearing", "azimuth", "angle", "tx"}}, {"truth", "left", "right"}, false);
    const NamedFacts* name =
        pick({kMarks}, {"range", "dist", "bearing", "angle", "yaw", "time"}, true);
    if (name == nullptr) {
      name =
          pick({kMarks}, {"range", "dist", "bearing", "angle", "yaw", "time", "_x", "_y"}, false);
    }
    if (name == nullptr) return;
    const bool below = name->path.find('/') != std::string::npos && !name->facts->path.empty();
    const std::string topic =
        below ? name->path.substr(0, name->path.size() - name->facts->path.size() - 1) : "";
    text_.blank();
    text_.list("sightings",
               range == nullptr && bearing == nullptr ? "the robot stands on what it names" : "");
    if (below) text_.text("topic", topic);
    if (!below && name->facts->path.empty()) {  // an entry of its own
      text_.text("topic", name->path);
      text_.line("landmark = \".\"");
    } else {
      text_.text("landmark", name->facts->path);
    }
    taken_.insert(name->path);
    for (const auto& [field, key] : {std::pair{range, "range"}, std::pair{bearing, "bearing"}}) {
      if (field == nullptr) continue;
      taken_.insert(field->path);
      text_.text(key, field->facts->path);
      const std::optional<Unit> unit = unit_in(field->path);
      if (is_of(unit, {Quantity::length, Quantity::angle})) {
        text_.text(std::string(key) + "_unit", std::string(unit->name));
      } else if (std::string(key) == "bearing") {
        text_.text("bearing_unit",
                   field->facts->largest - field->facts->least > 7.0 ? "deg" : "rad",
                   "a guess by its range");
      } else {
        text_.text("range_unit", field->facts->largest > 100.0 ? "mm" : "m", "a guess by its size");
      }
      if (std::string(key) == "bearing")
        text_.number("bearing_sign", 1, "-1 where it grows clockwise");
    }
    const bool numbers = !name->facts->is_text;
    if (numbers && (name->facts->least == -1.0 || name->facts->least == 0.0)) {
      text_.line(fmt::format("none = [\"{:.0f}\"]", name->facts->least),
                 "means that nothing is seen");
    }
    // A reading that stays in the rows until the next one must count once.
    const auto rows = static_cast<double>(name->facts->values);
    const double news =
        static_cast<double>(range != nullptr ? range->facts->different : name->facts->different);
    if (rows > 0.0 && news < 0.5 * rows) {
      text_.line("changes = true", "rows often repeat the one before: each reading counts once");
    }
    found_.places = true;
  }

  void fixes() {
    const NamedFacts* latitude = take({{"latitude", "lat"}}, {"latency", "left"});
    const NamedFacts* longitude =
        latitude == nullptr ? nullptr : take({{"longitude", "lon", "lng"}});
    if (longitude != nullptr) {
      text_.blank();
      text_.table("fixes", "x to the east and y to the north of the first");
      text_.text("latitude", latitude->facts->path);
      text_.text("longitude", longitude->facts->path);
      found_.places = true;
      return;
    }
    pair_of("fixes", {"gps", "gnss", "uwb", "fix", "utm", "east"});
  }

  void pair_of(const char* table, const Words& words) {
    const NamedFacts* x = take({words, {"x", "east"}});
    const NamedFacts* y = x == nullptr ? nullptr : take({words, {"y", "north"}});
    if (y == nullptr) return;
    text_.blank();
    text_.table(table);
    text_.text("x", x->facts->path);
    text_.text("y", y->facts->path);
    if (const auto unit = unit_in(x->path); is_of(unit, {Quantity::length})) {
      text_.text("unit", std::string(unit->name));
    }
    found_.places = true;
  }

  void truth() {
    static const Words kTruth{"truth", "true", "mocap", "vicon", "opti", "ground", "gt_"};
    const NamedFacts* x = take({kTruth, {"x"}});
    const NamedFacts* y = x == nullptr ? nullptr : take({kTruth, {"y"}}, {"yaw"});
    const NamedFacts* heading =
        y == nullptr ? nullptr : take({kTruth, {"heading", "yaw", "theta", "angle", "th"}});
    if (heading == nullptr) return;
    text_.blank();
    text_.table("truth");
    text_.text("x", x->path);
    text_.text("y", y->path);
    text_.text("heading", heading->path);
    if (const auto unit = unit_in(x->path); is_of(unit, {Quantity::length})) {
      text_.text("unit", std::string(unit->name));
    }
    const auto unit = unit_in(heading->path);
    const bool degrees = is_of(unit, {Quantity::angle})
                             ? unit->name == "deg"
                             : heading->facts->largest - heading->facts->least > 7.0;
    text_.text("heading_unit", degrees ? "deg" : "rad");
    found_.places = true;
  }

  void covariates() {
    bool any = false;
    std::set<std::string> names;
    for (const NamedFacts& one : fields_) {
      if (taken_.contains(one.path) || one.facts->is_text || one.facts->different == 0) continue;
      if (!has_word(one.path, {"batt", "volt", "temp", "payload", "load", "current", "light",
                               "mass", "weight", "pressure"})) {
        continue;
      }
      if (!any) {
        text_.blank();
        text_.table("covariates", "what else may matter; a row has the last value before its end");
      }
      any = true;
      const std::string name = covariate_name(one.path);
      if (names.insert(name).second) text_.text(name, one.path);
    }
  }

  const std::vector<NamedFacts>& fields_;
  MapText& text_;
  Guessed found_;
  std::set<std::string> taken_;
};

}  // namespace

Guessed guess_by_names(const std::vector<NamedFacts>& fields, bool table, MapText& text) {
  return NameGuesser(fields, text).guess(table);
}

}  // namespace trussmap
