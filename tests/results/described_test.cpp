// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A list of fields gives JSON and its schema: here of a result that no command has, with a field of
// every kind.
#include "results/json.hpp"
#include "results/schema.hpp"

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::described_test {

enum class Mood { calm, cross };
std::string_view name_of(Mood mood) {
  return mood == Mood::calm ? "calm" : "cross";
}

struct Point {
  double x = 0.0;
  double y = 0.0;
};
struct Base {
  int count = 3;
};
struct Wheel {
  double radius = 0.1;
  Point hub;
};
struct Whole {
  Base base;
  double length = 1.5;
  double unknown = std::numeric_limits<double>::quiet_NaN();
  bool good = true;
  Mood mood = Mood::cross;
  std::optional<double> maybe = std::nullopt;
  std::optional<double> there = 2.0;
  std::optional<std::string> absent = std::nullopt;
  std::vector<std::string> texts = {"a", "b"};
  std::vector<double> gaps = {1.0, std::numeric_limits<double>::infinity()};
  std::array<double, 2> interval = {-1.0, 1.0};
  std::pair<std::string, std::string> ends = {"A", "B"};
  std::map<std::string, Point> places = {{"A", {1.0, 2.0}}};
  std::vector<Wheel> wheels = {{0.2, {3.0, 4.0}}};
  const Point* seen = nullptr;

  [[nodiscard]] Wheel first() const { return wheels.front(); }
};

}  // namespace trussmap::described_test

namespace trussmap::results {

using described_test::Base;
using described_test::Point;
using described_test::Wheel;
using described_test::Whole;

template <>
inline constexpr auto kDescribed<Point> =
    described(field("x", &Point::x, "m"), field("y", &Point::y, "m")).named("point");
template <>
inline constexpr auto kDescribed<Base> =
    described(field("count", &Base::count, "of all").at_least(0.0));
template <>
inline constexpr auto kDescribed<Wheel> = described(field("radius_m", &Wheel::radius),
                                                    keys_of("hub", &Wheel::hub));
template <>
inline constexpr auto kDescribed<Whole> = described(
    keys_of("base", &Whole::base), field("length_m", &Whole::length, "of it"),
    field("unknown", &Whole::unknown).or_null(), field("good", &Whole::good),
    field("mood", &Whole::mood).one_of("calm | cross"), field("maybe", &Whole::maybe),
    field("there", &Whole::there, "if any").if_any(), field("absent", &Whole::absent).if_any(),
    field("texts", &Whole::texts), field("gaps", &Whole::gaps).or_null(),
    share("twice", [](const Whole& one) { return 2.0 * one.length; }),
    field("interval", &Whole::interval), field("ends", &Whole::ends),
    field("places", &Whole::places, "by name"), field("wheels", &Whole::wheels),
    field("seen", &Whole::seen), field("group", described(field("good", &Whole::good, "again"))),
    field("first_hub_x", through(&Whole::first, &Wheel::hub, &Point::x)).since_version("0.3.0"));

}  // namespace trussmap::results

namespace trussmap::described_test {
namespace {

using results::Json;

TEST(DescribedResult, IsWrittenFieldByField) {
  EXPECT_EQ(results::json_of(Whole()), Json::parse(R"({
    "count": 3, "length_m": 1.5, "unknown": null, "good": true, "mood": "cross", "maybe": null,
    "there": 2.0, "texts": ["a", "b"], "gaps": [1.0, null], "twice": 3.0, "interval": [-1.0, 1.0],
    "ends": ["A", "B"], "places": {"A": {"x": 1.0, "y": 2.0}},
    "wheels": [{"radius_m": 0.2, "x": 3.0, "y": 4.0}], "seen": null, "group": {"good": true},
    "first_hub_x": 3.0})"));
  Whole other;
  const Point seen{5.0, 6.0};
  other.seen = &seen;
  other.absent = "there";
  other.maybe = -1.0;
  const Json written = results::json_of(other);
  EXPECT_EQ(written["seen"], Json::parse(R"({"x": 5.0, "y": 6.0})"));
  EXPECT_EQ(written["absent"], "there");
  EXPECT_EQ(written["maybe"], -1.0);
}

TEST(DescribedResult, HasASchema) {
  results::SchemaMaker maker;
  maker.define<Whole>("whole", "all of it");
  const Json whole = maker.definitions().at("whole");
  EXPECT_EQ(whole["description"], "all of it");
  EXPECT_EQ(maker.definitions().at("point"), Json::parse(R"({"type": "object",
      "required": ["x", "y"], "properties": {"x": {"type": "number", "description": "m"},
                                             "y": {"type": "number", "description": "m"}}})"));
  EXPECT_EQ(whole["properties"], Json::parse(R"({
    "count": {"type": "integer", "minimum": 0.0, "description": "of all"},
    "length_m": {"type": "number", "description": "of it"},
    "unknown": {"type": ["number", "null"]},
    "good": {"type": "boolean"},
    "mood": {"enum": ["calm", "cross"]},
    "maybe": {"type": ["number", "null"]},
    "there": {"type": "number", "description": "if any"},
    "absent": {"type": "string"},
    "texts": {"type": "array", "items": {"type": "string"}},
    "gaps": {"type": "array", "items": {"type": ["number", "null"]}},
    "twice": {"type": "number", "minimum": 0.0, "maximum": 1.0},
    "interval": {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2},
    "ends": {"type": "array", "minItems": 2, "maxItems": 2, "items": {"type": "string"}},
    "places": {"type": "object", "additionalProperties": {"$ref": "#/definitions/point"},
               "description": "by name"},
    "wheels": {"type": "array", "items": {"type": "object", "required": ["radius_m"],
               "properties": {"radius_m": {"type": "number"}},
               "allOf": [{"$ref": "#/definitions/point"}]}},
    "seen": {"anyOf": [{"$ref": "#/definitions/point"}, {"type": "null"}]},
    "group": {"type": "object", "required": ["good"],
              "properties": {"good": {"type": "boolean", "description": "again"}}},
    "first_hub_x": {"type": "number", "$comment": "since 0.3.0"}})"));
  const std::vector<std::string> required = whole["required"];
  EXPECT_EQ(required,
            (std::vector<std::string>{"count", "length_m", "unknown", "good", "mood", "maybe",
                                      "texts", "gaps", "twice", "interval", "ends", "places",
                                      "wheels", "seen", "group", "first_hub_x"}));
}

}  // namespace
}  // namespace trussmap::described_test
