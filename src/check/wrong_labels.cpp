// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Sightings that have another landmark's name: once it is found far from where it is before and
// after, and the other landmark is there.
#include "check/findings.hpp"
#include "check/visits.hpp"
#include "text/number_text.hpp"
#include "trussmap/gate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace trussmap::check {
namespace {

struct WrongLabel {
  double t = 0.0;  ///< s
  std::string_view read;
  std::string_view right;
  double off = 0.0;  ///< m, from where the landmark that was read is
};

/// The least of how far a visit is from two others of its landmark that agree; nothing where it is
/// not at another place than both.
std::optional<double> off_from(const Visit& one, const Visit& a, const Visit& b,
                               const UsualMiss& usual) {
  if ((a.place - b.place).norm() > usual.allowed(a, b)) return std::nullopt;
  const double from_a = (one.place - a.place).norm();
  const double from_b = (one.place - b.place).norm();
  if (from_a <= kOtherPlace * usual.allowed(one, a)) return std::nullopt;
  if (from_b <= kOtherPlace * usual.allowed(one, b)) return std::nullopt;
  return std::min(from_a, from_b);
}

/// A visit's neighbours in time: before and after, of the first and the last the next two.
std::optional<double> off_at(const std::vector<Visit>& visits, std::size_t k,
                             const UsualMiss& usual) {
  if (visits.size() < 3) return std::nullopt;
  const std::size_t middle = std::clamp<std::size_t>(k, 1, visits.size() - 2);
  const std::size_t a = k == 0 ? 1 : middle - 1;
  const std::size_t b = k == 0 ? 2 : k + 1 == visits.size() ? k - 1 : middle + 1;
  return off_from(visits[k], visits[a], visits[b], usual);
}

const Visit& nearest_in_time(const std::vector<Visit>& visits, double t) {
  const auto after = std::lower_bound(visits.begin(), visits.end(), t,
                                      [](const Visit& one, double at) { return one.t < at; });
  if (after == visits.end()) return visits.back();
  if (after == visits.begin() || after->t - t < t - (after - 1)->t) return *after;
  return *(after - 1);
}

/// Whose place it is.
std::string_view landmark_at(const Visit& one, std::string_view read, double off,
                             const Visits& visits, const UsualMiss& usual) {
  constexpr double kThere = 0.5;  // of the way to where it should be
  std::string_view best;
  double least = kThere * off;
  for (const auto& [name, all] : visits) {
    if (name == read || all.empty()) continue;
    const Visit& other = nearest_in_time(all, one.t);
    const double apart = (other.place - one.place).norm();
    if (apart >= least || apart > usual.allowed(one, other)) continue;
    least = apart;
    best = name;
  }
  return best;
}

std::vector<WrongLabel> wrong_labels(const Visits& visits, const UsualMiss& usual) {
  std::vector<WrongLabel> wrong;
  for (const auto& [name, all] : visits) {
    for (std::size_t k = 0; k < all.size(); ++k) {
      const std::optional<double> off = off_at(all, k, usual);
      if (!off) continue;
      const std::string_view right = landmark_at(all[k], name, *off, visits, usual);
      if (!right.empty()) wrong.push_back({all[k].t, name, right, *off});
    }
  }
  std::sort(wrong.begin(), wrong.end(),
            [](const WrongLabel& a, const WrongLabel& b) { return a.t < b.t; });
  return wrong;
}

}  // namespace

void check_wrong_labels(Checked& checked, const Visits& visits, const UsualMiss& usual) {
  constexpr std::size_t kNamed = 3;
  const std::vector<WrongLabel> wrong = wrong_labels(visits, usual);
  std::size_t all = 0;
  for (const auto& [name, own] : visits) all += own.size();
  // Of more it is something else that is wrong.
  const double most = std::max(1.0, kMostLeftOut * static_cast<double>(all));
  if (wrong.empty() || static_cast<double>(wrong.size()) > most) return;
  std::string evidence;
  for (std::size_t k = 0; k < std::min(kNamed, wrong.size()); ++k) {
    const WrongLabel& one = wrong[k];
    evidence += text::joined(k == 0 ? "" : ", ", one.read, " at t = ", text::short_text(one.t),
                             " s (", figure(one.off, "m"), " from where it is otherwise, where ",
                             one.right, " is)");
  }
  if (wrong.size() > kNamed) evidence += text::joined(", and ", wrong.size() - kNamed, " more");
  checked.note("sightings.csv", "landmark", "wrong label",
               text::joined("at least ", wrong.size(), " of ", all,
                            wrong.size() == 1 ? " sightings has" : " sightings have",
                            " another landmark's name: ", evidence),
               "correct the names or take the rows out; fits leave them out by themselves "
               "(--gate)");
}

}  // namespace trussmap::check
