// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/monitor.hpp"

#include "effects/simple_shapes.hpp"
#include "fit/online_odometry.hpp"
#include "monitor/change_detector.hpp"
#include "monitor/leg_filter.hpp"
#include "monitor/leg_odometry.hpp"
#include "trussmap/dead_reckoning.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace trussmap {
using namespace monitor;

namespace {

constexpr std::size_t kStartsKept = 24;
constexpr double kClip = 2.5;
constexpr double kAlike = 0.95;   // cosine
constexpr double kSpeaks = 0.05;  // share of the evidence: 20 to 1
constexpr double kSurely = 0.9;   // share of what speaks for a start
constexpr double kPerHour = 1.0 / 3600.0;

[[noreturn]] void refuse_monitor(const std::string& why) {
  throw std::invalid_argument("monitor: " + why);
}

/// Whether the end of a leg shows what acts on this channel.
bool is_seen(Channel channel, const Robot& robot) {
  return (effects::acts_on(channel) == effects::ActsOn::drives || channel == Channel::compass) &&
         effects::is_of_drive(channel, robot);
}

MonitorOptions checked_options(MonitorOptions options, const Model& model,
                               const OdometryInputs& inputs) {
  if (!(options.false_alarms_per_hour > 0.0) || !std::isfinite(options.false_alarms_per_hour)) {
    refuse_monitor("the rate of false alarms must be above 0 per hour");
  }
  if (!(options.noise_margin >= 1.0) || !std::isfinite(options.noise_margin)) {
    refuse_monitor("the noise margin must be 1 or more");
  }
  if (options.landmarks < 2) refuse_monitor("it has to keep 2 landmarks or more");
  if (options.effects.empty()) options.effects = watched_effects(model.robot, inputs);
  for (const WatchedEffect& one : options.effects) {
    if (!is_seen(one.channel, model.robot)) {
      refuse_monitor("\"" + one.name + "\" acts on channel " + std::string(name_of(one.channel)) +
                     ", which it does not see on this robot");
    }
    if (!(one.usual > 0.0) || !std::isfinite(one.usual)) {
      refuse_monitor("the usual size of \"" + one.name + "\" must be above 0");
    }
  }
  return options;
}

/// Lasting noise of the motion and the compass; that of readings of landmarks becomes white.
std::vector<NoiseProcess> lasting_processes(Noise& noise, const Robot& robot) {
  std::vector<NoiseProcess> result;
  for (const NoiseProcess& one : noise.processes) {
    if (one.channel == Channel::range) noise.range = std::hypot(noise.range, one.sd);
    if (one.channel == Channel::bearing) noise.bearing = std::hypot(noise.bearing, one.sd);
    if (one.sd > 0.0 && is_seen(one.channel, robot)) result.push_back(one);
  }
  return result;
}

std::vector<Channel> channels_followed(const std::vector<WatchedEffect>& effects,
                                       const std::vector<NoiseProcess>& lasting) {
  std::vector<Channel> result;
  result.reserve(effects.size() + lasting.size());
  for (const WatchedEffect& one : effects) result.push_back(one.channel);
  for (const NoiseProcess& one : lasting) result.push_back(one.channel);
  return result;
}

void check_end(const MeasuredEnd& end) {
  const auto finite = [](std::initializer_list<double> numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
  };
  for (const Sighting& one : end.sightings) {
    if (std::isinf(one.range) || std::isinf(one.bearing) || one.range < 0.0) {
      refuse_monitor("landmark " + one.landmark + " has a range or bearing that none can have");
    }
  }
  if (end.fix && (!finite({end.fix->x, end.fix->y}) || std::isinf(end.fix->sd))) {
    refuse_monitor("a fix is not finite");
  }
  if (end.pose && !finite({end.pose->x, end.pose->y, end.pose->heading})) {
    refuse_monitor("a pose is not finite");
  }
}

Matrix2 circle(double sd) {
  return sd * sd * Matrix2::Identity();
}

}  // namespace

class __attribute__((visibility("hidden"))) Monitor::State {
 public:
  State(const Model& model, const OdometryInputs& inputs, const MonitorOptions& options)
      : model_(model),
        noise_(model.noise),
        options_(checked_options(options, model, inputs)),
        lasting_(lasting_processes(noise_, model.robot)),
        odometry_(model, inputs),
        leg_(channels_followed(options_.effects, lasting_)),
        filter_(lasting_, options_.landmarks, effects() * Eigen::Index(kStartsKept + 1)),
        detector_({options_.false_alarms_per_hour, options_.noise_margin, kClip, kStartsKept},
                  usual_sizes()),
        reading_by_(Eigen::RowVectorXd::Zero(effects())) {
    for (Eigen::Index k = 0; k < effects(); ++k) {
      if (effect(k).channel == Channel::compass) reading_by_[k] = 1.0;
    }
  }

  void know(const SurveyPoint& point) {
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) {
      refuse_monitor("the place of landmark " + point.landmark + " is not finite");
    }
    const double sd = std::isnan(point.sd) ? noise_.survey : point.sd;
    surveyed_[point.landmark] = {{point.x, point.y}, circle(sd)};
  }

  CorrectedRow drive(const WheelRow& row, std::span<const double> covariates) {
    CorrectedRow result = odometry_.drive(row, covariates);
    const drive::RowMotion& shown = odometry_.shown();
    // The variance of the excess: the gyro's, and that of the wheels (wheels_and_gyro.hpp).
    const double gyro = noise_.gyro * noise_.gyro * shown.duration;
    const double variance = gyro / std::max(1.0 - shown.gyro_share, 1e-12);
    leg_.take(result.motion, shown, odometry_.reading(), odometry_.excess(), variance);
    return result;
  }

  const MonitorReport& arrive(const MeasuredEnd& end) {
    check_end(end);
    if (begun_ && !(leg_.duration() > 0.0)) {
      refuse_monitor("no row was driven since the last leg ended");
    }
    begun_ = true;
    const LegReckoning leg = leg_.finish();
    if (leg.duration > 0.0) ++report_.legs;
    report_.hours += leg.duration * kPerHour;
    begin_leg(leg);
    measure(leg, end);
    conclude();
    return report_;
  }

  [[nodiscard]] const MonitorReport& report() const { return report_; }
  [[nodiscard]] const Model& model() const { return model_; }

  Effect take_in() {
    if (!report_.found) throw std::logic_error("monitor: no effect has been found");
    const FoundEffect found = *report_.found;
    const Effect& effect = found.effect;
    const EffectSince since = detector_.likeliest(likeliest_effect());
    filter_.believe(static_cast<Eigen::Index>(since.start) * effects() +
                        static_cast<Eigen::Index>(since.effect),
                    effect.coefficients.front(), found.sd * found.sd, rest_of(effect, found.sd));
    go_on_with(effect, found.sd);
    return effect;
  }

  void add(const Effect& effect, double sd) {
    if (!effect.is_constant() || effect.coefficients.size() != 1 || !(sd >= 0.0)) {
      refuse_monitor("\"" + effect.name + "\" has to be a constant with one coefficient");
    }
    if (leg_.duration() > 0.0) throw std::logic_error("monitor: a leg is under way");
    odometry_.set_effects(with(effect));  // throws where the drive has no such effect
    filter_.expect(sd * sd, rest_of(effect, sd));
    go_on_with(effect, sd);
  }

 private:
  [[nodiscard]] std::vector<Effect> with(const Effect& effect) const {
    std::vector<Effect> all = model_.effects;
    all.push_back(effect);
    return all;
  }

  /// What is left of an effect: an error of unknown size that stays.
  [[nodiscard]] static NoiseProcess rest_of(const Effect& effect, double sd) {
    return {effect.channel, ProcessKind::per_session, sd};
  }

  void go_on_with(const Effect& effect, double sd) {
    lasting_.push_back(rest_of(effect, sd));
    model_.effects = with(effect);
    odometry_.set_effects(model_.effects);
    leg_ = LegOdometry(channels_followed(options_.effects, lasting_));
    detector_.clear();
    report_.evidence = 0.0;
    report_.alarm = false;
    report_.found.reset();
  }

  [[nodiscard]] Eigen::Index effects() const {
    return static_cast<Eigen::Index>(options_.effects.size());
  }
  [[nodiscard]] const WatchedEffect& effect(Eigen::Index k) const {
    return options_.effects[static_cast<std::size_t>(k)];
  }
  [[nodiscard]] std::vector<double> usual_sizes() const {
    std::vector<double> sizes;
    for (const WatchedEffect& one : options_.effects) sizes.push_back(one.usual);
    return sizes;
  }

  /// An effect may begin with this leg.
  void begin_leg(const LegReckoning& leg) {
    if (leg.duration > 0.0) {
      if (const auto gone = detector_.make_room()) {
        filter_.drop_columns(static_cast<Eigen::Index>(*gone) * effects(), effects());
      }
      detector_.begin(report_.legs, leg.duration * kPerHour);
      filter_.set_columns(static_cast<Eigen::Index>(detector_.starts()) * effects());
    }
    filter_.drive(leg, leg.by_channel.leftCols(effects()),
                  leg.by_channel.rightCols(leg.by_channel.cols() - effects()));
  }

  void measure(const LegReckoning& leg, const MeasuredEnd& end) {
    const LegFilter::Said said = [this](const Eigen::VectorXd& w, const Eigen::MatrixXd& columns) {
      detector_.take(w, columns);
    };
    if (leg.gyro_readings > 0) filter_.read_gyro(said);
    filter_.read_compass(leg, noise_.compass, reading_by_, said);
    for (const Sighting& sighting : end.sightings) {
      if (!sighting.locates()) continue;
      const CorrectedSighting clear = odometry_.corrected(sighting);
      LandmarkOffset offset = landmark_offset(clear.sighting, noise_);
      offset.offset_robot += clear.sensor_robot;
      const auto found = surveyed_.find(sighting.landmark);
      filter_.see(sighting.landmark, offset, found == surveyed_.end() ? nullptr : &found->second,
                  said);
    }
    if (end.fix) {
      const double sd = std::isnan(end.fix->sd) ? noise_.fix : end.fix->sd;
      filter_.know_place({{end.fix->x, end.fix->y}, circle(sd)}, said);
    }
    if (end.pose) {
      filter_.know_place({{end.pose->x, end.pose->y}, circle(noise_.truth)}, said);
      filter_.know_heading(end.pose->heading, noise_.truth_heading * noise_.truth_heading, said);
    }
  }

  void conclude() {
    report_.evidence = detector_.evidence();
    if (detector_.starts() == 0) return;
    find();
    if (report_.alarm || report_.evidence < 1.0 || !report_.found) return;
    report_.alarm = true;  // it has a name
    detector_.alarmed(report_.legs);
  }

  void find() {
    shares_ = detector_.shares();
    const EffectSince since = detector_.likeliest(likeliest_effect());
    report_.found.reset();
    if (!(since.sd > 0.0)) return;
    const WatchedEffect& watched = options_.effects[since.effect];
    FoundEffect found;
    found.effect = {
        watched.name, watched.channel, {effects::constant_shape()}, {since.coefficient}};
    found.sd = since.sd;
    found.share = shares_[since.effect];
    found.leg = since.leg;
    std::tie(found.earliest, found.latest) = detector_.since(since.effect, kSurely);
    for (std::size_t k = 0; k < options_.effects.size(); ++k) {
      const double cosine = detector_.cosine(since.start, since.effect, k);
      if (k == since.effect || (std::abs(cosine) < kAlike && shares_[k] < kSpeaks)) continue;
      found.look_alikes.push_back({options_.effects[k].name, cosine, shares_[k]});
    }
    std::stable_sort(found.look_alikes.begin(), found.look_alikes.end(),
                     [](const auto& a, const auto& b) { return a.share > b.share; });
    report_.found = std::move(found);
  }

  [[nodiscard]] std::size_t likeliest_effect() const {
    return static_cast<std::size_t>(std::max_element(shares_.begin(), shares_.end()) -
                                    shares_.begin());
  }

  Model model_;
  Noise noise_;
  MonitorOptions options_;
  std::vector<NoiseProcess> lasting_;
  fitting::OnlineOdometry odometry_;
  LegOdometry leg_;
  LegFilter filter_;
  ChangeDetector detector_;
  Eigen::RowVectorXd reading_by_;
  std::map<std::string, MapPlace, std::less<>> surveyed_;
  std::vector<double> shares_;
  bool begun_ = false;
  MonitorReport report_;
};

Monitor::Monitor(const Model& model, const OdometryInputs& inputs, const MonitorOptions& options)
    : state_(std::make_unique<State>(model, inputs, options)) {}
Monitor::~Monitor() = default;
Monitor::Monitor(Monitor&&) noexcept = default;
Monitor& Monitor::operator=(Monitor&&) noexcept = default;

void Monitor::know(const SurveyPoint& point) {
  state_->know(point);
}
CorrectedRow Monitor::drive(const WheelRow& row, std::span<const double> covariates) {
  return state_->drive(row, covariates);
}
MonitorReport Monitor::arrive(const MeasuredEnd& end) {
  return state_->arrive(end);
}
const MonitorReport& Monitor::report() const {
  return state_->report();
}
Effect Monitor::take_in() {
  return state_->take_in();
}
void Monitor::add(const Effect& effect, double sd) {
  state_->add(effect, sd);
}
const Model& Monitor::model() const {
  return state_->model();
}

}  // namespace trussmap
