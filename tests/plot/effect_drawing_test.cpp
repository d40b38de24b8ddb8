// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/catalogue_record.hpp"
#include "io/xml_element.hpp"
#include "plot/sketch.hpp"
#include "trussmap/workbench.hpp"

#include <map>
#include <regex>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::effect_drawing_test {
using namespace plot;
namespace {

Effect named(std::string_view name, Channel channel) {
  Effect effect;
  effect.name = std::string(name);
  effect.channel = channel;
  return effect;
}

/// All but its title.
std::string marks_of(const std::string& svg) {
  return svg.substr(svg.find("</title>"));
}

/// Or that of its kin, where its file says so.
TEST(EffectDrawing, EveryEffectOfTheCatalogueHasItsOwn) {
  std::map<std::string, std::string> of;
  for (const effects::CatalogueRecord& record : effects::catalogue_records()) {
    const CatalogueEntry& entry = record.entry;
    const std::string svg = effect_drawing(named(entry.name, entry.channel));
    ASSERT_NE(svg, "") << entry.name;
    const std::string which =
        std::string(record.drawing.of) + "|" + std::string(record.drawing.part);
    const auto [other, fresh] = of.emplace(marks_of(svg), which);
    EXPECT_TRUE(fresh || other->second == which)
        << entry.name << " is drawn like " << other->second;
    const io::XmlElement root = io::parse_xml(svg, "drawing");
    EXPECT_EQ(root.name, "svg");
    EXPECT_EQ(root.attribute("aria-label"), entry.name);
    ASSERT_NE(root.child("title"), nullptr);
    EXPECT_EQ(root.child("title")->text, entry.name);
    // The cause is marked, and not by colour alone: something is dashed, or named.
    EXPECT_NE(svg.find("var(--c2, "), std::string::npos) << entry.name;
    EXPECT_TRUE(svg.find("stroke-dasharray") != std::string::npos ||
                svg.find("<text") != std::string::npos)
        << entry.name;
  }
}

/// A text of twelve pixels is about six and a half a letter.
TEST(EffectDrawing, NothingIsWrittenBeyondItsEdges) {
  static const std::regex kText(
      R"re(<text x="([^"]+)" y="([^"]+)"[^>]*text-anchor="(\w+)"[^>]*>([^<]*)<)re");
  constexpr double kLetter = 6.5;
  int texts = 0;
  for (const CatalogueEntry& entry : catalogue()) {
    const std::string svg = effect_drawing(named(entry.name, entry.channel));
    for (std::sregex_iterator at(svg.begin(), svg.end(), kText), end; at != end; ++at) {
      const double width = kLetter * static_cast<double>((*at)[4].length());
      const double x = std::stod((*at)[1]);
      const double y = std::stod((*at)[2]);
      const double from = (*at)[3] == "start" ? x : (*at)[3] == "end" ? x - width : x - width / 2;
      EXPECT_GE(from, 0.0) << entry.name << ": " << (*at)[4];
      EXPECT_LE(from + width, Sketch::kWidth) << entry.name << ": " << (*at)[4];
      EXPECT_TRUE(y > 8.0 && y < Sketch::kHeight - 2.0) << entry.name << ": " << (*at)[4];
      ++texts;
    }
  }
  EXPECT_GT(texts, 60);
}

TEST(EffectDrawing, OfOnesOwnEffectIsThatOfItsChannel) {
  const auto drawn = [](std::string_view name, Channel channel) {
    return effect_drawing(named(name, channel));
  };
  EXPECT_EQ(drawn("my own", Channel::turn), drawn("wheelbase", Channel::turn));
  EXPECT_EQ(drawn("my own", Channel::compass), drawn("compass offset", Channel::compass));
  EXPECT_EQ(drawn("my own", Channel::fix_x), "");  // no effect of the catalogue is of this channel
  EXPECT_EQ(drawn("<b>", Channel::turn).find("<b>"), std::string::npos);
}

TEST(Sketch, ArrowsEndWhereTheyPoint) {
  Sketch sketch;
  sketch.arrow({10, 20}, {110, 20}, Ink::real).text({5, 5}, "a < b & c");
  const std::string svg = sketch.svg("a \"title\" & <more>");
  EXPECT_NE(svg.find("M110.0,20.0L"), std::string::npos) << svg;
  EXPECT_NE(svg.find("a &lt; b &amp; c"), std::string::npos);
  EXPECT_EQ(io::parse_xml(svg, "sketch").child("title")->text, "a \"title\" & <more>");
}

TEST(Sketch, PlacesBesideAreCounterClockwise) {
  const Spot up = beside({100, 100}, 90.0, 10.0);
  EXPECT_NEAR(up.x, 100.0, 1e-9);
  EXPECT_NEAR(up.y, 90.0, 1e-9);
}

}  // namespace
}  // namespace trussmap::effect_drawing_test
