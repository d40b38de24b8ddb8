// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/sketch.hpp"

#include "geometry/units.hpp"
#include "text/xml_text.hpp"

#include <cmath>

#include <fmt/format.h>

namespace trussmap::plot {
namespace {

const char* colour_of(Ink ink) {
  switch (ink) {
    case Ink::faint:
      return "var(--faint, #9aa3ad)";
    case Ink::believed:
      return "var(--muted, #57606a)";
    case Ink::real:
      return "var(--c1, #0072b2)";
    case Ink::cause:
      return "var(--c2, #d55e00)";
    case Ink::plain:
      break;
  }
  return "var(--ink, #1b1f24)";
}

std::string stroke_of(Ink ink) {
  return fmt::format(
      "stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\" stroke-linejoin=\"round\"{}",
      colour_of(ink),
      ink == Ink::real || ink == Ink::cause ? "2.6"
      : ink == Ink::faint                   ? "1"
                                            : "1.6",
      ink == Ink::believed ? " stroke-dasharray=\"5 4\"" : "");
}

double direction_of(Spot from, Spot to) {
  return geometry::kDegrees * std::atan2(from.y - to.y, to.x - from.x);
}

}  // namespace

Spot beside(Spot from, double direction, double distance) {
  return {from.x + distance * std::cos(direction / geometry::kDegrees),
          from.y - distance * std::sin(direction / geometry::kDegrees)};
}

Sketch& Sketch::path(const std::string& d, Ink ink, std::string_view more) {
  marks_ += fmt::format("<path d=\"{}\" {} {}/>\n", d, stroke_of(ink), more);
  return *this;
}

Sketch& Sketch::head(Spot at, double direction, Ink ink) {
  const Spot a = beside(at, direction + 152.0, 11.0);
  const Spot b = beside(at, direction - 152.0, 11.0);
  marks_ += fmt::format("<path d=\"M{:.1f},{:.1f}L{:.1f},{:.1f}L{:.1f},{:.1f}Z\" fill=\"{}\"/>\n",
                        at.x, at.y, a.x, a.y, b.x, b.y, colour_of(ink));
  return *this;
}

Sketch& Sketch::line(Spot from, Spot to, Ink ink) {
  return path(fmt::format("M{:.1f},{:.1f}L{:.1f},{:.1f}", from.x, from.y, to.x, to.y), ink);
}

Sketch& Sketch::arrow(Spot from, Spot to, Ink ink) {
  const double direction = direction_of(from, to);
  return line(from, beside(to, direction + 180.0, 6.0), ink).head(to, direction, ink);
}

Sketch& Sketch::bent_arrow(Spot from, Spot bend, Spot to, Ink ink) {
  // The control point that brings the curve through `bend` halfway.
  const Spot control{2.0 * bend.x - 0.5 * (from.x + to.x), 2.0 * bend.y - 0.5 * (from.y + to.y)};
  const double direction = direction_of(control, to);
  const Spot end = beside(to, direction + 180.0, 6.0);
  path(fmt::format("M{:.1f},{:.1f}Q{:.1f},{:.1f} {:.1f},{:.1f}", from.x, from.y, control.x,
                   control.y, end.x, end.y),
       ink);
  return head(to, direction, ink);
}

Sketch& Sketch::way(const std::vector<Spot>& spots, Ink ink) {
  std::string d;
  for (const Spot& one : spots)
    d += fmt::format("{}{:.1f},{:.1f}", d.empty() ? "M" : "L", one.x, one.y);
  return path(d, ink);
}

Sketch& Sketch::arc(Spot centre, double radius, double from, double to, Ink ink) {
  const Spot a = beside(centre, from, radius);
  const Spot b = beside(centre, to, radius);
  return path(fmt::format("M{:.1f},{:.1f}A{:.1f},{:.1f} 0 {} {} {:.1f},{:.1f}", a.x, a.y, radius,
                          radius, std::abs(to - from) > 180.0 ? 1 : 0, to > from ? 0 : 1, b.x, b.y),
              ink);
}

Sketch& Sketch::arc_arrow(Spot centre, double radius, double from, double to, Ink ink) {
  const double along = to > from ? 1.0 : -1.0;
  const double back = along * 6.0 / radius * geometry::kDegrees;
  arc(centre, radius, from, to - back, ink);
  return head(beside(centre, to, radius), to + along * 90.0 - back * 0.6, ink);
}

Sketch& Sketch::circle(Spot centre, double radius, Ink ink) {
  marks_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"none\" {}/>\n",
                        centre.x, centre.y, radius, stroke_of(ink));
  return *this;
}

Sketch& Sketch::dot(Spot centre, double radius, Ink ink) {
  marks_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"{}\"/>\n",
                        centre.x, centre.y, radius, colour_of(ink));
  return *this;
}

Sketch& Sketch::block(Spot centre, double width, double height, Ink ink, double angle) {
  const bool ghost = ink == Ink::believed;
  marks_ += fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" rx=\"2\" "
      "transform=\"translate({:.1f} {:.1f}) rotate({:.1f})\" fill=\"{}\" {}/>\n",
      -width / 2.0, -height / 2.0, width, height, centre.x, centre.y, -angle,
      ghost ? "none" : colour_of(ink), ghost ? stroke_of(ink) : "");
  return *this;
}

Sketch& Sketch::text(Spot at, std::string_view words, Ink ink, std::string_view anchor) {
  const Ink shown = ink == Ink::faint ? Ink::believed : ink;
  marks_ += fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" font-family=\"system-ui, Liberation Sans, sans-serif\" "
      "font-size=\"12\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n",
      at.x, at.y, anchor, colour_of(shown), text::xml_escaped(std::string(words)));
  return *this;
}

Sketch& Sketch::robot(Spot at, double heading, const RobotLook& look) {
  const bool ghost = look.body == Ink::believed;
  const double half = 19.0 * look.track;
  marks_ += fmt::format(
      "<g transform=\"translate({:.1f} {:.1f}) rotate({:.1f})\"><path d=\"M-18,-14H14Q24,-14 "
      "24,0Q24,14 14,14H-18Z\" {} {}/><path d=\"M10,-6L18,0L10,6Z\" fill=\"{}\"/></g>\n",
      at.x, at.y, -heading, stroke_of(look.body),
      ghost ? "fill=\"none\"" : "fill=\"var(--panel, #f6f7f9)\"", colour_of(look.body));
  const auto wheel = [&](double side, double size, Ink ink) {
    block(beside(at, heading + side, half), 20.0 * size, 7.0, ghost ? Ink::believed : ink, heading);
  };
  wheel(90.0, look.left, look.left_ink);
  wheel(-90.0, look.right, look.right_ink);
  return *this;
}

Sketch& Sketch::wheel(double x, double floor, double radius, Ink ink, double flat) {
  const double drop = radius * (1.0 - flat);
  const double half = std::sqrt(radius * radius - drop * drop);
  const double y = floor - drop;
  if (flat > 0.0) {
    path(fmt::format("M{:.1f},{:.1f}A{:.1f},{:.1f} 0 1 1 {:.1f},{:.1f}Z", x - half, floor, radius,
                     radius, x + half, floor),
         ink);
  } else {
    circle({x, y}, radius, ink);
  }
  return dot({x, y}, 2.5, ink);
}

Sketch& Sketch::compass(Spot at, double radius, double angle, Ink ink) {
  circle(at, radius, Ink::faint);
  return arrow(beside(at, angle + 180.0, radius - 4.0), beside(at, angle, radius - 2.0), ink);
}

Sketch& Sketch::clock(Spot at, Ink ink) {
  circle(at, 13.0, ink);
  line(at, beside(at, 90.0, 9.0), ink);
  return line(at, beside(at, -20.0, 6.0), ink);
}

Sketch& Sketch::landmark(Spot at, Ink ink) {
  circle(at, 7.0, ink);
  line({at.x - 10.0, at.y}, {at.x + 10.0, at.y}, ink);
  return line({at.x, at.y - 10.0}, {at.x, at.y + 10.0}, ink);
}

Sketch& Sketch::axes(Spot at, double length, double angle, Ink ink) {
  arrow(at, beside(at, angle, length), ink);
  return arrow(at, beside(at, angle + 90.0, 0.7 * length), ink);
}

Sketch& Sketch::gear(Spot at, double radius, Ink ink, double turned) {
  constexpr int kTeeth = 10;
  std::string d;
  for (int k = 0; k < 4 * kTeeth; ++k) {
    const Spot one =
        beside(at, turned + 360.0 * k / (4.0 * kTeeth), k % 4 < 2 ? radius : 0.76 * radius);
    d += fmt::format("{}{:.1f},{:.1f}", d.empty() ? "M" : "L", one.x, one.y);
  }
  return path(d + "Z", ink).dot(at, 2.5, ink);
}

Sketch& Sketch::span(Spot from, Spot to, Ink ink) {
  const double direction = direction_of(from, to);
  line(beside(from, direction, 6.0), beside(to, direction + 180.0, 6.0), ink);
  return head(from, direction + 180.0, ink).head(to, direction, ink);
}

std::string Sketch::svg(std::string_view title) const {
  const std::string name = text::xml_escaped(std::string(title));
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" role=\"img\" aria-label=\"{2}\">\n<title>{2}</title>\n{3}</svg>\n",
      kWidth, kHeight, name, marks_);
}

}  // namespace trussmap::plot
