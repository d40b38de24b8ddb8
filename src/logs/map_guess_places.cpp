// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/named_fields.hpp"

namespace trussmap::logs {
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
  write_file_of(name, text);
  const bool entry = name.facts->path.empty();
  if (!name.topic.empty()) text.text("topic", name.topic);
  text.text("landmark", entry ? "." : name.facts->path);
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
  for (const NamedFacts& x : fields.all()) {
    const auto fits = [&](const NamedFacts& one, char axis, const char* direction) {
      const std::string name = stem_of(one.file) + ' ' + one.path;
      const bool along = axis_of(one.path) == axis || has_word(one.path, {direction});
      return fields.is_free(one) && !one.facts->is_text && has_word(name, words) && along &&
             one.file == x.file && one.topic == x.topic &&
             !has_word(one.path, {"cov", "vel", "speed", "acc", "zone"});
    };
    if (!fits(x, 'x', "east")) continue;
    for (const NamedFacts& y : fields.all()) {
      if (!fits(y, 'y', "north")) continue;
      fields.mark_taken(x);
      fields.mark_taken(y);
      text.blank();
      text.table("fixes");
      write_file_of(x, text);
      if (!x.topic.empty()) text.text("topic", x.topic);
      text.text("x", x.facts->path);
      text.text("y", y.facts->path);
      if (const auto unit = unit_in(x.path); is_of(unit, {Quantity::length})) {
        text.text("unit", std::string(unit->name));
      }
      return true;
    }
  }
  return false;
}

/// The name of a landmark: a text, or a whole number, and neither a speed nor a count of rows.
const NamedFacts* landmark_in(const FreeFields& fields) {
  static const FreeFields::Words kMarks{"tag",      "landmark", "marker",  "code", "beacon",
                                        "fiducial", "aruco",    "station", "rfid", "anchor"};
  static const FreeFields::Words kNot{
      "range",    "dist",  "bearing", "angle", "yaw",  "time",   "pose",       "linear", "twist",
      "position", "speed", "vel",     "frame", "type", "family", "stationary", "seq",    "header"};
  for (const bool text : {true, false}) {
    for (const bool by_file : {false, true}) {
      for (const NamedFacts& one : fields.all()) {
        if (!fields.is_free(one) || one.facts->is_text != text || has_word(one.path, kNot))
          continue;
        if (!text && (!one.facts->is_whole || axis_of(one.path) != '\0')) continue;
        const bool called = has_word(one.path, kMarks) || has_word(one.path, {"=line"});
        const bool by_its_file = !one.file.empty() && has_word(stem_of(one.file), kMarks) &&
                                 (text || has_word(one.path, {"id", "name", "number", "label"}));
        if (by_file ? by_its_file : called) return &one;
      }
    }
  }
  return nullptr;
}

}  // namespace

bool guess_sightings(FreeFields& fields, MapText& text) {
  const NamedFacts* name = landmark_in(fields);
  if (name == nullptr) return false;
  fields.look_at(name->file);
  static const FreeFields::Words kNot{"truth", "left", "right", "std", "sd", "cov"};
  const NamedFacts* range = fields.find({{"range", "distance", "dist"}}, kNot);
  const NamedFacts* bearing = fields.find({{"bearing", "azimuth", "angle", "tx"}}, kNot);
  fields.look_at(std::nullopt);
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
  if (latitude != nullptr) fields.look_at(latitude->file);
  const NamedFacts* longitude =
      latitude == nullptr ? nullptr : fields.take({{"longitude", "lon", "lng"}});
  fields.look_at(std::nullopt);
  if (longitude != nullptr) {
    text.blank();
    text.table("fixes", "x to the east and y to the north of the first");
    write_file_of(*latitude, text);
    text.text("latitude", latitude->facts->path);
    text.text("longitude", longitude->facts->path);
    return true;
  }
  return guess_planar_fixes({"gps", "gnss", "uwb", "fix", "utm", "east"}, fields, text);
}

}  // namespace trussmap::logs
