// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/event_scores.hpp"

#include "linalg/dense.hpp"
#include "parallel/parallel_for.hpp"
#include "statistics/distributions.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace trussmap::criticism {
namespace {

constexpr double kUnchecked = 1e-6;
constexpr Eigen::Index kBatch = 64;  // columns solved at a time

/// How many independent tests so many that overlap are worth: (sum sqrt l)^2 / sum l over the
/// eigenvalues l of their correlations (Galwey 2009).
double effective_tries(const Eigen::MatrixXd& S, Eigen::Index width) {
  const Eigen::Index count = S.cols() / width;
  if (count == 1) return 1.0;
  Eigen::VectorXd size(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    size[k] = std::sqrt(S.block(k * width, k * width, width, width).norm());
  }
  Eigen::MatrixXd overlap = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      const double both = size[i] * size[j];
      if (both > 0.0) {
        overlap(i, j) = S.block(i * width, j * width, width, width).norm() / both;
      }
    }
  }
  const linalg::SymmetricModes axes = linalg::symmetric_modes(overlap);
  const Eigen::ArrayXd l = axes.eigenvalues.array().max(0.0);
  return l.sum() > 0.0 ? std::pow(l.sqrt().sum(), 2) / l.sum() : 1.0;
}

class Scorer {
 public:
  Scorer(const fitting::FitState& fit, const estimation::RecordingSystem& system,
         const fitting::FitProjection& P)
      : fit_(fit), system_(system), P_(P), r_(P.times(system.residuals())) {}

  /// Solves are shared by events that need some.
  [[nodiscard]] std::vector<Scored> score(const std::vector<SingleEvent>& events) const {
    std::vector<Scored> result(events.size());
    std::vector<Batch> batches{{}};
    std::vector<std::size_t> local;
    for (std::size_t e = 0; e < events.size(); ++e) {
      if (std::all_of(events[e].places.begin(), events[e].places.end(),
                      [](const Dummies& one) { return one.parts.size() == 1; })) {
        local.push_back(e);
        continue;
      }
      if (batches.back().columns >= kBatch) batches.emplace_back();
      batches.back().events.push_back(e);
      batches.back().columns +=
          static_cast<Eigen::Index>(events[e].places.size()) * width(events[e]);
    }
    parallel::parallel_for(
        local.size(), [&](std::size_t k) { result[local[k]] = score_locally(events[local[k]]); });
    parallel::parallel_for(batches.size(),
                           [&](std::size_t k) { solve(events, batches[k], result); });
    return result;
  }

 private:
  struct Batch {
    std::vector<std::size_t> events;
    Eigen::Index columns = 0;
  };

  [[nodiscard]] static Eigen::Index width(const SingleEvent& event) {
    return event.places.front().parts.front().rows.cols();
  }

  /// Every place is within one measurement, and so is a group.
  [[nodiscard]] Scored score_locally(const SingleEvent& event) const {
    Scored result;
    for (std::size_t first = 0; first < event.places.size();) {
      const std::size_t k = event.places[first].parts.front().measurement;
      const Eigen::MatrixXd own = P_.own_block(k);
      const auto here = r_.segment(system_.first_row(k), own.rows());
      std::size_t next = first;
      while (next < event.places.size() && event.places[next].group == event.places[first].group) {
        const Eigen::MatrixXd& M = event.places[next].parts.front().rows;
        result.places.push_back(judge(M.transpose() * here, M.transpose() * own * M,
                                      M.colwise().squaredNorm(), event.places[next].prior_sd));
        ++next;
      }
      const Eigen::Index count = event.places[first].parts.front().rows.cols();
      Eigen::MatrixXd all(own.rows(), count * static_cast<Eigen::Index>(next - first));
      for (std::size_t place = first; place < next; ++place) {
        all.middleCols(count * static_cast<Eigen::Index>(place - first), count) =
            event.places[place].parts.front().rows;
      }
      result.tried += effective_tries(all.transpose() * own * all, count);
      first = next;
    }
    return result;
  }

  void solve(const std::vector<SingleEvent>& events, const Batch& batch,
             std::vector<Scored>& result) const {
    const Eigen::Index columns = batch.columns;
    const linalg::BlockSystem& normal = system_.normal_equations();
    std::vector<Eigen::Triplet<double>> right;
    Eigen::MatrixXd nuisance = Eigen::MatrixXd::Zero(P_.set_aside().cols(), columns);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(columns);
    Eigen::VectorXd whole = Eigen::VectorXd::Zero(columns);
    Eigen::Index at = 0;
    for (const std::size_t e : batch.events) {
      const Eigen::Index count = width(events[e]);
      for (const Dummies& dummies : events[e].places) {
        for (const DummyRows& part : dummies.parts) {
          const std::size_t k = part.measurement;
          const Eigen::MatrixXd& M = part.rows;
          const int first = system_.first_row(k);
          for (const estimation::RecordingSystem::NodeRows& link : system_.node_rows(k)) {
            const Eigen::MatrixXd block = link.rows.transpose() * M;
            for (Eigen::Index c = 0; c < block.cols(); ++c) {
              for (Eigen::Index r = 0; r < block.rows(); ++r) {
                right.emplace_back(normal.offset(link.node) + static_cast<int>(r),
                                   static_cast<int>(at + c), block(r, c));
              }
            }
          }
          g.segment(at, count) += M.transpose() * r_.segment(first, M.rows());
          whole.segment(at, count) += M.colwise().squaredNorm();
          nuisance.middleCols(at, count) +=
              P_.set_aside().middleRows(first, M.rows()).transpose() * M;
        }
        at += count;
      }
    }
    const Eigen::MatrixXd explained = normal.inverse_products(right, static_cast<int>(columns));
    at = 0;
    for (const std::size_t e : batch.events) {
      const SingleEvent& event = events[e];
      const Eigen::Index count = width(event);
      const Eigen::Index all = count * static_cast<Eigen::Index>(event.places.size());
      const auto Q = nuisance.middleCols(at, all);
      const Eigen::MatrixXd S = gram(event) - explained.block(at, at, all, all) - Q.transpose() * Q;
      for (Eigen::Index own = 0; own < all; own += count) {
        result[e].places.push_back(
            judge(g.segment(at + own, count), S.block(own, own, count, count),
                  whole.segment(at + own, count),
                  event.places[static_cast<std::size_t>(own / count)].prior_sd));
      }
      result[e].tried = effective_tries(S, count);
      at += all;
    }
  }

  /// M'M of all places at once.
  [[nodiscard]] static Eigen::MatrixXd gram(const SingleEvent& event) {
    const Eigen::Index count = width(event);
    const Eigen::Index all = count * static_cast<Eigen::Index>(event.places.size());
    std::map<std::size_t, std::vector<std::pair<Eigen::Index, const Eigen::MatrixXd*>>> rows;
    for (std::size_t place = 0; place < event.places.size(); ++place) {
      for (const auto& [k, M] : event.places[place].parts) {
        rows[k].push_back({count * static_cast<Eigen::Index>(place), &M});
      }
    }
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(all, all);
    for (const auto& [k, here] : rows) {
      for (const auto& [i, M] : here) {
        for (const auto& [j, N] : here) {
          result.block(i, j, count, count) += M->transpose() * *N;
        }
      }
    }
    return result;
  }

  /// Of what can be seen, g' S^-1 g; with a prior, as ScoreTest has it.
  [[nodiscard]] Found judge(const Eigen::VectorXd& g, const Eigen::MatrixXd& S,
                            const Eigen::VectorXd& whole, const Eigen::VectorXd& prior_sd) const {
    const bool prior = prior_sd.size() > 0;
    const double chi2 = fit_.adjustment.chi2;
    const int dof = fit_.adjustment.dof;
    const double dispersion = dof > 0 ? std::max(1.0, chi2 / dof) : 1.0;
    Found result;
    result.size = Eigen::VectorXd::Zero(g.size());
    std::vector<Eigen::Index> seen;
    for (Eigen::Index k = 0; k < g.size(); ++k) {
      bool counts =
          S(k, k) > (prior ? fitting::kLeastShare : kUnchecked) * whole[k] && S(k, k) > 0.0;
      if (prior) {
        counts =
            counts && std::sqrt(dispersion / S(k, k)) < fitting::kLargestUncertainty * prior_sd[k];
      }
      if (counts) seen.push_back(k);
    }
    if (seen.empty()) return result;
    const Eigen::VectorXd scale = S(seen, seen).diagonal().cwiseSqrt().cwiseInverse();
    Eigen::MatrixXd scaled = scale.asDiagonal() * S(seen, seen) * scale.asDiagonal();
    if (prior) {
      const Eigen::VectorXd sds = prior_sd(seen);
      scaled.diagonal() += dispersion * scale.cwiseAbs2().cwiseQuotient(sds.cwiseAbs2());
    }
    const linalg::SymmetricModes axes = linalg::symmetric_modes(scaled);
    const Eigen::VectorXd along = axes.eigenvectors.transpose() * scale.cwiseProduct(g(seen));
    Eigen::VectorXd size = Eigen::VectorXd::Zero(along.size());
    for (Eigen::Index k = 0; k < along.size(); ++k) {
      if (axes.eigenvalues[k] < kUnchecked) continue;
      ++result.dof;
      result.score += along[k] * along[k] / axes.eigenvalues[k];
      size -= along[k] / axes.eigenvalues[k] * axes.eigenvectors.col(k);
    }
    result.size(seen) = scale.cwiseProduct(size);
    const double left = dof > result.dof ? (chi2 - result.score) / (dof - result.dof) : 1.0;
    result.log_p = statistics::log_chi2_p_value(result.score / std::max(1.0, left), result.dof);
    return result;
  }

  const fitting::FitState& fit_;
  const estimation::RecordingSystem& system_;
  const fitting::FitProjection& P_;
  Eigen::VectorXd r_;
};

}  // namespace

std::vector<Scored> score_events(const fitting::FitState& fit,
                                 const estimation::RecordingSystem& system,
                                 const fitting::FitProjection& projection,
                                 const std::vector<SingleEvent>& events) {
  return Scorer(fit, system, projection).score(events);
}

}  // namespace trussmap::criticism
