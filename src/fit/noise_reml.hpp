// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Restricted likelihood of a fit (restricted_likelihood.hpp) as a function of its noise.
//
//   component   white: covariance per unit of its variance, measurement by measurement
//               process: states (noise_states.hpp), with an sd and perhaps a length
//
// To -2 log R the scatter of the compass readings within segments is added (reading_scatter.hpp).
#pragma once

#include "estimation/noise_states.hpp"
#include "estimation/restricted_likelihood.hpp"
#include "estimation/segment_noise.hpp"
#include "fit/fit_state.hpp"
#include "fit/noise_components.hpp"
#include "fit/reading_scatter.hpp"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace trussmap::fitting {

class NoiseReml {
 public:
  /// `stated`: by which wheels share their noise, and ranges their part in proportion. Keeps a
  /// reference to the fit.
  NoiseReml(const FitState& fit, const Noise& stated);

  /// Whitened columns (of the fit's rows) of what else may be missing, instead of those before.
  void set_nuisance(const Eigen::MatrixXd& nuisance);

  [[nodiscard]] const FitState& fit() const { return fit_; }
  [[nodiscard]] const Noise& stated() const { return stated_; }

  /// Of the components chosen, and no others.
  struct Sizes {
    std::vector<double> sd;
    std::vector<double> length;  ///< 0 where there is none
  };
  void choose(const std::vector<NoiseComponent>& components);
  [[nodiscard]] double minus_two_log(const Sizes& sizes);
  /// The same with the nuisance columns' sizes at their likeliest, instead of integrated out: to
  /// compare with none, or with others.
  [[nodiscard]] double minus_two_log_at_best(const Sizes& sizes);

  /// What of them is the readings' scatter within segments.
  [[nodiscard]] double scatter(const Sizes& sizes);

  /// Problem and system of the last call.
  [[nodiscard]] const estimation::RecordingProblem& problem() const { return problem_; }
  [[nodiscard]] const estimation::RecordingSystem& system() const { return *system_; }
  [[nodiscard]] const Eigen::MatrixXd& nuisance() const { return nuisance_; }
  [[nodiscard]] const estimation::ProcessLayer& layer() const { return layer_; }
  /// Covariance per unit of a white component's variance, per measurement.
  [[nodiscard]] std::vector<estimation::Matrix4> unit_covariances(
      const NoiseComponent& component) const;
  [[nodiscard]] bool left_out(std::size_t measurement) const { return left_out_[measurement]; }

 private:
  /// A segment's rows, linearised where the fit believes them to be.
  struct Rows {
    std::vector<Eigen::Matrix<double, 4, 3>> H;
    int readings = 0;
  };
  [[nodiscard]] estimation::Matrix4 segment_covariance(const estimation::Measurement& one,
                                                       const Noise& noise) const;
  [[nodiscard]] estimation::Matrix4 gyro_covariance(const estimation::Measurement& one,
                                                    const Noise& noise) const;
  [[nodiscard]] estimation::RestrictedLikelihood likelihood(const Sizes& sizes);
  void whiten(const Sizes& sizes);

  const FitState& fit_;
  Noise stated_;
  estimation::RecordingProblem problem_;
  estimation::ProcessLayer layer_;
  std::unique_ptr<estimation::RecordingSystem> system_;
  std::vector<bool> left_out_;
  ReadingScatter scatter_;
  struct Scattered {
    ReadingNoise at;
    double value = 0.0;
  };
  std::vector<Scattered> scattered_;        ///< of late
  std::vector<Rows> rows_;                  ///< per segment
  std::vector<estimation::Matrix4> fixed_;  ///< per measurement
  std::vector<NoiseComponent> components_;
  std::vector<std::vector<estimation::Matrix4>> units_;  ///< per white component and measurement
  std::map<std::string, std::vector<estimation::Matrix4>>
      units_known_;                            ///< by the components' names
  std::vector<estimation::LaidProcess> laid_;  ///< per process
  std::vector<double> laid_length_;
  std::vector<estimation::LaidProcess> laid_before_;  ///< with another length
  std::vector<double> laid_length_before_;
  Eigen::MatrixXd plain_nuisance_;  ///< not whitened, rows of the measurements
  Eigen::MatrixXd nuisance_;
};

}  // namespace trussmap::fitting
