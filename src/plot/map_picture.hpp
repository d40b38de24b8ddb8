// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A map, or a path, as a picture (SVG): before correction grey, after black, true positions as
// crosses, like Figure 7 of Golfarelli, Maio & Rizzi (1998), or the true routes light grey below
// it, like Figures 5 and 8. Routes are drawn straight; a route's width grows with its traversals. A
// tick at a landmark is its own axis, where it has one.
#pragma once

#include "trussmap/build_map.hpp"
#include "trussmap/landmark_map.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/survey_comparison.hpp"

#include <string>
#include <utility>
#include <vector>

namespace trussmap::plot {

struct MapPicture {
  std::string title;
  LandmarkGraph map;         ///< after correction
  LandmarkPositions before;  ///< may be empty, or lack landmarks
  /// In place of `before`: each route as measured, from where to where, m. May be empty.
  std::vector<std::pair<Vector2, Vector2>> measured;
  LandmarkPositions truth;       ///< may be empty
  bool true_routes = false;      ///< draw the routes between true positions, too
  bool crosses = true;           ///< mark the true positions
  Alignment map_onto_truth;      ///< laid over map and before alike
  std::vector<BuiltPath> paths;  ///< where there are no landmarks
  bool names = true;             ///< write the landmarks' names beside them
};

/// The map before and after, laid over its survey where there is one.
[[nodiscard]] MapPicture picture_of(const BuiltMap& built, const std::string& title);

/// The picture as SVG text; names are escaped. 800 pixels wide.
[[nodiscard]] std::string draw_map(const MapPicture& picture);

}  // namespace trussmap::plot
