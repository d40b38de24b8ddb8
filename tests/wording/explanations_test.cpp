// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/catalogue.hpp"
#include "trussmap/workbench.hpp"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::explanations_test {
namespace {

Effect of_entry(const CatalogueEntry& entry) {
  Effect effect;
  effect.name = entry.of_covariate() ? name_of(entry, "payload_kg") : std::string(entry.name);
  effect.channel = entry.channel;
  for (const std::string& shape : entry.pattern) {
    effect.shape.emplace_back(entry.of_covariate()                   ? "payload_kg"
                              : shape.find('{') != std::string::npos ? "1"
                                                                     : shape);
  }
  return effect;
}

TEST(Explanation, EveryEffectOfTheCatalogueHasItsOwn) {
  std::set<std::string> done, drives;
  for (const CatalogueEntry& entry : catalogue()) {
    const Effect effect = of_entry(entry);
    const Explanation explanation = explanation_of(effect);
    EXPECT_TRUE(done.insert(explanation.does).second) << entry.name;
    drives.insert(explanation.drive);
    for (const std::string* text : {&explanation.does, &explanation.look, &explanation.drive}) {
      EXPECT_GT(text->size(), 20U) << entry.name;
      EXPECT_TRUE(text->ends_with('.') || text->ends_with('?')) << entry.name << ": " << *text;
      EXPECT_EQ(text->find('{'), std::string::npos) << entry.name << ": " << *text;
    }
    // What is said of an effect that nobody catalogued is another text.
    Effect own = effect;
    own.name = "my own";
    EXPECT_NE(explanation_of(own).does, explanation.does) << entry.name;
  }
  EXPECT_GT(drives.size(), 40U);
}

TEST(Explanation, NamesWhatItGoesWith) {
  const Explanation drift = explanation_of(catalogue_effect("tyre drift (t)"));
  EXPECT_NE(drift.does.find("with time"), std::string::npos) << drift.does;
  const Explanation load = explanation_of(catalogue_effect("load on one wheel (payload_kg)"));
  EXPECT_NE(load.does.find("payload_kg"), std::string::npos) << load.does;
  EXPECT_NE(explanation_of(catalogue_effect("radius of wheel 3")).does.find("third wheel"),
            std::string::npos);
}

TEST(Explanation, OfTheOtherSignIsNotOfTheUsualOne) {
  // Slip loses way; ticks that are missed make a wheel say too little.
  for (const auto& [name, usual] :
       {std::pair("slip with speed", -0.01), std::pair("missed ticks (v0=0.5)", 0.05)}) {
    Effect effect = catalogue_effect(name);
    const std::string unsized = explanation_of(effect).does;
    effect.coefficients = {usual};
    EXPECT_EQ(explanation_of(effect).does, unsized);
    EXPECT_FALSE(explanation_of(effect).unusual);
    effect.coefficients = {-usual};
    EXPECT_NE(explanation_of(effect).does, unsized);
    EXPECT_TRUE(explanation_of(effect).unusual);
    EXPECT_EQ(explanation_of(effect).does.find("lost in slip"), std::string::npos);
  }
  // A wheelbase may be wrong either way.
  Effect wheelbase = catalogue_effect("wheelbase");
  wheelbase.coefficients = {-0.02};
  EXPECT_FALSE(explanation_of(wheelbase).unusual);
}

TEST(Explanation, OfOnesOwnEffectNamesItsPartAndItsCauses) {
  Effect own;
  own.name = "my effect";
  own.channel = Channel::compass;
  own.shape = {Shape("speed*lights")};
  const Explanation explanation = explanation_of(own);
  EXPECT_NE(explanation.does.find("compass reading"), std::string::npos) << explanation.does;
  EXPECT_NE(explanation.does.find("lights"), std::string::npos);
  EXPECT_NE(explanation.drive.find("speed"), std::string::npos) << explanation.drive;
  EXPECT_NE(explanation.look.find("compass"), std::string::npos) << explanation.look;
  own.shape = {Shape("1")};
  EXPECT_NE(explanation_of(own).does.find("alike everywhere"), std::string::npos);
}

}  // namespace
}  // namespace trussmap::explanations_test
