// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How a map grows: the landmarks' true places as crosses, the map of each moment in black, the
// routes as dark as they were driven often, and where the robot is.
#include "geometry/index.hpp"
#include "text/xml_text.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/survey_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr double kMargin = 24.0;  // pixels
constexpr double kSecondsPerFrame = 0.2;
constexpr std::size_t kMostFrames = 150;
constexpr double kOften = 4.0;  // traversals, from which a route is black

/// From metres to pixels: y up.
struct Frame {
  Vector2 low = Vector2::Constant(std::numeric_limits<double>::infinity());
  Vector2 high = -low;
  double scale = 1.0;
  double width = 0.0;
  double height = 0.0;

  Frame(const LandmarkPositions& truth, double wide) : width(wide) {
    for (const auto& [name, at] : truth) {
      low = low.cwiseMin(at);
      high = high.cwiseMax(at);
    }
    const Vector2 size = (high - low).cwiseMax(1e-9);
    scale = std::min((width - 2.0 * kMargin) / size.x(), 1.5 * width / size.y());
    height = size.y() * scale + 2.0 * kMargin + 20.0;
  }

  [[nodiscard]] double x(const Vector2& at) const { return kMargin + (at.x() - low.x()) * scale; }
  [[nodiscard]] double y(const Vector2& at) const {
    return height - kMargin - (at.y() - low.y()) * scale;
  }
};

std::string crosses(const Frame& frame, const LandmarkPositions& truth) {
  std::string path;
  for (const auto& [name, at] : truth) {
    path += fmt::format("M{0:.1f} {1:.1f}l6 6m0 -6l-6 6", frame.x(at) - 3.0, frame.y(at) - 3.0);
  }
  return fmt::format("<path d=\"{}\" stroke=\"#c0504d\" fill=\"none\"/>\n", path);
}

std::string moment(const Frame& frame, const ExplorationFrame& one) {
  std::string text;
  for (int number = 0; number < one.map.routes(); ++number) {
    const Route& route = one.map.route(number);
    const Vector2& from = one.map.landmark(route.source).position;
    const Vector2& to = one.map.landmark(route.target).position;
    text += fmt::format(
        "<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"#222\" stroke-width=\"1.5\" "
        "opacity=\"{:.2f}\"/>",
        frame.x(from), frame.y(from), frame.x(to), frame.y(to),
        0.25 + 0.75 * std::min(1.0, route.traversals / kOften));
  }
  for (int k = 0; k < one.map.landmarks(); ++k) {
    const Vector2& at = one.map.landmark(k).position;
    const bool here = k == one.here;
    text += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>", frame.x(at),
                        frame.y(at), here ? 6 : 3, here ? "#1f6fb4" : "#222");
  }
  return text +
         fmt::format("<text x=\"{}\" y=\"16\" font-size=\"12\">{:.0f} m, {} landmarks</text>",
                     kMargin, one.way, one.map.landmarks());
}

std::string opening(const Frame& frame, const std::string& title) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
      "width=\"{0:.0f}\" height=\"{1:.0f}\" font-family=\"sans-serif\" role=\"img\" "
      "aria-label=\"{2}\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      frame.width, frame.height, xml_escaped(title));
}

/// At most `most` of the frames, evenly spread, the last among them.
std::vector<ExplorationFrame> chosen_frames(const std::vector<ExplorationFrame>& frames,
                                            std::size_t most) {
  if (frames.size() <= most) return frames;
  std::vector<ExplorationFrame> chosen;
  for (std::size_t k = 1; k <= most; ++k) chosen.push_back(frames[k * frames.size() / most - 1]);
  return chosen;
}

/// One moment as a picture, `width` pixels wide.
std::string still_picture(const ExplorationFrame& frame, const LandmarkPositions& truth,
                          double width) {
  const Frame paper(truth, width);
  return opening(paper, "the map at a moment") + crosses(paper, truth) + moment(paper, frame) +
         "\n</svg>\n";
}

}  // namespace

std::string exploration_picture(const std::vector<ExplorationFrame>& frames,
                                const LandmarkPositions& truth, const std::string& subject) {
  constexpr double kWidth = 560.0;
  const Frame paper(truth, kWidth);
  const std::vector<ExplorationFrame> shown = chosen_frames(frames, kMostFrames);
  const double whole = kSecondsPerFrame * static_cast<double>(shown.size());
  std::string text = opening(paper, "A map as it grows: " + subject) + crosses(paper, truth);
  for (std::size_t k = 0; k < shown.size(); ++k) {
    // Each is seen in its turn; without animation the last stays.
    const bool last = k + 1 == shown.size();
    const double from = static_cast<double>(k) / static_cast<double>(shown.size());
    const double to = static_cast<double>(k + 1) / static_cast<double>(shown.size());
    text += fmt::format("<g visibility=\"{}\">{}", last ? "visible" : "hidden",
                        moment(paper, shown[k]));
    if (shown.size() > 1) {
      const std::string values = k == 0 ? "visible;hidden"
                                 : last ? "hidden;visible"
                                        : "hidden;visible;hidden";
      const std::string times = k == 0 ? fmt::format("0;{:.5f}", to)
                                : last ? fmt::format("0;{:.5f}", from)
                                       : fmt::format("0;{:.5f};{:.5f}", from, to);
      text += fmt::format(
          "<animate attributeName=\"visibility\" calcMode=\"discrete\" values=\"{}\" "
          "keyTimes=\"{}\" dur=\"{:.1f}s\" repeatCount=\"indefinite\"/>",
          values, times, whole);
    }
    text += "</g>\n";
  }
  return text + "</svg>\n";
}

std::string exploration_page(const std::vector<ExplorationFrame>& frames,
                             const LandmarkPositions& truth, const std::string& subject) {
  constexpr std::size_t kStills = 12;
  constexpr double kStillWidth = 260.0;
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'\">\n<title>Exploration: {0}</title>\n<style>body{{font-family:sans-serif;"
      "margin:2em auto;max-width:60em;padding:0 1em}}figure{{display:inline-block;margin:.3em}}"
      "svg{{max-width:100%;height:auto;border:1px solid #ddd}}</style>\n</head>\n<body>\n"
      "<h1>A map as it grows</h1>\n<p>{0}. Red crosses: where the landmarks are; black: the map; "
      "blue: the robot; routes are as dark as they were driven often.</p>\n",
      xml_escaped(subject));
  page += exploration_picture(frames, truth, subject);
  page += "<h2>Moments</h2>\n";
  for (const ExplorationFrame& one : chosen_frames(frames, kStills)) {
    page += "<figure>" + still_picture(one, truth, kStillWidth) + "</figure>\n";
  }
  return page + "</body>\n</html>\n";
}

}  // namespace trussmap
