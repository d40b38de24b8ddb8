// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/recording_problem.hpp"

#include "estimation/gyro_excess.hpp"
#include "estimation/motion_changes.hpp"
#include "estimation/noise_states.hpp"
#include "linalg/dense.hpp"
#include "parallel/parallel_for.hpp"
#include "recording/floor_code.hpp"
#include "recording/legs.hpp"
#include "recording/time_spans.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/LU>

namespace trussmap {
namespace {

constexpr double kExactSd = 1e-6;   // m or rad: what is called exact is this exact
constexpr double kNearRange = 3.0;  // sds

Matrix4 whitener_of_sds(std::initializer_list<double> sds) {
  Matrix4 result = Matrix4::Zero();
  Eigen::Index k = 0;
  for (const double sd : sds) {
    result(k, k) = 1.0 / std::max(sd, kExactSd);
    ++k;
  }
  return result;
}

/// Collects the problem, session by session.
class Collector {
 public:
  Collector(const Model& model, const ProblemOptions& options) : model_(model), options_(options) {}

  void add_session(const Recording& recording) {
    session_ = static_cast<int>(problem_.sessions.size());
    problem_.sessions.push_back(recording.name);
    const std::vector<std::size_t> truth = truth_rows_used(recording);
    const std::vector<std::size_t> fixes = fixes_used(recording);
    const bool loops = options_.loops && !recording.loops.empty();
    if (recording.sightings.empty() && truth.empty() && fixes.empty() && !loops) {
      throw InputError(recording.name, 0,
                       "neither sightings, truth, fixes nor loops in use, expected some to adjust "
                       "to");
    }
    add_poses(recording, truth, fixes);
    add_segments(recording);
    for (std::size_t k = 0; k < recording.sightings.size(); ++k) {
      if (pose_at_.contains(recording.sightings[k].t)) add_sighting(recording.sightings[k], k);
    }
    for (const std::size_t k : truth) {
      if (pose_at_.contains(recording.truth[k].t)) add_truth(recording.truth[k], k);
    }
    for (const std::size_t k : fixes) {
      if (pose_at_.contains(recording.fixes[k].t)) add_fix(recording.fixes[k], k);
    }
    for (std::size_t k = 0; loops && k < recording.loops.size(); ++k) {
      const Loop& loop = recording.loops[k];
      if (pose_at_.contains(loop.t) && pose_at_.contains(loop.t2)) add_loop(loop, k);
    }
  }

  /// After all sessions, so that every sighted landmark has its node.
  void add_survey(const Recording& recording) {
    if (!options_.survey) return;
    for (std::size_t k = 0; k < recording.survey.size(); ++k) {
      const SurveyPoint& point = recording.survey[k];
      const auto node = landmark_node_.find(point.landmark);
      if (node == landmark_node_.end()) continue;
      const double sd = std::isnan(point.sd) ? model_.noise.survey : point.sd;
      Measurement one;
      one.kind = MeasurementKind::survey;
      one.from = node->second;
      one.rows = 2;
      one.value.head<2>() = Vector2(point.x, point.y);
      one.whitener = whitener_of_sds({sd, sd});
      one.source = k;
      // Sessions come with copies of one survey: the same numbers count once.
      const auto same_place = [&](const Surveyed& other) {
        return other.landmark == one.from && other.place == one.value.head<2>();
      };
      const auto copy = std::find_if(surveyed_.begin(), surveyed_.end(), same_place);
      if (copy == surveyed_.end()) problem_.measurements.push_back(one);
      const bool has_heading = !std::isnan(point.heading);
      const bool new_heading =
          has_heading && std::none_of(copy, surveyed_.end(), [&](const Surveyed& other) {
            return same_place(other) && other.heading == point.heading;
          });
      if (copy != surveyed_.end() && !new_heading) continue;
      surveyed_.push_back({one.from, one.value.head<2>(), point.heading});
      if (new_heading) add_survey_heading(point, k, node->second);
    }
  }

  [[nodiscard]] RecordingProblem take() { return std::move(problem_); }

 private:
  [[nodiscard]] std::vector<std::size_t> truth_rows_used(const Recording& recording) const {
    std::vector<std::size_t> used;
    if (!options_.truth || recording.truth.empty()) return used;
    const Drive& drive = recording.drive;
    double path = 0.0;
    double turn = 0.0;
    double from = drive.start();
    std::size_t last = 0;
    for (std::size_t k = 0; k < recording.truth.size(); ++k) {
      const double t = recording.truth[k].t;
      if (t < drive.start() || t > drive.t.back()) continue;
      for (const SegmentRow& row : segment_rows(drive, from, t, model_.robot)) {
        path += std::abs(row.path);
        turn += std::abs(row.turn);
      }
      from = t;
      last = k;
      if (used.empty() || path >= options_.truth_path || turn >= options_.truth_turn) {
        used.push_back(k);
        path = turn = 0.0;
      }
    }
    // At rest again, the end tells a late clock from a short way.
    if (!used.empty() && used.back() != last) used.push_back(last);
    return used;
  }

  /// All but those that follow one another faster than their errors change; at rest one in
  /// `fix_gap`, too, for each tells more of the place.
  [[nodiscard]] std::vector<std::size_t> fixes_used(const Recording& recording) const {
    std::vector<std::size_t> used;
    if (!options_.fixes || recording.fixes.empty()) return used;
    const Drive& drive = recording.drive;
    const std::vector<double> driven = driven_path(drive);
    double last_t = 0.0;
    double last_path = 0.0;
    for (std::size_t k = 0; k < recording.fixes.size(); ++k) {
      const double t = recording.fixes[k].t;
      if (t < drive.start() || t > drive.t.back()) continue;
      const double path = path_at(drive, driven, t);
      const bool soon = t - last_t < options_.fix_gap && path - last_path < options_.fix_path;
      if (!used.empty() && soon) continue;
      used.push_back(k);
      last_t = t;
      last_path = path;
    }
    return used;
  }

  void add_poses(const Recording& recording, const std::vector<std::size_t>& truth,
                 const std::vector<std::size_t>& fixes) {
    std::vector<double> times;
    for (const Sighting& sighting : recording.sightings) times.push_back(sighting.t);
    for (const std::size_t k : truth) times.push_back(recording.truth[k].t);
    for (const std::size_t k : fixes) times.push_back(recording.fixes[k].t);
    if (options_.loops) {
      for (const Loop& loop : recording.loops) {
        times.push_back(loop.t);
        times.push_back(loop.t2);
      }
    }
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    leave_out(times);
    pose_at_.clear();
    for (std::size_t k = 0; k < times.size(); ++k) {
      if (k > 0 && !is_left_out(times[k - 1], times[k])) {
        const std::vector<SegmentRow> rows =
            segment_rows(recording.drive, times[k - 1], times[k], model_.robot);
        for (const double t : motion_changes(recording.drive, rows, model_.robot,
                                             {options_.least_spin, options_.least_drive})) {
          if (t > times[k - 1] && t < times[k]) add_pose(t);
        }
      }
      add_pose(times[k]);
    }
  }

  /// Whether the drive between two successive instants does not count.
  [[nodiscard]] bool is_left_out(double from, double to) const {
    return overlaps_any({from, to}, spans_);
  }

  /// Drops instants inside what is left out, and those that would stand alone.
  void leave_out(std::vector<double>& times) {
    spans_.clear();
    if (!options_.left_out.empty()) spans_ = options_.left_out[idx(session_)];
    if (spans_.empty()) return;
    std::erase_if(times, [this](double t) {
      return std::any_of(spans_.begin(), spans_.end(),
                         [t](const TimeSpan& span) { return span.from < t && t < span.to; });
    });
    std::vector<double> kept;
    for (std::size_t k = 0; k < times.size(); ++k) {
      const bool after = k > 0 && !is_left_out(times[k - 1], times[k]);
      const bool before = k + 1 < times.size() && !is_left_out(times[k], times[k + 1]);
      if (after || before) kept.push_back(times[k]);
    }
    times = std::move(kept);
  }

  void add_pose(double t) {
    pose_at_[t] = static_cast<int>(problem_.poses.size());
    problem_.poses.push_back({session_, t});
  }

  void add_segments(const Recording& recording) {
    if (pose_at_.empty()) return;
    using Node = std::pair<const double, int>;
    std::vector<std::pair<const Node*, const Node*>> ends;
    for (auto from = pose_at_.begin(), to = std::next(from); to != pose_at_.end(); from = to++) {
      if (!is_left_out(from->first, to->first)) ends.emplace_back(&*from, &*to);
    }
    std::vector<Measurement> segments(ends.size());
    std::vector<std::vector<SegmentRow>> rows_of(ends.size());
    parallel_for(ends.size(), [&](std::size_t k) {
      const auto& [from, to] = ends[k];
      std::vector<SegmentRow>& rows = rows_of[k];
      rows = segment_rows(recording.drive, from->first, to->first, model_.robot);
      const SegmentMotion motion = segment_motion(rows);
      Measurement& one = segments[k];
      one.kind = MeasurementKind::segment;
      one.from = from->second;  // poses, until every landmark has its node
      one.to = to->second;
      one.rows = std::isnan(motion.mean_heading) ? 3 : 4;
      one.value << motion.displacement.x, motion.displacement.y, motion.displacement.heading,
          one.rows == 4 ? motion.mean_heading : 0.0;
      one.whitener = whitener_of(
          segment_covariance(recording.drive, rows, model_.robot, model_.noise), one.rows);
      one.session = session_;
    });
    for (std::size_t k = 0; k < ends.size(); ++k) {
      segments[k].source = problem_.segments.size();
      problem_.segments.push_back(std::move(rows_of[k]));
      problem_.measurements.push_back(segments[k]);
      add_gyro(recording.drive, segments[k]);
    }
  }

  void add_gyro(const Drive& drive, const Measurement& segment) {
    GyroExcess excess =
        gyro_excess(drive, problem_.segments[segment.source], model_.robot, model_.noise);
    problem_.gyro_weights.push_back(std::move(excess.weights));
    if (excess.rows == 0) return;
    Measurement one;
    one.kind = MeasurementKind::gyro;
    one.from = segment.from;
    one.rows = excess.rows;
    one.value = excess.value;
    one.whitener.topLeftCorner(one.rows, one.rows).setIdentity();
    one.session = session_;
    one.source = segment.source;
    problem_.measurements.push_back(one);
  }

  void add_sighting(const Sighting& sighting, std::size_t source) {
    const int next = static_cast<int>(problem_.landmarks.size());
    const auto [node, fresh] = landmark_node_.try_emplace(sighting.landmark, next);
    if (fresh) problem_.landmarks.push_back(sighting.landmark);
    const Noise& noise = model_.noise;
    Measurement one;
    one.from = pose_at_.at(sighting.t);
    one.to = node->second;
    one.rows = 2;
    one.session = session_;
    one.source = source;
    if (sighting.standing()) {
      one.kind = MeasurementKind::standing;
      one.value.head<2>() = code_from_robot(sighting);
      one.whitener = whitener_of_sds({noise.sighting, noise.sighting});
    } else {
      const double sd_range = std::hypot(noise.range, noise.range_relative * sighting.range);
      if (std::isnan(sighting.range)) {
        one.kind = MeasurementKind::direction;
        one.rows = 1;
        one.value[0] = sighting.bearing;
        one.whitener = whitener_of_sds({noise.bearing});
      } else if (std::isnan(sighting.bearing)) {
        one.kind = MeasurementKind::view;
        one.rows = 1;
        one.value[0] = sighting.range;
        one.whitener = whitener_of_sds({sd_range});
      } else if (sighting.range > kNearRange * sd_range) {
        one.kind = MeasurementKind::view;
        one.value.head<2>() = Vector2(sighting.range, sighting.bearing);
        one.whitener = whitener_of_sds({sd_range, noise.bearing});
      } else {
        one.kind = MeasurementKind::cartesian_view;
        one.value.head<2>() = sighting.range * rotation(sighting.bearing).col(0);
        one.whitener = whitener_of_sds({sd_range, sd_range});
      }
    }
    problem_.measurements.push_back(one);
    if (std::isnan(sighting.yaw)) return;
    one.kind = MeasurementKind::sighting_yaw;
    one.to = orientation_of(node->second);
    one.rows = 1;
    one.value = Vector4(sighting.yaw, 0.0, 0.0, 0.0);
    one.whitener = whitener_of_sds({noise.yaw});
    problem_.measurements.push_back(one);
  }

  /// Counted among the orientations, until every pose has its node.
  int orientation_of(int landmark) {
    const int next = static_cast<int>(problem_.oriented.size());
    const auto [at, fresh] = orientation_.try_emplace(landmark, next);
    if (fresh) problem_.oriented.push_back(landmark);
    return at->second;
  }

  void add_survey_heading(const SurveyPoint& point, std::size_t source, int landmark) {
    const auto orientation = orientation_.find(landmark);
    if (orientation == orientation_.end()) return;
    Measurement one;
    one.kind = MeasurementKind::survey_heading;
    one.from = orientation->second;
    one.rows = 1;
    one.value[0] = point.heading;
    one.whitener = whitener_of_sds({model_.noise.yaw});
    one.source = source;
    problem_.measurements.push_back(one);
  }

  void add_truth(const TruthRow& row, std::size_t source) {
    const Noise& noise = model_.noise;
    Measurement one;
    one.kind = MeasurementKind::truth;
    one.from = pose_at_.at(row.t);
    one.rows = 3;
    one.value.head<3>() = Eigen::Vector3d(row.x, row.y, row.heading);
    one.whitener = whitener_of_sds({noise.truth, noise.truth, noise.truth_heading});
    one.session = session_;
    one.source = source;
    problem_.measurements.push_back(one);
  }

  void add_fix(const Fix& fix, std::size_t source) {
    const double sd = std::isnan(fix.sd) ? model_.noise.fix : fix.sd;
    Measurement one;
    one.kind = MeasurementKind::fix;
    one.from = pose_at_.at(fix.t);
    one.rows = 2;
    one.value.head<2>() = Vector2(fix.x, fix.y);
    one.whitener = whitener_of_sds({sd, sd});
    one.session = session_;
    one.source = source;
    problem_.measurements.push_back(one);
  }

  void add_loop(const Loop& loop, std::size_t source) {
    const double sd = std::isnan(loop.sd) ? model_.noise.loop : loop.sd;
    const double sd_heading =
        std::isnan(loop.sd_heading) ? model_.noise.loop_heading : loop.sd_heading;
    Measurement one;
    one.kind = MeasurementKind::loop;
    one.from = pose_at_.at(loop.t);
    one.to = pose_at_.at(loop.t2);
    one.rows = 3;
    one.value.head<3>() = Eigen::Vector3d(loop.dx, loop.dy, loop.dtheta);
    one.whitener = whitener_of_sds({sd, sd, sd_heading});
    one.session = session_;
    one.source = source;
    problem_.measurements.push_back(one);
  }

  /// A point of a survey that has been taken.
  struct Surveyed {
    int landmark = 0;
    Vector2 place = Vector2::Zero();  ///< m
    double heading = kAbsent;         ///< rad; NaN: none
  };

  const Model& model_;
  const ProblemOptions& options_;
  int session_ = 0;
  std::vector<TimeSpan> spans_;  ///< left out of this session
  std::map<std::string, int> landmark_node_;
  std::map<int, int> orientation_;  ///< of a landmark
  std::map<double, int> pose_at_;   ///< of this session, by time
  std::vector<Surveyed> surveyed_;
  RecordingProblem problem_;
};

}  // namespace

Matrix4 whitener_of(const Matrix4& covariance, int rows) {
  Matrix4 result = Matrix4::Zero();
  const Eigen::MatrixXd block = covariance.topLeftCorner(rows, rows);
  result.topLeftCorner(rows, rows) = DenseCholesky(block).inverse_factor();
  return result;
}

Matrix4 whitener_with(const Matrix4& whitener, const Matrix4& more, int rows) {
  if (more.isZero(0.0)) return whitener;
  Matrix4 colour = Matrix4::Zero();
  colour.topLeftCorner(rows, rows) = whitener.topLeftCorner(rows, rows).inverse();
  return whitener_of(colour * colour.transpose() + more, rows);
}

RecordingProblem make_problem(const std::vector<Recording>& recordings, const Model& model,
                              const ProblemOptions& options) {
  Collector collector(model, options);
  for (const Recording& recording : recordings) collector.add_session(recording);
  for (const Recording& recording : recordings) collector.add_survey(recording);
  RecordingProblem problem = collector.take();
  for (Measurement& one : problem.measurements) {
    if (one.kind == MeasurementKind::survey) continue;
    if (one.kind == MeasurementKind::survey_heading) {
      one.from += problem.pose_end();
      continue;
    }
    one.from = problem.pose_node(one.from);
    if (one.kind == MeasurementKind::sighting_yaw) one.to += problem.pose_end();
    if (is_between_poses(one.kind)) one.to = problem.pose_node(one.to);
  }
  add_processes(problem, recordings, model);
  return problem;
}

std::string describe(const RecordingProblem& problem, const Measurement& measurement) {
  const auto time = [&](int node) {
    return fixed_text(problem.poses[idx(node - problem.landmark_count())].t, 3);
  };
  const std::string session = problem.sessions.size() > 1 && measurement.session >= 0
                                  ? " of " + problem.sessions[idx(measurement.session)]
                                  : std::string();
  switch (measurement.kind) {
    case MeasurementKind::segment:
      return "drive from t = " + time(measurement.from) + " s to " + time(measurement.to) + " s" +
             session;
    case MeasurementKind::gyro:
      return "gyro from t = " + time(measurement.from) + " s" + session;
    case MeasurementKind::standing:
      return "standing on landmark " + problem.landmarks[idx(measurement.to)] +
             " at t = " + time(measurement.from) + " s" + session;
    case MeasurementKind::view:
    case MeasurementKind::cartesian_view:
    case MeasurementKind::direction:
      return "sight of landmark " + problem.landmarks[idx(measurement.to)] +
             " at t = " + time(measurement.from) + " s" + session;
    case MeasurementKind::sighting_yaw:
      return "yaw of landmark " + problem.landmark_of(measurement.to) +
             " at t = " + time(measurement.from) + " s" + session;
    case MeasurementKind::survey_heading:
      return "surveyed heading of landmark " + problem.landmark_of(measurement.from);
    case MeasurementKind::survey:
      return "survey of landmark " + problem.landmarks[idx(measurement.from)];
    case MeasurementKind::truth:
      return "truth at t = " + time(measurement.from) + " s" + session;
    case MeasurementKind::fix:
      return "fix at t = " + time(measurement.from) + " s" + session;
    case MeasurementKind::loop:
      return "loop from t = " + time(measurement.from) + " s to " + time(measurement.to) + " s" +
             session;
  }
  return "measurement";
}

bool locates(const Measurement& one) {
  return is_sighting(one.kind) && one.kind != MeasurementKind::direction &&
         !(one.kind == MeasurementKind::view && one.rows == 1);
}

}  // namespace trussmap
