// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// Maps and pose graphs as files. The ending of a file's name says what it holds:
//
//   .graphml   a map, out and in without loss
//   .g2o       a map as a pose graph of points, or any pose graph in the plane
//   .geojson   a map for other people's programs, out only
//   .dot       a map for Graphviz, out only
//   .yaml      a map for ROS nodes that look for markers, out only; .yml, too
//
// GraphML: undirected; node id = landmark name; node data x, y [m] and, where known, c_xx c_xy c_yy
// [m^2], heading (of the landmark's own axis) and its standard error sd_heading [rad]; edge data
// traversals, stretch [m], orientation [rad] (source to target), dx, dy [m], c_xx c_xy c_yy [m^2]
// (mean covariance of a traversal, map frame).
//
// A map as a pose graph: landmarks are points, the first of them fixed; routes are displacements
// with information t C^-1 (t traversals of mean covariance C), the Gauss-Markov stiffness. The way
// back cannot know how many traversals an edge stands for: it makes one of each.
//
// g2o's format, of which the plane's part, TORO's and iSAM's; one element a line, in any order,
// blank lines and what follows a # are skipped:
//
//   VERTEX_SE2   id x y theta                                pose                     m, rad
//   VERTEX_XY    id x y                                      point                    m
//   FIX          id id ...                                   these stay where they are
//   EDGE_SE2     i j  dx dy dtheta  I11 I12 I13 I22 I23 I33  pose to pose
//   EDGE_SE2_XY  i j  dx dy  I11 I12 I22                     pose to point, robot's frame
//   EDGE_POINTXY i j  dx dy  I11 I12 I22                     point to point, map frame
//   VERTEX2      id x y theta                                TORO: pose
//   EDGE2        i j  dx dy dtheta  I11 I12 I22 I33 I13 I23  TORO: pose to pose, j seen from i
//
//   ODOMETRY     i j  dx dy dtheta  R11 R12 R13 R22 R23 R33  iSAM: pose to pose, information R'R
//   EDGE2        i j  dx dy dtheta  R11 R12 R13 R22 R23 R33  iSAM: the same
//   LANDMARK     i l  dx dy  R11 R12 R22                     iSAM: pose to point, robot's frame;
//                                                            l counts landmarks apart from poses,
//                                                            and becomes vertex (last) + 1 + l
//                                                            unless VERTEX_XY l stands there
//
// How a line's information is read is said by its tag alone, whatever stands beside it. EDGE2,
// which two programs write, is iSAM's in files named .txt without VERTEX2 lines, else TORO's, or
// what Edge2 says; where the file has lines of the other program, it has to be said.
//
// A file may have no vertex lines at all: its vertices are then those that its edges name, without
// estimates. If there are vertex lines, every vertex needs one. Names that end in .xz are
// decompressed.
#pragma once

#include "trussmap/landmark_map.hpp"
#include "trussmap/pose_graph.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap {

struct FieldOfPlaces;

// Maps, whatever the ending says.

/// Whether the name ends like a map's: .graphml, .g2o, .geojson, .dot, .yaml or .yml.
[[nodiscard]] bool is_map_file(const std::filesystem::path& file);

/// From .graphml or .g2o. Throws InputError on another ending and on what is no map in the file,
/// with the line where there is one.
[[nodiscard]] LandmarkGraph read_map(const std::filesystem::path& file);

/// What a file of this name holds of the map; `comment` (which method made it, say) stands where
/// the format has room for one. Throws InputError on another ending, or a map that the format
/// cannot hold.
[[nodiscard]] std::string format_map(const LandmarkGraph& map, const std::filesystem::path& file,
                                     const std::string& comment = "");

// Maps, format by format.

/// Throws InputError, with the line where the XML reader knows it: no XML, no GraphML graph, a
/// directed graph, a landmark twice, a value missing or no number, an edge to an unknown landmark,
/// two edges between the same landmarks, a count below 1.
[[nodiscard]] LandmarkGraph read_map_graphml(const std::filesystem::path& file);

/// `comment`, if any, is written as an XML comment.
[[nodiscard]] std::string format_map_graphml(const LandmarkGraph& map,
                                             const std::string& comment = "");

/// A FeatureCollection: a Point per landmark, a LineString per route, with their numbers as
/// properties. Coordinates are metres in the map frame, not degrees.
[[nodiscard]] std::string format_geojson(const LandmarkGraph& map);

/// A field over the floor (diagnose.hpp): a Polygon per cell that the robot was in, with `mean`
/// and `sd` in the channel's unit, `channel` and `unit` as properties.
[[nodiscard]] std::string format_geojson(const FieldOfPlaces& field);

/// An undirected graph with pinned positions in metres: `neato -Tsvg` draws it as it lies.
[[nodiscard]] std::string format_dot(const LandmarkGraph& map);

// Landmarks as markers that lie on the floor, faces up: z = 0, turned about z by their heading,
// or not at all where they have none. A marker's id is the number that the landmark's name ends in
// (5 of tag36h11:5, tag_5 and 5), if no other's is the same.

enum class YamlLayout {
  /// frame_id, and markers with name, id, size, and pose and covariance as
  /// geometry_msgs/PoseWithCovariance has them, with a variance of 1e6 of what is not known.
  markers,
  /// tags.yaml of apriltag_ros (ROS 1, version 3): one bundle of all tags.
  apriltag,
};

struct YamlMapOptions {
  YamlLayout layout = YamlLayout::markers;
  std::optional<double> tag_size = {};  ///< m, edge of a marker's black square; apriltag needs it
  std::string frame = "map";            ///< frame_id, or the bundle's name
  std::string comment = {};             ///< stands at the top
};

struct YamlMap {
  std::string text;
  /// Names without a number, or with one that another has, too: markers without an id; in a bundle
  /// they are left out.
  std::vector<std::string> without_id;
  std::vector<std::string> without_heading;  ///< not turned
};

/// Numbers read back exactly, in YAML 1.1 as in 1.2. Throws std::invalid_argument on a size that is
/// not above 0 or that a bundle lacks, InputError where a bundle would have no tag.
[[nodiscard]] YamlMap format_map_yaml(const LandmarkGraph& map, const YamlMapOptions& options = {});

/// A table of the landmarks: landmark, x, y [m] and, where all are known, c_xx, c_xy, c_yy [m^2];
/// where any has an orientation heading, sd_heading [rad].
[[nodiscard]] std::string format_positions(const LandmarkGraph& map);

// Pose graphs.

/// Whose EDGE2 lines a file has.
enum class Edge2 { by_name, toro, isam };
/// Of the entries of a pose edge's information.
enum class InformationOrder {
  as_documented,  ///< an InputError where they are none as they stand
  either          ///< g2o's for TORO's and the reverse, where they are none otherwise
};

/// Throws InputError with file and line: a tag that is not in the table, too few or too many
/// values, a value that is no finite number, a vertex defined twice or not at all, an edge between
/// the wrong kinds of vertices, information that is not positive semidefinite, EDGE2 lines that may
/// be either program's.
[[nodiscard]] PoseGraph read_g2o(const std::string& path, Edge2 edge2 = Edge2::by_name,
                                 InformationOrder order = InformationOrder::as_documented);

/// The same from text; `name` stands for the file in messages, and says what EDGE2 is.
[[nodiscard]] PoseGraph parse_g2o(std::string_view text, const std::string& name,
                                  Edge2 edge2 = Edge2::by_name,
                                  InformationOrder order = InformationOrder::as_documented);

/// Vertices that have an estimate, fixed ones, and all edges; numbers read back without loss.
[[nodiscard]] std::string format_g2o(const PoseGraph& graph);

/// Written whole or not at all. Throws InputError where the path cannot be written.
void write_g2o(const PoseGraph& graph, const std::string& path);

}  // namespace trussmap
