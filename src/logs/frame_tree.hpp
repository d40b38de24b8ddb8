// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Frames of a robot and where they are in one another over time, as /tf and /tf_static have it.
//
//   transform   parent, child: where the child's origin is in the parent, and how it is turned
//   chain       from any frame to any other, over their common ancestor
//
// Static transforms hold for all times. Between two samples of a moving one translation is
// interpolated linearly, rotation along the great circle; before its first and after its last there
// is none.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

namespace trussmap::logs {

struct FrameSample {
  std::int64_t t = 0;                                     ///< ns
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< m
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

/// A child's place in its parent.
struct FrameLink {
  std::string parent;
  bool is_static = false;
  std::vector<FrameSample> samples;  ///< in order of time once sorted
};

class FrameTree {
 public:
  /// Frames whose chains will be asked for, with * for anything in a name: of the others no more
  /// than needed is kept. None: all.
  void wants(const std::string& frame);

  /// A child that changes its parent keeps the last one. A rotation that is none is refused: false.
  bool add(std::string_view parent, std::string_view child, const FrameSample& sample,
           bool is_static);

  /// Frames that are needed after all, of which samples went before anybody could know.
  [[nodiscard]] std::vector<std::string> lost() const;

  /// After the last add: samples in order of time, of equal times the last.
  void sort();

  [[nodiscard]] bool knows(const std::string& frame) const;
  [[nodiscard]] const std::map<std::string, FrameLink, std::less<>>& links() const {
    return links_;
  }
  /// Children whose names fit a pattern with *, in order.
  [[nodiscard]] std::vector<std::string> children_like(std::string_view pattern) const;

  /// Where `child` is in `parent` at a time; none where they are not joined, or not at that time.
  [[nodiscard]] std::optional<Eigen::Isometry3d> transform(const std::string& parent,
                                                           const std::string& child,
                                                           std::int64_t t) const;
  /// Times at which `child` is known in `parent`: those of the moving link that is nearest to the
  /// child. Empty where they are not joined, or where nothing moves.
  [[nodiscard]] std::vector<std::int64_t> times(const std::string& parent,
                                                const std::string& child) const;
  /// Whether there is a chain between them at all.
  [[nodiscard]] bool are_joined(const std::string& parent, const std::string& child) const;

 private:
  [[nodiscard]] std::vector<std::string> ancestors(const std::string& frame) const;
  [[nodiscard]] std::set<std::string> needed() const;
  void prune();

  std::map<std::string, FrameLink, std::less<>> links_;  ///< by child
  std::set<std::string> wanted_;
  std::set<std::string> pruned_;
  std::size_t samples_ = 0;
  std::size_t prune_at_ = 200000;
};

/// Whether a name fits a pattern, in which * stands for any characters.
[[nodiscard]] bool is_like(std::string_view name, std::string_view pattern);

/// Direction of an axis (x, y, z) of a turned frame in the plane, rad, and how much of it lies in
/// the plane, 0 to 1.
struct PlanarAxis {
  double angle = 0.0;
  double share = 0.0;
};
[[nodiscard]] PlanarAxis planar_axis(const Eigen::Matrix3d& rotation, char axis);

}  // namespace trussmap::logs
