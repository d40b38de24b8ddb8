// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "planning/separation.hpp"

#include "planning/drive_information.hpp"
#include "statistics/distributions.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::planning {

double separation(const Eigen::MatrixXd& gram, const Question& question,
                  const std::vector<Eigen::Index>& beside, double phi) {
  std::vector<Eigen::Index> all = question.columns;
  all.insert(all.end(), question.others.begin(), question.others.end());
  all.insert(all.end(), beside.begin(), beside.end());
  std::vector<Eigen::Index> gone;
  for (std::size_t k = question.columns.size(); k < all.size(); ++k) {
    gone.push_back(static_cast<Eigen::Index>(k));
  }
  const Eigen::MatrixXd left = without(gram(all, all), gone);
  return std::max(0.0, question.sizes.dot(left * question.sizes)) / phi;
}

double power_of(const Question& question, double lambda) {
  constexpr int kSizes = 11;  // equally likely ones stand for all
  const auto dof = static_cast<double>(question.columns.size());
  double sum = 0.0;
  for (int k = 0; k < kSizes; ++k) {
    const double z = statistics::normal_quantile((k + 0.5) / kSizes);
    const double share = std::max(0.0, 1.0 + z * question.sd_share);
    sum += statistics::noncentral_chi2_tail(question.threshold, dof, lambda * share * share);
  }
  return sum / kSizes;
}

void want_power(Question& question, double power) {
  double low = 0.0;
  double high = 1.0;
  while (power_of(question, high) < power && high < 1e6) high *= 2.0;
  for (int pass = 0; pass < 40; ++pass) {
    const double middle = 0.5 * (low + high);
    (power_of(question, middle) < power ? low : high) = middle;
  }
  question.wanted = high;
}

}  // namespace trussmap::planning
