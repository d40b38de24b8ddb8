// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Noise as a mix of components with sizes, some of them free: what a search for noise passes from
// stage to stage.
#pragma once

#include "fit/noise_reml.hpp"
#include "fit/noise_search.hpp"

#include <string>
#include <vector>

namespace trussmap::fitting {

struct NoiseMember {
  NoiseComponent component;
  double sd = 0.0;
  double length = 0.0;   ///< s or m, 0 where there is none
  bool free = false;     ///< else as stated
  double gain = 0.0;     ///< fall of -2 log R by it, or by its other size
  double p_value = 1.0;  ///< of a process
};

struct NoiseMix {
  std::vector<NoiseMember> members;
  double minus_two_log = 0.0;  ///< of the restricted likelihood

  [[nodiscard]] bool has(const std::string& component) const;
  /// A process takes its part of what the white source of its sensor had.
  [[nodiscard]] bool is_beside_a_process(std::size_t member) const;
  [[nodiscard]] std::vector<bool> free() const;
};

/// The white component of the sensor, or the wheels, that a process acts on.
[[nodiscard]] std::string white_source_of(const NoiseComponent& process);

[[nodiscard]] NoiseReml::Sizes sizes_of(const NoiseMix& mix);

/// Lays the likelihood out for the members.
void choose(NoiseReml& reml, const NoiseMix& mix);

/// -2 log R of the members chosen; infinity where there is none.
[[nodiscard]] double deviance(NoiseReml& reml, const NoiseReml::Sizes& sizes);

/// What lengths can be told from: part of all that was recorded.
struct NoiseExtents {
  double time = 0.0;  ///< s
  double way = 0.0;   ///< m
};
[[nodiscard]] NoiseExtents extents_of(const FitState& fit);

/// Logarithms of sizes: of all sds that vary, then of their lengths.
class NoiseLogarithms {
 public:
  NoiseLogarithms(const NoiseMix& mix, const NoiseExtents& extents, const std::vector<bool>& vary);

  struct Place {
    std::size_t member = 0;
    bool length = false;
  };
  [[nodiscard]] const std::vector<Place>& places() const { return places_; }
  [[nodiscard]] Eigen::VectorXd values() const;
  [[nodiscard]] NoiseReml::Sizes sizes(const Eigen::VectorXd& values) const;
  /// Where they may go.
  [[nodiscard]] Eigen::VectorXd bounded(Eigen::VectorXd values) const;
  /// Whether a size or a length of the member would go further than it may.
  [[nodiscard]] bool at_limit(std::size_t member) const;
  /// Whether its size would be larger than is sought.
  [[nodiscard]] bool at_largest(std::size_t member) const;

 private:
  struct Range {
    double least = 0.0;
    double most = 0.0;
  };
  [[nodiscard]] static Range range_of_length(const NoiseMember& member,
                                             const NoiseExtents& extents);
  [[nodiscard]] static Range range_of_sd(const NoiseMix& mix, std::size_t member);

  NoiseReml::Sizes sizes_;
  std::vector<Place> places_;
  std::vector<Range> ranges_;  ///< of each place
};

/// The mix with its likeliest sizes, those that vary; laid out already.
[[nodiscard]] NoiseMix likeliest(NoiseReml& reml, NoiseMix mix, const NoiseExtents& extents,
                                 const std::vector<bool>& vary, int most_steps, double least_gain);

/// Standard errors of the logarithms at the likeliest.
[[nodiscard]] Eigen::VectorXd standard_errors(NoiseReml& reml, const NoiseLogarithms& logarithms);

}  // namespace trussmap::fitting
