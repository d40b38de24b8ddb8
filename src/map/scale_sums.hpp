// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A truss of bars relaxed by groups of any size at the cost of six numbers per group: no step
// visits a group's landmarks.
//
//   level 2      G            p = A_G(c)             A_G  = T_G
//               / \                                  A_g  = A_G T_g
//   level 1    g   h          p = A_g(c)             of a landmark: the product up the tree
//             /|\  /|\                               .
//            landmarks        c, in the frame of g
//
// Numbers of a step, of each free group: how it is moved; how that changes along the axis in which
// its landmarks spread most, and across it. A group that is thinner than kThinnest of its length
// moves alike across: there would be nothing to tell it by.
//
// A group that is moved, turned and sheared changes its T alone; its landmarks follow when they are
// looked at. What its bars pull is known from sums (affine_sums.hpp), which every group keeps of
// the bars within and per neighbour in its own frame: there no move of itself or of a coarser group
// changes them. Where landmarks have moved by themselves, or bars have changed, the sums of their
// groups are taken anew, those of a coarser group from its members' sums.
//
// Exact: a step is the minimisation of the energy over the free groups' numbers, as if every
// landmark were visited. Cost of a step: free groups x neighbours; of what follows from it: as
// much per level above.
#pragma once

#include "linalg/band_cholesky.hpp"
#include "map/affine_sums.hpp"
#include "map/scale_groups.hpp"
#include "truss/elastic_truss.hpp"

#include <vector>

namespace trussmap::map {

class ScaleSums {
 public:
  /// Finer levels are relaxed landmark by landmark.
  static constexpr int kFinest = 1;
  /// Of a group across its longest axis, standard deviations of its landmarks' places.
  static constexpr double kThinnest = 0.01;

  [[nodiscard]] bool empty() const { return levels_.empty(); }
  void clear() noexcept;

  /// Takes in landmarks and groups that are new, and all of them at first. Positions in `truss`
  /// that are new are where they are. What throws leaves all positions as they were.
  void follow(const ScaleGroups& groups, truss::ElasticTruss& truss);

  /// Where a landmark is now; in the truss it may still be where it was last looked at.
  [[nodiscard]] Vector2 position(const truss::ElasticTruss& truss, int landmark) const;

  /// Lets the landmark's group in the truss be where it is.
  void look(truss::ElasticTruss& truss, int landmark) noexcept;
  /// The same of the landmarks and of all at the other ends of their bars.
  void look_round(truss::ElasticTruss& truss, const std::vector<int>& landmarks) noexcept;
  /// The same of all landmarks, which are then no longer followed.
  void settle(truss::ElasticTruss& truss) noexcept;

  /// A landmark was moved by itself (it was looked at before), or a bar at it has changed.
  void touch(int landmark) noexcept;

  /// From the finest level on: first the sums of what was touched or moved below, then the groups
  /// come to equilibrium, all else held. Returns the energy that this took.
  void take_sums(int level, truss::ElasticTruss& truss);
  double relax(int level, const std::vector<int>& groups, const truss::ElasticTruss& truss);

  /// Steps since begin() can be taken back, until commit().
  void begin() noexcept;
  void roll_back() noexcept;

  /// The landmarks in groups that were moved since begin(), at the level where these are most, and
  /// a bound on how far, m.
  [[nodiscard]] int moved() const { return moved_; }
  [[nodiscard]] double largest_move() const { return largest_move_; }

  /// The `count` landmarks nearest to a point, ascending; of those equally far the lowest numbers.
  [[nodiscard]] std::vector<int> nearest(const truss::ElasticTruss& truss, const Vector2& to,
                                         int count) const;

 private:
  struct Frame {
    Affine T;  ///< the group's frame in that of its parent, or the map's
    int parent = -1;
  };
  struct Group {
    InnerSums inner;
    std::vector<int> members;  ///< groups of the level below, or landmarks
    std::vector<int> ties;
    Vector2 low = Vector2::Zero();  ///< its landmarks lie in this box of its frame
    Vector2 high = Vector2::Zero();
    int landmarks = 0;
    Vector2 mean = Vector2::Zero();    ///< of their places
    Matrix2 spread = Matrix2::Zero();  ///< sum of squares about it
    bool touched = false;
  };
  struct Tie {
    int a = -1;
    int b = -1;  ///< -1: the landmark that is held
    TieSums sums;
  };
  struct Level {
    std::vector<Frame> frames;
    std::vector<Group> groups;
    std::vector<Tie> ties;
    std::vector<int> touched;
  };
  struct Change {
    int level = 0;
    int group = -1;
    Affine before;
  };
  /// Where the truss has a finest group's landmarks.
  struct Seen {
    Affine at;    ///< the group's frame when they were last looked at
    Affine back;  ///< its inverse
    unsigned when = 0;
  };

  [[nodiscard]] Level& level_at(int level) { return levels_[idx(level - kFinest)]; }
  [[nodiscard]] const Level& level_at(int level) const { return levels_[idx(level - kFinest)]; }
  [[nodiscard]] int coarsest() const { return kFinest + static_cast<int>(levels_.size()) - 1; }
  [[nodiscard]] int home(int landmark) const {
    return idx(landmark) < home_.size() ? home_[idx(landmark)] : -1;
  }
  [[nodiscard]] Affine frame_of(int level, int group) const;
  void set_frame(int level, int group, const Affine& T);
  void touch_group(int level, int group) noexcept;
  void follow_level(int level, const ScaleGroups& groups, const truss::ElasticTruss& truss);
  void follow_landmarks(const ScaleGroups& groups, truss::ElasticTruss& truss);
  int tie_between(Level& level, int a, int b);
  void clear_sums(Level& level, int group);
  void sum_landmarks(int group, truss::ElasticTruss& truss);
  void take_frame(int group, truss::ElasticTruss& truss);
  void sum_bar(int group, const truss::Element& bar, const truss::ElasticTruss& truss);
  void take_frame_of_members(int level, int group);
  void sum_members(int level, int group);
  void measure_members(int level, int group);

  struct Free;
  [[nodiscard]] Free free_groups(int level, const std::vector<int>& groups) const;
  void order(const Level& level, Free& free) const;
  void assemble(int level, Free& free);
  void assemble_tie(int level, const Tie& tie, std::size_t n, Free& free);
  double move(int level, const Free& free);

  std::vector<Level> levels_;
  std::vector<int> home_;   ///< per landmark: its group at the finest level, -1: in none
  std::vector<Seen> seen_;  ///< per group of the finest level
  Affine held_;             ///< where the landmark is that is held
  unsigned now_ = 1;        ///< counts moves of groups
  std::vector<Change> changes_;
  std::vector<int> place_;  ///< per group of a level: its place among the free ones, or -1
  linalg::BandMatrix K_;
  int moved_ = 0;
  double largest_move_ = 0.0;
};

}  // namespace trussmap::map
