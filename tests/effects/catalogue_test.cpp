// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/catalogue.hpp"

#include "drive/row_variables.hpp"
#include "text/edit_distance.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::catalogue_test {
using namespace text;
namespace {

TEST(Catalogue, EveryShapeCanBeReadAndSpeaksOfWhatThereIs) {
  const std::vector<std::string>& known = recording::reserved_variables();
  std::set<std::string_view> names;
  for (const CatalogueEntry& entry : catalogue()) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    Effect effect{"", entry.channel, {}, {}};
    if (entry.of_covariate()) {
      effect = catalogue_effect(entry, "payload_kg");
    } else if (entry.has_parameters()) {
      std::vector<ShapeParameter> parameters;
      for (const OpenParameter& one : entry.parameters) {
        parameters.push_back({std::string(one.name), -1.5});
      }
      effect = catalogue_effect(entry, parameters);
    } else {
      effect = catalogue_effect(entry);
    }
    EXPECT_EQ(find_entry(effect.name), &entry);
    EXPECT_EQ(catalogue_effect(effect.name).shape, effect.shape);
    EXPECT_EQ(effect.shape.size(), entry.pattern.size());
    for (const Shape& shape : effect.shape) {
      for (const std::string& variable : shape.variables()) {
        EXPECT_TRUE(variable == "payload_kg" ||
                    std::find(known.begin(), known.end(), variable) != known.end())
            << variable;
      }
    }
  }
}

std::string complaint(const std::string& name, const std::vector<double>& coefficients = {}) {
  try {
    (void)catalogue_effect(name, coefficients);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "none";
}

TEST(EditDistance, CountsLettersThatDiffer) {
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("abc", ""), 3U);
  EXPECT_EQ(edit_distance("Hard Iron", "hard iron"), 0U);
  EXPECT_EQ(edit_distance("turn", "trun"), 2U);
}

TEST(Catalogue, ANameAloneIsEnoughAndAnUnknownOneIsRefused) {
  EXPECT_EQ(catalogue_effect("hard iron").channel, Channel::compass);
  EXPECT_EQ(catalogue_effect("load on one wheel (crates)").shape.front(), "crates");
  EXPECT_EQ(complaint("gremlins"),
            "effect \"gremlins\" is not in the catalogue, expected a channel and a shape");
  EXPECT_EQ(complaint("Weelbase"),
            "effect \"Weelbase\" is not in the catalogue, expected a channel and a shape; is "
            "\"wheelbase\" meant?");
  EXPECT_EQ(complaint("tyredrift (load)"),
            "effect \"tyredrift (load)\" is not in the catalogue, expected a channel and a shape; "
            "is \"tyre drift (COLUMN)\" meant?");
  EXPECT_EQ(complaint("wheels with speed"),
            "effect \"wheels with speed\" is not in the catalogue, expected a channel and a shape; "
            "what diagnose names so has its channel and shape beside it");
  EXPECT_EQ(complaint("tyre drift"),
            "effect \"tyre drift\" needs a covariate, expected \"tyre drift (COLUMN)\"");
  EXPECT_EQ(complaint("slope", {0.1}),
            "effect \"slope\" has 1 coefficients, expected 2, one per shape");
}

TEST(Catalogue, KnowsEveryEffectThatTheProjectNames) {
  for (const char* name : {"wheel diameter ratio",
                           "wheelbase",
                           "travel scale",
                           "wheel scale",
                           "sighting delay",
                           "constant creep",
                           "cross-slope creep",
                           "centrifugal side-slip",
                           "slope",
                           "slip with speed",
                           "loss per start",
                           "turn scrub",
                           "turn asymmetry",
                           "twist per spin",
                           "load on both wheels",
                           "load on one wheel",
                           "tyre drift",
                           "tyre drift (temperature_C)",
                           "tyre drift (t)",
                           "tyre drift (distance)",
                           "backlash",
                           "missed ticks",
                           "sampling skew",
                           "heading drift",
                           "compass offset",
                           "hard iron",
                           "soft iron",
                           "body tilt",
                           "compass lag",
                           "motor current",
                           "local magnetic anomaly",
                           "compass disturbance",
                           "slippery patch",
                           "lever arm",
                           "range bias",
                           "range scale",
                           "bearing offset",
                           "yaw offset"}) {
    const CatalogueEntry* entry = find_entry(name);
    ASSERT_NE(entry, nullptr) << name;
    EXPECT_FALSE(entry->cause.empty() || entry->remedy.empty()) << name;
    EXPECT_GT(entry->prior_sd(), 0.0) << name;
  }
}

TEST(Catalogue, PlacesAndThresholdsStandInTheName) {
  const Effect patch = catalogue_effect("slippery patch (x=12.5, y=-9, r=3)", {-0.03});
  EXPECT_EQ(patch.channel, Channel::wheels);
  EXPECT_EQ(texts_of(patch.shape),
            std::vector<std::string>{"(1+sign(3^2-(x-12.5)^2-(y-(-9))^2))/2"});
  EXPECT_EQ(patch.shape.front().values({{"x", {12.5, 20.0}}, {"y", {-7.0, -9.0}}}),
            (std::vector<double>{1.0, 0.0}));
  EXPECT_EQ(catalogue_effect("missed ticks (v0=0.4)").shape.front(), "max(0, speed-0.4)");
  const CatalogueEntry* entry = find_entry("slippery patch");
  EXPECT_EQ(name_of(*entry, std::vector<ShapeParameter>{{"x", 1.0}, {"y", 2.5}, {"r", 3.0}}),
            "slippery patch (x=1, y=2.5, r=3)");
  const std::string expected =
      ", expected \"slippery patch (x=..., y=..., r=3)\"; or a channel and a shape of its own";
  EXPECT_EQ(complaint("slippery patch"),
            "effect \"slippery patch\" lacks a place or threshold" + expected);
  EXPECT_EQ(complaint("slippery patch (x=1, y=2)"),
            "effect \"slippery patch (x=1, y=2)\" lacks a place or threshold" + expected);
  EXPECT_EQ(
      complaint("slippery patch (x=1, y=2, r=a)"),
      "effect \"slippery patch (x=1, y=2, r=a)\" has r = \"a\", which is no number" + expected);
  EXPECT_EQ(complaint("slippery patch (x=1, x=2, r=1)"),
            "effect \"slippery patch (x=1, x=2, r=1)\" has no parameter \"x\", or has it twice" +
                expected);
}

TEST(Catalogue, FormerNamesStillWork) {
  EXPECT_EQ(catalogue_effect("tyre drift with time").shape.front(), "t");
  EXPECT_EQ(catalogue_effect("tyre drift with distance").shape.front(), "distance");
}

TEST(Catalogue, ParametersGoThroughANameWithoutLoss) {
  const CatalogueEntry& entry = *find_entry("local magnetic anomaly");
  const std::vector<ShapeParameter> parameters{
      {"x", 1.0 / 3.0}, {"y", -1e-7 / 7.0}, {"r", 2e5 / 3}};
  const Effect made = catalogue_effect(entry, parameters);
  const Effect read = catalogue_effect(made.name);
  EXPECT_EQ(read.shape, made.shape);
  EXPECT_EQ(read.shape.front().parameters(), parameters);
}

}  // namespace
}  // namespace trussmap::catalogue_test
