// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Which sets of candidates explain the residuals, all of them weighed: exactly every one, every
// pair and every triple; larger ones by adding to the best.
//
// Log evidence of a set S against none (Laplace's approximation; Kass & Raftery 1995, eq. 4):
//
//   log E = g_S' G_SS^-1 g_S / (2 phi) - log det(G_SS)/2 + sum over i in S of b_i(|u_i|^2 / phi)
//   b_i(s) = d_i log(sqrt(2 pi) / (2 log 100)) - d_i/2 log(1 + s/d_i)           sizes
//            - log n_i - p_i/2 log(1 + s)                                       constants sought
//            - max(0, z_i^2 - 9)                                                plausibility
//
// d_i columns, u_i as estimated jointly, in standard errors of each alone. The first line is the
// density of a prior that has sizes equally likely on a logarithmic scale, over a factor of a
// hundred from the smallest that shows on, so that no unit and no belief about a size comes between
// look-alikes. The second pays for n_i members tried of a family with p_i constants, as all
// evidence here does (tested_candidate.hpp); the third for sizes z_i > 3 standard deviations of
// what is known of the channel.
//
// Prior of sets: numbers of effects by Poisson's law of mean 1; of sets of as many by the product
// of their classes' beliefs w_c, so that many candidates cost what they should (Scott & Berger
// 2010); members of a class of look-alikes share its belief: many names make nothing likelier.
//
//   P(S) ~ prod w_c(i) share_i / (k! e_k(w)),   e_k: elementary symmetric polynomial of all classes
//
// Triples: for each pair (i, j) the residual correlations h of all columns and the shares D that
// the pair leaves of them cost a few operations a column. The chi^2 that k adds is h_k' D_k^-1 h_k,
// never more than |h_k|^2 / (1 - |C_k|^2) with C_k the correlations of k's columns with the pair
// (the largest eigenvalue of C C' is at most its trace); u_i = u_j = 0 bounds b. A triple whose
// bound is below the best less the window is passed over, all others are computed.
#pragma once

#include "criticism/candidate_gram.hpp"
#include "geometry/index.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace trussmap::criticism {

/// What a candidate is believed to be before any data.
struct BlockBelief {
  std::size_t look_alikes = 0;  ///< its class: of these a set has one
  double log_share = 0.0;       ///< log of w_c times its share
  double tried = 1.0;           ///< members of its family
  int constants = 0;            ///< that were sought
  double offset = 0.0;          ///< to its log evidence: what is known beyond first order
};

/// Classes of look-alikes and what is believed of all of them.
struct SetBelief {
  std::vector<BlockBelief> blocks;
  std::vector<double> log_sets;  ///< log (k! e_k(w)), k = 0, 1, ...
};

inline constexpr std::size_t kMostInSet = 6;

/// Candidates by their blocks, ascending.
struct CandidateSet {
  std::array<int, kMostInSet> members{};
  int size = 0;
  double gain = 0.0;          ///< chi^2 that it takes away
  double log_evidence = 0.0;  ///< with its prior; none: 0
};

struct SubsetOptions {
  double dispersion = 1.0;  ///< phi
  double window = 12.0;     ///< of log evidence behind the best
  int most = 5;             ///< effects in a set, at most kMostInSet
};

class SubsetSearch {
 public:
  /// Keeps references.
  SubsetSearch(const CandidateGram& gram, const SetBelief& belief, const SubsetOptions& options);

  /// All within the window, best first; the empty set counts. Throws std::invalid_argument where
  /// the belief has no number for sets as large as the options allow.
  [[nodiscard]] std::vector<CandidateSet> run() const;

  /// Of one set; nothing of members that look alike, or that the others determine all but 0.05 of.
  [[nodiscard]] bool weigh(CandidateSet& set) const;

  /// u of each member as estimated jointly, one after the other, and its standard errors with the
  /// others there (of phi = 1).
  struct Sizes {
    Eigen::VectorXd u;
    Eigen::MatrixXd covariance;
  };
  [[nodiscard]] Sizes sizes(const CandidateSet& set) const;

  [[nodiscard]] bool alike(int a, int b) const;

 private:
  class Pair;
  void take(CandidateSet set, std::vector<CandidateSet>& kept, double& best) const;
  void add_pairs(int i, std::vector<CandidateSet>& kept, double& best) const;
  void add_triples(int i, std::vector<CandidateSet>& kept, double& best) const;
  void add_larger(std::vector<CandidateSet>& kept, double& best) const;
  [[nodiscard]] double size_belief(int block, const double* u) const;
  [[nodiscard]] double most_of(int block, double squares) const;
  void keep_best(std::vector<CandidateSet>& kept, double best) const;

  const CandidateGram& gram_;
  const SetBelief& belief_;
  SubsetOptions options_;
  std::vector<double> alone_;  ///< most_of(block, 0) of each
};

/// Blocks whose columns span nearly the same: mean squared cosine at least 0.95^2. In order of
/// `order`, each joins the most alike of the classes begun before it. One class number per block.
[[nodiscard]] std::vector<std::size_t> look_alike_classes(const CandidateGram& gram,
                                                          const std::vector<std::size_t>& order);

/// log e_k(w) of the classes' log beliefs, k = 0 ... most.
[[nodiscard]] std::vector<double> log_symmetric(const std::vector<double>& log_beliefs,
                                                std::size_t most);

}  // namespace trussmap::criticism
