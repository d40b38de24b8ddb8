// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/channel_physics.hpp"
#include "estimation/noise_states.hpp"
#include "fit/noise_reml.hpp"
#include "parallel/parallel_for.hpp"
#include "trussmap/noise_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>

namespace trussmap {
namespace {

constexpr std::size_t kMostWindows = 400;  // per recording, evenly spread

/// Mean square of the position's error.
double square_of(const estimation::Matrix4& covariance) {
  return covariance.topLeftCorner<2, 2>().trace();
}

/// A piece of a drive that is reckoned by the wheels.
struct Window {
  const MotionRows& drive;
  const Robot& robot;
  std::vector<estimation::SegmentRow> rows;
  double from = 0.0;                ///< s
  double way = 0.0;                 ///< m, from the recording's start
  const std::vector<double>& ends;  ///< of legs, s
};

/// What one white field of the noise makes, all others silent.
double white_square(const Window& window, const Noise& noise,
                    const std::vector<double Noise::*>& members) {
  Noise alone = fitting::silent_noise();
  for (double Noise::*member : members) alone.*member = noise.*member;
  const estimation::Matrix4 floor = estimation::segment_covariance(
      window.drive, window.rows, window.robot, fitting::silent_noise());
  return square_of(estimation::segment_covariance(window.drive, window.rows, window.robot, alone) -
                   floor);
}

double process_square(const Window& window, const NoiseProcess& process) {
  if (effects::acts_on(process.channel) != effects::ActsOn::drives) return 0.0;
  const std::vector<estimation::Matrix4> influences = estimation::row_influences(window.rows);
  const std::vector<estimation::Vector4> c = estimation::unit_columns(
      window.drive, window.rows, influences, process.channel, window.robot);
  estimation::Matrix4 unit = estimation::Matrix4::Zero();
  if (is_chain(process.process)) {
    const estimation::ProcessMoments m =
        estimation::process_moments(window.rows, c, process.process, process.length, false);
    double start = 1.0;
    if (process.process == ProcessKind::walk_in_t) start = window.from - window.drive.start();
    if (process.process == ProcessKind::walk_in_distance) start = window.way;
    unit = m.uu + start * m.by_start * m.by_start.transpose();
  } else if (process.process == ProcessKind::white) {
    for (const estimation::Vector4& row : c) unit += row * row.transpose();
  } else if (process.process == ProcessKind::per_leg) {
    for (const auto& [leg, sum] :
         estimation::sums_by_leg(window.rows, c, window.from, window.ends)) {
      unit += sum * sum.transpose();
    }
  } else {
    estimation::Vector4 sum = estimation::Vector4::Zero();
    for (const estimation::Vector4& row : c) sum += row;
    unit = sum * sum.transpose();
  }
  return process.sd * process.sd * square_of(unit);
}

class Budget {
 public:
  explicit Budget(const Model& model) : model_(model) {}

  void add(const Window& window) {
    const Noise& noise = model_.noise;
    add("wheels", white_square(window, noise, {&Noise::left, &Noise::right}));
    if (noise.heading_per_s > 0.0) {
      add("heading_per_s", white_square(window, noise, {&Noise::heading_per_s}));
    }
    if (noise.heading_per_rad > 0.0) {
      add("heading_per_rad", white_square(window, noise, {&Noise::heading_per_rad}));
    }
    if (noise.travel_per_s > 0.0) {
      add("travel_per_s", white_square(window, noise, {&Noise::travel_per_s}));
    }
    gyro_ = gyro_ || !window.drive.gyro.empty() || !window.drive.yaw_rate.empty();
    if (!window.drive.gyro.empty()) add("gyro", white_square(window, noise, {&Noise::gyro}));
    for (const NoiseProcess& one : noise.processes) {
      add(fitting::name_of_source(one), process_square(window, one));
    }
    ++windows_;
  }

  [[nodiscard]] NoiseBudget take(double horizon) const {
    NoiseBudget budget;
    budget.horizon = horizon;
    budget.windows = windows_;
    budget.gyro = gyro_;
    double whole = 0.0;
    for (const auto& [source, square] : squares_) whole += square;
    budget.rms = std::sqrt(whole / std::max(windows_, 1));
    for (const auto& [source, square] : squares_) {
      if (square > 0.0) budget.shares.push_back({source, square / whole});
    }
    std::stable_sort(budget.shares.begin(), budget.shares.end(),
                     [](const NoiseShare& a, const NoiseShare& b) { return a.share > b.share; });
    return budget;
  }
  [[nodiscard]] bool empty() const { return windows_ == 0; }

 private:
  void add(const std::string& source, double square) { squares_[source] += square; }

  const Model& model_;
  std::map<std::string, double> squares_;  ///< m^2, summed over the windows
  int windows_ = 0;
  bool gyro_ = false;
};

struct Stretch {
  double from = 0.0;  ///< s
  double to = 0.0;
};

/// Half a horizon apart. Of more than a few per row, for a clock that was set or counts another
/// unit, those that hold the end of a row.
std::vector<Stretch> stretches(const MotionRows& drive, double horizon) {
  constexpr double kPerRow = 4.0;
  static constexpr double kMost = 9e15;  // whole numbers that a double tells apart
  std::vector<Stretch> result;
  const double apart = 0.5 * horizon;
  const auto whole = [](double number) {
    return static_cast<std::int64_t>(std::floor(std::min(number, kMost)));
  };
  const std::int64_t count = whole(2.0 * ((drive.t.back() - drive.start()) / horizon - 1.0) + 1.0);
  const auto add = [&](std::int64_t k) {
    const double from = drive.start() + apart * static_cast<double>(k);
    result.push_back({from, from + horizon});
  };
  if (static_cast<double>(count) <= kPerRow * static_cast<double>(drive.rows())) {
    for (std::int64_t k = 0; k < count; ++k) add(k);
    return result;
  }
  std::int64_t next = 0;
  for (const double t : drive.t) {
    const std::int64_t last = whole((t - drive.start()) / apart);
    for (std::int64_t k = std::max(next, last - 1); k <= std::min(last, count - 1); ++k) {
      add(k);
      next = k + 1;
    }
  }
  return result;
}

std::vector<Stretch> legs(const std::vector<double>& ends) {
  std::vector<Stretch> result;
  for (std::size_t k = 1; k < ends.size(); ++k) result.push_back({ends[k - 1], ends[k]});
  return result;
}

/// `horizon` 0: legs.
void add_windows(const DrivenRecording& recording, const Robot& robot, double horizon,
                 Budget& budget) {
  const MotionRows& drive = recording.drive;
  if (drive.rows() == 0) return;
  const std::vector<double> ends = estimation::ends_of_legs(recording);
  const std::vector<Stretch> all = horizon > 0.0 ? stretches(drive, horizon) : legs(ends);
  const std::size_t stride = std::max<std::size_t>(1, all.size() / kMostWindows);
  double way = 0.0;
  double reached = drive.start();
  for (std::size_t k = 0; k < all.size(); k += stride) {
    for (const estimation::SegmentRow& row :
         estimation::segment_rows(drive, reached, all[k].from)) {
      way += std::abs(row.path);
    }
    reached = all[k].from;
    const Window window{drive,       robot, estimation::segment_rows(drive, all[k].from, all[k].to),
                        all[k].from, way,   ends};
    double driven = 0.0;
    for (const estimation::SegmentRow& row : window.rows) driven += std::abs(row.path);
    if (window.rows.empty() || (horizon == 0.0 && driven < kDefaultMinDrive)) continue;
    budget.add(window);
  }
}

}  // namespace

std::vector<NoiseBudget> noise_budget(const std::vector<DrivenRecording>& recordings,
                                      const Model& model, const std::vector<double>& horizons) {
  std::vector<std::optional<NoiseBudget>> budgets(horizons.size());
  parallel::parallel_for(horizons.size(), [&](std::size_t k) {
    const double horizon = horizons[k];
    if (!(horizon >= 0.0)) throw std::invalid_argument("a horizon has to be 0 s (a leg) or more");
    Budget budget(model);
    for (const DrivenRecording& one : recordings) add_windows(one, model.robot, horizon, budget);
    if (!budget.empty()) budgets[k] = budget.take(horizon);
  });
  std::vector<NoiseBudget> result;
  for (std::optional<NoiseBudget>& one : budgets) {
    if (one) result.push_back(std::move(*one));
  }
  return result;
}

}  // namespace trussmap
