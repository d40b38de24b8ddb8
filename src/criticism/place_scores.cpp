// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/place_scores.hpp"

#include "criticism/driven_variables.hpp"
#include "effects/channel_physics.hpp"
#include "fit/noise_components.hpp"
#include "geometry/index.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace trussmap::criticism {
namespace {

using Instant = fitting::ShapeContext::Instant;

constexpr double kFinest = 28.0;  // cells along the longer side
constexpr std::size_t kMostNodes = 110;

/// Rows of all sessions, shared out among all nodes of a grid.
using SharedRows = std::vector<std::vector<fitting::RowShares>>;

SquareGrid grid_over(const Area& area, double cell) {
  const Vector2 extent = area.high - area.low;
  const auto nodes = [cell](double along) { return static_cast<int>(std::ceil(along / cell)) + 1; };
  SquareGrid grid{area.low, cell, nodes(extent.x()), nodes(extent.y())};
  grid.low -= 0.5 * (cell * Vector2(grid.columns - 1, grid.rows - 1) - extent);
  return grid;
}

/// A place among the four nodes about it.
fitting::RowShares shares_at(const SquareGrid& grid, const Vector2& place) {
  const Vector2 at = (place - grid.low) / grid.cell;
  // A middle may lie a little beyond all ends, which the grid is over.
  const double u = std::clamp(at.x(), 0.0, static_cast<double>(grid.columns - 1));
  const double v = std::clamp(at.y(), 0.0, static_cast<double>(grid.rows - 1));
  const int column = std::min(static_cast<int>(u), std::max(0, grid.columns - 2));
  const int row = std::min(static_cast<int>(v), std::max(0, grid.rows - 2));
  const int right = grid.columns > 1 ? 1 : 0;
  const int up = grid.rows > 1 ? grid.columns : 0;
  const double a = u - column;
  const double b = v - row;
  const int first = grid.index_of({column, row});
  return {{first, first + right, first + up, first + right + up},
          {(1.0 - a) * (1.0 - b), a * (1.0 - b), (1.0 - a) * b, a * b}};
}

SharedRows shared_out(const SquareGrid& grid, const fitting::ShapeContext& context, Instant at) {
  SharedRows result;
  for (std::size_t s = 0; s < context.recordings().size(); ++s) {
    const RowVariables& variables = context.variables(s, at);
    const std::vector<double>& x = variables.at("x");
    const std::vector<double>& y = variables.at("y");
    std::vector<fitting::RowShares>& rows = result.emplace_back();
    rows.reserve(x.size());
    for (std::size_t row = 0; row < x.size(); ++row) {
      rows.push_back(shares_at(grid, Vector2(x[row], y[row])));
    }
  }
  return result;
}

/// Where the robot was, every so often.
std::vector<Vector2> places_driven(const fitting::ShapeContext& context, double apart) {
  std::vector<Vector2> places;
  for (std::size_t s = 0; s < context.recordings().size(); ++s) {
    const RowVariables& variables = context.variables(s, Instant::middle);
    const std::vector<double>& x = variables.at("x");
    const std::vector<double>& y = variables.at("y");
    for (std::size_t row = 0; row < x.size(); ++row) {
      const Vector2 place(x[row], y[row]);
      if (places.empty() || (places.back() - place).norm() > apart) places.push_back(place);
    }
  }
  return places;
}

/// Nodes at the corners of the squares that these are in.
std::size_t nodes_about(const SquareGrid& grid, const std::vector<Vector2>& places) {
  std::vector<std::uint8_t> near(idx(grid.nodes()), 0);
  for (const Vector2& place : places) {
    const fitting::RowShares about = shares_at(grid, place);
    for (std::size_t c = 0; c < 4; ++c) {
      if (about.share[c] > 0.0) near[idx(about.column[c])] = 1;
    }
  }
  return static_cast<std::size_t>(std::ranges::count(near, 1));
}

/// As fine as the number of nodes that the robot comes near allows.
SquareGrid finest_grid(const Area& area, const fitting::ShapeContext& context) {
  double cell = (area.high - area.low).maxCoeff() / kFinest;
  const std::vector<Vector2> places = places_driven(context, 0.5 * cell);
  while (nodes_about(grid_over(area, cell), places) > kMostNodes) cell *= 1.12;
  return grid_over(area, cell);
}

/// What of the way is near each node, m, and within the square about it.
struct WayNear {
  std::vector<double> near;
  std::vector<double> within;
};

WayNear way_near(const SquareGrid& grid, const SharedRows& shares,
                 const fitting::ShapeContext& context) {
  const std::size_t nodes = idx(grid.nodes());
  WayNear way{std::vector<double>(nodes, 0.0), std::vector<double>(nodes, 0.0)};
  for (std::size_t s = 0; s < shares.size(); ++s) {
    const std::vector<double>& distance = context.variables(s, Instant::middle).at("distance");
    for (std::size_t row = 1; row < shares[s].size(); ++row) {
      const double step = std::abs(distance[row] - distance[row - 1]);
      for (std::size_t c = 0; c < 4; ++c) {
        way.near[idx(shares[s][row].column[c])] += step * shares[s][row].share[c];
      }
      const auto nearest = std::ranges::max_element(shares[s][row].share);
      way.within[idx(shares[s][row].column[idx(nearest - shares[s][row].share.begin())])] += step;
    }
  }
  return way;
}

/// Those that more than hardly anything of the way is near.
void take_nodes(const WayNear& way, PlaceScores& scores) {
  constexpr double kLeastShare = 1e-3;  // of what a node has on average
  double sum = 0.0;
  double near = 0.0;
  for (const double one : way.near) {
    sum += one;
    near += one > 0.0 ? 1.0 : 0.0;
  }
  std::vector<double> kept;
  for (std::size_t k = 0; k < way.near.size() && kept.size() < kMostNodes; ++k) {
    if (!(way.near[k] * near > kLeastShare * sum)) continue;
    const int at = static_cast<int>(k);
    scores.nodes.push_back({at % scores.grid.columns, at / scores.grid.columns});
    scores.visited.push_back(way.within[k] > 0.0);
    kept.push_back(way.near[k]);
  }
  scores.driven = Eigen::Map<const Eigen::VectorXd>(kept.data(), std::ssize(kept));
  scores.driven /= std::max(1e-300, scores.driven.sum());
}

/// The same shares among the nodes that are kept: of others a row has none.
SharedRows among_kept(SharedRows shares, const PlaceScores& scores) {
  std::vector<int> place(idx(scores.grid.nodes()), -1);
  for (std::size_t k = 0; k < scores.nodes.size(); ++k) {
    place[idx(scores.grid.index_of(scores.nodes[k]))] = static_cast<int>(k);
  }
  for (std::vector<fitting::RowShares>& session : shares) {
    for (fitting::RowShares& row : session) {
      for (std::size_t c = 0; c < 4; ++c) {
        row.column[c] = place[idx(row.column[c])];
        if (row.column[c] < 0) row.share[c] = 0.0;
      }
    }
  }
  return shares;
}

/// Whether fields as large as such effects ever are would show.
bool can_show(Channel channel, const Eigen::MatrixXd& G, double dispersion) {
  const double sd = facts_of(channel).prior_sd;
  return G.diagonal().maxCoeff() * sd * sd > dispersion;
}

std::vector<Channel> channels_seen_in(const fitting::FitState& fit) {
  std::vector<Channel> result;
  for (const Channel one : {Channel::travel, Channel::turn, Channel::creep, Channel::compass}) {
    if (!effects::is_of_drive(one, fit.model.robot)) continue;
    if (one == Channel::compass && !fitting::noises_in(fit.problem).contains("compass")) continue;
    result.push_back(one);
  }
  return result;
}

void append_to(linalg::SparseMatrix& M, const linalg::SparseMatrix& more) {
  linalg::SparseMatrix all(more.rows(), M.cols() + more.cols());
  all.leftCols(M.cols()) = M;
  all.rightCols(more.cols()) = more;
  M.swap(all);
}

/// Without the channels that cannot show.
void keep_shown(double dispersion, PlaceScores& scores) {
  const Eigen::Index n = scores.count();
  std::vector<Channel> kept;
  std::vector<Eigen::Index> columns;
  for (std::size_t c = 0; c < scores.channels.size(); ++c) {
    const Eigen::Index first = n * static_cast<Eigen::Index>(c);
    if (!can_show(scores.channels[c], scores.G.block(first, first, n, n), dispersion)) continue;
    kept.push_back(scores.channels[c]);
    for (Eigen::Index k = 0; k < n; ++k) columns.push_back(first + k);
  }
  if (kept.size() == scores.channels.size()) return;
  for (auto k = n * std::ssize(scores.channels); k < scores.s.size(); ++k) columns.push_back(k);
  scores.G = scores.G(columns, columns).eval();
  scores.s = scores.s(columns).eval();
  scores.channels = std::move(kept);
}

}  // namespace

std::optional<PlaceScores> place_scores(const fitting::FitState& fit, const ScoreTest& tests,
                                        const std::vector<Effect>& patches) {
  constexpr std::size_t kFewestNodes = 8;
  if (fit.paths.empty() || fit.adjustment.dof <= 0) return std::nullopt;
  const Area area = driven_area(fit);
  if (!(area.step > 0.0)) return std::nullopt;
  PlaceScores scores;
  scores.grid = finest_grid(area, tests.context());
  SharedRows middles = shared_out(scores.grid, tests.context(), Instant::middle);
  take_nodes(way_near(scores.grid, middles, tests.context()), scores);
  if (scores.nodes.size() < kFewestNodes) return std::nullopt;
  scores.channels = channels_seen_in(fit);
  scores.patches = patches;
  middles = among_kept(std::move(middles), scores);
  linalg::SparseMatrix M(tests.residuals().size(), 0);
  for (const Channel channel : scores.channels) {
    const auto count = static_cast<int>(scores.count());
    append_to(
        M,
        effects::acts_on(channel) == effects::ActsOn::readings
            ? tests.cut_column(
                  channel,
                  among_kept(shared_out(scores.grid, tests.context(), Instant::end), scores), count)
            : tests.cut_column(channel, middles, count));
  }
  for (const Effect& one : patches) append_to(M, tests.columns(one).sparseView());
  ScoreInformation said = tests.information(M);
  scores.G = std::move(said.G);
  scores.s = std::move(said.s);
  scores.chi2 = tests.residuals().squaredNorm();
  scores.dof = fit.adjustment.dof;
  keep_shown(tests.dispersion(), scores);
  if (scores.channels.empty()) return std::nullopt;
  return scores;
}

}  // namespace trussmap::criticism
