// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/noise_fit.hpp"

#include "effects/channel_record.hpp"
#include "fit/noise_fit.hpp"
#include "fit/noise_reml.hpp"
#include "fit/noise_screening.hpp"
#include "linalg/dense.hpp"
#include "statistics/distributions.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace trussmap {
namespace {

constexpr double kWorthFitting = 2.0;  // sds of a score
constexpr double kAsStated = 10.0;     // -2 log R: p = 0.0016
constexpr double kStays = 10.0;        // -2 log R
constexpr double kAlmostNothing = 1e-4;
constexpr double kNegligible = 0.05;    // of a size
constexpr double kLeastOfStated = 2.0;  // times smaller a white size may be
constexpr double kLeastBesideAProcess = 8.0;
constexpr double kLongest = 60.0;      // s or m: what lasts longer is an effect, and no noise
constexpr double kLongestShare = 0.1;  // of all that was recorded
constexpr double kLongestOfViews = 10.0;
constexpr double kOfALength = 3.0;   // -2 log R that it has to bring: the plainer is likelier
constexpr double kStep = 1e-3;       // of a logarithm, for slopes
constexpr double kWideStep = 0.05;   // the same, for curvatures
constexpr double kLeastGain = 1e-3;  // of -2 log R, to go on for
constexpr double kRoughly = 0.05;    // the same, to compare processes
constexpr double kMostOfALaw = 1.0;  // rad/s^(1/2), rad/rad^(1/2), m/s^(1/2)
constexpr double kLeastInformation = 1e-2;  // of a logarithm

/// Sizes of components as logarithms: all sds that are free, then the lengths.
struct Parameters {
  struct Place {
    std::size_t component = 0;
    bool length = false;
  };
  std::vector<Place> places;
  NoiseReml::Sizes sizes;

  [[nodiscard]] Eigen::VectorXd values() const {
    Eigen::VectorXd x(static_cast<Eigen::Index>(places.size()));
    for (std::size_t k = 0; k < places.size(); ++k) {
      x[static_cast<Eigen::Index>(k)] = std::log(at(places[k]));
    }
    return x;
  }
  [[nodiscard]] NoiseReml::Sizes with(const Eigen::VectorXd& x) const {
    NoiseReml::Sizes result = sizes;
    for (std::size_t k = 0; k < places.size(); ++k) {
      auto& list = places[k].length ? result.length : result.sd;
      list[places[k].component] = std::exp(x[static_cast<Eigen::Index>(k)]);
    }
    return result;
  }

 private:
  [[nodiscard]] double at(const Place& place) const {
    return place.length ? sizes.length[place.component] : sizes.sd[place.component];
  }
};

/// Estimates sizes, and finds which processes there are.
class NoiseFitter {
 public:
  NoiseFitter(NoiseReml& reml, const NoiseFitOptions& options)
      : fit_(reml.fit()),
        stated_(reml.stated()),
        options_(options),
        candidates_(candidate_components(fit_, stated_)),
        reml_(reml) {}

  FittedNoise run() {
    take_stated();
    choose();
    const double at_stated = deviance(sizes_);
    start_from_present();
    measure_extents();
    choose();
    best_ = deviance(sizes_);
    free_the_white();
    drop_superfluous();
    add_processes();
    FittedNoise result;
    result.tried = tried_;
    report(at_stated, result);
    return result;
  }

 private:
  struct Member {
    NoiseComponent component;
    bool free = false;
    double gain = 0.0;
    double p_value = 1.0;
  };

  void take_stated() {
    for (const NoiseComponent& one : white_components(fit_, stated_)) {
      take(one, one.stated, 0.0, false);
    }
    for (const NoiseComponent& one : processes_of(stated_)) {
      take(one, one.stated, one.process.length, true);
    }
  }

  /// What the fit was made with, where that is more than what was stated.
  void start_from_present() {
    const Noise& present = fit_.model.noise;
    for (std::size_t k = 0; k < members_.size(); ++k) {
      sizes_.sd[k] = size_in(present, members_[k].component);
    }
    for (const auto& more : {white_components(fit_, present), processes_of(present)}) {
      for (NoiseComponent one : more) {
        if (is_member(one)) continue;
        const double sd = one.stated;
        one.stated = 0.0;
        take(one, sd, one.process.length, true);
      }
    }
  }

  void take(const NoiseComponent& one, double sd, double length, bool free) {
    members_.push_back({one, free, 0.0, 1.0});
    sizes_.sd.push_back(sd);
    sizes_.length.push_back(length);
  }

  void choose() {
    std::vector<NoiseComponent> components;
    for (const Member& one : members_) components.push_back(one.component);
    reml_.choose(components);
  }

  double deviance(const NoiseReml::Sizes& sizes) {
    try {
      return reml_.minus_two_log(sizes);
    } catch (const NotPositiveDefinite&) {
      return std::numeric_limits<double>::infinity();
    }
  }

  /// How long lengths can be told from: between the pace of the instants and part of the whole.
  void measure_extents() {
    for (const Recording& one : fit_.recordings) {
      longest_time_ += one.drive.rows() > 0 ? one.drive.t.back() - one.drive.start() : 0.0;
    }
    double path = 0.0;
    for (const std::vector<SegmentRow>& rows : fit_.problem.segments) {
      for (const SegmentRow& row : rows) path += std::abs(row.path);
    }
    longest_way_ = path;
  }

  [[nodiscard]] Parameters parameters(const std::vector<bool>& free) const {
    Parameters result;
    result.sizes = sizes_;
    for (std::size_t k = 0; k < members_.size(); ++k) {
      if (free[k]) result.places.push_back({k, false});
    }
    for (std::size_t k = 0; k < members_.size(); ++k) {
      if (free[k] && sizes_.length[k] > 0.0) result.places.push_back({k, true});
    }
    return result;
  }

  /// Where a logarithm may go.
  [[nodiscard]] Eigen::VectorXd bounded(const Parameters& of, Eigen::VectorXd x) const {
    constexpr double kReach = 5.0;
    for (std::size_t k = 0; k < of.places.size(); ++k) {
      const Member& member = members_[of.places[k].component];
      double& value = x[static_cast<Eigen::Index>(k)];
      if (of.places[k].length) {
        const bool time = member.component.process.process == ProcessKind::correlated_in_t;
        const bool view = acts_on(member.component.process.channel) == ActsOn::views;
        const double limit = view ? kLongestOfViews : kLongest;
        const double most = std::min(limit, kLongestShare * (time ? longest_time_ : longest_way_));
        value = std::clamp(value, std::log(0.2), std::log(std::max(most, 0.4)));
      } else if (member.component.stated > 0.0) {
        const double stated = std::log(member.component.stated);
        const bool scattered = member.component.name == "compass";  // known from readings alone
        const bool beside = is_beside_a_process(of.places[k].component);
        const double least = std::log(beside ? kLeastBesideAProcess : kLeastOfStated);
        value = std::clamp(value, stated - (scattered ? kReach : least), stated + kReach);
      } else {
        // More than effects may be, noise is not either.
        const double scale = std::log(facts_scale(member.component));
        value = std::clamp(value, scale - 3.0 * kReach, scale);
      }
    }
    return x;
  }

  [[nodiscard]] static double facts_scale(const NoiseComponent& one) {
    return one.lasts() ? facts_of(one.process.channel).prior_sd : kMostOfALaw;
  }

  /// Quasi-Newton (BFGS) in the logarithms, from slopes by differences. Changes sizes_ and best_.
  void optimise(const std::vector<bool>& free, int most_steps, double least_gain = kLeastGain) {
    Parameters of = parameters(free);
    if (of.places.empty()) return;
    Eigen::VectorXd x = bounded(of, of.values());
    const Eigen::Index n = x.size();
    best_ = deviance(of.with(x));
    Eigen::VectorXd slope = slopes(of, x, best_);
    Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      inverse(k, k) = 1.0 / std::max(curvature(of, x, k), 1.0);
    }
    for (int step = 0; step < most_steps; ++step) {
      Eigen::VectorXd way = -(inverse * slope);
      constexpr double kFarthest = 1.5;
      way *= std::min(1.0, kFarthest / std::max(way.cwiseAbs().maxCoeff(), 1e-12));
      if (-slope.dot(way) < least_gain) break;
      Eigen::VectorXd next = x;
      double value = best_;
      for (int half = 0; half < 6; ++half, way *= 0.4) {
        next = bounded(of, x + way);
        value = deviance(of.with(next));
        if (value < best_) break;
      }
      if (!(value < best_)) break;
      const double gained = best_ - value;
      if (gained < least_gain) {
        x = next;
        best_ = value;
        break;
      }
      const Eigen::VectorXd after = slopes(of, next, value);
      const Eigen::VectorXd s = next - x;
      const Eigen::VectorXd y = after - slope;
      const double sy = s.dot(y);
      if (sy > 1e-10) {
        const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(n, n) - s * y.transpose() / sy;
        inverse = (left * inverse * left.transpose() + s * s.transpose() / sy).eval();
      }
      x = next;
      slope = after;
      best_ = value;
    }
    sizes_ = of.with(x);
  }

  [[nodiscard]] Eigen::VectorXd slopes(const Parameters& of, const Eigen::VectorXd& x,
                                       double value) {
    Eigen::VectorXd result(x.size());
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      Eigen::VectorXd moved = x;
      moved[k] += kStep;
      result[k] = (deviance(of.with(moved)) - value) / kStep;
    }
    return result;
  }

  /// What a log sd or length tells, roughly: 4 for each value that its source is checked by.
  [[nodiscard]] double curvature(const Parameters& of, const Eigen::VectorXd& x, Eigen::Index k) {
    Eigen::VectorXd up = x;
    Eigen::VectorXd down = x;
    up[k] += 4.0 * kWideStep;
    down[k] -= 4.0 * kWideStep;
    return (deviance(of.with(up)) + deviance(of.with(down)) - 2.0 * best_) /
           std::pow(4.0 * kWideStep, 2);
  }

  [[nodiscard]] std::vector<bool> free_ones() const {
    std::vector<bool> free;
    for (const Member& one : members_) free.push_back(one.free);
    return free;
  }

  // ----------------------------------------
  // White sizes: other than stated only where the likelihood insists.

  void free_the_white() {
    for (Member& one : members_) one.free = true;
    optimise(free_ones(), 12);
    keep_stated_where_possible();
  }

  void keep_stated_where_possible() {
    bool kept = false;
    for (std::size_t k = 0; k < members_.size(); ++k) {
      Member& one = members_[k];
      if (one.component.lasts() || one.component.stated == 0.0 || is_beside_a_process(k)) continue;
      NoiseReml::Sizes as_stated = sizes_;
      as_stated.sd[k] = one.component.stated;
      const double value = deviance(as_stated);
      one.gain = value - best_;
      const double off = std::abs(std::log(sizes_.sd[k] / one.component.stated));
      if (one.gain >= kAsStated && off > kNegligible) continue;
      sizes_ = as_stated;
      best_ = value;
      one.gain = 0.0;
      one.free = false;
      kept = true;
    }
    const std::vector<bool> free = free_ones();
    if (kept && std::find(free.begin(), free.end(), true) != free.end()) optimise(free, 12);
  }

  /// A process takes its part of what the white source of its sensor had.
  [[nodiscard]] bool is_beside_a_process(std::size_t k) const {
    return std::any_of(members_.begin(), members_.end(), [&](const Member& one) {
      return one.component.lasts() && source_of(one.component) == members_[k].component.name;
    });
  }

  [[nodiscard]] static std::string source_of(const NoiseComponent& one) {
    return std::string(record_of(one.process.channel).noise_source);
  }

  // ----------------------------------------
  // Processes, one after the other.

  /// What an earlier fit took in, perhaps for an effect that it lacked, goes where it is no longer
  /// wanted.
  void drop_superfluous() {
    for (std::size_t k = members_.size(); k-- > 0;) {
      if (members_[k].component.stated > 0.0) continue;
      NoiseReml::Sizes without = sizes_;
      without.sd[k] *= kAlmostNothing;
      members_[k].gain = deviance(without) - best_;
      members_[k].p_value = p_value_of(members_[k].gain, members_[k].component);
      if (members_[k].gain >= kStays) continue;
      members_.erase(members_.begin() + static_cast<std::ptrdiff_t>(k));
      sizes_.sd.erase(sizes_.sd.begin() + static_cast<std::ptrdiff_t>(k));
      sizes_.length.erase(sizes_.length.begin() + static_cast<std::ptrdiff_t>(k));
      choose();
      best_ = deviance(sizes_);
      free_the_white();
    }
  }

  void add_processes() {
    for (std::size_t round = 0; round < options_.most_processes; ++round) {
      if (!add_one()) return;
    }
  }

  bool add_one() {
    const std::vector<ScreenedNoise> screened = screen();
    if (round_ == 0) tried_ = static_cast<int>(screened.size());
    ++round_;
    // The likeliest few, each with its own size: the length of a kind that scores best stands for
    // it.
    std::vector<ScreenedNoise> worth;
    for (const ScreenedNoise& one : screened) {
      if (one.z < kWorthFitting) continue;
      const auto twin = std::find_if(worth.begin(), worth.end(), [&](const ScreenedNoise& other) {
        return other.component.name == one.component.name;
      });
      if (twin == worth.end()) {
        worth.push_back(one);
      } else if (one.z > twin->z) {
        *twin = one;
      }
    }
    std::sort(worth.begin(), worth.end(),
              [](const ScreenedNoise& a, const ScreenedNoise& b) { return a.z > b.z; });
    if (worth.size() > kMostFitted) worth.resize(kMostFitted);
    const std::vector<Member> members = members_;
    const NoiseReml::Sizes sizes = sizes_;
    const double before = best_;
    struct Tried {
      std::vector<Member> members;
      NoiseReml::Sizes sizes;
      double claim = 0.0;
    };
    std::optional<Tried> best;
    for (const ScreenedNoise& one : worth) {
      members_ = members;
      sizes_ = sizes;
      take(one.component, std::max(one.sd, 1e-9), one.component.process.length, true);
      for (std::size_t k = 0; k < members_.size(); ++k) {
        if (!members_[k].component.lasts() && is_beside_a_process(k)) members_[k].free = true;
      }
      choose();
      start_size(members_.size() - 1);
      optimise(with_its_sensor(members_.size() - 1), 10, kRoughly);
      const double value = best_ + (one.component.process.length > 0.0 ? kOfALength : 0.0);
      if (!best || value < best->claim) best = Tried{members_, sizes_, value};
    }
    if (best) {
      members_ = best->members;
      sizes_ = best->sizes;
      choose();
      optimise(free_ones(), 12);
      const double gain = before - best_;
      const double p = p_value_of(gain, members_.back().component);
      if (gain > 0.0 && p < options_.level) {
        members_.back().gain = gain;
        members_.back().p_value = p;
        return true;
      }
    }
    members_ = members;
    sizes_ = sizes;
    best_ = before;
    choose();
    return false;
  }

  /// A process and the white source that it takes its part of.
  [[nodiscard]] std::vector<bool> with_its_sensor(std::size_t k) const {
    std::vector<bool> free(members_.size(), false);
    free[k] = true;
    for (std::size_t other = 0; other < members_.size(); ++other) {
      if (members_[other].free &&
          members_[other].component.name == source_of(members_[k].component)) {
        free[other] = true;
      }
    }
    return free;
  }

  /// Half of chi^2's (a variance cannot be negative; Self & Liang 1987), times the kinds asked of:
  /// of one kind, lengths are as good as one.
  [[nodiscard]] double p_value_of(double gain, const NoiseComponent& one) const {
    const int dof = one.process.length > 0.0 ? 2 : 1;
    std::size_t kinds = 0;
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
      kinds += k == 0 || candidates_[k].name != candidates_[k - 1].name ? 1U : 0U;
    }
    return std::min(1.0, 0.5 * static_cast<double>(kinds) * chi2_p_value(std::max(gain, 0.0), dof));
  }

  /// The best of a few sds about the score's guess.
  void start_size(std::size_t k) {
    double best = std::numeric_limits<double>::infinity();
    const double guess = sizes_.sd[k];
    double at = guess;
    for (const double factor : {0.3, 1.0, 3.0}) {
      NoiseReml::Sizes tried = sizes_;
      tried.sd[k] = factor * guess;
      const double value = deviance(tried);
      if (value >= best) continue;
      best = value;
      at = tried.sd[k];
    }
    sizes_.sd[k] = at;
  }

  /// The candidates that are not there yet, asked of the present fit.
  std::vector<ScreenedNoise> screen() {
    static_cast<void>(deviance(sizes_));
    std::vector<NoiseComponent> present;
    for (std::size_t k = 0; k < members_.size(); ++k) {
      if (!members_[k].free) continue;
      present.push_back(members_[k].component);
      present.back().process.length = sizes_.length[k];
    }
    std::vector<NoiseComponent> asked = candidates_;
    std::erase_if(asked, [this](const NoiseComponent& one) { return is_member(one); });
    return screened_noise(fit_, reml_, asked, present);
  }

  [[nodiscard]] bool is_member(const NoiseComponent& one) const {
    return std::any_of(members_.begin(), members_.end(),
                       [&](const Member& member) { return member.component.name == one.name; });
  }

  // ----------------------------------------

  /// Whether a size or a length of the component would go further than it may.
  [[nodiscard]] bool at_limit(const Parameters& of, std::size_t component) const {
    constexpr double kBeyond = 1e-6;
    const Eigen::VectorXd x = of.values();
    const Eigen::VectorXd away = Eigen::VectorXd::Constant(x.size(), kBeyond);
    const Eigen::VectorXd less = bounded(of, x - away);
    const Eigen::VectorXd more = bounded(of, x + away);
    for (std::size_t k = 0; k < of.places.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      if (of.places[k].component != component) continue;
      if (less[at] > x[at] - 0.5 * kBeyond || more[at] < x[at] + 0.5 * kBeyond) return true;
    }
    return false;
  }

  void report(double stated, FittedNoise& result) {
    result.noise = stated_;
    Eigen::VectorXd errors;
    const Parameters of = parameters(free_ones());
    if (options_.errors && !of.places.empty()) errors = standard_errors(of);
    bool any = false;
    for (std::size_t k = 0; k < members_.size(); ++k) {
      const Member& one = members_[k];
      NoiseSource source;
      source.name = one.component.name;
      source.lasts = one.component.lasts();
      source.process = one.component.process;
      source.process.sd = sizes_.sd[k];
      source.process.length = sizes_.length[k];
      source.unit = one.component.unit;
      source.stated = one.component.stated;
      source.sd = sizes_.sd[k];
      source.gain = one.gain;
      source.p_value = one.p_value;
      for (std::size_t place = 0; place < of.places.size(); ++place) {
        if (of.places[place].component != k || errors.size() == 0) continue;
        const double error = errors[static_cast<Eigen::Index>(place)];
        (of.places[place].length ? source.length_error : source.sd_error) =
            error * (of.places[place].length ? sizes_.length[k] : sizes_.sd[k]);
      }
      source.at_limit = one.free && at_limit(of, k);
      result.sources.push_back(source);
      if (!one.free) continue;
      any = true;
      take_into(result.noise, one.component, sizes_.sd[k], sizes_.length[k]);
    }
    result.gain = any ? std::max(0.0, stated - best_) : 0.0;
    for (NoiseSource& one : result.sources) one.gain = std::min(one.gain, result.gain);
  }

  /// Of the logarithms. The readings' scatter and the adjustment see the same errors of the wheels,
  /// each in its own way, and what both say is no more than once true: the scores' covariance is
  /// taken as if they went together wherever they can (Godambe 1960; Varin, Reid & Firth 2011, on
  /// composite likelihoods), H^-1 J H^-1 with J = A + S + A^(1/2) S^(1/2) + S^(1/2) A^(1/2).
  [[nodiscard]] Eigen::VectorXd standard_errors(const Parameters& of) {
    const Eigen::VectorXd x = of.values();
    const auto scatter = [&](const Eigen::VectorXd& at) { return reml_.scatter(of.with(at)); };
    const auto whole = [&](const Eigen::VectorXd& at) { return deviance(of.with(at)); };
    // -2 log is twice the information.
    const Eigen::MatrixXd H = 0.5 * curvatures(whole, x);
    const Eigen::MatrixXd S = 0.5 * curvatures(scatter, x);
    const Eigen::MatrixXd both = square_root(H - S) * square_root(S);
    const Eigen::MatrixXd J = H + both + both.transpose();
    const SymmetricModes modes = symmetric_modes(H);
    const Eigen::VectorXd information = modes.eigenvalues.cwiseMax(kLeastInformation);
    const Eigen::MatrixXd inverse = modes.eigenvectors * information.cwiseInverse().asDiagonal() *
                                    modes.eigenvectors.transpose();
    const Eigen::VectorXd variances = (inverse * J * inverse).diagonal();
    return variances.cwiseMax(inverse.diagonal()).cwiseSqrt();
  }

  /// Second derivatives, by differences.
  template <typename Function>
  [[nodiscard]] static Eigen::MatrixXd curvatures(const Function& function,
                                                  const Eigen::VectorXd& x) {
    constexpr double h = kWideStep;
    const Eigen::Index n = x.size();
    const double middle = function(x);
    Eigen::VectorXd up(n);
    Eigen::MatrixXd H(n, n);
    const auto at = [&](Eigen::Index a, double by_a, Eigen::Index b, double by_b) {
      Eigen::VectorXd moved = x;
      moved[a] += by_a;
      moved[b] += by_b;
      return function(moved);
    };
    for (Eigen::Index a = 0; a < n; ++a) {
      up[a] = at(a, h, a, 0.0);
      H(a, a) = (up[a] + at(a, -h, a, 0.0) - 2.0 * middle) / (h * h);
      for (Eigen::Index b = 0; b < a; ++b) {
        H(a, b) = H(b, a) = (at(a, h, b, h) - up[a] - up[b] + middle) / (h * h);
      }
    }
    return H;
  }

  /// Of a matrix that may have slightly negative eigenvalues.
  [[nodiscard]] static Eigen::MatrixXd square_root(const Eigen::MatrixXd& matrix) {
    const SymmetricModes modes = symmetric_modes(matrix);
    return modes.eigenvectors * modes.eigenvalues.cwiseMax(0.0).cwiseSqrt().asDiagonal() *
           modes.eigenvectors.transpose();
  }

  static constexpr std::size_t kMostFitted = 4;

  const FitState& fit_;
  const Noise& stated_;
  const NoiseFitOptions& options_;
  std::vector<NoiseComponent> candidates_;
  NoiseReml& reml_;
  std::vector<Member> members_;
  NoiseReml::Sizes sizes_;
  double best_ = 0.0;
  double longest_time_ = 0.0;  ///< s
  double longest_way_ = 0.0;   ///< m
  int tried_ = 0;
  int round_ = 0;
};

constexpr double kStillBetter = 1.0;  // of -2 log R

}  // namespace

FittedNoise fit_noise(NoiseReml& reml, const Eigen::MatrixXd& nuisance,
                      const NoiseFitOptions& options) {
  reml.set_nuisance(nuisance);
  return NoiseFitter(reml, options).run();
}

double minus_two_log_under(NoiseReml& reml, const Noise& noise, const Eigen::MatrixXd& columns) {
  reml.set_nuisance(columns);
  const FitState& fit = reml.fit();
  std::vector<NoiseComponent> components = white_components(fit, reml.stated());
  for (const auto& more : {white_components(fit, noise), processes_of(noise)}) {
    for (NoiseComponent one : more) {
      const bool known =
          std::any_of(components.begin(), components.end(),
                      [&one](const NoiseComponent& other) { return other.name == one.name; });
      if (known) continue;
      one.stated = 0.0;
      components.push_back(one);
    }
  }
  NoiseReml::Sizes sizes;
  for (const NoiseComponent& one : components) {
    sizes.sd.push_back(size_in(noise, one));
    sizes.length.push_back(one.process.length);
  }
  reml.choose(components);
  return reml.minus_two_log_at_best(sizes);
}

FittedNoise fit_noise(const ModelFit& fit, const NoiseFitOptions& options) {
  NoiseReml reml(*fit.state, fit.model.noise);
  return fit_noise(reml, Eigen::MatrixXd(), options);
}

FitWithNoise fit_model_and_noise(const std::vector<Recording>& recordings, const Model& model,
                                 const FitOptions& fit, const NoiseFitOptions& options) {
  constexpr int kMostRounds = 3;
  FitWithNoise result{fit_model(recordings, model, fit), {}};
  double log_likelihood = 0.0;
  for (int round = 0; round < kMostRounds; ++round) {
    NoiseReml reml(*result.fit.state, model.noise);
    result.noise = fit_noise(reml, Eigen::MatrixXd(), options);
    if (!result.noise.changed() || result.noise.gain - log_likelihood < kStillBetter) break;
    log_likelihood = result.noise.gain;
    Model better = result.fit.model;
    better.noise = result.noise.noise;
    result.fit = refit(recordings, better, result.fit);
  }
  return result;
}

}  // namespace trussmap
