// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/place.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/wording.hpp"

#include <gtest/gtest.h>

namespace trussmap::effect_words_test {
using namespace effects;
namespace {

TEST(EffectWords, APlaceIsReadOffTheShapeNotOffTheName) {
  Effect patch = catalogue_effect("slippery patch (x=12.345, y=-9.8, r=3.06)");
  EXPECT_EQ(name_in_words(patch), "slippery patch at x 12.3 m, y -9.8 m, radius 3.1 m");
  EXPECT_EQ(short_name(patch), "slippery patch");
  ASSERT_TRUE(place_of(patch));
  EXPECT_EQ(*place_of(patch), Vector2(12.345, -9.8));
  patch.shape = {"exp(-((x-1)^2+(y-2)^2)/(2*0.5^2))"};
  EXPECT_EQ(*place_of(patch), Vector2(1.0, 2.0));
  patch.per_session = true;
  EXPECT_FALSE(place_of(patch));
  EXPECT_FALSE(place_of(catalogue_effect("slope")));
}

TEST(EffectWords, AFitSaysWhatItHolds) {
  EXPECT_EQ(
      held_in_words(catalogue_effect("slippery patch (x=12, y=9, r=3)")),
      "x, y, r are held as the model has them, and the standard errors are for that: trussmap "
      "discover seeks them anew");
  EXPECT_EQ(held_in_words(catalogue_effect("missed ticks (v0=0.4)")).rfind("v0 is held", 0), 0U);
  EXPECT_EQ(held_in_words(catalogue_effect("hard iron")), "");
}

TEST(ResponseWords, AxesShowWhatAPersonReads) {
  const ResponseAxes compass = axes_of({Channel::compass, "rad", "heading", {}, {}, {}});
  EXPECT_EQ(compass.variable, "heading [\u00b0]");
  EXPECT_EQ(compass.error, "compass reads too much by [\u00b0]");
  EXPECT_NEAR(compass.error_factor, 57.29578, 1e-5);
  const ResponseAxes turn = axes_of({Channel::turn, "", kPlace, {}, {}, {}});
  EXPECT_EQ(turn.variable, "distance from its place [m]");
  EXPECT_EQ(turn.error_factor, 100.0);
}

TEST(EffectWords, NamesSayWhatIsOpenInThem) {
  EXPECT_EQ(name_in_words(catalogue_effect("missed ticks (v0=0.4)")),
            "missed ticks of the left wheel above 0.4 m/s");
  EXPECT_EQ(name_in_words(catalogue_effect("tyre drift (t)")), "tyre drift with time");
  EXPECT_EQ(name_in_words({"turn with turn_rate", Channel::turn, {"turn_rate"}, {}}),
            "turning error with turn rate");
  EXPECT_EQ(name_in_words(
                {"creep at a place", Channel::creep, {"exp(-((x-1)^2+(y-2)^2)/(2*0.5^2))"}, {}}),
            "sideways slip at x 1.0 m, y 2.0 m");
  EXPECT_EQ(name_in_words({"my own", Channel::turn, {"x"}, {}}), "my own");
}

TEST(EffectWords, ACurveIsWhatItComesToAndNotItsCoefficients) {
  // Bells that overlap: their sum at each middle, by hand.
  Effect curve{
      "left with a curve of speed",
      Channel::left,
      {"exp(-((speed-0.2)/0.2)^2)", "exp(-((speed-0.4)/0.2)^2)", "exp(-((speed-0.6)/0.2)^2)"},
      {0.01, 0.0, -0.01}};
  EXPECT_EQ(in_words(curve, {0.001, 0.001, 0.001}),
            "the left wheel rolls 0.98 % further than it says at speed 0.2, nothing at speed 0.4, "
            "0.98 % less far than it says at speed 0.6");
}

TEST(EffectWords, AWaveGoesRoundWithWhatIsInIt) {
  Effect iron = catalogue_effect("soft iron", {0.03, -0.04});
  EXPECT_EQ(in_words(iron, {0.001, 0.001}),
            "the compass reads up to 2.865 +- 0.057 deg too much, and as much the other way, as "
            "2*heading goes round");
  iron.shape = {"sin(heading)", "cos(2*heading)"};
  EXPECT_EQ(in_words(iron, {0.001, 0.001}).find("goes round"), std::string::npos);
}

TEST(EffectWords, AGrossConstantIsSaidInTheOwnersFigures) {
  // A quarter of the wheels' turns is missing: B is 4/3 of what is stated, dB = B^2 dg.
  EXPECT_EQ(in_words(catalogue_effect("wheelbase", {-0.25}), {0.0045}),
            "the wheelbase is 33.33 +- 0.80 % larger than nominal");
  // Right over left is (1 + g/2)/(1 - g/2): 5/3 of g = 1/2.
  EXPECT_EQ(in_words(catalogue_effect("wheel diameter ratio", {0.5}), {0.009}),
            "the right wheel is 66.7 +- 1.6 % larger than the left");
}

TEST(EffectWords, NoWheelbaseTurnsTheOtherWayRound) {
  const std::string words = in_words(catalogue_effect("wheelbase", {-2.0}), {0.002});
  EXPECT_NE(words.find("left and right exchanged"), std::string::npos);
  EXPECT_EQ(words.find("%"), std::string::npos);
  EXPECT_EQ(size_in_words(catalogue_effect("wheelbase", {-2.0}), -2.0, -2.0).find("%"),
            std::string::npos);
}

TEST(EffectWords, AFactorOfEverydayIsSaidToBeOne) {
  EXPECT_TRUE(in_words(catalogue_effect("travel scale", {1.004}), {0.001})
                  .ends_with("(twice: a radius taken for a diameter, or a gear?)"));
  EXPECT_TRUE(in_words(catalogue_effect("wheel scale", {-0.501}), {0.001})
                  .ends_with("(half: a diameter taken for a radius, or a gear?)"));
  EXPECT_TRUE(in_words(catalogue_effect("wheelbase", {-0.5}), {0.001})
                  .ends_with("the distance from the middle to a wheel?)"));
  EXPECT_TRUE(in_words(catalogue_effect("travel scale", {0.9}), {0.001}).ends_with("say"));
  EXPECT_TRUE(in_words(catalogue_effect("travel scale", {0.95}), {0.2}).ends_with("say"));
}

TEST(EffectWords, ALoadIsInKilograms) {
  const Effect load{"load on both wheels (payload_kg)", Channel::wheels, {"payload_kg"}, {0.002}};
  EXPECT_TRUE(in_words(load, {0.0001}).ends_with(" per kg of payload")) << in_words(load, {0.0001});
  const Effect lights{"load on both wheels (lights)", Channel::wheels, {"lights"}, {0.002}};
  EXPECT_TRUE(in_words(lights, {0.0001}).ends_with(" per unit of lights"));
}

TEST(EffectWords, FormulasSayTheirUnits) {
  const auto said = [](const Shape& shape) {
    return in_words(Effect{"own", Channel::travel, {shape}, {0.01}}, {0.001});
  };
  EXPECT_TRUE(said("speed*payload_kg").ends_with(" per m/s per kg of payload"));
  EXPECT_TRUE(said("abs(turn_rate)*payload_kg").ends_with(" per rad/s turned per kg of payload"));
  EXPECT_TRUE(said("speed*sin(heading)").ends_with(" per unit of speed*sin(heading)"));
  EXPECT_TRUE(said("sin(2*heading)").ends_with(" per unit of sin(2*heading)"));
  EXPECT_TRUE(said("0.8*x+0.6*y>10.2").ends_with(" where 0.8*x+0.6*y>10.2"));
  EXPECT_TRUE(said("exp(-t/200)").ends_with(" times exp(-t/200)"));
}

}  // namespace
}  // namespace trussmap::effect_words_test
