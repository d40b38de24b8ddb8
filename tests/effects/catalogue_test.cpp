// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/catalogue.hpp"

#include "effects/shape.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap {
namespace {

TEST(Catalogue, EveryShapeCanBeReadAndSpeaksOfWhatThereIs) {
  const std::vector<std::string>& known = reserved_variables();
  std::set<std::string_view> names;
  for (const CatalogueEntry& entry : catalogue()) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    std::string name(entry.name);
    if (entry.of_covariate()) name = name_of(entry, "payload_kg");
    if (entry.has_parameters()) {
      name = name_of(entry, std::vector<double>(entry.parameters.size(), -1.5));
    }
    const Effect effect = resolved({name, "", {}, {}, false});
    EXPECT_EQ(effect.shape.size(), entry.shape.size());
    for (const std::string& shape : effect.shape) {
      for (const std::string& variable : variables_of(shape)) {
        EXPECT_TRUE(variable == "payload_kg" ||
                    std::find(known.begin(), known.end(), variable) != known.end())
            << variable;
      }
    }
  }
}

std::string complaint(const Effect& effect) {
  try {
    (void)resolved(effect);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "none";
}

TEST(Catalogue, ANameAloneIsEnoughAndAnUnknownOneIsRefused) {
  EXPECT_EQ(resolved({"hard iron", "", {}, {}, false}).channel, "compass");
  EXPECT_EQ(resolved({"load on one wheel (crates)", "", {}, {}, false}).shape.front(), "crates");
  EXPECT_EQ(complaint({"gremlins", "", {}, {}, false}),
            "effect \"gremlins\" is not in the catalogue, expected a channel and a shape");
  EXPECT_EQ(complaint({"tyre drift", "", {}, {}, false}),
            "effect \"tyre drift\" needs a covariate, expected \"tyre drift (COLUMN)\"");
  EXPECT_EQ(complaint({"slope", "", {}, {0.1}, false}),
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
                           "bearing offset"}) {
    const CatalogueEntry* entry = find_entry(name);
    ASSERT_NE(entry, nullptr) << name;
    EXPECT_FALSE(entry->cause.empty() || entry->remedy.empty()) << name;
    EXPECT_GT(entry->prior_sd(), 0.0) << name;
  }
}

TEST(Catalogue, PlacesAndThresholdsStandInTheName) {
  const Effect patch = resolved({"slippery patch (x=12.5, y=-9, r=3)", "", {}, {-0.03}, false});
  EXPECT_EQ(patch.channel, "wheels");
  EXPECT_EQ(patch.shape, std::vector<std::string>{"(1+sign(3^2-(x-12.5)^2-(y-(-9))^2))/2"});
  EXPECT_EQ(evaluate_shape(patch.shape.front(), {{"x", {12.5, 20.0}}, {"y", {-7.0, -9.0}}}),
            (std::vector<double>{1.0, 0.0}));
  EXPECT_EQ(resolved({"missed ticks (v0=0.4)", "", {}, {}, false}).shape.front(),
            "max(0, speed-0.4)");
  const CatalogueEntry* entry = find_entry("slippery patch");
  EXPECT_EQ(name_of(*entry, std::vector<double>{1.0, 2.5, 3.0}),
            "slippery patch (x=1, y=2.5, r=3)");
  const std::string expected =
      ", expected \"slippery patch (x=..., y=..., r=3)\"; or a channel and a shape of its own";
  EXPECT_EQ(complaint({"slippery patch", "", {}, {}, false}),
            "effect \"slippery patch\" lacks a place or threshold" + expected);
  EXPECT_EQ(complaint({"slippery patch (x=1, y=2)", "", {}, {}, false}),
            "effect \"slippery patch (x=1, y=2)\" lacks a place or threshold" + expected);
  EXPECT_EQ(
      complaint({"slippery patch (x=1, y=2, r=a)", "", {}, {}, false}),
      "effect \"slippery patch (x=1, y=2, r=a)\" has r = \"a\", which is no number" + expected);
  EXPECT_EQ(complaint({"slippery patch (x=1, x=2, r=1)", "", {}, {}, false}),
            "effect \"slippery patch (x=1, x=2, r=1)\" has no parameter \"x\", or has it twice" +
                expected);
}

TEST(Catalogue, FormerNamesStillWork) {
  EXPECT_EQ(resolved({"tyre drift with time", "", {}, {}, false}).shape.front(), "t");
  EXPECT_EQ(resolved({"tyre drift with distance", "", {}, {}, false}).shape.front(), "distance");
}

TEST(Catalogue, AnOwnEffectOfTheSameNameKeepsItsShape) {
  const Effect own = resolved({"hard iron", "turn", {"x"}, {0.5}, false});
  EXPECT_EQ(own.channel, "turn");
  EXPECT_EQ(own.shape, std::vector<std::string>{"x"});
}

}  // namespace
}  // namespace trussmap
