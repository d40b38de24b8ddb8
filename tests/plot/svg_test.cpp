// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/svg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <gtest/gtest.h>

namespace trussmap::svg_test {
using namespace plot;
namespace {

Figure some_figure() {
  Figure figure;
  figure.title = "Errors <of> \"A & B\"";
  Panel panel;
  panel.title = "x < y";
  panel.x_label = "x [mm]";
  panel.y_label = "y & z [mm]";
  panel.marks = {
      {MarkKind::dots, {{0.0, 0.0}, {10.0, 4.0}}, colour::kBlue, 4.0, false, "runs <1>", {}},
      {MarkKind::crosses, {{5.0, 2.0}}, colour::kBlack, 5.0, false, "", {}},
      {MarkKind::pluses, {{5.0, 1.0}}, colour::kBlack, 5.0, false, "", {}},
      {MarkKind::circles, {{6.0, 1.0}}, colour::kBlack, 5.0, false, "", {}},
      {MarkKind::polyline, {{0.0, 0.0}, {3.0, 3.0}}, colour::kGrey, 1.0, true, "line", {}},
      {MarkKind::segments,
       {{0.0, 1.0}, {1.0, 1.0}, {2.0, 2.0}, {2.0, 3.0}},
       "red",
       1.0,
       false,
       "",
       {}},
      {MarkKind::labels, {{5.0, 2.0}}, colour::kBlack, 11.0, false, "", {"<A>"}}};
  figure.panels = {panel, panel};
  return figure;
}

TEST(Svg, IsWellFormedWhateverTheTexts) {
  const std::string svg = draw_figure(some_figure());
  std::istringstream stream(svg);
  boost::property_tree::ptree tree;
  ASSERT_NO_THROW(boost::property_tree::read_xml(stream, tree));
  EXPECT_EQ(tree.get<std::string>("svg.title"), "Errors <of> \"A & B\"");
  EXPECT_EQ(draw_figure(some_figure()), svg);
  // A legend's text is listed once although two panels have it.
  EXPECT_EQ(svg.find("runs &lt;1&gt;"), svg.rfind("runs &lt;1&gt;"));
}

/// Every circle of a picture: centre, pixels.
std::vector<Vector2> circles(const std::string& svg) {
  static const std::regex kCircle(R"re(<circle cx="([^"]+)" cy="([^"]+)")re");
  std::vector<Vector2> found;
  for (auto at = std::sregex_iterator(svg.begin(), svg.end(), kCircle);
       at != std::sregex_iterator(); ++at) {
    found.push_back({std::stod((*at)[1]), std::stod((*at)[2])});
  }
  return found;
}

TEST(Svg, EqualAspectMakesUnitsEquallyLong) {
  Figure figure;
  Panel panel;
  panel.equal_aspect = true;
  panel.marks = {{MarkKind::dots, {{0.0, 0.0}, {7.0, 0.0}, {0.0, 2.0}}, "red", 4.0, false, "", {}}};
  figure.panels = {panel};
  const std::vector<Vector2> at = circles(draw_figure(figure));
  ASSERT_EQ(at.size(), 3U);
  const double per_x = (at[1].x() - at[0].x()) / 7.0;
  const double per_y = (at[0].y() - at[2].y()) / 2.0;
  EXPECT_NEAR(per_x, per_y, 0.01);  // pixels are written with two decimals
  EXPECT_GT(per_x, 0.0);            // x to the right, y upwards
  EXPECT_NEAR(at[0].y(), at[1].y(), 0.01);
}

TEST(Svg, RefusesWhatCannotBeDrawn) {
  EXPECT_THROW((void)draw_figure({}), std::invalid_argument);
  Figure figure = some_figure();
  figure.panels[0].marks[0].at[0].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)draw_figure(figure), std::invalid_argument);
  figure = some_figure();
  figure.panels[0].x = Range{1.0, 1.0};
  EXPECT_THROW((void)draw_figure(figure), std::invalid_argument);
}

TEST(Svg, OneSinglePointAndNoPointAtAllAreDrawn) {
  Figure figure;
  figure.panels = {Panel{}};
  EXPECT_NO_THROW((void)draw_figure(figure));
  figure.panels[0].marks = {{MarkKind::dots, {{3.0, 1e-12}}, "red", 4.0, false, "", {}}};
  EXPECT_EQ(draw_figure(figure).find("nan"), std::string::npos);
  EXPECT_EQ(draw_figure(figure).find("inf"), std::string::npos);
}

TEST(RoundTicks, AreRoundWithinAndAsManyAsWanted) {
  for (const double low : {-1234.5, -3e-5, 0.0, 17.2}) {
    for (const double width : {1e-4, 0.37, 1.0, 99.0, 1e6}) {
      for (const int count : {2, 5, 9}) {
        const std::vector<double> ticks = round_ticks({low, low + width}, count);
        ASSERT_GE(ticks.size(), 1U);
        EXPECT_LE(static_cast<int>(ticks.size()), count + 1);
        EXPECT_GE(ticks.front(), low - 1e-9 * width);
        EXPECT_LE(ticks.back(), low + width + 1e-9 * width);
        if (ticks.size() < 2) continue;
        const double step = ticks[1] - ticks[0];
        const double digits = step / std::pow(10.0, std::floor(std::log10(step * (1 + 1e-6))));
        EXPECT_TRUE(std::abs(digits - 1) < 1e-3 || std::abs(digits - 2) < 1e-3 ||
                    std::abs(digits - 5) < 1e-3)
            << step;
      }
    }
  }
}

TEST(EllipseOutline, EveryPointIsAtItsMahalanobisDistance) {
  Matrix2 covariance;
  covariance << 4.0, 1.2, 1.2, 1.0;
  const Vector2 centre(3.0, -2.0);
  const auto outline = ellipse_outline(centre, covariance, 2.5);
  EXPECT_EQ(outline.front(), outline.back());
  for (const Vector2& p : outline) {
    // By the explicit inverse of a 2x2 matrix.
    const Vector2 d = p - centre;
    const double det = 4.0 * 1.0 - 1.2 * 1.2;
    const double distance =
        (1.0 * d.x() * d.x() - 2 * 1.2 * d.x() * d.y() + 4.0 * d.y() * d.y()) / det;
    EXPECT_NEAR(distance, 6.25, 1e-9);
  }
}

}  // namespace
}  // namespace trussmap::svg_test
