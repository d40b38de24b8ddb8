// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/logs/named_fields.hpp"

namespace trussmap {
namespace {

/// In the unit that its name has, else in this one.
void guess_with_unit(const std::string& key, const NamedFacts& field, const char* else_unit,
                     const char* why, MapText& text) {
  text.text(key, field.facts->path);
  const std::optional<Unit> unit = unit_in(field.path);
  if (is_of(unit, {Quantity::length, Quantity::angle})) {
    text.text(key + "_unit", std::string(unit->name));
  } else {
    text.text(key + "_unit", else_unit, why);
  }
}

void guess_range(const NamedFacts& field, MapText& text) {
  guess_with_unit("range", field, field.facts->largest > 100.0 ? "mm" : "m", "a guess by its size",
                  text);
}

void guess_bearing(const NamedFacts& field, MapText& text) {
  guess_with_unit("bearing", field, looks_like_degrees(*field.facts) ? "deg" : "rad",
                  "a guess by its range", text);
  text.number("bearing_sign", 1, "-1 where it grows clockwise");
}

/// A field below the message that a sighting is in: the column, or what follows the topic.
void guess_landmark(const NamedFacts& name, MapText& text) {
  const bool below = name.path.find('/') != std::string::npos && !name.facts->path.empty();
  const std::string topic =
      below ? name.path.substr(0, name.path.size() - name.facts->path.size() - 1) : "";
  if (below) text.text("topic", topic);
  if (!below && name.facts->path.empty()) {  // an entry of its own
    text.text("topic", name.path);
    text.line("landmark = \".\"");
  } else {
    text.text("landmark", name.facts->path);
  }
}

/// Which names mean nothing, and whether a reading stays in the rows until the next one.
void guess_repeats(const NamedFacts& name, const NamedFacts* range, MapText& text) {
  const bool numbers = !name.facts->is_text;
  if (numbers && (name.facts->least == -1.0 || name.facts->least == 0.0)) {
    text.line(fmt::format("none = [\"{:.0f}\"]", name.facts->least), "means that nothing is seen");
  }
  // A reading that stays in the rows until the next one must count once.
  const auto rows = static_cast<double>(name.facts->values);
  const double news =
      static_cast<double>(range != nullptr ? range->facts->different : name.facts->different);
  if (rows > 0.0 && news < 0.5 * rows) {
    text.line("changes = true", "rows often repeat the one before: each reading counts once");
  }
}

bool guess_planar_fixes(const FreeFields::Words& words, FreeFields& fields, MapText& text) {
  const NamedFacts* x = fields.take({words, {"x", "east"}});
  const NamedFacts* y = x == nullptr ? nullptr : fields.take({words, {"y", "north"}});
  if (y == nullptr) return false;
  text.blank();
  text.table("fixes");
  text.text("x", x->facts->path);
  text.text("y", y->facts->path);
  if (const auto unit = unit_in(x->path); is_of(unit, {Quantity::length})) {
    text.text("unit", std::string(unit->name));
  }
  return true;
}

}  // namespace

bool guess_sightings(FreeFields& fields, MapText& text) {
  static const FreeFields::Words kMarks{"tag",      "landmark", "marker",  "code", "beacon",
                                        "fiducial", "aruco",    "station", "rfid", "line"};
  const NamedFacts* range =
      fields.find({{"range", "distance", "dist"}}, {"truth", "left", "right"});
  const NamedFacts* bearing =
      fields.find({{"bearing", "azimuth", "angle", "tx"}}, {"truth", "left", "right"});
  const NamedFacts* name =
      fields.find({kMarks}, {"range", "dist", "bearing", "angle", "yaw", "time"}, true);
  if (name == nullptr) {
    name = fields.find({kMarks}, {"range", "dist", "bearing", "angle", "yaw", "time", "_x", "_y"});
  }
  if (name == nullptr) return false;
  text.blank();
  text.list("sightings",
            range == nullptr && bearing == nullptr ? "the robot stands on what it names" : "");
  guess_landmark(*name, text);
  fields.mark_taken(*name);
  if (range != nullptr) {
    fields.mark_taken(*range);
    guess_range(*range, text);
  }
  if (bearing != nullptr) {
    fields.mark_taken(*bearing);
    guess_bearing(*bearing, text);
  }
  guess_repeats(*name, range, text);
  return true;
}

bool guess_fixes(FreeFields& fields, MapText& text) {
  const NamedFacts* latitude = fields.take({{"latitude", "lat"}}, {"latency", "left"});
  const NamedFacts* longitude =
      latitude == nullptr ? nullptr : fields.take({{"longitude", "lon", "lng"}});
  if (longitude != nullptr) {
    text.blank();
    text.table("fixes", "x to the east and y to the north of the first");
    text.text("latitude", latitude->facts->path);
    text.text("longitude", longitude->facts->path);
    return true;
  }
  return guess_planar_fixes({"gps", "gnss", "uwb", "fix", "utm", "east"}, fields, text);
}

bool guess_truth(FreeFields& fields, MapText& text) {
  static const FreeFields::Words kTruth{"truth", "true", "mocap", "vicon", "opti", "ground", "gt_"};
  const NamedFacts* x = fields.take({kTruth, {"x"}});
  const NamedFacts* y = x == nullptr ? nullptr : fields.take({kTruth, {"y"}}, {"yaw"});
  const NamedFacts* heading =
      y == nullptr ? nullptr : fields.take({kTruth, {"heading", "yaw", "theta", "angle", "th"}});
  if (heading == nullptr) return false;
  text.blank();
  text.table("truth");
  text.text("x", x->path);
  text.text("y", y->path);
  text.text("heading", heading->path);
  if (const auto unit = unit_in(x->path); is_of(unit, {Quantity::length})) {
    text.text("unit", std::string(unit->name));
  }
  const auto unit = unit_in(heading->path);
  const bool degrees =
      is_of(unit, {Quantity::angle}) ? unit->name == "deg" : looks_like_degrees(*heading->facts);
  text.text("heading_unit", degrees ? "deg" : "rad");
  return true;
}

}  // namespace trussmap
