// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/coefficient_course.hpp"

#include "drive/slow_covariates.hpp"
#include "geometry/index.hpp"
#include "linalg/dense.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace trussmap::criticism {
namespace {

constexpr std::size_t kMostParts = 48;
constexpr std::size_t kRowsPerPart = 2;  // measurements that the effect shows in
constexpr std::size_t kFewestParts = 6;

/// When a measurement was taken; of a drive its middle.
double time_of(const estimation::RecordingProblem& problem, const estimation::Measurement& one) {
  double sum = 0.0;
  int count = 0;
  for (const int node : {one.from, one.to}) {
    if (node < problem.landmark_count() || node >= problem.pose_end()) continue;
    sum += problem.time_of(node);
    ++count;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

/// A measurement that the effect shows in.
struct Shown {
  std::size_t measurement = 0;
  std::size_t session = 0;
  double t = 0.0;
  double energy = 0.0;  ///< of its rows
};

std::vector<Shown> shown_in(const fitting::FitState& fit, const estimation::RecordingSystem& system,
                            const Eigen::VectorXd& column) {
  std::vector<Shown> all;
  for (std::size_t k = 0; k < fit.problem.measurements.size(); ++k) {
    const estimation::Measurement& one = fit.problem.measurements[k];
    if (one.session < 0) continue;
    const double energy = column.segment(system.first_row(k), one.rows).squaredNorm();
    const double t = time_of(fit.problem, one);
    if (energy > 0.0 && std::isfinite(t)) all.push_back({k, idx(one.session), t, energy});
  }
  std::stable_sort(all.begin(), all.end(), [](const Shown& a, const Shown& b) {
    return a.session != b.session ? a.session < b.session : a.t < b.t;
  });
  return all;
}

/// Where in `shown` each part begins: parts of about equal energy, none over the end of a session.
std::vector<std::size_t> cuts(const std::vector<Shown>& shown) {
  const std::size_t parts = std::min(kMostParts, shown.size() / kRowsPerPart);
  const double energy =
      std::accumulate(shown.begin(), shown.end(), 0.0,
                      [](double sum, const Shown& one) { return sum + one.energy; });
  std::vector<std::size_t> begins;
  double filled = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const bool other = k > 0 && shown[k].session != shown[k - 1].session;
    if (other || filled >= energy / static_cast<double>(parts)) {
      begins.push_back(k);
      filled = 0.0;
    }
    filled += shown[k].energy;
  }
  return begins;
}

/// Columns of the fit's other effects, less what the map absorbs, orthonormal.
Eigen::MatrixXd others_than(std::size_t effect, const fitting::FitState& fit,
                            const ScoreTest& tests) {
  constexpr double kSame = 1e-9;  // of the largest pivot
  Eigen::MatrixXd all(tests.residuals().size(), 0);
  for (std::size_t e = 0; e < fit.model.effects.size(); ++e) {
    if (e != effect)
      linalg::append_columns(all, tests.free_of_map(tests.columns(fit.model.effects[e])));
  }
  return linalg::orthonormal_basis(all, kSame);
}

/// Of hours driven until an instant, all sessions before included.
double hours_at(const fitting::FitState& fit, std::size_t session, double t) {
  double seconds = 0.0;
  for (std::size_t k = 0; k < session; ++k) {
    const std::vector<double>& times = fit.recordings[k].drive.t;
    if (!times.empty()) seconds += times.back() - times.front();
  }
  const std::vector<double>& times = fit.recordings[session].drive.t;
  return (seconds + (times.empty() ? 0.0 : t - times.front())) / 3600.0;
}

/// The column of one coefficient, or of the effect at the size that it has.
Eigen::VectorXd column_of(const Effect& effect, const ScoreTest& tests) {
  const Eigen::MatrixXd all = tests.columns(effect);
  if (effect.coefficients.size() == 1) return all.col(0);
  return all *
         Eigen::Map<const Eigen::VectorXd>(effect.coefficients.data(),
                                           static_cast<Eigen::Index>(effect.coefficients.size()));
}

/// Mean of a covariate over each part; nothing where a session lacks it, or it never changes.
std::optional<Eigen::VectorXd> means_of(const std::string& name, const CoefficientCourse& course,
                                        const fitting::FitState& fit) {
  Eigen::VectorXd means(course.s.size());
  for (std::size_t k = 0; k < course.parts.size(); ++k) {
    const DrivePart& part = course.parts[k];
    const MotionRows& drive = fit.recordings[part.session].drive;
    const Covariate* found = drive::find_covariate(drive, name);
    if (found == nullptr) return std::nullopt;
    const auto first = std::lower_bound(drive.t.begin(), drive.t.end(), part.from);
    const auto last = std::max(std::lower_bound(first, drive.t.end(), part.until), first);
    const auto from = first - drive.t.begin();
    const auto count = std::min<std::ptrdiff_t>(last - first + 1, std::ssize(drive.t) - from);
    if (count <= 0) return std::nullopt;
    means[static_cast<Eigen::Index>(k)] =
        std::accumulate(found->values.begin() + from, found->values.begin() + from + count, 0.0) /
        static_cast<double>(count);
  }
  if (!(means.maxCoeff() > means.minCoeff())) return std::nullopt;
  return means;
}

}  // namespace

std::optional<CoefficientCourse> course_of(std::size_t effect, const fitting::FitState& fit,
                                           const ScoreTest& tests) {
  const Eigen::VectorXd column = column_of(fit.model.effects[effect], tests);
  const std::vector<Shown> shown = shown_in(fit, tests.system(), column);
  const std::vector<std::size_t> begins = cuts(shown);
  if (begins.size() < kFewestParts) return std::nullopt;
  CoefficientCourse course;
  Eigen::MatrixXd B =
      Eigen::MatrixXd::Zero(column.size(), static_cast<Eigen::Index>(begins.size()));
  for (std::size_t part = 0; part < begins.size(); ++part) {
    const std::size_t end = part + 1 < begins.size() ? begins[part + 1] : shown.size();
    double hours = 0.0;
    double energy = 0.0;
    for (std::size_t k = begins[part]; k < end; ++k) {
      const Eigen::Index row = tests.system().first_row(shown[k].measurement);
      const int rows = fit.problem.measurements[shown[k].measurement].rows;
      B.col(static_cast<Eigen::Index>(part)).segment(row, rows) = column.segment(row, rows);
      hours += shown[k].energy * hours_at(fit, shown[k].session, shown[k].t);
      energy += shown[k].energy;
    }
    course.parts.push_back(
        {shown[end - 1].session, shown[begins[part]].t, shown[end - 1].t, hours / energy});
  }
  Eigen::MatrixXd free = tests.free_of_map(B);
  const Eigen::MatrixXd others = others_than(effect, fit, tests);
  free -= others * (others.transpose() * free);
  course.G = free.transpose() * free;
  course.s = free.transpose() * tests.residuals();
  course.chi2 = fit.adjustment.chi2;
  course.dof = fit.adjustment.dof;
  return course;
}

CoefficientCourse about_constant(CoefficientCourse course) {
  const Eigen::VectorXd one = course.G.rowwise().sum();
  const double all = one.sum();
  if (!(all > 0.0)) return course;
  course.s -= one * (course.s.sum() / all);
  course.G -= one * one.transpose() / all;
  return course;
}

CoefficientCourse beside(const Eigen::VectorXd& values, CoefficientCourse course) {
  const Eigen::VectorXd column = course.G * values;
  const double own = values.dot(column);
  if (!(own > 1e-9 * course.G.trace() * values.squaredNorm())) return course;
  const double score = values.dot(course.s);
  course.s -= column * (score / own);
  course.G -= column * column.transpose() / own;
  course.chi2 -= score * score / own;
  course.dof -= 1;
  return course;
}

std::map<std::string, Eigen::VectorXd> variables_over(const CoefficientCourse& course,
                                                      const fitting::FitState& fit) {
  std::map<std::string, Eigen::VectorXd> result;
  Eigen::VectorXd hours(course.s.size());
  for (std::size_t k = 0; k < course.parts.size(); ++k) {
    hours[static_cast<Eigen::Index>(k)] = course.parts[k].hours;
  }
  if (fit.recordings.size() == 1) result.emplace("t", hours);  // else it begins anew in each
  for (const Covariate& one : fit.recordings.front().drive.covariates) {
    if (auto means = means_of(one.name, course, fit)) result.emplace(one.name, *std::move(means));
  }
  return result;
}

}  // namespace trussmap::criticism
