// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Whitened columns of any number of effects at one fit, fast: channel x shape comes apart.
//
//   column = - W sum over the rows k of a segment  f_k  I_k u_k        (a view: W V u f)
//
//   I_k   what one unit of motion in row k does to the segment (row_influences)
//   u_k   what one unit of the channel adds to row k (drive_pattern): the same for every shape
//   f_k   the shape there: the same for every channel
//
// Shapes and the I u of channels are worked out once and kept, as many as there is room for; where
// there is none for I u, it is worked out segment by segment for all columns that are asked for
// together. Cost of a further column: four products a row.
#pragma once

#include "fit/effect_columns.hpp"
#include "linalg/sparse_cholesky.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace trussmap::fitting {

/// How much of a row is in each of a few columns; a share of 0: none.
struct RowShares {
  std::array<int, 4> column{};
  std::array<double, 4> share{};
};

class ColumnBuilder {
 public:
  /// Keeps references to context, problem and border. `weights` of the measurements (information);
  /// `offsets` of the border's coefficients from their references.
  ColumnBuilder(const ShapeContext& context, const estimation::RecordingProblem& problem,
                const estimation::EffectParameters& border, const Eigen::VectorXd& offsets,
                const estimation::RecordingState& state, const std::vector<double>& weights);

  /// The same for a quick look: so many seconds of driving count as one row, with the variables of
  /// its middle. Shares what it can with this one.
  [[nodiscard]] ColumnBuilder coarsened(double seconds) const;

  /// Of each effect one column per coefficient, its rows in the order of the problem's
  /// measurements. Throws std::invalid_argument like effect_columns.
  [[nodiscard]] std::vector<Eigen::MatrixXd> columns(std::span<const Effect> effects);
  [[nodiscard]] Eigen::MatrixXd columns(const Effect& effect) {
    return std::move(columns(std::span(&effect, 1)).front());
  }
  /// The column of a channel that acts on drives, its shape 1, cut into `count`: by the shares that
  /// each session's rows have in them. Of every row by itself (not coarsened).
  [[nodiscard]] linalg::SparseMatrix cut_column(Channel channel,
                                                const std::vector<std::vector<RowShares>>& shares,
                                                int count) const;
  /// |f| at most, per coefficient.
  [[nodiscard]] std::vector<double> largest(const Effect& effect);

  /// Drops what is kept for further columns.
  void forget();

  [[nodiscard]] Eigen::Index rows() const { return rows_; }

 private:
  /// The entries of I that are not 0 or said by others; of a gyro's numbers those of an excess.
  struct Row {
    std::size_t row = 0;  ///< of the drive
    Vector2 along = Vector2::Zero();
    Vector2 by_turn = Vector2::Zero();
    double part = 0.0;
    double reading_by_turn = 0.0;
    double reading = 0.0;

    [[nodiscard]] estimation::Vector4 times(const effects::DrivePattern& unit) const {
      return {along.x() * unit.advance - along.y() * unit.slip + by_turn.x() * unit.turn,
              along.y() * unit.advance + along.x() * unit.slip + by_turn.y() * unit.turn,
              part * unit.turn, reading_by_turn * unit.turn + reading * unit.compass};
    }
    [[nodiscard]] estimation::Vector4 excess() const {
      return {along.x(), along.y(), by_turn.x(), by_turn.y()};
    }
  };
  /// Rows of a segment that share a shape's value.
  struct Stretch {
    std::uint32_t place = 0;  ///< of the value, in its session
    std::uint32_t begin = 0;  ///< of the rows
    std::uint32_t end = 0;
  };
  struct Segment {
    Eigen::Index first_row = 0;
    int rows = 0;
    std::size_t session = 0;
    std::size_t row_begin = 0;  ///< of the rows
    std::size_t row_end = 0;
    std::size_t begin = 0;  ///< of training_segments_
    std::size_t end = 0;
    bool gyro = false;  ///< a gyro's numbers
    estimation::Matrix4 W = estimation::Matrix4::Zero();
  };
  struct View {
    Eigen::Index first_row = 0;
    int rows = 0;
    std::size_t session = 0;
    std::size_t source = 0;
    ShapeContext::Instant at = ShapeContext::Instant::sighting;
    effects::ByView influence = effects::ByView::Zero();  ///< whitened
  };
  using Values = std::vector<std::vector<double>>;  ///< per session
  /// A shape at the rows, or events, where it is asked for.
  using Evaluation = std::pair<Shape, ShapeContext::Instant>;
  /// One column of one effect.
  struct Job {
    const Effect& effect;
    const Shape& shape;
    int session;  ///< -1: all
    Eigen::Index column;
    Eigen::MatrixXd& columns;
  };

  void add_gyro(const estimation::RecordingProblem& problem, const estimation::Measurement& one,
                const estimation::Matrix4& W);
  /// Of rows joint_ long at most; no longer than a segment.
  void take_training_segments();
  void take_training_segments(Segment& segment);
  [[nodiscard]] RowVariables thinned(std::size_t session, ShapeContext::Instant at) const;
  /// Works out shapes for jobs from `begin` on, as many as may be kept; returns the end of these
  /// jobs.
  std::size_t make_ready(const std::vector<Job>& jobs, std::size_t begin);
  /// Shapes, each with an effect that asks for it.
  void evaluate(const std::map<Evaluation, const Effect*>& wanted);
  [[nodiscard]] Values evaluated(const Evaluation& one) const;
  /// Those of the jobs that act on drives.
  void add_drives(std::span<const Job> jobs);
  /// Columns of I u, one per stretch of a segment, for each channel to where it says.
  void work_out(const Segment& segment, std::span<const std::pair<Channel, double*>> wanted) const;
  /// Whether there is room for so many channels' I u; those that are not there yet are empty then.
  bool make_room(const std::vector<Channel>& channels);
  void add_views(const Job& job, Eigen::Ref<Eigen::VectorXd> column) const;

  const ShapeContext& context_;
  double joint_ = 0.0;
  Eigen::Index rows_ = 0;
  std::shared_ptr<std::vector<Row>> segment_rows_;
  std::vector<Stretch> training_segments_;
  std::vector<std::vector<std::size_t>> middles_;  ///< per session, rows that stand for a stretch
  std::vector<Segment> segments_;
  std::vector<View> views_;
  std::map<Channel, Eigen::Matrix4Xd> bases_;  ///< I u per stretch
  std::map<ShapeContext::Instant, std::vector<RowVariables>> thinned_;
  std::map<Evaluation, Values> values_;
  /// |f| at most, spikes apart, per session; outlives the values.
  std::map<Evaluation, std::vector<double>> largest_;
};

}  // namespace trussmap::fitting
