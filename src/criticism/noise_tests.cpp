// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/noise_tests.hpp"

#include "criticism/noise_laws.hpp"
#include "criticism/noise_likelihood.hpp"
#include "fit/fit_projection.hpp"
#include "linalg/dense.hpp"
#include "statistics/distributions.hpp"
#include "statistics/multiple_tests.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace trussmap::criticism {
namespace {

constexpr Eigen::Index kProbes = 48;
constexpr Eigen::Index kAtOnce = 16;  // columns, of either
constexpr Eigen::Index kDraws = 128;
static_assert(kDraws % kAtOnce == 0);
constexpr double kLeastRedundancy = 1e-6;
constexpr double kWorthFitting = 0.01;  // p
constexpr double kLeastDrive = 0.1;     // m
constexpr double kUnchecked = 1e-6;
constexpr double kFewest = 10.0;  // degrees of freedom that have tails to speak of

/// Upper tail of a law with this skewness, in its standard deviations (Pearson's three moments).
double skewed_tail(double z, double skewness) {
  if (skewness < 1e-3) return statistics::normal_p_value(z);
  const double dof = 8.0 / (skewness * skewness);
  const double chi2 = dof + std::sqrt(2.0 * dof) * z;
  return chi2 <= 0.0 ? 1.0 : statistics::chi2_p_value_real(chi2, dof);
}

/// V times columns of whitened rows.
Eigen::MatrixXd law_times(const std::vector<estimation::Matrix4>& V,
                          const estimation::RecordingProblem& problem,
                          const estimation::RecordingSystem& system,
                          const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(columns.rows(), columns.cols());
  for (std::size_t k = 0; k < V.size(); ++k) {
    if (V[k].isZero(0.0)) continue;
    const int rows = problem.measurements[k].rows;
    const int at = system.first_row(k);
    result.middleRows(at, rows).noalias() =
        V[k].topLeftCorner(rows, rows) * columns.middleRows(at, rows);
  }
  return result;
}

struct LawScore {
  double z = 0.0;
  double skewness = 0.0;
  double variance = 0.0;  ///< (q - E q)/tr(PVPV)
  bool seen = false;
};

LawScore score_of(const NoiseLaw& law, const estimation::RecordingProblem& problem,
                  const estimation::RecordingSystem& system, const fitting::FitProjection& P,
                  const std::vector<Eigen::MatrixXd>& own, const Eigen::VectorXd& r,
                  const Eigen::MatrixXd& projected_probes) {
  std::vector<estimation::Matrix4> V;
  double whole = 0.0;
  double expected = 0.0;
  double q = 0.0;
  for (std::size_t k = 0; k < law.added.size(); ++k) {
    const estimation::Measurement& one = problem.measurements[k];
    V.push_back(P.left_out(k)
                    ? estimation::Matrix4(estimation::Matrix4::Zero())
                    : estimation::Matrix4(one.whitener * law.added[k] * one.whitener.transpose()));
    const Eigen::MatrixXd block = V.back().topLeftCorner(one.rows, one.rows);
    const auto here = r.segment(system.first_row(k), one.rows);
    whole += block.trace();
    expected += own[k].cwiseProduct(block).sum();
    q += here.dot(block * here);
  }
  LawScore result;
  if (expected <= kLeastRedundancy * whole) return result;
  double second = 0.0;
  double third = 0.0;
  for (Eigen::Index first = 0; first < projected_probes.cols(); first += kAtOnce) {
    const Eigen::MatrixXd some =
        projected_probes.middleCols(first, std::min(kAtOnce, projected_probes.cols() - first));
    const Eigen::MatrixXd once = P.times(law_times(V, problem, system, some));
    second += once.squaredNorm();
    third += once.cwiseProduct(law_times(V, problem, system, once)).sum();
  }
  const auto count = static_cast<double>(projected_probes.cols());
  second /= count;
  third /= count;
  result.seen = second > 0.0;
  if (!result.seen) return result;
  result.z = (q - expected) / std::sqrt(2.0 * second);
  result.skewness = 8.0 * third / std::pow(2.0 * second, 1.5);
  result.variance = (q - expected) / second;
  return result;
}

/// Statistics of residuals that no overall factor changes.
struct ResidualShape {
  double tails = 0.0;        ///< log of the mean fourth power, of measurements, by its expectation
  double correlation = 0.0;  ///< of successive drives
};

class ShapeStatistics {
 public:
  ShapeStatistics(const estimation::RecordingProblem& problem,
                  const estimation::RecordingSystem& system, const fitting::FitProjection& P)
      : problem_(problem), system_(system) {
    std::size_t last = problem.measurements.size();
    for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
      const estimation::Measurement& one = problem.measurements[k];
      add_measurement(k, one, P);
      if (!estimation::is_segment(one) || P.left_out(k)) continue;
      double path = 0.0;
      for (const estimation::SegmentRow& row : problem.segments[one.source])
        path += std::abs(row.path);
      if (path < kLeastDrive) continue;
      const bool follows =
          last < problem.measurements.size() && problem.measurements[last].session == one.session;
      if (follows) successive_.push_back({last, k});
      last = k;
    }
  }

  [[nodiscard]] std::size_t pairs() const { return successive_.size(); }
  /// Degrees of freedom of all that is checked.
  [[nodiscard]] double redundancy() const { return redundancy_; }

  [[nodiscard]] ResidualShape of(const Eigen::VectorXd& r) const {
    double squares = 0.0;
    double fourths = 0.0;
    double dof = 0.0;
    double expected = 0.0;
    for (const Standardised& one : standardised_) {
      const double t = (one.root * r.segment(one.at, one.root.cols())).squaredNorm();
      const auto c = static_cast<double>(one.root.rows());
      squares += t;
      fourths += t * t;
      dof += c;
      expected += c * (c + 2.0);
    }
    ResidualShape shape;
    if (squares > 0.0) {
      shape.tails = std::log(fourths / expected) - 2.0 * std::log(squares / dof);
    }
    double products = 0.0;
    double own = 0.0;
    for (const auto& [a, b] : successive_) {
      const auto first = r.segment<3>(system_.first_row(a));
      const auto second = r.segment<3>(system_.first_row(b));
      products += first.dot(second);
      own += 0.5 * (first.squaredNorm() + second.squaredNorm());
    }
    if (own > 0.0) shape.correlation = products / own;
    return shape;
  }

 private:
  struct Standardised {
    int at = 0;
    Eigen::MatrixXd root;  ///< whitens what of the measurement is checked
  };

  void add_measurement(std::size_t k, const estimation::Measurement& one,
                       const fitting::FitProjection& P) {
    if (P.left_out(k)) return;
    const linalg::SymmetricModes axes = linalg::symmetric_modes(P.own_block(k));
    redundancy_ += axes.eigenvalues.head(one.rows).sum();
    Eigen::Index checked = 0;
    for (Eigen::Index a = 0; a < one.rows; ++a) checked += axes.eigenvalues[a] > kUnchecked;
    if (checked == 0) return;
    Standardised result{system_.first_row(k), Eigen::MatrixXd(checked, one.rows)};
    for (Eigen::Index a = one.rows - checked, row = 0; a < one.rows; ++a, ++row) {
      result.root.row(row) = axes.eigenvectors.col(a).transpose() / std::sqrt(axes.eigenvalues[a]);
    }
    standardised_.push_back(std::move(result));
  }

  const estimation::RecordingProblem& problem_;
  const estimation::RecordingSystem& system_;
  std::vector<Standardised> standardised_;
  double redundancy_ = 0.0;
  std::vector<std::pair<std::size_t, std::size_t>> successive_;
};

NoiseTest shape_test(const char* name, double found, const Eigen::VectorXd& drawn) {
  NoiseTest test;
  test.law = name;
  const double mean = drawn.mean();
  const double sd =
      std::sqrt((drawn.array() - mean).square().sum() / static_cast<double>(drawn.size() - 1));
  const double z = sd > 0.0 ? (found - mean) / sd : 0.0;
  const double skewness = (drawn.array() - mean).cube().mean() / std::max(sd * sd * sd, 1e-300);
  test.score = z > 0.0 ? z * z : 0.0;
  test.p_value = skewed_tail(z, skewness);
  test.size = found - mean;
  return test;
}

/// Against residuals drawn under the same fit.
void test_shapes(const fitting::FitState& fit, const NoiseLikelihood& under,
                 std::vector<NoiseTest>& tests) {
  const fitting::FitProjection P(fit, under.problem(), under.system(), under.nuisance());
  const ShapeStatistics statistics(under.problem(), under.system(), P);
  if (statistics.redundancy() < kFewest) return;
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  Eigen::VectorXd tails(kDraws);
  Eigen::VectorXd correlation(kDraws);
  for (Eigen::Index first = 0; first < kDraws; first += kAtOnce) {
    Eigen::MatrixXd draws(under.system().rows(), kAtOnce);
    for (double& value : draws.reshaped()) value = normal(random);
    draws = P.times(std::move(draws));
    for (Eigen::Index k = 0; k < kAtOnce; ++k) {
      const ResidualShape shape = statistics.of(draws.col(k));
      tails[first + k] = shape.tails;
      correlation[first + k] = shape.correlation;
    }
  }
  const ResidualShape found = statistics.of(P.times(under.system().residuals()));
  tests.push_back(shape_test("heavy tails", found.tails, tails));
  if (statistics.pairs() < 3) return;
  tests.push_back(shape_test("autocorrelation", found.correlation, correlation));
}

/// A law that the data tell of, and what they say.
struct TestedLaw {
  NoiseLaw law;
  NoiseTest test;
};

/// Random signs for the traces that scores need.
Eigen::MatrixXd random_signs(int rows) {
  std::mt19937_64 random(1);
  Eigen::MatrixXd probes(rows, kProbes);
  for (double& sign : probes.reshaped()) sign = (random() & 1U) != 0U ? 1.0 : -1.0;
  return probes;
}

NoiseTest test_of(const NoiseLaw& law, const LawScore& score, NoiseLikelihood& likelihood) {
  NoiseTest test;
  test.law = law.name;
  test.unit = law.unit;
  test.p_value = skewed_tail(score.z, score.skewness);
  double variance = std::max(0.0, score.variance);
  test.score = score.z > 0.0 ? score.z * score.z : 0.0;
  if (test.p_value < kWorthFitting) {
    const NoiseLikelihood::Best best = likelihood.best(law, variance);
    variance = best.variance;
    test.score = best.gain;
  }
  test.size = std::sqrt(variance);
  test.stated = law.stated;
  return test;
}

/// Each by itself; `apart`: a basis of what is not to be taken for noise.
std::vector<TestedLaw> test_laws(const fitting::FitState& fit, const ScoreTest& tests,
                                 const Eigen::MatrixXd& apart, NoiseLikelihood& likelihood) {
  const estimation::RecordingProblem& problem = fit.problem;
  const estimation::RecordingSystem& system = tests.system();
  const fitting::FitProjection P(fit, problem, system, apart, tests.fitted_rows());
  std::vector<Eigen::MatrixXd> own;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) own.push_back(P.own_block(k));
  const Eigen::MatrixXd probes = P.times(random_signs(system.rows()));
  const Eigen::VectorXd r = P.times(system.residuals());
  std::vector<TestedLaw> result;
  for (NoiseLaw& law : noise_laws(fit, tests.context())) {
    const LawScore score = score_of(law, problem, system, P, own, r, probes);
    if (!score.seen) continue;
    NoiseTest test = test_of(law, score, likelihood);
    result.push_back({std::move(law), std::move(test)});
  }
  return result;
}

void adjust_p(std::vector<NoiseTest>& tests) {
  std::vector<double> p_values;
  p_values.reserve(tests.size());
  for (const NoiseTest& test : tests) p_values.push_back(test.p_value);
  const std::vector<double> adjusted = statistics::holm(p_values);
  for (std::size_t k = 0; k < tests.size(); ++k) tests[k].p_adjusted = adjusted[k];
}

}  // namespace

std::vector<NoiseTest> test_noise_laws(const fitting::FitState& fit, const ScoreTest& tests,
                                       const Eigen::MatrixXd& nuisance) {
  tests.forget();
  const Eigen::MatrixXd apart = nuisance.cols() > 0
                                    ? linalg::orthonormal_basis(nuisance, fitting::kSameDirection)
                                    : Eigen::MatrixXd(tests.system().rows(), 0);
  NoiseLikelihood likelihood(fit, apart);
  const std::vector<TestedLaw> laws = test_laws(fit, tests, apart, likelihood);
  std::vector<NoiseTest> result;
  result.reserve(laws.size());
  for (const TestedLaw& one : laws) result.push_back(one.test);
  const auto claim = [&](std::size_t k) {
    return result[k].score - (k < laws.size() ? laws[k].law.margin : 0.0);
  };
  if (!result.empty()) {
    adjust_p(result);
    std::size_t best = 0;
    for (std::size_t k = 1; k < result.size(); ++k) {
      if (claim(k) > claim(best)) best = k;
    }
    const double size = result[best].p_adjusted < kSignificance ? result[best].size : 0.0;
    static_cast<void>(likelihood.deviance(laws[best].law, size * size));
  }
  test_shapes(fit, likelihood, result);
  adjust_p(result);
  std::vector<std::size_t> order(result.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return claim(a) > claim(b); });
  std::vector<NoiseTest> sorted;
  sorted.reserve(order.size());
  for (const std::size_t k : order) sorted.push_back(std::move(result[k]));
  return sorted;
}

fitting::FitState with_noise(const fitting::FitState& fit, const ScoreTest& tests,
                             const NoiseTest& law) {
  for (const NoiseLaw& one : noise_laws(fit, tests.context())) {
    if (one.name != law.law) continue;
    NoiseLikelihood likelihood(fit, {});
    static_cast<void>(likelihood.deviance(one, law.size * law.size));
    fitting::FitState result = fit;
    result.problem = likelihood.problem();
    return result;
  }
  throw std::invalid_argument("'" + law.law + "' is no law of noise of this recording");
}

}  // namespace trussmap::criticism
