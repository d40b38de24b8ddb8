// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/place_fields.hpp"

#include "criticism/field_likelihood.hpp"
#include "geometry/index.hpp"
#include "linalg/dense.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

namespace trussmap {
using namespace criticism;

namespace {

/// A channel that has been found to differ.
struct FoundField {
  std::size_t channel = 0;
  double p_value = 1.0;
  FieldSize likeliest;
  std::vector<std::size_t> rivals;  ///< that explained as much when it was found
};

class FieldSearch {
 public:
  FieldSearch(const PlaceScores& scores, double level)
      : scores_(scores), level_(level), R_(mean_covariance(scores)) {
    all_ = {scores.G, scores.s, scores.chi2, static_cast<double>(scores.dof)};
    for (std::size_t c = 0; c < scores.channels.size(); ++c) {
      all_.take_out(amounts_of(first_of(c), scores.count()));
    }
    own_.resize(scores.channels.size());
    for (std::size_t c = 0; c < scores.channels.size(); ++c) find_own_patches(c);
  }

  std::vector<FieldOfPlaces> run() {
    std::vector<std::size_t> left(scores_.channels.size());
    for (std::size_t c = 0; c < left.size(); ++c) left[c] = c;
    while (!left.empty()) {
      const auto surest = surest_of(left);
      if (!surest) break;
      found_.push_back(*surest);
      std::erase(left, surest->channel);
    }
    std::vector<FieldOfPlaces> fields;
    for (const FoundField& one : found_) fields.push_back(told(one));
    std::ranges::stable_sort(fields, {}, &FieldOfPlaces::p_value);
    return fields;
  }

 private:
  /// Places of patches' columns among all.
  using Columns = std::vector<Eigen::Index>;

  [[nodiscard]] Eigen::Index first_of(std::size_t channel) const {
    return scores_.count() * static_cast<Eigen::Index>(channel);
  }
  [[nodiscard]] Eigen::VectorXd amounts_of(Eigen::Index first, Eigen::Index count) const {
    Eigen::VectorXd amounts = Eigen::VectorXd::Zero(all_.s.size());
    amounts.segment(first, count).setOnes();
    return amounts;
  }

  [[nodiscard]] const FieldPriors& priors() const {
    if (!priors_) priors_ = priors_over(scores_);
    return *priors_;
  }

  /// Those that the channel's own columns can show: they may be what its field is.
  void find_own_patches(std::size_t channel) {
    constexpr double kMostly = 0.5;
    Eigen::Index column = first_of(scores_.channels.size());
    if (scores_.patches.empty()) return;
    Eigen::MatrixXd G = all_.part(first_of(channel), scores_.count()).G;
    G.diagonal().array() += 1e-3 * G.diagonal().maxCoeff();
    const linalg::DenseCholesky factor(G);
    for (std::size_t k = 0; k < scores_.patches.size(); ++k) {
      const auto count = static_cast<Eigen::Index>(scores_.patches[k].shape.size());
      const Eigen::MatrixXd with = all_.G.block(first_of(channel), column, scores_.count(), count);
      const double shown = (with.transpose() * factor.solve(with)).trace();
      if (shown > kMostly * all_.G.diagonal().segment(column, count).sum()) {
        own_[channel].push_back(k);
      }
      column += count;
    }
  }

  [[nodiscard]] Columns columns_of(std::size_t patch) const {
    Eigen::Index first = first_of(scores_.channels.size());
    for (std::size_t k = 0; k < patch; ++k) first += std::ssize(scores_.patches[k].shape);
    Columns columns;
    for (std::size_t k = 0; k < scores_.patches[patch].shape.size(); ++k) {
      columns.push_back(first + static_cast<Eigen::Index>(k));
    }
    return columns;
  }

  [[nodiscard]] bool is_own(std::size_t channel, std::size_t patch) const {
    return std::ranges::find(own_[channel], patch) != own_[channel].end();
  }

  /// All beside other fields that were found, and patches that are not the channel's own; `also`
  /// beside its own.
  [[nodiscard]] ScoresBeside beside_others(std::size_t channel, bool also) const {
    ScoresBeside result = all_;
    for (std::size_t k = 0; k < scores_.patches.size(); ++k) {
      if (is_own(channel, k) && !also) continue;
      for (const Eigen::Index column : columns_of(k)) result.take_out(amounts_of(column, 1));
    }
    for (const FoundField& one : found_) {
      if (one.channel == channel) continue;
      Eigen::MatrixXd amounts = Eigen::MatrixXd::Zero(all_.s.size(), scores_.count());
      amounts.middleRows(first_of(one.channel), scores_.count()) =
          priors().roots[one.likeliest.length];
      const double variance = one.likeliest.sigma * one.likeliest.sigma;
      result.take_out(amounts, one.likeliest.phi / variance);
    }
    return result;
  }

  [[nodiscard]] ScoresBeside of_channel(std::size_t channel, bool also = false) const {
    return beside_others(channel, also).part(first_of(channel), scores_.count());
  }

  /// Nothing where it is not significant among so many.
  [[nodiscard]] std::optional<FoundField> tested(const ScoresBeside& one, std::size_t channel,
                                                 double tried) const {
    if (!may_be_there(one, R_)) return std::nullopt;
    const FieldForm form = form_of(one, R_);
    if (!(form.chance(1.0) * tried < level_)) return std::nullopt;
    const FieldSize likeliest = likelihood_of(one, priors()).likeliest;
    if (!(likeliest.sigma > 0.0)) return std::nullopt;
    const double p_value = form.chance(likeliest.phi) * tried;
    if (!(p_value < level_)) return std::nullopt;
    return FoundField{channel, p_value, likeliest, {}};
  }

  [[nodiscard]] std::optional<FoundField> surest_of(const std::vector<std::size_t>& left) const {
    std::vector<FoundField> all;
    for (const std::size_t channel : left) {
      if (auto one = tested(of_channel(channel), channel, static_cast<double>(left.size()))) {
        all.push_back(*std::move(one));
      }
    }
    if (all.empty()) return std::nullopt;
    // Where all are as sure as numbers can say, by how much each explains.
    FoundField surest = *std::ranges::max_element(
        all, {}, [](const FoundField& one) { return one.likeliest.gain; });
    for (const FoundField& one : all) {
      if (one.channel == surest.channel) continue;
      if (surest.likeliest.gain - one.likeliest.gain < kToldApart) {
        surest.rivals.push_back(one.channel);
      }
    }
    return surest;
  }

  /// Whether the channel's own patches explain as much as its field does.
  [[nodiscard]] bool are_patches(std::size_t channel, const ScoresBeside& without,
                                 double gain) const {
    if (own_[channel].empty()) return false;
    const ScoresBeside with = of_channel(channel, true);
    if (!tested(with, channel, 1.0)) return true;
    const double each = std::log(std::max(2.0, without.dof));
    double numbers = 0.0;
    for (const std::size_t k : own_[channel]) {
      for (const Shape& shape : scores_.patches[k].shape) {
        numbers += 1.0 + static_cast<double>(shape.parameters().size());
      }
    }
    const double gain_with = without.deviance() - with.deviance();
    return gain - 2.0 * each < gain_with - numbers * each + kToldApart;
  }

  [[nodiscard]] FieldOfPlaces told(const FoundField& found) const {
    const ScoresBeside one = of_channel(found.channel);
    const FieldLikelihood likelihood = likelihood_of(one, priors());
    FieldOfPlaces field;
    field.channel = scores_.channels[found.channel];
    field.p_value = std::min(1.0, found.p_value);
    for (const std::size_t k : found.rivals) {
      const bool beside = std::ranges::find(found_, k, &FoundField::channel) != found_.end();
      if (!beside) field.rivals.push_back(scores_.channels[k]);
    }
    field.length = priors().lengths[likelihood.likeliest.length];
    field.chi2_decrease = likelihood.likeliest.phi * likelihood.likeliest.gain;
    if (are_patches(found.channel, one, likelihood.likeliest.gain)) {
      for (const std::size_t k : own_[found.channel]) {
        field.patches.push_back(scores_.patches[k].name);
      }
    }
    tell_map(likelihood, field);
    return field;
  }

  /// Mean and standard deviation of each node, over all that may be.
  void tell_map(const FieldLikelihood& likelihood, FieldOfPlaces& field) const {
    constexpr double kLeastWeight = 1e-4;
    const Eigen::Index n = scores_.count();
    double sum = 0.0;
    Eigen::ArrayXd mean = Eigen::ArrayXd::Zero(n);
    Eigen::ArrayXd square = Eigen::ArrayXd::Zero(n);
    std::size_t length = std::numeric_limits<std::size_t>::max();
    Eigen::MatrixXd about;    // modes less their means over the way
    Eigen::MatrixXd squared;  // each of its entries
    for (const FieldSize& size : likelihood.sizes) {
      const double weight = std::exp(0.5 * (size.gain - likelihood.likeliest.gain));
      if (weight < kLeastWeight) continue;
      const FieldModes& modes = likelihood.modes[size.length];
      if (size.length != length) {
        length = size.length;
        about = modes.fields.rowwise() - scores_.driven.transpose() * modes.fields;
        squared = about.cwiseAbs2();
      }
      const Eigen::ArrayXd stiffness =
          modes.variances.array() + size.phi / (size.sigma * size.sigma);
      const Eigen::ArrayXd own = -(about * (modes.t.array() / stiffness).matrix()).array();
      const Eigen::ArrayXd variance = (squared * (size.phi / stiffness).matrix()).array();
      sum += weight;
      mean += weight * own;
      square += weight * (variance + own.square());
    }
    mean /= sum;
    square /= sum;
    const Eigen::ArrayXd variance = (square - mean.square()).max(0.0);
    field.size = std::sqrt(scores_.driven.dot(square.matrix()));
    field.told = std::clamp(
        1.0 - scores_.driven.dot(variance.matrix()) / scores_.driven.dot(square.matrix()), 0.0,
        1.0);
    lay_out_map(mean, variance.sqrt(), field);
  }

  void lay_out_map(const Eigen::ArrayXd& mean, const Eigen::ArrayXd& sd,
                   FieldOfPlaces& field) const {
    const SquareGrid& grid = scores_.grid;
    field.x = grid.low.x();
    field.y = grid.low.y();
    field.cell = grid.cell;
    field.columns = grid.columns;
    field.rows = grid.rows;
    field.mean.assign(idx(grid.nodes()), std::numeric_limits<double>::quiet_NaN());
    field.sd = field.mean;
    for (std::size_t k = 0; k < scores_.nodes.size(); ++k) {
      if (!scores_.visited[k]) continue;
      const std::size_t at = idx(grid.index_of(scores_.nodes[k]));
      field.mean[at] = mean[static_cast<Eigen::Index>(k)];
      field.sd[at] = sd[static_cast<Eigen::Index>(k)];
    }
  }

  const PlaceScores& scores_;
  double level_;
  Eigen::MatrixXd R_;                          ///< what is asked for
  mutable std::optional<FieldPriors> priors_;  ///< made when first asked for
  ScoresBeside all_;
  std::vector<std::vector<std::size_t>> own_;  ///< per channel: patches
  std::vector<FoundField> found_;
};

}  // namespace

std::vector<FieldCell> FieldOfPlaces::cells_driven() const {
  std::vector<FieldCell> cells;
  std::size_t at = 0;
  for (int along_y = 0; along_y < rows; ++along_y) {
    for (int column = 0; column < columns; ++column, ++at) {
      if (std::isnan(mean[at])) continue;
      cells.push_back(
          {column, along_y, Vector2(x, y) + cell * Vector2(column, along_y), mean[at], sd[at]});
    }
  }
  return cells;
}

double FieldOfPlaces::most() const {
  double largest = 0.0;
  for (const FieldCell& one : cells_driven()) largest = std::max(largest, std::abs(one.mean));
  return largest;
}

}  // namespace trussmap

namespace trussmap::criticism {

std::vector<FieldOfPlaces> place_fields(const PlaceScores& scores, double level) {
  return FieldSearch(scores, level).run();
}

}  // namespace trussmap::criticism
