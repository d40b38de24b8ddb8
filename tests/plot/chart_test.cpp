// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/chart.hpp"

#include "plot/chart_svg.hpp"
#include "report/some_charts.hpp"

#include <cmath>
#include <limits>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::chart_test {
using namespace plot;
namespace {

using nlohmann::json;

boost::property_tree::ptree parsed_xml(const std::string& text) {
  std::istringstream stream(text);
  boost::property_tree::ptree tree;
  boost::property_tree::read_xml(stream, tree);
  return tree;
}

TEST(Chart, ItsJsonCanStandInAScriptElement) {
  for (const Chart& chart : testing::charts_of_every_kind(testing::kHostile)) {
    const std::string text = chart_json(chart);
    EXPECT_EQ(text.find('<'), std::string::npos) << chart.id;
    const json parsed = json::parse(text);
    EXPECT_EQ(parsed["id"], chart.id);
    EXPECT_EQ(parsed["title"], chart.title);
    ASSERT_EQ(parsed["layers"].size(), chart.layers.size());
    for (const json& layer : parsed["layers"]) {
      const std::size_t rows = layer["columns"][0]["values"].size();
      for (const json& column : layer["columns"]) EXPECT_EQ(column["values"].size(), rows);
      EXPECT_GE(layer["columns"].size(), layer["places"].get<std::size_t>());
    }
  }
}

TEST(Chart, NamesComeBackAsTheyWere) {
  const Chart chart = testing::map_like_chart(testing::kHostile);
  const json parsed = json::parse(chart_json(chart));
  EXPECT_EQ(parsed["layers"][0]["columns"][4]["values"][0], testing::kHostile);
}

TEST(Chart, BytesThatAreNoTextDoNotStopIt) {
  const Chart chart = testing::map_like_chart("caf\xe9 \x01");
  EXPECT_TRUE(json::accept(chart_json(chart)));
}

TEST(Chart, WhatIsNoNumberIsNone) {
  Chart chart = testing::line_like_chart("a");
  chart.layers.back().columns[1].numbers[1] = std::numeric_limits<double>::quiet_NaN();
  chart.layers.back().columns[1].numbers[2] = std::numeric_limits<double>::infinity();
  const json parsed = json::parse(chart_json(chart));
  const json& values = parsed["layers"].back()["columns"][1]["values"];
  EXPECT_TRUE(values[1].is_null());
  EXPECT_TRUE(values[2].is_null());
  EXPECT_FALSE(values[0].is_null());
}

TEST(Chart, LinesAreOneMarkAndDotsOneEach) {
  Chart chart;
  chart.id = "c";
  chart.layers = {{LayerKind::line, "", {{"x", {1, 2, 3}}, {"y", {1, 2, 3}}}},
                  {LayerKind::dots, "", {{"x", {1, 2, 3}}, {"y", {1, 2, 3}}}}};
  EXPECT_EQ(mark_count(chart), 4U);
}

TEST(Chart, TooManyMarksAreRefused) {
  Chart chart;
  chart.id = "c";
  const std::vector<double> many(kMostMarks + 1, 1.0);
  chart.layers = {{LayerKind::dots, "", {{"x", many}, {"y", many}}}};
  EXPECT_THROW(static_cast<void>(chart_json(chart)), std::invalid_argument);
  chart.layers.front().kind = LayerKind::line;
  EXPECT_NO_THROW(static_cast<void>(chart_json(chart)));
}

TEST(Chart, ColumnsThatDoNotFitAreRefused) {
  Chart chart;
  chart.id = "c";
  chart.layers = {{LayerKind::dots, "", {{"x", {1, 2}}, {"y", {1}}}}};
  EXPECT_THROW(static_cast<void>(chart_json(chart)), std::invalid_argument);
  chart.layers = {{LayerKind::dots, "", {{"x", {1, 2}}}}};
  EXPECT_THROW(static_cast<void>(chart_json(chart)), std::invalid_argument);
}

TEST(Chart, CsvQuotesWhatHasToBe) {
  Chart chart;
  chart.id = "c";
  chart.layers = {
      {LayerKind::dots, "runs", {{"x, [m]", {1.5}}, {"y", {2}}, {"n", {}, {"a \"b\""}}}}};
  EXPECT_EQ(chart_csv(chart), "layer,\"x, [m]\",y,n\r\nruns,1.5,2,\"a \"\"b\"\"\"\r\n");
}

TEST(ChartSvg, EveryKindIsDrawnAsWellFormedXml) {
  for (const Chart& chart : testing::charts_of_every_kind(testing::kHostile)) {
    const std::string svg = draw_chart(chart);
    ASSERT_NO_THROW(parsed_xml(svg)) << chart.id;
    EXPECT_EQ(svg.find("<script"), std::string::npos) << chart.id;
    EXPECT_EQ(svg.find("nan"), std::string::npos) << chart.id;
    EXPECT_EQ(svg, draw_chart(chart));
  }
}

TEST(ChartSvg, AUnitIsAsLongAcrossAsUpWhereItShouldBe) {
  Chart chart;
  chart.id = "c";
  chart.equal_aspect = true;
  chart.layers = {{LayerKind::dots, "", {{"x", {0, 10, 0}}, {"y", {0, 0, 10}}}}};
  const std::string svg = draw_chart(chart);
  const std::regex circle("<circle cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"");
  std::vector<Vector2> at;
  for (std::sregex_iterator k(svg.begin(), svg.end(), circle), end; k != end; ++k) {
    at.emplace_back(std::stod((*k)[1]), std::stod((*k)[2]));
  }
  ASSERT_EQ(at.size(), 3U);
  EXPECT_NEAR(at[1].x() - at[0].x(), at[0].y() - at[2].y(), 0.03);  // pixels have two decimals
}

TEST(ChartSvg, TheFirstCategoryStandsOnTop) {
  const std::string svg = draw_chart(testing::bar_like_chart("zz"));
  EXPECT_LT(svg.find(">zz one<"), svg.find(">zz two<"));
  const std::regex label("<text class=\"tick\" x=\"[0-9.]+\" y=\"([0-9.]+)\"[^>]*>zz (one|two)<");
  std::vector<double> heights;
  for (std::sregex_iterator k(svg.begin(), svg.end(), label), end; k != end; ++k) {
    heights.push_back(std::stod((*k)[1]));
  }
  ASSERT_EQ(heights.size(), 2U);
  EXPECT_LT(heights[0], heights[1]);
}

}  // namespace
}  // namespace trussmap::chart_test
