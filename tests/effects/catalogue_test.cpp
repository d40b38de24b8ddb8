// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/effects/catalogue.hpp"

#include "trussmap/effects/shape.hpp"

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
    const std::string name =
        entry.of_covariate() ? std::string(entry.name) + " (payload_kg)" : std::string(entry.name);
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

TEST(Catalogue, AnOwnEffectOfTheSameNameKeepsItsShape) {
  const Effect own = resolved({"hard iron", "turn", {"x"}, {0.5}, false});
  EXPECT_EQ(own.channel, "turn");
  EXPECT_EQ(own.shape, std::vector<std::string>{"x"});
}

}  // namespace
}  // namespace trussmap
