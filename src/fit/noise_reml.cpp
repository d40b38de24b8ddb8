// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/noise_reml.hpp"

#include "effects/channel_physics.hpp"
#include "estimation/segment_noise.hpp"
#include "estimation/student_tails.hpp"
#include "odometry/row_reckoner.hpp"
#include "odometry/wheels_and_gyro.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace trussmap::fitting {
namespace {

constexpr double kExactSd = 1e-6;  // m and rad

}  // namespace

std::vector<estimation::Matrix4> NoiseReml::unit_covariances(
    const NoiseComponent& component) const {
  Noise unit = silent_noise();
  for (double Noise::*member : component.white) {
    unit.*member = component.stated > 0.0 ? stated_.*member / component.stated : 1.0;
  }
  std::vector<estimation::Matrix4> result;
  result.reserve(fit_.problem.measurements.size());
  for (const estimation::Measurement& one : fit_.problem.measurements) {
    estimation::Matrix4 added = estimation::Matrix4::Zero();
    if (estimation::is_segment(one)) {
      added = segment_covariance(one, unit);
    } else if (estimation::is_driven(one)) {
      added = gyro_covariance(one, unit);
    } else if (!one.own_sd) {
      for (Eigen::Index row = 0; row < one.rows; ++row) {
        added(row, row) = std::pow(reading_sd(unit, one.kind->noise(row)), 2);
      }
    }
    result.push_back(added);
  }
  return result;
}

estimation::Matrix4 NoiseReml::segment_covariance(const estimation::Measurement& one,
                                                  const Noise& noise) const {
  estimation::Matrix4 result = estimation::Matrix4::Zero();
  const Rows& rows = rows_[one.source];
  if (one.rows == 4) result(3, 3) = noise.compass * noise.compass / rows.readings;
  const bool moves = noise.left + noise.right + noise.heading_per_s + noise.heading_per_rad +
                         noise.travel_per_s + noise.gyro >
                     0.0;
  if (!moves) return result;
  const MotionRows& drive = fit_.recordings[idx(one.session)].drive;
  const std::vector<estimation::SegmentRow>& parts = fit_.problem.segments[one.source];
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const estimation::SegmentRow& row = parts[k];
    const Matrix3 Q =
        odometry::row_covariance(drive, row.row, row.part, row.duration, fit_.model.robot, noise);
    result += rows.H[k] * Q * rows.H[k].transpose();
  }
  return result;
}

estimation::Matrix4 NoiseReml::gyro_covariance(const estimation::Measurement& one,
                                               const Noise& noise) const {
  estimation::Matrix4 result = estimation::Matrix4::Zero();
  const MotionRows& drive = fit_.recordings[idx(one.session)].drive;
  const std::vector<estimation::SegmentRow>& rows = fit_.problem.segments[one.source];
  const std::vector<estimation::Vector4>& weights = fit_.problem.gyro_weights[one.source];
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double variance = odometry::excess_variance(drive, rows[k].row, rows[k].part,
                                                      rows[k].duration, fit_.model.robot, noise);
    if (std::isfinite(variance)) result += variance * weights[k] * weights[k].transpose();
  }
  return result;
}

NoiseReml::NoiseReml(const FitState& fit, const Noise& stated)
    : fit_(fit),
      stated_(stated),
      problem_(fit.problem),
      layer_(problem_, fit.recordings, fit.model.robot),
      left_out_(fit.problem.measurements.size(), false),
      scatter_(fit) {
  for (const int k : fit.adjustment.left_out) left_out_[idx(k)] = true;
  const std::vector<std::vector<effects::DrivePattern>> effects =
      estimation::summed_patterns(fit.columns.border, offsets_of(fit), fit.recordings.size());
  rows_.resize(problem_.segments.size());
  for (std::size_t k = 0; k < problem_.measurements.size(); ++k) {
    const estimation::Measurement& one = problem_.measurements[k];
    if (!estimation::is_segment(one)) continue;
    rows_[one.source] = {estimation::believed_noise(problem_, k, fit.recordings, fit.model,
                                                    effects[idx(one.session)], fit.adjustment.state)
                             .H,
                         estimation::readings_of(problem_.segments[one.source])};
  }
  for (estimation::Measurement& one : problem_.measurements) {
    fixed_.push_back(one.kind->fixed_covariance(one, stated_));
    // Variances are those of the errors themselves, whatever their tails.
    if (one.tails > 0.0) one.value_offset.setZero();
    one.tails = 0.0;
  }
}

void NoiseReml::set_nuisance(const Eigen::MatrixXd& nuisance) {
  plain_nuisance_.resize(0, nuisance.cols());
  if (nuisance.cols() == 0) return;
  int rows = 0;
  for (const estimation::Measurement& one : fit_.problem.measurements) rows += one.rows;
  plain_nuisance_ = nuisance.topRows(rows);
  int at = 0;
  for (const estimation::Measurement& one : fit_.problem.measurements) {
    const Eigen::MatrixXd colour = one.whitener.topLeftCorner(one.rows, one.rows).inverse();
    plain_nuisance_.middleRows(at, one.rows) =
        (colour * plain_nuisance_.middleRows(at, one.rows)).eval() /
        std::sqrt(estimation::tail_information(one.tails, one.rows));
    at += one.rows;
  }
}

void NoiseReml::choose(const std::vector<NoiseComponent>& components) {
  components_ = components;
  units_.clear();
  laid_.clear();
  laid_length_.clear();
  laid_before_.clear();
  laid_length_before_.clear();
  for (const NoiseComponent& one : components) {
    if (one.lasts()) {
      laid_.push_back(
          layer_.lay(one.process.channel, one.process.process, std::max(one.process.length, 1.0)));
      laid_length_.push_back(-1.0);
      laid_before_.emplace_back();
      laid_length_before_.push_back(-1.0);
    } else {
      auto known = units_known_.find(one.name);
      if (known == units_known_.end()) {
        known = units_known_.emplace(one.name, unit_covariances(one)).first;
      }
      units_.push_back(known->second);
    }
  }
  estimation::put_processes(problem_, laid_, std::vector<double>(laid_.size(), 1.0));
  system_ = std::make_unique<estimation::RecordingSystem>(problem_, fit_.columns.border);
  std::vector<double> weights(problem_.measurements.size(), 1.0);
  for (std::size_t k = 0; k < weights.size(); ++k) weights[k] = left_out_[k] ? 0.0 : 1.0;
  system_->set_weights(weights);
}

void NoiseReml::whiten(const Sizes& sizes) {
  std::vector<double> sds;
  for (std::size_t c = 0; c < components_.size(); ++c) {
    const NoiseComponent& one = components_[c];
    if (!one.lasts()) continue;
    const std::size_t p = sds.size();
    sds.push_back(sizes.sd[c]);
    if (sizes.length[c] == laid_length_[p]) continue;
    // Slopes go from one length to the next and back.
    std::swap(laid_[p], laid_before_[p]);
    std::swap(laid_length_[p], laid_length_before_[p]);
    if (sizes.length[c] == laid_length_[p]) continue;
    laid_[p] = layer_.lay(one.process.channel, one.process.process, sizes.length[c]);
    laid_length_[p] = sizes.length[c];
  }
  estimation::put_processes(problem_, laid_, sds);
  nuisance_.resize(system_->rows(), plain_nuisance_.cols());
  nuisance_.setZero();
  for (std::size_t k = 0; k < problem_.measurements.size(); ++k) {
    estimation::Measurement& one = problem_.measurements[k];
    estimation::Matrix4 covariance = fixed_[k];
    std::size_t white = 0;
    for (std::size_t c = 0; c < components_.size(); ++c) {
      if (components_[c].lasts()) continue;
      covariance += sizes.sd[c] * sizes.sd[c] * units_[white++][k];
    }
    if (!laid_.empty()) covariance += problem_.within[k];
    covariance.diagonal().array() += kExactSd * kExactSd;
    one.whitener = estimation::whitener_of(covariance, one.rows);
    if (nuisance_.cols() == 0) continue;
    const int at = system_->first_row(k);
    nuisance_.middleRows(at, one.rows) =
        one.whitener.topLeftCorner(one.rows, one.rows) * plain_nuisance_.middleRows(at, one.rows);
  }
}

double NoiseReml::scatter(const Sizes& sizes) {
  if (scatter_.empty()) return 0.0;
  ReadingNoise noise;
  for (std::size_t c = 0; c < components_.size(); ++c) {
    const NoiseComponent& one = components_[c];
    const double sd = sizes.sd[c];
    if (one.name == "compass") noise.white = std::hypot(noise.white, sd);
    if (one.name == "wheels") noise.wheels = std::pow(sd / size_in(fit_.model.noise, one), 2);
    if (one.name == "heading_per_s") noise.heading_per_s = sd;
    if (one.name == "heading_per_rad") noise.heading_per_rad = sd;
    if (!one.lasts()) continue;
    if (one.process.process == ProcessKind::white && one.process.channel == Channel::compass) {
      noise.white = std::hypot(noise.white, sd);
    }
    if (!shows_in_readings(one.process)) continue;
    noise.processes.push_back(one.process);
    noise.processes.back().sd = sd;
    noise.processes.back().length = sizes.length[c];
  }
  for (const Scattered& known : scattered_) {
    if (known.at == noise) return known.value;
  }
  constexpr std::size_t kKept = 4;  // slopes come back to where they were taken
  if (scattered_.size() == kKept) scattered_.erase(scattered_.begin());
  const double value = scatter_.minus_two_log(noise);
  scattered_.push_back({std::move(noise), value});
  return value;
}

estimation::RestrictedLikelihood NoiseReml::likelihood(const Sizes& sizes) {
  whiten(sizes);
  const double within = scatter(sizes);
  estimation::RecordingState at = fit_.adjustment.state;
  at.noise.resize(0);  // states of other processes, or in other units
  return estimation::restricted_likelihood(*system_, problem_, at, fit_.adjustment.coefficients,
                                           nuisance_, within);
}

double NoiseReml::minus_two_log(const Sizes& sizes) {
  return likelihood(sizes).integrated();
}

double NoiseReml::minus_two_log_at_best(const Sizes& sizes) {
  return likelihood(sizes).at_likeliest();
}

}  // namespace trussmap::fitting
