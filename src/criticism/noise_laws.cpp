// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/noise_laws.hpp"

#include "estimation/segment_noise.hpp"
#include "fit/noise_reml.hpp"
#include "odometry/row_reckoner.hpp"
#include "parallel/parallel_for.hpp"

#include <cmath>
#include <functional>

namespace trussmap::criticism {
namespace {

// By how much more, in -2 log likelihood, a law must explain than one without: the sort of noise
// that the model states already is the simplest, and its variants and the rarer laws have to earn
// their place. Chosen on simulated drives of 56 legs (other seeds than the tests').
constexpr double kSeconds = 1.0;
constexpr double kReadings = 2.0;
constexpr double kOneWheel = 3.0;
constexpr double kRare = 6.0;

/// A law of the drive: noise that it adds to a row.
struct DriveLaw {
  std::string name;
  std::string unit;
  double margin;
  std::function<Matrix3(std::size_t session, const estimation::SegmentRow&)> row;
};

std::vector<DriveLaw> drive_laws(const fitting::FitState& fit,
                                 const fitting::ShapeContext& context) {
  std::vector<DriveLaw> laws;
  const auto add = [&](const char* name, const char* unit, double margin, const Noise& noise) {
    laws.push_back(
        {name, unit, margin, [&fit, noise](std::size_t session, const estimation::SegmentRow& row) {
           const MotionRows& drive = fit.recordings[session].drive;
           return odometry::row_covariance(drive, row.row, row.part, row.duration, fit.model.robot,
                                           noise);
         }});
  };
  const double wheels = fitting::mean_wheel_noise(fit.model.noise);
  Noise noise = fitting::silent_noise();
  noise.left = wheels > 0.0 ? fit.model.noise.left / wheels : 1.0;
  noise.right = wheels > 0.0 ? fit.model.noise.right / wheels : 1.0;
  add("per metre", "m/sqrt(m)", 0.0, noise);
  if (fit.model.robot.drive == DriveKind::differential) {
    noise = fitting::silent_noise();
    noise.left = 1.0;
    add("per metre, left wheel", "m/sqrt(m)", kOneWheel, noise);
    noise = fitting::silent_noise();
    noise.right = 1.0;
    add("per metre, right wheel", "m/sqrt(m)", kOneWheel, noise);
  }
  noise =
      fitting::silent_noise();  // of each wheel: half the travel's variance and 2/B^2 of the turn's
  noise.travel_per_s = std::sqrt(0.5);
  noise.heading_per_s = std::sqrt(2.0) / fit.model.robot.wheelbase;
  add("per second", "m/sqrt(s)", kSeconds, noise);
  noise = fitting::silent_noise();
  noise.heading_per_s = 1.0;
  add("per second, heading", "rad/sqrt(s)", kRare, noise);
  noise = fitting::silent_noise();
  noise.travel_per_s = 1.0;
  add("per second, travel", "m/sqrt(s)", kRare, noise);
  noise = fitting::silent_noise();
  noise.heading_per_rad = 1.0;
  add("per radian turned", "rad/sqrt(rad)", kRare, noise);
  const auto add_event = [&](const char* name, const char* unit, const char* event, int value) {
    laws.push_back({name, unit, 0.0,
                    [&context, event, value](std::size_t session,
                                             const estimation::SegmentRow& row) -> Matrix3 {
                      const RowVariables& variables =
                          context.variables(session, fitting::ShapeContext::Instant::middle);
                      Matrix3 Q = Matrix3::Zero();
                      Q(value, value) = row.part * variables.find(event)->second[row.row];
                      return Q;
                    }});
  };
  add_event("per start", "m per start", "starts", 0);
  add_event("per spin", "rad per spin", "spins", 2);
  return laws;
}

std::vector<NoiseLaw> of_drives(const fitting::FitState& fit,
                                const fitting::ShapeContext& context) {
  const estimation::RecordingProblem& problem = fit.problem;
  const std::vector<DriveLaw> laws = drive_laws(fit, context);
  std::vector<NoiseLaw> result;
  for (const DriveLaw& law : laws) {
    const std::vector<estimation::Matrix4> none(problem.measurements.size(),
                                                estimation::Matrix4::Zero());
    result.push_back({law.name, law.unit, 0.0, law.margin, none});
  }
  const std::vector<std::vector<effects::DrivePattern>> effects = estimation::summed_patterns(
      fit.columns.border, fitting::offsets_of(fit), fit.recordings.size());
  context.prepare(fitting::ShapeContext::Instant::middle);
  parallel::parallel_for(problem.measurements.size(), [&](std::size_t k) {
    const estimation::Measurement& one = problem.measurements[k];
    if (!estimation::is_segment(one)) return;
    const std::size_t session = idx(one.session);
    const std::vector<estimation::SegmentRow>& rows = problem.segments[one.source];
    const estimation::SegmentNoise segment = estimation::believed_noise(
        problem, k, fit.recordings, fit.model, effects[session], fit.adjustment.state);
    for (std::size_t row = 0; row < rows.size(); ++row) {
      for (std::size_t law = 0; law < laws.size(); ++law) {
        const Matrix3 Q = laws[law].row(session, rows[row]);
        if (Q.isZero(0.0)) continue;
        result[law].added[k] += segment.H[row] * Q * segment.H[row].transpose();
      }
    }
  });
  return result;
}

/// What the model has of a law already; 0 of one that it has not.
double stated_of(const std::string& law, const Noise& noise) {
  if (law == "per metre") return fitting::mean_wheel_noise(noise);
  if (law == "per metre, left wheel") return noise.left;
  if (law == "per metre, right wheel") return noise.right;
  return fitting::reading_sd(noise, law);
}

/// The reading's own noise, of those that do not answer for it themselves.
NoiseLaw of_reading(const fitting::FitState& fit, const fitting::ReadingKey& noise) {
  NoiseLaw law{noise.name, noise.unit, 0.0, kReadings, {}};
  for (const estimation::Measurement& one : fit.problem.measurements) {
    estimation::Matrix4 added = estimation::Matrix4::Zero();
    for (Eigen::Index row = 0; row < one.rows && !one.own_sd; ++row) {
      if (one.kind->noise(row) != noise.name) continue;
      added(row, row) = estimation::is_segment(one)
                            ? 1.0 / estimation::readings_of(fit.problem.segments[one.source])
                            : 1.0;
    }
    law.added.push_back(added);
  }
  return law;
}

}  // namespace

std::vector<NoiseLaw> noise_laws(const fitting::FitState& fit,
                                 const fitting::ShapeContext& context) {
  std::vector<NoiseLaw> laws = of_drives(fit, context);
  for (const fitting::ReadingKey& one : fitting::reading_keys())
    laws.push_back(of_reading(fit, one));
  std::erase_if(laws, [](const NoiseLaw& law) {
    for (const estimation::Matrix4& added : law.added) {
      if (!added.isZero(0.0)) return false;
    }
    return true;
  });
  for (NoiseLaw& law : laws) law.stated = stated_of(law.name, fit.model.noise);
  return laws;
}

}  // namespace trussmap::criticism
