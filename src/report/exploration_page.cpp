// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How a map grows: the world in pale grey and red, the map of each moment in black, its routes as
// dark as they were driven often, where the robot is, and how far off the map's landmarks are.
#include "plot/svg.hpp"
#include "text/xml_text.hpp"
#include "trussmap/pages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr double kMargin = 24.0;    // pixels
constexpr double kCaption = 240.0;  // the longest one, in pixels
constexpr double kSecondsPerFrame = 0.2;
constexpr double kSecondsAtTheEnd = 3.0;
constexpr std::size_t kMostFrames = 150;
constexpr double kOften = 4.0;  // traversals, from which a route is black

/// From metres to pixels: y up, the whole within a square.
struct Paper {
  Vector2 low = Vector2::Constant(std::numeric_limits<double>::infinity());
  Vector2 high = -low;
  double scale = 1.0;
  double width = 0.0;
  double height = 0.0;

  Paper(const LandmarkGraph& world, double wide) {
    for (int k = 0; k < world.landmarks(); ++k) {
      low = low.cwiseMin(world.landmark(k).position);
      high = high.cwiseMax(world.landmark(k).position);
    }
    const Vector2 size = (high - low).cwiseMax(1e-9);
    scale = (wide - 2.0 * kMargin) / size.maxCoeff();
    width = std::max(size.x() * scale + 2.0 * kMargin, kCaption);
    height = size.y() * scale + 2.0 * kMargin + 20.0;
  }

  [[nodiscard]] double x(const Vector2& at) const { return kMargin + (at.x() - low.x()) * scale; }
  [[nodiscard]] double y(const Vector2& at) const {
    return height - kMargin - (at.y() - low.y()) * scale;
  }
  [[nodiscard]] std::string line(const LandmarkGraph& graph, int number) const {
    const Route& route = graph.route(number);
    const Vector2& from = graph.landmark(route.source).position;
    const Vector2& to = graph.landmark(route.target).position;
    return fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", x(from), y(from), x(to), y(to));
  }
};

/// What the robot does not know.
std::string world_as_it_is(const Paper& paper, const LandmarkGraph& world) {
  std::string routes;
  for (int number = 0; number < world.routes(); ++number) routes += paper.line(world, number);
  std::string crosses;
  for (int k = 0; k < world.landmarks(); ++k) {
    const Vector2& at = world.landmark(k).position;
    crosses += fmt::format("M{0:.1f} {1:.1f}l6 6m0 -6l-6 6", paper.x(at) - 3.0, paper.y(at) - 3.0);
  }
  return fmt::format(
      "<path d=\"{}\" stroke=\"#ddd\" stroke-width=\"4\" fill=\"none\"/>\n"
      "<path d=\"{}\" stroke=\"#c0504d\" fill=\"none\"/>\n",
      routes, crosses);
}

std::string moment(const Paper& paper, const ExplorationFrame& one) {
  std::string text;
  for (int number = 0; number < one.map.routes(); ++number) {
    const int driven = one.map.route(number).traversals;
    text += fmt::format("<path d=\"{}\" stroke=\"#222\" stroke-width=\"1.5\" opacity=\"{:.2f}\"/>",
                        paper.line(one.map, number), 0.25 + 0.75 * std::min(1.0, driven / kOften));
  }
  for (int k = 0; k < one.map.landmarks(); ++k) {
    const Vector2& at = one.map.landmark(k).position;
    const bool here = k == one.here;
    text += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>", paper.x(at),
                        paper.y(at), here ? 6 : 3, here ? "#1f6fb4" : "#222");
  }
  return text + fmt::format(
                    "<text x=\"6\" y=\"16\" font-size=\"12\">{:.0f} m, {} landmarks, {:.3f} m off"
                    "</text>",
                    one.way, one.map.landmarks(), one.error);
}

std::string opening(const Paper& paper, const std::string& title) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
      "width=\"{0:.0f}\" height=\"{1:.0f}\" font-family=\"sans-serif\" role=\"img\" "
      "aria-label=\"{2}\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      paper.width, paper.height, text::xml_escaped(title));
}

/// At most `most` of the frames, evenly spread, the last among them.
std::vector<ExplorationFrame> chosen_frames(const std::vector<ExplorationFrame>& frames,
                                            std::size_t most) {
  if (frames.size() <= most) return frames;
  std::vector<ExplorationFrame> chosen;
  for (std::size_t k = 1; k <= most; ++k) chosen.push_back(frames[k * frames.size() / most - 1]);
  return chosen;
}

/// One moment as a picture, within a square of so many pixels.
std::string still_picture(const ExplorationFrame& frame, const LandmarkGraph& world, double width) {
  const Paper paper(world, width);
  return opening(paper, fmt::format("The map after {:.0f} m", frame.way)) +
         world_as_it_is(paper, world) + moment(paper, frame) + "\n</svg>\n";
}

/// Shown from one share of the whole time to another.
std::string shown_between(double from, double to, double seconds) {
  std::string values = "visible";
  std::string times = "0";
  if (from > 0.0) {
    values = "hidden;visible";
    times += fmt::format(";{:.5f}", from);
  }
  if (to < 1.0) {
    values += ";hidden";
    times += fmt::format(";{:.5f}", to);
  }
  return fmt::format(
      "<animate attributeName=\"visibility\" calcMode=\"discrete\" values=\"{}\" keyTimes=\"{}\" "
      "dur=\"{:.1f}s\" repeatCount=\"indefinite\"/>",
      values, times, seconds);
}

std::string error_picture(const std::vector<ExplorationFrame>& frames) {
  plot::Mark line;
  line.kind = plot::MarkKind::polyline;
  line.colour = plot::colour::kBlue;
  line.size = 1.5;
  for (const ExplorationFrame& one : chosen_frames(frames, 400)) {
    line.at.emplace_back(one.way, one.error);
  }
  plot::Panel panel;
  panel.x_label = "driven [m]";
  panel.y_label = "landmarks off, mean [m]";
  panel.marks.push_back(std::move(line));
  plot::Figure figure;
  figure.title = "How far off the map is";
  figure.subtitle = "Of the landmarks found so far";
  figure.panels.push_back(std::move(panel));
  return plot::draw_figure(figure);
}

}  // namespace

std::string exploration_picture(const std::vector<ExplorationFrame>& frames,
                                const LandmarkGraph& world, const std::string& subject) {
  constexpr double kWidth = 560.0;
  const Paper paper(world, kWidth);
  const std::vector<ExplorationFrame> shown = chosen_frames(frames, kMostFrames);
  const double whole = kSecondsPerFrame * static_cast<double>(shown.size()) + kSecondsAtTheEnd;
  std::string text = opening(paper, "A map as it grows: " + subject) + world_as_it_is(paper, world);
  for (std::size_t k = 0; k < shown.size(); ++k) {
    // Each is seen in its turn; without animation the last stays.
    const bool last = k + 1 == shown.size();
    const double from = kSecondsPerFrame * static_cast<double>(k) / whole;
    const double to = last ? 1.0 : kSecondsPerFrame * static_cast<double>(k + 1) / whole;
    text += fmt::format("<g visibility=\"{}\">{}", last ? "visible" : "hidden",
                        moment(paper, shown[k]));
    if (shown.size() > 1) text += shown_between(from, to, whole);
    text += "</g>\n";
  }
  return text + "</svg>\n";
}

std::string exploration_page(const std::vector<ExplorationFrame>& frames,
                             const LandmarkGraph& world, const std::string& subject) {
  constexpr std::size_t kStills = 12;
  constexpr double kStillWidth = 260.0;
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'\">\n<title>Exploration: {0}</title>\n<style>body{{font-family:sans-serif;"
      "margin:2em auto;max-width:64em;padding:0 1em}}.row{{display:flex;flex-wrap:wrap;gap:1em;"
      "align-items:flex-start}}figure{{margin:0}}svg{{max-width:100%;height:auto;"
      "border:1px solid #ddd}}</style>\n</head>\n<body>\n<main>\n"
      "<h1>A map as it grows</h1>\n<p>{0}. Black: the map, its routes as dark as they were driven "
      "often; blue: the robot. What it does not know: red crosses, where the landmarks are, and "
      "in pale grey the ways between them.</p>\n",
      text::xml_escaped(subject));
  page += "<div class=\"row\">\n" + exploration_picture(frames, world, subject);
  if (!frames.empty()) page += error_picture(frames);
  page += "</div>\n<h2>Moments</h2>\n<div class=\"row\">\n";
  for (const ExplorationFrame& one : chosen_frames(frames, kStills)) {
    page += "<figure>" + still_picture(one, world, kStillWidth) + "</figure>\n";
  }
  return page + "</div>\n</main>\n</body>\n</html>\n";
}

}  // namespace trussmap
