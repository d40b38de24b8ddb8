// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Small drawings of robots and what ails them, as SVG: seen from above unless said otherwise.
//
//   dashed grey   as the robot believes it to be       orange   the cause
//   solid blue    as it is                             ink      robot, floor, things
//
// Pixels, x to the right, y down; angles in degrees, 0 to the right, counter-clockwise. Colours are
// those of the pages, with values of their own for where there is no page.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trussmap::plot {

enum class Ink { plain, faint, believed, real, cause };

struct Spot {
  double x = 0.0;
  double y = 0.0;
};

/// So far from a place, in a direction [degrees].
[[nodiscard]] Spot beside(Spot from, double direction, double distance);

/// A robot of two wheels and a castor. Sizes are factors of the usual.
struct RobotLook {
  double left = 1.0;  ///< size of its left wheel
  double right = 1.0;
  double track = 1.0;  ///< between the wheels
  Ink left_ink = Ink::plain;
  Ink right_ink = Ink::plain;
  Ink body = Ink::plain;  ///< believed: one that is not there
};

class Sketch {
 public:
  static constexpr double kWidth = 320.0;
  static constexpr double kHeight = 170.0;

  Sketch& line(Spot from, Spot to, Ink ink);
  Sketch& arrow(Spot from, Spot to, Ink ink);
  /// Through `bend` halfway, with an arrow's head at its end.
  Sketch& bent_arrow(Spot from, Spot bend, Spot to, Ink ink);
  Sketch& way(const std::vector<Spot>& spots, Ink ink);
  Sketch& arc(Spot centre, double radius, double from, double to, Ink ink);
  Sketch& arc_arrow(Spot centre, double radius, double from, double to, Ink ink);
  Sketch& circle(Spot centre, double radius, Ink ink);
  Sketch& dot(Spot centre, double radius, Ink ink);
  /// Filled, its middle here, turned.
  Sketch& block(Spot centre, double width, double height, Ink ink, double angle = 0.0);
  Sketch& text(Spot at, std::string_view words, Ink ink = Ink::plain,
               std::string_view anchor = "middle");

  Sketch& robot(Spot at, double heading, const RobotLook& look = {});
  /// A wheel from the side, on a floor at y = `floor`; `flat`: share of its radius that it gives.
  Sketch& wheel(double x, double floor, double radius, Ink ink, double flat = 0.0);
  /// A needle that points to `angle`, in a ring.
  Sketch& compass(Spot at, double radius, double angle, Ink ink);
  Sketch& clock(Spot at, Ink ink);
  Sketch& landmark(Spot at, Ink ink = Ink::plain);
  /// A pair of axes, the first along `angle`.
  Sketch& axes(Spot at, double length, double angle, Ink ink);
  /// A toothed wheel.
  Sketch& gear(Spot at, double radius, Ink ink, double turned = 0.0);
  /// Between two ends, with its arrows pointing outwards.
  Sketch& span(Spot from, Spot to, Ink ink);

  /// The picture, with a title for those who do not see it.
  [[nodiscard]] std::string svg(std::string_view title) const;

 private:
  Sketch& path(const std::string& d, Ink ink, std::string_view more = "fill=\"none\"");
  Sketch& head(Spot at, double direction, Ink ink);

  std::string marks_;
};

}  // namespace trussmap::plot
