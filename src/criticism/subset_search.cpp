// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/subset_search.hpp"

#include "linalg/dense.hpp"
#include "parallel/parallel_for.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace trussmap::criticism {
namespace {

constexpr double kLeastOwn = 0.05;       // that a column keeps beside the others of a set
constexpr double kAlike = 0.95 * 0.95;   // mean squared cosine
constexpr double kLargestSize = 3.0;     // standard deviations of what is known
constexpr std::size_t kBeginnings = 40;  // sets that larger ones are begun with
constexpr int kMostColumns = static_cast<int>(kMostInSet * kMostColumnsOfOne);

/// log(sqrt(2 pi) / (2 log 100)): of each coefficient.
double size_cost() {
  return std::log(std::sqrt(2.0 * std::numbers::pi) / (2.0 * std::log(100.0)));
}

/// Cholesky's factor in place (lower, column by column); false where a pivot is below `least`.
/// `log_det`: of the matrix.
bool factorise(double* A, int n, double least, double& log_det) {
  for (int k = 0; k < n; ++k) {
    double pivot = A[k * n + k];
    for (int m = 0; m < k; ++m) pivot -= A[m * n + k] * A[m * n + k];
    if (!(pivot >= least)) return false;
    log_det += std::log(pivot);
    const double root = std::sqrt(pivot);
    A[k * n + k] = root;
    for (int row = k + 1; row < n; ++row) {
      double sum = A[k * n + row];
      for (int m = 0; m < k; ++m) sum -= A[m * n + row] * A[m * n + k];
      A[k * n + row] = sum / root;
    }
  }
  return true;
}

/// L^-1 x in place; its square.
double forward(const double* L, int n, double* x) {
  double squares = 0.0;
  for (int k = 0; k < n; ++k) {
    x[k] /= L[k * n + k];
    squares += x[k] * x[k];
    for (int row = k + 1; row < n; ++row) x[row] -= L[k * n + row] * x[k];
  }
  return squares;
}

/// L^-T x in place.
void backward(const double* L, int n, double* x) {
  for (int k = n - 1; k >= 0; --k) {
    for (int row = k + 1; row < n; ++row) x[k] -= L[k * n + row] * x[row];
    x[k] /= L[k * n + k];
  }
}

bool likelier_set(const CandidateSet& a, const CandidateSet& b) {
  if (a.log_evidence != b.log_evidence) return a.log_evidence > b.log_evidence;
  if (a.size != b.size) return a.size < b.size;
  return a.members < b.members;
}

}  // namespace

SubsetSearch::SubsetSearch(const CandidateGram& gram, const SetBelief& belief,
                           const SubsetOptions& options)
    : gram_(gram), belief_(belief), options_(options) {
  for (int k = 0; k < static_cast<int>(gram.blocks.size()); ++k) alone_.push_back(most_of(k, 0.0));
}

/// b without its plausibility, which is a cost: the most that a block of this size may add.
double SubsetSearch::most_of(int block, double squares) const {
  const auto k = static_cast<std::size_t>(block);
  const BlockBelief& belief = belief_.blocks[k];
  const auto d = static_cast<double>(gram_.blocks[k].size);
  double sum =
      d * size_cost() - 0.5 * d * std::log1p(squares / d) - std::log(belief.tried) + belief.offset;
  if (belief.constants > 0) sum -= 0.5 * belief.constants * std::log1p(squares);
  return sum;
}

double SubsetSearch::size_belief(int block, const double* u) const {
  const ColumnBlock& one = gram_.blocks[static_cast<std::size_t>(block)];
  const Eigen::Map<const Eigen::VectorXd> own(u, one.size);
  double largest = 0.0;
  for (Eigen::Index k = 0; k < one.in_priors.size(); ++k) {
    if (one.in_priors[k] == 0.0) continue;
    largest = std::max(largest, one.in_priors[k] * std::abs(one.weights.row(k).dot(own)));
  }
  return most_of(block, own.squaredNorm() / options_.dispersion) -
         std::max(0.0, largest * largest - kLargestSize * kLargestSize);
}

bool SubsetSearch::alike(int a, int b) const {
  const BlockBelief& one = belief_.blocks[static_cast<std::size_t>(a)];
  const BlockBelief& other = belief_.blocks[static_cast<std::size_t>(b)];
  return one.look_alikes == other.look_alikes;
}

bool SubsetSearch::weigh(CandidateSet& set) const {
  std::array<double, static_cast<std::size_t>(kMostColumns) * kMostColumns> R;
  std::array<double, kMostColumns> u;
  std::array<Eigen::Index, kMostColumns> columns;
  int n = 0;
  for (int m = 0; m < set.size; ++m) {
    for (int other = 0; other < m; ++other) {
      if (alike(set.members[idx(other)], set.members[idx(m)])) return false;
    }
    const ColumnBlock& one = gram_.blocks[idx(set.members[idx(m)])];
    for (Eigen::Index c = 0; c < one.size; ++c) columns[idx(n++)] = one.first + c;
  }
  for (int c = 0; c < n; ++c) {
    u[idx(c)] = gram_.g[columns[idx(c)]];
    for (int row = c; row < n; ++row) {
      R[idx(c * n + row)] = gram_.G(columns[idx(row)], columns[idx(c)]);
    }
  }
  double log_det = 0.0;
  if (!factorise(R.data(), n, kLeastOwn, log_det)) return false;
  set.gain = forward(R.data(), n, u.data());
  backward(R.data(), n, u.data());
  double sum =
      0.5 * set.gain / options_.dispersion - 0.5 * log_det - belief_.log_sets[idx(set.size)];
  int at = 0;
  for (int m = 0; m < set.size; ++m) {
    const int block = set.members[idx(m)];
    sum += size_belief(block, u.data() + at) + belief_.blocks[idx(block)].log_share;
    at += static_cast<int>(gram_.blocks[idx(block)].size);
  }
  set.log_evidence = sum;
  return true;
}

SubsetSearch::Sizes SubsetSearch::sizes(const CandidateSet& set) const {
  std::vector<Eigen::Index> columns;
  for (int m = 0; m < set.size; ++m) {
    const ColumnBlock& one = gram_.blocks[idx(set.members[idx(m)])];
    for (Eigen::Index c = 0; c < one.size; ++c) columns.push_back(one.first + c);
  }
  const linalg::DenseCholesky factor(Eigen::MatrixXd(gram_.G(columns, columns)));
  return {factor.solve(Eigen::MatrixXd(gram_.g(columns))), factor.inverse()};
}

void SubsetSearch::take(CandidateSet set, std::vector<CandidateSet>& kept, double& best) const {
  if (!weigh(set) || set.log_evidence < best - options_.window) return;
  best = std::max(best, set.log_evidence);
  kept.push_back(set);
}

void SubsetSearch::keep_best(std::vector<CandidateSet>& kept, double best) const {
  std::erase_if(kept,
                [&](const CandidateSet& one) { return one.log_evidence < best - options_.window; });
}

void SubsetSearch::add_pairs(int i, std::vector<CandidateSet>& kept, double& best) const {
  for (int j = i + 1; j < static_cast<int>(gram_.blocks.size()); ++j) {
    take({{i, j}, 2}, kept, best);
  }
}

/// What a pair leaves of all columns and of the residuals.
class SubsetSearch::Pair {
 public:
  Pair(const SubsetSearch& search, int i)
      : gram_(search.gram_), i_(gram_.blocks[idx(i)]), V_(gram_.G.middleCols(i_.first, i_.size)) {
    h_i_ = gram_.g - V_ * gram_.g.segment(i_.first, i_.size);
    squares_i_ = V_.rowwise().squaredNorm();
    gain_i_ = gram_.g.segment(i_.first, i_.size).squaredNorm();
  }

  /// False where j is all but determined by i. Columns from `from` on are worked out.
  bool with(int j, Eigen::Index from) {
    const ColumnBlock& own = gram_.blocks[idx(j)];
    const auto n = static_cast<int>(own.size);
    const Eigen::MatrixXd C = V_.middleRows(own.first, own.size);
    Eigen::MatrixXd D = -C * C.transpose();
    D.diagonal().array() += 1.0;
    log_det_ = 0.0;
    if (!factorise(D.data(), n, kLeastOwn, log_det_)) return false;
    Eigen::VectorXd a = h_i_.segment(own.first, own.size);
    gain_ = gain_i_ + forward(D.data(), n, a.data());
    const Eigen::Index rows = gram_.G.rows() - from;
    U_ = gram_.G.block(from, own.first, rows, own.size);
    U_.noalias() -= V_.bottomRows(rows) * C.transpose();
    for (int k = 0; k < n; ++k) {  // times L^-T
      for (int m = 0; m < k; ++m) U_.col(k) -= D(k, m) * U_.col(m);
      U_.col(k) /= D(k, k);
    }
    h_ = h_i_.tail(rows);
    h_.noalias() -= U_ * a;
    squares_ = squares_i_.tail(rows) + U_.rowwise().squaredNorm();
    from_ = from;
    return true;
  }

  /// chi^2 that k takes away beside the pair, or a bound of it; `log_det` of what it keeps of its
  /// own, and |u_k|^2, where they are known, else what they are at least. False: it has no share.
  struct Third {
    double gain = 0.0;
    double log_det = 0.0;
    double squares = 0.0;
  };
  bool third(int k, Third& result) const {
    const ColumnBlock& own = gram_.blocks[idx(k)];
    const Eigen::Index at = own.first - from_;
    if (own.size == 1) {
      const double left = 1.0 - squares_[at];
      if (!(left >= kLeastOwn)) return false;
      const double u = h_[at] / left;
      result = {u * h_[at], std::log(left), u * u};
      return true;
    }
    return exact(own, at, result);
  }
  /// A bound of the gain alone, from above; infinite where it says nothing.
  [[nodiscard]] double bound(int k) const {
    const ColumnBlock& own = gram_.blocks[idx(k)];
    const Eigen::Index at = own.first - from_;
    double left = 1.0;
    double squares = 0.0;
    for (Eigen::Index c = at; c < at + own.size; ++c) {
      left -= squares_[c];
      squares += h_[c] * h_[c];
    }
    return left > 0.0 ? squares / left : std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] double gain() const { return gain_; }
  [[nodiscard]] double log_det() const { return log_det_; }

 private:
  bool exact(const ColumnBlock& own, Eigen::Index at, Third& result) const {
    const auto n = static_cast<int>(own.size);
    std::array<double, static_cast<std::size_t>(kMostColumnsOfOne * kMostColumnsOfOne)> D;
    std::array<double, static_cast<std::size_t>(kMostColumnsOfOne)> u;
    for (int c = 0; c < n; ++c) {
      u[idx(c)] = h_[at + c];
      for (int row = c; row < n; ++row) {
        D[idx(c * n + row)] = (row == c ? 1.0 : 0.0) -
                              V_.row(own.first + row).dot(V_.row(own.first + c)) -
                              U_.row(at + row).dot(U_.row(at + c));
      }
    }
    result = {};
    if (!factorise(D.data(), n, kLeastOwn, result.log_det)) return false;
    result.gain = forward(D.data(), n, u.data());
    backward(D.data(), n, u.data());
    for (int c = 0; c < n; ++c) result.squares += u[idx(c)] * u[idx(c)];
    return true;
  }

  const CandidateGram& gram_;
  const ColumnBlock& i_;
  Eigen::MatrixXd V_;  ///< G of all columns with i's
  Eigen::VectorXd h_i_, squares_i_;
  double gain_i_ = 0.0;
  Eigen::MatrixXd U_;  ///< likewise with j's, those that i leaves, orthonormal; from `from_` on
  Eigen::VectorXd h_, squares_;
  Eigen::Index from_ = 0;
  double gain_ = 0.0;
  double log_det_ = 0.0;
};

void SubsetSearch::add_triples(int i, std::vector<CandidateSet>& kept, double& best) const {
  const auto count = static_cast<int>(gram_.blocks.size());
  Pair pair(*this, i);
  for (int j = i + 1; j + 1 < count; ++j) {
    if (alike(i, j) || !pair.with(j, gram_.blocks[idx(j + 1)].first)) continue;
    const double of_pair = 0.5 * pair.gain() / options_.dispersion - 0.5 * pair.log_det() +
                           alone_[idx(i)] + alone_[idx(j)] + belief_.blocks[idx(i)].log_share +
                           belief_.blocks[idx(j)].log_share - belief_.log_sets[3];
    for (int k = j + 1; k < count; ++k) {
      // Below this nothing is kept; what k leaves of its own is at least kLeastOwn a column.
      const double least = best - options_.window - of_pair - belief_.blocks[idx(k)].log_share;
      const double own =
          -0.5 * std::log(kLeastOwn) * static_cast<double>(gram_.blocks[idx(k)].size);
      const double alone = least - own - alone_[idx(k)];
      if (0.5 * pair.bound(k) / options_.dispersion < alone) continue;
      Pair::Third third;
      if (!pair.third(k, third)) continue;
      const double most = 0.5 * third.gain / options_.dispersion - 0.5 * third.log_det +
                          most_of(k, third.squares / options_.dispersion);
      if (most < least) continue;
      take({{i, j, k}, 3}, kept, best);
    }
  }
}

/// Each of the best of one size with any other beside it, until none of a size is among the best.
void SubsetSearch::add_larger(std::vector<CandidateSet>& kept, double& best) const {
  const auto count = static_cast<int>(gram_.blocks.size());
  for (int size = 3; size < options_.most; ++size) {
    std::vector<CandidateSet> begun;
    for (const CandidateSet& one : kept) {
      if (one.size == size) begun.push_back(one);
    }
    std::sort(begun.begin(), begun.end(), likelier_set);
    if (begun.size() > kBeginnings) begun.resize(kBeginnings);
    std::vector<CandidateSet> larger;
    for (const CandidateSet& one : begun) {
      for (int k = 0; k < count; ++k) {
        CandidateSet more = one;
        const auto end = more.members.begin() + size;
        if (std::find(more.members.begin(), end, k) != end) continue;
        more.members[idx(size)] = k;
        more.size = size + 1;
        std::sort(more.members.begin(), end + 1);
        take(more, larger, best);
      }
    }
    const auto same = [](const CandidateSet& a, const CandidateSet& b) {
      return a.members == b.members;
    };
    std::sort(larger.begin(), larger.end(), likelier_set);
    larger.erase(std::unique(larger.begin(), larger.end(), same), larger.end());
    keep_best(larger, best);
    if (larger.empty()) return;
    kept.insert(kept.end(), larger.begin(), larger.end());
  }
}

std::vector<CandidateSet> SubsetSearch::run() const {
  if (idx(options_.most) > kMostInSet || idx(options_.most) >= belief_.log_sets.size()) {
    throw std::invalid_argument("sets have more members than there are beliefs for");
  }
  const auto count = static_cast<int>(gram_.blocks.size());
  double best = 0.0;
  std::vector<CandidateSet> kept{CandidateSet{}};
  for (int i = 0; i < count; ++i) take({{i}, 1}, kept, best);
  // Each turn its own: what is passed over does not depend on the order of turns.
  const auto all_from = [&](const auto& add) {
    std::vector<std::vector<CandidateSet>> found(idx(count));
    std::vector<double> bests(idx(count), best);
    parallel::parallel_for(idx(count),
                           [&](std::size_t i) { add(static_cast<int>(i), found[i], bests[i]); });
    best = std::max(best, *std::max_element(bests.begin(), bests.end()));
    for (const std::vector<CandidateSet>& some : found) {
      kept.insert(kept.end(), some.begin(), some.end());
      keep_best(kept, best);
    }
  };
  if (count > 1 && options_.most >= 2) {
    all_from([this](int i, auto& found, double& most) { add_pairs(i, found, most); });
  }
  if (count > 2 && options_.most >= 3) {
    all_from([this](int i, auto& found, double& most) { add_triples(i, found, most); });
  }
  add_larger(kept, best);
  keep_best(kept, best);
  std::sort(kept.begin(), kept.end(), likelier_set);
  return kept;
}

std::vector<std::size_t> look_alike_classes(const CandidateGram& gram,
                                            const std::vector<std::size_t>& order) {
  std::vector<std::size_t> classes(gram.blocks.size(), 0);
  std::vector<std::size_t> leaders;
  for (const std::size_t k : order) {
    const ColumnBlock& one = gram.blocks[k];
    double most = kAlike;
    std::size_t with = leaders.size();
    for (std::size_t c = 0; c < leaders.size(); ++c) {
      const ColumnBlock& other = gram.blocks[leaders[c]];
      const double cosine2 =
          gram.G.block(one.first, other.first, one.size, other.size).squaredNorm() /
          static_cast<double>(std::max(one.size, other.size));
      if (cosine2 < most) continue;
      most = cosine2;
      with = c;
    }
    if (with == leaders.size()) leaders.push_back(k);
    classes[k] = with;
  }
  return classes;
}

std::vector<double> log_symmetric(const std::vector<double>& log_beliefs, std::size_t most) {
  std::vector<double> e(most + 1, 0.0);
  e[0] = 1.0;
  for (const double one : log_beliefs) {
    for (std::size_t k = most; k > 0; --k) e[k] += std::exp(one) * e[k - 1];
  }
  for (double& one : e) one = std::log(one);
  return e;
}

}  // namespace trussmap::criticism
