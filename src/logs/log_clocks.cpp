// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The offset at which two motions are alike: by the correlation of what they are over windows, over
// all offsets at which they meet, then finer and finer around the best.
#include "logs/log_motion.hpp"
#include "trussmap/recording.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace trussmap::logs {
namespace {

constexpr std::size_t kMostWindows = 4000;
constexpr double kLeastWindow = 0.2;  // s
constexpr double kPerWindow = 4.0;    // windows over each other, in the fine search

/// LoggedMotion in windows next to each other, without their mean; NaN where it has none.
std::vector<double> windows_of(const LoggedMotion& motion, double start, double window,
                               std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double from = start + window * static_cast<double>(k);
    values[k] = motion.between(from, from + window);
  }
  return values;
}

/// Correlation of a[k] and b[k + shift] where both are, and how many of these there are.
struct Likeness {
  double r = 0.0;
  std::size_t n = 0;
};

class Sums {
 public:
  void add(double a, double b) {
    if (!(a == a) || !(b == b)) return;
    n_ += 1.0;
    a_ += a;
    b_ += b;
    aa_ += a * a;
    ab_ += a * b;
    bb_ += b * b;
  }
  [[nodiscard]] Likeness likeness() const {
    const double aa = n_ * aa_ - a_ * a_;
    const double bb = n_ * bb_ - b_ * b_;
    constexpr double kTiny = 1e-12;
    const bool vary = aa > kTiny * n_ * aa_ && bb > kTiny * n_ * bb_;
    return {vary ? (n_ * ab_ - a_ * b_) / std::sqrt(aa * bb) : 0.0, static_cast<std::size_t>(n_)};
  }

 private:
  double n_ = 0.0, a_ = 0.0, b_ = 0.0, aa_ = 0.0, ab_ = 0.0, bb_ = 0.0;
};

Likeness likeness_at(const std::vector<double>& a, const std::vector<double>& b,
                     std::ptrdiff_t shift) {
  Sums sums;
  const auto na = static_cast<std::ptrdiff_t>(a.size());
  const auto nb = static_cast<std::ptrdiff_t>(b.size());
  const std::ptrdiff_t end = std::min(na, nb - shift);
  for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(0, -shift); k < end; ++k) {
    sums.add(a[static_cast<std::size_t>(k)], b[static_cast<std::size_t>(k + shift)]);
  }
  return sums.likeness();
}

struct Search {
  const LoggedMotion* a;
  const LoggedMotion* b;
  double window = kLeastWindow;  ///< s
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();  ///< part of a that is looked at, s

  /// With `offset` added to b's times.
  [[nodiscard]] Likeness at(double offset) const {
    const double begin = std::max({a->first(), b->first() + offset, from});
    const double end = std::min({a->last(), b->last() + offset, to});
    Sums sums;
    const double step =
        std::max(window / kPerWindow, (end - begin) / static_cast<double>(kMostWindows));
    for (double t = begin; t + window <= end; t += step) {
      sums.add(a->between(t, t + window), b->between(t - offset, t + window - offset));
    }
    return sums.likeness();
  }
};

/// The coarse offset with the largest likeness, and the next one that is not beside it.
struct Peak {
  double offset = 0.0;
  double r = 0.0;
  double next = 0.0;
};

std::optional<Peak> best_peak(const LoggedMotion& a, const LoggedMotion& b, double window) {
  const auto count = [window](const LoggedMotion& one) {
    return static_cast<std::size_t>((one.last() - one.first()) / window);
  };
  const std::size_t na = count(a);
  const std::size_t nb = count(b);
  constexpr std::size_t kFew = 20;
  if (na < kFew || nb < kFew) return std::nullopt;
  const std::vector<double> va = windows_of(a, a.first(), window, na);
  const std::vector<double> vb = windows_of(b, b.first(), window, nb);
  // Short overlaps are alike by chance.
  const auto least = static_cast<double>(std::min(na, nb)) * 0.4;
  const auto first = -static_cast<std::ptrdiff_t>(na);
  const auto last = static_cast<std::ptrdiff_t>(nb);
  std::vector<double> likeness;
  for (std::ptrdiff_t shift = first; shift <= last; ++shift) {
    const Likeness one = likeness_at(va, vb, shift);
    likeness.push_back(static_cast<double>(one.n) < least ? 0.0 : one.r);
  }
  const auto larger = [](double x, double y) { return std::abs(x) < std::abs(y); };
  const auto best = std::max_element(likeness.begin(), likeness.end(), larger);
  Peak peak;
  peak.r = *best;
  const auto shift = first + (best - likeness.begin());
  peak.offset = a.first() - b.first() - window * static_cast<double>(shift);
  // Down both sides, as far as it falls.
  auto left = best;
  while (left != likeness.begin() && std::abs(*(left - 1)) < std::abs(*left)) --left;
  auto right = best;
  while (right + 1 != likeness.end() && std::abs(*(right + 1)) < std::abs(*right)) ++right;
  for (auto one = likeness.begin(); one != likeness.end(); ++one) {
    if (one < left || one > right) peak.next = std::max(peak.next, std::abs(*one));
  }
  return peak;
}

/// Climbs from within `reach` of a coarse offset; the height's bend there per s^2.
struct Fine {
  double offset = 0.0;
  Likeness likeness;
  double bend = 0.0;
};

Fine climb(const Search& search, double offset, double reach, double sign) {
  constexpr int kSteps = 4;
  constexpr double kFinest = 1e-4;  // s
  const auto height = [&](double at) { return sign * search.at(at).r; };
  for (double step = reach / kSteps; step > kFinest; step /= kSteps) {
    double best = offset;
    double highest = height(offset);
    for (int k = -kSteps; k <= kSteps; ++k) {
      const double at = offset + step * k;
      if (const double h = height(at); h > highest) {
        highest = h;
        best = at;
      }
    }
    offset = best;
  }
  // The bend over a distance at which rounding and the samples' steps do not matter.
  const double beside = std::max(0.25 * search.window, 20.0 * kFinest);
  const double bend = (2.0 * height(offset) - height(offset - beside) - height(offset + beside)) /
                      (beside * beside);
  return {offset, search.at(offset), bend};
}

/// sd of the place of the highest likeness: what is left over, n windows of it, against the bend.
/// Between samples motion is interpolated, which a twentieth of a step allows for.
double sd_of(const Fine& fine, const Search& search) {
  const double r = std::abs(fine.likeness.r);
  const double n = std::max(1.0, static_cast<double>(fine.likeness.n) / kPerWindow);
  const double least = std::max(1e-3, 0.05 * std::max(search.a->step(), search.b->step()));  // s
  if (!(fine.bend > 0.0)) return std::numeric_limits<double>::infinity();
  return std::max(least, std::sqrt(std::max(0.0, 1.0 - r * r) / (n * fine.bend * r)));
}

double drift_of(Search search, const Fine& whole, double sd) {
  const double begin = std::max(search.a->first(), search.b->first() + whole.offset);
  const double end = std::min(search.a->last(), search.b->last() + whole.offset);
  const double middle = 0.5 * (begin + end);
  const double sign = whole.likeness.r < 0.0 ? -1.0 : 1.0;
  const double reach = std::max(0.5, search.window);
  search.to = middle;
  const Fine early = climb(search, whole.offset, reach, sign);
  search.from = middle;
  search.to = std::numeric_limits<double>::infinity();
  const Fine late = climb(search, whole.offset, reach, sign);
  const double apart = late.offset - early.offset;
  const double scatter = std::hypot(sd_of(early, search), sd_of(late, search));
  constexpr double kPlain = 5.0;
  constexpr double kMuch = 0.02;  // s
  const double least = std::max({kPlain * scatter, kPlain * sd, kMuch});
  return std::abs(apart) > least ? apart / (0.5 * (end - begin)) : 0.0;
}

std::string called(const LoggedMotion& motion) {
  return (motion.turns ? "turns of the " : "speeds of the ") + motion.what;
}

std::optional<ClockOffset> offset_by(const LoggedMotion& a, const LoggedMotion& b) {
  const double longest =
      std::max(a.last() - a.first(), b.last() - b.first()) / static_cast<double>(kMostWindows);
  double window = std::max({kLeastWindow, 2.0 * a.step(), 2.0 * b.step()});
  if (!a.turns) window = std::max(window, 1.0);
  const auto peak = best_peak(a, b, std::max(window, longest));
  constexpr double kClear = 0.5;
  constexpr double kAhead = 0.05;  // of the next
  if (!peak || std::abs(peak->r) < kClear || (!a.turns && peak->r < 0.0)) return std::nullopt;
  if (std::abs(peak->r) - peak->next < kAhead) return std::nullopt;
  const Search search{&a, &b, window};
  const double sign = peak->r < 0.0 ? -1.0 : 1.0;
  const Fine fine = climb(search, peak->offset, std::max(window, longest), sign);
  const double sd = sd_of(fine, search);
  constexpr double kAlike = 0.7;
  if (std::abs(fine.likeness.r) < kAlike || !std::isfinite(sd)) return std::nullopt;
  const auto held = [](const LoggedMotion& one) { return one.held ? 0.5 * one.step() : 0.0; };
  return ClockOffset{fine.offset,     std::hypot(sd, held(a), held(b)),
                     fine.likeness.r, drift_of(search, fine, sd),
                     called(b),       called(a)};
}

}  // namespace

std::optional<ClockOffset> clock_offset(const std::vector<LoggedMotion>& first,
                                        const std::vector<LoggedMotion>& second) {
  for (const bool turns : {true, false}) {
    std::optional<ClockOffset> best;
    for (const LoggedMotion& a : first) {
      for (const LoggedMotion& b : second) {
        if (a.turns != turns || b.turns != turns) continue;
        const auto found = offset_by(a, b);
        const bool liker = found && (!best || std::abs(found->likeness) > std::abs(best->likeness));
        if (liker) best = found;
      }
    }
    if (best) return best;
  }
  return std::nullopt;
}

}  // namespace trussmap::logs
