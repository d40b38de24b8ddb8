// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Since when has which effect been there? An e-detector with mixtures over effects and starts.
//
//   w     whitened numbers of a leg's innovation: independent, of variance 1, while the model holds
//   h     what one unit of the effect's coefficient, there since a start, adds to w
//   psi   w, clipped to +-c: tails count no more than that
//
//   A = sum h psi(w),  Q = sum h^2                     since the start
//   E = (1 + s^2 k^2 Q)^(-1/2) exp(s^2 A^2/(2 (1 + s^2 k^2 Q)))
//       the mean of exp(b A - b^2 k^2 Q/2) over coefficients b ~ N(0, s^2); k: noise margin
//   M = sum over starts and effects of (weight) E,  weight = rate x hours of the start's
//   leg/effects
//
// While E[exp(l psi(w)) | past] <= exp(l^2 k^2/2), each E is a supermartingale that begins at 1, so
// M - rate x hours is one that begins at 0: an alarm where M reaches 1 is false at most `rate`
// times an hour, whenever one looks (docs/mathematics.md). Clipped normal numbers satisfy that with
// k = 1, as |psi(w)| <= |w| and they are symmetric.
//
// Which effect it is, and since when, is told by w itself in place of psi(w): a large effect clips
// all numbers alike. Where w has tails that errs sooner, but no alarm hangs on it.
//
// Starts older than a horizon go for nothing, which only lets M fall: what no 200 legs show is no
// change of the model, but what it leaves out, as the second order of errors, and would add up.
//
// h is reckoned along the motion as measured, and so errs with it by some tenths of w per unit of a
// scale: where s|h| is below a floor that is most of it, and h counts as 0.
//
// Starts are kept up to a number: of two neighbours in time whose ages differ least, in proportion,
// the one with less evidence goes, and its part of M is given to the other. M does not change by
// that, so what was said of it stays true. The ages kept grow geometrically.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace trussmap::monitor {

struct DetectorOptions {
  double rate = 0.01;   ///< false alarms per hour
  double margin = 1.1;  ///< k
  double clip = 2.5;    ///< c
  std::size_t starts = 24;
  double floor = 0.15;  ///< of s|h|
  long horizon = 200;   ///< legs
};

/// What is known of an effect that began at a start.
struct EffectSince {
  std::size_t start = 0;  ///< number among those kept
  std::size_t effect = 0;
  long leg = 0;  ///< the first with it
  double coefficient = 0.0;
  double sd = 0.0;
};

class ChangeDetector {
 public:
  /// `usual`: s of each effect.
  ChangeDetector(const DetectorOptions& options, std::vector<double> usual);

  /// Before a start begins: the number of the one that goes for it, where there are too many.
  std::optional<std::size_t> make_room();
  /// A leg of so many hours begins, and with it a start.
  void begin(long leg, double hours);
  /// Numbers of the leg's innovation and what effects add to them: a column per start and effect.
  void take(const Eigen::VectorXd& whitened, const Eigen::MatrixXd& columns);

  /// M.
  [[nodiscard]] double evidence() const;
  /// Per effect its share of the evidence, by w itself.
  [[nodiscard]] std::vector<double> shares() const;
  /// The start that speaks most for this effect. There must be one.
  [[nodiscard]] EffectSince likeliest(std::size_t effect) const;
  /// The first and last leg with which it may have begun: starts with this share of what speaks for
  /// the effect.
  [[nodiscard]] std::pair<long, long> since(std::size_t effect, double share) const;
  /// Cosine between two effects over the legs since a start; 0 where one of them shows nowhere.
  [[nodiscard]] double cosine(std::size_t start, std::size_t a, std::size_t b) const;

  /// An alarm was raised after this leg: what it is of began by then. Which effect and since when
  /// are told by starts up to it, as long as one is kept.
  void alarmed(long leg);

  [[nodiscard]] std::size_t starts() const { return starts_.size(); }
  void clear();

 private:
  struct Start {
    long leg = 0;
    Eigen::ArrayXd log_weight;
    Eigen::ArrayXd clipped;   ///< A
    Eigen::ArrayXd measured;  ///< the same of w itself
    Eigen::MatrixXd gram;     ///< Q on its diagonal
  };
  [[nodiscard]] Eigen::ArrayXd log_parts(const Start& start, const Eigen::ArrayXd& sum) const;
  /// Of M, and of what tells which effect it is.
  [[nodiscard]] Eigen::ArrayXd log_parts(const Start& start) const {
    return log_parts(start, start.clipped);
  }
  [[nodiscard]] Eigen::ArrayXd log_naming(const Start& start) const {
    return log_parts(start, start.measured);
  }

  /// How many of the starts tell which effect it is: the first ones.
  [[nodiscard]] std::size_t telling() const;

  DetectorOptions options_;
  Eigen::ArrayXd usual_;
  std::vector<Start> starts_;  ///< the oldest first
  long leg_ = 0;
  std::optional<long> alarm_;  ///< the leg after which it was raised
};

}  // namespace trussmap::monitor
