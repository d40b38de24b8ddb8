// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/column_builder.hpp"

#include "drive/row_motion.hpp"
#include "estimation/measurement_rows.hpp"
#include "estimation/student_tails.hpp"
#include "parallel/parallel_for.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace trussmap::fitting {
namespace {

using Instant = ShapeContext::Instant;

constexpr std::size_t kValuesKept = 24'000'000;  // numbers, of shapes
constexpr std::size_t kBasesKept = 4'000'000;    // of channels
constexpr std::size_t kAtOnce = 16;              // segments

/// Shape and session (-1: all) of each of an effect's coefficients.
struct Part {
  const Shape& shape;
  int session;
};

std::vector<Part> parts_of(const Effect& effect, std::size_t sessions) {
  std::vector<Part> parts;
  const bool apart = effect.per_session && sessions > 1;
  for (std::size_t s = 0; s < (apart ? sessions : 1); ++s) {
    for (const Shape& shape : effect.shape) {
      parts.push_back({shape, apart ? static_cast<int>(s) : -1});
    }
  }
  return parts;
}

Instant instant_of(estimation::RecordingStream stream) {
  using enum estimation::RecordingStream;
  switch (stream) {
    case truth:
      return Instant::truth;
    case fixes:
      return Instant::fix;
    case loops:
      return Instant::loop;
    case drive:
    case sightings:
    case survey:
      break;
  }
  return Instant::sighting;
}

/// Where a channel's shapes are asked for.
std::vector<Instant> instants_of(Channel channel) {
  if (effects::acts_on(channel) == effects::ActsOn::readings) return {Instant::end};
  if (effects::acts_on(channel) != effects::ActsOn::views) return {Instant::middle};
  std::vector<Instant> instants;
  if (effects::acts_on_sightings(channel)) instants.push_back(Instant::sighting);
  if (effects::acts_on_truth(channel)) instants.push_back(Instant::truth);
  if (effects::acts_on_fixes(channel)) instants.push_back(Instant::fix);
  if (effects::acts_on_loops(channel)) instants.push_back(Instant::loop);
  return instants;
}

bool is_of_rows(Instant at) {
  return at == Instant::middle || at == Instant::end;
}

}  // namespace

ColumnBuilder::ColumnBuilder(const ShapeContext& context,
                             const estimation::RecordingProblem& problem,
                             const estimation::EffectParameters& border,
                             const Eigen::VectorXd& offsets,
                             const estimation::RecordingState& state,
                             const std::vector<double>& weights)
    : context_(context), segment_rows_(std::make_shared<std::vector<Row>>()) {
  std::size_t count = 0;
  for (const estimation::Measurement& one : problem.measurements) {
    if (estimation::is_driven(one)) count += problem.segments[one.source].size();
  }
  segment_rows_->reserve(count);
  struct Driven {
    const std::vector<estimation::SegmentRow>* rows;
    std::size_t session;
    std::size_t first;
  };
  std::vector<Driven> driven;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const estimation::Measurement& one = problem.measurements[k];
    const estimation::Matrix4 W =
        std::sqrt(weights[k] * estimation::tail_information(one.tails, one.rows)) * one.whitener;
    if (estimation::is_segment(one)) {
      const std::vector<estimation::SegmentRow>& rows = problem.segments[one.source];
      const std::size_t first = segment_rows_->size();
      segments_.push_back(
          {rows_, one.rows, idx(one.session), first, first + rows.size(), 0, 0, false, -W});
      segment_rows_->resize(first + rows.size());
      driven.push_back({&rows, idx(one.session), first});
    } else if (estimation::is_driven(one)) {
      add_gyro(problem, one, W);
    } else if (one.session >= 0 && !estimation::is_tie(one)) {
      const effects::ViewPattern view = estimation::view_of(border, offsets, one);
      const estimation::MeasurementRows rows =
          estimation::measurement_rows(problem, one, state, one.value, view);
      views_.push_back({rows_, one.rows, idx(one.session), one.source,
                        instant_of(one.kind->facts().stream), W * rows.by_view});
    }
    rows_ += one.rows;
  }
  rows_ += static_cast<int>(problem.noise_states.size());
  const std::vector<std::vector<effects::DrivePattern>> effects =
      estimation::summed_patterns(border, offsets, context.recordings().size());
  parallel::parallel_for(driven.size(), [&](std::size_t k) {
    const Driven& one = driven[k];
    const std::vector<estimation::Matrix4> influences =
        estimation::row_influences(estimation::with_effects(*one.rows, effects[one.session]));
    for (std::size_t row = 0; row < influences.size(); ++row) {
      const estimation::Matrix4& I = influences[row];
      (*segment_rows_)[one.first + row] = {(*one.rows)[row].row,
                                           I.block<2, 1>(0, 0),
                                           I.block<2, 1>(0, 2),
                                           I(2, 2),
                                           I(3, 2),
                                           I(3, 3)};
    }
  });
  take_training_segments();
}

void ColumnBuilder::add_gyro(const estimation::RecordingProblem& problem,
                             const estimation::Measurement& one, const estimation::Matrix4& W) {
  const std::vector<estimation::SegmentRow>& rows = problem.segments[one.source];
  const std::vector<estimation::Vector4>& weights = problem.gyro_weights[one.source];
  Segment segment{rows_, one.rows, idx(one.session), segment_rows_->size(), 0, 0, 0, true, -W};
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const estimation::Vector4 excess = rows[row].part * weights[row];
    segment_rows_->push_back({rows[row].row, excess.head<2>(), excess.tail<2>()});
  }
  segment.row_end = segment_rows_->size();
  segments_.push_back(segment);
}

ColumnBuilder ColumnBuilder::coarsened(double seconds) const {
  ColumnBuilder result = *this;
  result.joint_ = seconds;
  result.bases_.clear();
  result.thinned_.clear();
  result.values_.clear();
  result.largest_.clear();
  result.take_training_segments();
  return result;
}

void ColumnBuilder::forget() {
  bases_.clear();
  thinned_.clear();
  values_.clear();
}

void ColumnBuilder::take_training_segments() {
  training_segments_.clear();
  middles_.assign(context_.recordings().size(), {});
  for (Segment& segment : segments_) take_training_segments(segment);
}

void ColumnBuilder::take_training_segments(Segment& segment) {
  const std::vector<Row>& rows = *segment_rows_;
  const MotionRows& drive = context_.recordings()[segment.session].drive;
  std::vector<std::size_t>& middles = middles_[segment.session];
  segment.begin = training_segments_.size();
  for (std::size_t k = segment.row_begin; k < segment.row_end;) {
    Stretch stretch{static_cast<std::uint32_t>(rows[k].row), static_cast<std::uint32_t>(k),
                    static_cast<std::uint32_t>(k + 1)};
    if (joint_ > 0.0) {
      double time = drive.duration(rows[k].row);
      for (; stretch.end < segment.row_end; ++stretch.end) {
        time += drive.duration(rows[stretch.end].row);
        if (time > joint_) break;
      }
      stretch.place = static_cast<std::uint32_t>(middles.size());
      middles.push_back(rows[(stretch.begin + stretch.end) / 2].row);
    }
    training_segments_.push_back(stretch);
    k = stretch.end;
  }
  segment.end = training_segments_.size();
}

RowVariables ColumnBuilder::thinned(std::size_t session, Instant at) const {
  RowVariables result;
  for (const auto& [name, values] : context_.variables(session, at)) {
    std::vector<double>& some = result[name];
    some.reserve(middles_[session].size());
    for (const std::size_t row : middles_[session]) some.push_back(values[row]);
  }
  return result;
}

std::size_t ColumnBuilder::make_ready(const std::vector<Job>& jobs, std::size_t begin) {
  const std::size_t rows = std::max<std::size_t>(1, training_segments_.size());
  const std::size_t most_shapes = kValuesKept / rows;
  std::map<Evaluation, const Effect*> shapes;
  std::size_t end = begin;
  for (; end < jobs.size(); ++end) {
    const Job& job = jobs[end];
    std::map<Evaluation, const Effect*> own;
    for (const Instant at : instants_of(job.effect.channel)) {
      const Evaluation one(job.shape, at);
      if (!shapes.contains(one)) own.emplace(one, &job.effect);
    }
    if (shapes.size() + own.size() > most_shapes && end > begin) break;
    shapes.merge(own);
  }
  if (values_.size() + shapes.size() > most_shapes) {
    std::erase_if(values_, [&shapes](const auto& one) { return !shapes.contains(one.first); });
  }
  evaluate(shapes);
  return end;
}

void ColumnBuilder::evaluate(const std::map<Evaluation, const Effect*>& wanted) {
  std::vector<std::pair<Evaluation, const Effect*>> missing;
  for (const auto& [one, effect] : wanted) {
    if (values_.contains(one)) continue;
    missing.emplace_back(one, effect);
    const Instant at = one.second;
    context_.prepare(at);
    if (joint_ == 0.0 || !is_of_rows(at)) continue;
    std::vector<RowVariables>& some = thinned_[at];
    for (std::size_t s = some.size(); s < middles_.size(); ++s) some.push_back(thinned(s, at));
  }
  std::vector<Values> values(missing.size());
  std::vector<std::vector<double>> largest(missing.size());
  parallel::parallel_for(missing.size(), [&](std::size_t k) {
    const auto& [one, effect] = missing[k];
    try {
      values[k] = evaluated(one);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("effect \"" + effect->name + "\": " + error.what());
    }
    for (const auto& session : values[k]) largest[k].push_back(largest_but_for_spikes(session));
  });
  for (std::size_t k = 0; k < missing.size(); ++k) {
    values_.emplace(missing[k].first, std::move(values[k]));
    largest_.insert_or_assign(missing[k].first, std::move(largest[k]));
  }
}

ColumnBuilder::Values ColumnBuilder::evaluated(const Evaluation& one) const {
  const auto& [shape, at] = one;
  if (joint_ == 0.0 || !is_of_rows(at)) return context_.values(shape, at);
  Values result;
  for (const RowVariables& session : thinned_.at(at)) result.push_back(shape.values(session));
  return result;
}

void ColumnBuilder::work_out(const Segment& segment,
                             std::span<const std::pair<Channel, double*>> wanted) const {
  for (std::size_t k = segment.begin; k < segment.end; ++k) {
    const std::size_t first = 4 * (k - segment.begin);
    for (const auto& [channel, columns] : wanted) std::fill_n(columns + first, 4, 0.0);
    for (std::size_t at = training_segments_[k].begin; at < training_segments_[k].end; ++at) {
      const Row& row = (*segment_rows_)[at];
      const drive::RowMotion motion = context_.motion(segment.session, row.row);
      for (const auto& [channel, columns] : wanted) {
        const effects::DrivePattern unit = effects::drive_pattern(channel, 1.0, motion);
        Eigen::Map<estimation::Vector4>(columns + first) +=
            segment.gyro ? estimation::Vector4(unit.excess * row.excess()) : row.times(unit);
      }
    }
  }
}

bool ColumnBuilder::make_room(const std::vector<Channel>& channels) {
  const std::size_t numbers = 4 * std::max<std::size_t>(1, training_segments_.size());
  const std::size_t most = kBasesKept / numbers;
  if (channels.size() > most) return false;
  const auto wanted = [&channels](Channel channel) {
    return std::find(channels.begin(), channels.end(), channel) != channels.end();
  };
  std::size_t further = channels.size();
  for (const auto& one : bases_) further -= wanted(one.first) ? 1U : 0U;
  if (bases_.size() + further > most) {
    std::erase_if(bases_, [&wanted](const auto& one) { return !wanted(one.first); });
  }
  for (const Channel channel : channels) bases_[channel];
  return true;
}

void ColumnBuilder::add_drives(std::span<const Job> jobs) {
  struct Summed {
    const Job& job;
    const Values& f;
    std::size_t channel;
  };
  std::vector<Channel> channels;
  std::vector<Summed> sums;
  for (const Job& job : jobs) {
    const Channel channel = job.effect.channel;
    if (effects::acts_on(channel) == effects::ActsOn::views) continue;
    const auto found = std::find(channels.begin(), channels.end(), channel);
    const auto place = static_cast<std::size_t>(found - channels.begin());
    if (found == channels.end()) channels.push_back(channel);
    sums.push_back({job, values_.at({job.shape, instants_of(channel).front()}), place});
  }
  if (sums.empty()) return;
  const bool kept = make_room(channels);
  std::vector<Eigen::Matrix4Xd*> bases;
  std::vector<bool> missing(channels.size(), true);
  for (std::size_t c = 0; kept && c < channels.size(); ++c) {
    bases.push_back(&bases_.at(channels[c]));
    missing[c] = bases[c]->cols() == 0;
    bases[c]->resize(4, static_cast<Eigen::Index>(training_segments_.size()));
  }
  parallel::parallel_ranges(segments_.size(), kAtOnce, [&](std::size_t first, std::size_t last) {
    std::vector<double> scratch;
    std::vector<double*> units(channels.size());
    std::vector<std::pair<Channel, double*>> wanted;
    for (std::size_t s = first; s < last; ++s) {
      const Segment& segment = segments_[s];
      const std::size_t numbers = 4 * (segment.end - segment.begin);
      if (!kept) scratch.resize(std::max(scratch.size(), numbers * channels.size()));
      wanted.clear();
      for (std::size_t c = 0; c < channels.size(); ++c) {
        units[c] = kept ? bases[c]->data() + 4 * segment.begin : scratch.data() + c * numbers;
        if (missing[c]) wanted.emplace_back(channels[c], units[c]);
      }
      if (!wanted.empty()) work_out(segment, wanted);
      for (const Summed& one : sums) {
        if (one.job.session >= 0 && segment.session != idx(one.job.session)) continue;
        const std::vector<double>& here = one.f[segment.session];
        const double* unit = units[one.channel];
        estimation::Vector4 sum = estimation::Vector4::Zero();
        for (std::size_t k = segment.begin; k < segment.end; ++k, unit += 4) {
          sum += here[training_segments_[k].place] * Eigen::Map<const estimation::Vector4>(unit);
        }
        one.job.columns.col(one.job.column).segment(segment.first_row, segment.rows) =
            (segment.W * sum).head(segment.rows);
      }
    }
  });
}

void ColumnBuilder::add_views(const Job& job, Eigen::Ref<Eigen::VectorXd> column) const {
  for (const Instant at : instants_of(job.effect.channel)) {
    const Values& f = values_.at({job.shape, at});
    for (const View& view : views_) {
      if (view.at != at) continue;
      if (job.session >= 0 && view.session != idx(job.session)) continue;
      const RowVariables& variables = context_.variables(view.session, at);
      const effects::ViewPattern unit = effects::view_pattern(
          job.effect.channel, f[view.session][view.source], variables.at("speed")[view.source],
          variables.at("turn_rate")[view.source]);
      const estimation::Vector4 rows = view.influence * unit.vector();
      for (int row = 0; row < view.rows; ++row) column[view.first_row + row] = rows[row];
    }
  }
}

std::vector<Eigen::MatrixXd> ColumnBuilder::columns(std::span<const Effect> effects) {
  std::vector<Eigen::MatrixXd> result(effects.size());
  std::vector<Job> jobs;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const std::vector<Part> parts = parts_of(effects[k], context_.recordings().size());
    result[k] = Eigen::MatrixXd::Zero(rows_, static_cast<Eigen::Index>(parts.size()));
    for (std::size_t c = 0; c < parts.size(); ++c) {
      jobs.push_back(
          {effects[k], parts[c].shape, parts[c].session, static_cast<Eigen::Index>(c), result[k]});
    }
  }
  for (std::size_t begin = 0; begin < jobs.size();) {
    const std::size_t end = make_ready(jobs, begin);
    add_drives(std::span(jobs).subspan(begin, end - begin));
    parallel::parallel_for(end - begin, [&](std::size_t k) {
      const Job& job = jobs[begin + k];
      if (effects::acts_on(job.effect.channel) != effects::ActsOn::views) return;
      add_views(job, job.columns.col(job.column));
    });
    begin = end;
  }
  return result;
}

std::vector<double> ColumnBuilder::largest(const Effect& effect) {
  const Channel channel = effect.channel;
  std::vector<double> result;
  for (const Part& part : parts_of(effect, context_.recordings().size())) {
    if (adds_to_rows(channel, part.shape)) {
      result.push_back(size_of_additions(channel, part.shape, part.session, context_));
      continue;
    }
    double most = 0.0;
    for (const Instant at : instants_of(channel)) {
      const Evaluation one(part.shape, at);
      if (!largest_.contains(one)) evaluate({{one, &effect}});
      const std::vector<double>& sessions = largest_.at(one);
      for (std::size_t s = 0; s < sessions.size(); ++s) {
        if (part.session < 0 || s == idx(part.session)) most = std::max(most, sessions[s]);
      }
    }
    result.push_back(most);
  }
  return result;
}

}  // namespace trussmap::fitting
