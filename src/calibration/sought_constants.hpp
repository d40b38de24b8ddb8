// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a calibration seeks of a drive: its constants, as values g of the channels of effects.
#pragma once

#include "trussmap/channel.hpp"
#include "trussmap/model.hpp"
#include "trussmap/robot.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace trussmap::calibration {

/// What is sought: g of a channel, with the shape 1.
struct SoughtConstant {
  std::string name;  ///< of its effect
  Channel channel;
  std::string symbol;
  /// What is missing where the motion does not determine it, in the user's terms...
  const char* missing =
      "the motion does not tell this wheel from the others; drive ahead, to the side where the "
      "robot can, and turn";
  const char* missing_without_distance =  ///< ... and where nothing tells a distance
      "nothing in use measures a distance; add a survey, truth, or loops between poses far apart";
  /// What few robots have: sought where that explains what is left without it.
  bool seldom = false;
  /// E_d, E_b and E_s, or the like; of a steering offset how much of the wheel's way is left.
  double (*ratio)(double g) = [](double g) { return 1.0 + g; };
  /// What was found on corrected rows, more, beside what was in force: of a reading, which stays as
  /// it is, or beside it.
  double (*joined)(double g, double more) = [](double g, double more) { return g + more; };
  /// How much more of g a little more of `more` is.
  [[nodiscard]] double slope(double g) const;
};

/// Whether a column of the drive `wheels` turns the robot, and moves it nowhere.
[[nodiscard]] bool turns_alone(const Robot& robot, std::size_t column);

/// Whether one of its columns says how far the robot has turned, and nothing else, as what has
/// integrated a gyro does: what it says may have a bias.
[[nodiscard]] bool says_its_turns(const Robot& robot);

/// In the order in which their values stand everywhere.
[[nodiscard]] std::vector<SoughtConstant> sought_constants(const Robot& robot);

/// Which of the constants are sought.
using Wanted = std::vector<bool>;

/// Without a measured distance a smaller map has smaller errors: the drive's scale is then unknown.
[[nodiscard]] bool shows_scale(Channel channel);

/// The channels of those that few robots have.
[[nodiscard]] std::vector<Channel> seldom_constants(const Robot& robot);

/// The standard error from which on a constant is none.
[[nodiscard]] double useless_sd(const SoughtConstant& one, const Model& model);

/// Place of the steering's gain among a drive's constants.
[[nodiscard]] std::optional<std::size_t> place_of_gain(const Robot& robot);

/// The values that a model has, 0 where it has none.
[[nodiscard]] std::vector<double> in_force(const Model& model);

/// The model whose constants have these values; its other effects as given.
[[nodiscard]] Model with_constants(const Model& model, const std::vector<double>& g);

/// What counts of a constant that was found on rows corrected by `g`: wheels of two sizes turn the
/// robot before its turning is scaled by the wheelbase.
[[nodiscard]] double share_before_turning(const std::vector<SoughtConstant>& constants,
                                          const std::vector<double>& g, std::size_t which);

/// `g` and what was found, of those that are wanted, on rows that are corrected by it.
[[nodiscard]] std::vector<double> refined(const std::vector<double>& g, const Wanted& wanted,
                                          const Robot& robot, const Eigen::VectorXd& found);

}  // namespace trussmap::calibration
