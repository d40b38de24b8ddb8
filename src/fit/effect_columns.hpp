// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Effects as columns of the adjustment's border: channel x shape, row by row.
//
// What a channel adds to a row or a view is channel_physics.hpp's; here it meets the shapes'
// values.
//
// Travel and turn are those of the record less its noise, as the fit believes it (fitted_path.hpp):
// a column that holds the same noise as the residual it is to explain would explain it. So would a
// smaller map, by shrinking every error, where no survey fixes the scale.
//
// All act on the motion as recorded, so the order of effects does not matter. Delays and steering
// are exact only near their references, by which recordings are to be laid out: the times of
// sightings and truth, or of fixes, moved back (retimed), and the wheels steered (steered). Far
// factors of wheels are laid out for their noise (effects/wheel_factors.hpp).
#pragma once

#include "drive/row_motion.hpp"
#include "drive/row_variables.hpp"
#include "estimation/effect_parameters.hpp"
#include "fit/fitted_path.hpp"
#include "trussmap/channel.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace trussmap::fitting {

/// What the data tell of a coefficient counts only above this share of what its column would tell
/// if nothing else were unknown: what rounding leaves.
inline constexpr double kLeastShare = 1e-7;
/// And only where its standard error is below this share of the channel's prior standard deviation:
/// else more was known before.
inline constexpr double kLargestUncertainty = 1.0 / 3.0;

/// Where one coefficient of the border belongs.
struct Coefficient {
  std::size_t effect = 0;
  std::size_t shape = 0;
  std::size_t place = 0;  ///< in the effect's list of coefficients
  double largest = 0.0;   ///< |f| over all rows or instants (largest_but_for_spikes)
};

/// The largest |f|, but for single ones: those above it make up a twentieth of the sum of all |f|
/// at most. One row of a second among those of a hundredth says nothing of an effect's size.
[[nodiscard]] double largest_but_for_spikes(const std::vector<double>& values);

struct EffectColumns {
  estimation::EffectParameters border;
  std::vector<Coefficient> coefficients;  ///< one per entry of the border
};

/// A row without its noise: `missing` and `excess` are as SessionPath has them.
void add_noise(const Vector2& missing, double excess, drive::RowMotion& row);

/// What shapes may speak of, for all sessions.
class ShapeContext {
 public:
  /// Keeps references to recordings and paths. Variables are made when first asked for: several
  /// threads may ask for those that prepare has made.
  ShapeContext(const std::vector<DrivenRecording>& recordings, const Robot& robot,
               const std::vector<SessionPath>& paths);

  /// Values of a shape per session, per row at its middle or end, per sighting, truth row, fix.
  /// Throws std::invalid_argument like Shape::values.
  enum class Instant { middle, end, sighting, truth, fix, loop };
  [[nodiscard]] std::vector<std::vector<double>> values(const Shape& shape, Instant at) const;
  [[nodiscard]] const RowVariables& variables(std::size_t session, Instant at) const;
  /// Makes the variables of all sessions at these instants.
  void prepare(Instant at) const;
  /// A row's travels, its noise taken out.
  [[nodiscard]] drive::RowMotion motion(std::size_t session, std::size_t row) const;

  [[nodiscard]] const std::vector<DrivenRecording>& recordings() const { return recordings_; }
  [[nodiscard]] const Robot& robot() const { return robot_; }

 private:
  const std::vector<DrivenRecording>& recordings_;
  Robot robot_;
  const std::vector<SessionPath>& paths_;
  mutable std::map<std::pair<std::size_t, Instant>, RowVariables> variables_;
};

/// One column per coefficient: a channel with a given shape, acting in one session (-1: in all).
/// Throws std::invalid_argument on a shape that cannot be evaluated.
[[nodiscard]] estimation::EffectPattern effect_column(Channel channel, const Shape& shape,
                                                      int session, const ShapeContext& context);

/// Columns of all effects. Throws std::invalid_argument, with the effect's name, on a shape that
/// cannot be evaluated, or a number of coefficients that does not match.
[[nodiscard]] EffectColumns effect_columns(const std::vector<Effect>& effects,
                                           const ShapeContext& context);

/// Whether the channel's columns are about a reference by which recordings are laid out.
[[nodiscard]] bool is_laid_out(Channel channel);

/// One per shape, or per shape and session.
[[nodiscard]] std::size_t coefficient_count(const Effect& effect, std::size_t sessions);

/// Coefficients of an effect in the model's order, 0 where not yet fitted. Throws
/// std::invalid_argument where their number is wrong for so many sessions, or there is no shape.
[[nodiscard]] std::vector<double> coefficients_of(const Effect& effect, std::size_t sessions);

/// Sightings, truth rows and fixes moved back by the delays of the effects; those that fall out of
/// the drive are dropped. Shapes of delays see no path: heading, x and y are 0.
[[nodiscard]] std::vector<DrivenRecording> retimed(const std::vector<DrivenRecording>& recordings,
                                                   const std::vector<Effect>& effects,
                                                   const Robot& robot);

/// Any instants of one of the sessions, moved back in the same way by effects of that channel.
[[nodiscard]] std::vector<double> retimed(const std::vector<double>& instants,
                                          const DrivenRecording& recording, std::size_t session,
                                          std::size_t sessions, const std::vector<Effect>& effects,
                                          const Robot& robot, Channel delay = Channel::delay);

/// Drives with the steering effects taken in; gyros are not yet. Shapes see the paths where there
/// is one for every row, else a robot at (0, 0, 0).
[[nodiscard]] std::vector<DrivenRecording> steered(const std::vector<DrivenRecording>& recordings,
                                                   const std::vector<Effect>& effects,
                                                   const Robot& robot,
                                                   const std::vector<SessionPath>& paths);

/// Whether the steering effects leave the measured wheel a way ahead in every row, along the same.
[[nodiscard]] bool leave_a_way(const std::vector<Effect>& effects,
                               const std::vector<DrivenRecording>& recordings, const Robot& robot,
                               const std::vector<SessionPath>& paths);

/// The channel that delays what a recording's legs end at: its fixes', where it has nothing else.
[[nodiscard]] Channel delay_of_legs(const DrivenRecording& recording);

/// Whether the channel adds the same to every row, however short, by a shape that counts no events.
/// Its size is then no matter of rows.
[[nodiscard]] bool adds_to_rows(Channel channel, const Shape& shape);
/// Of such an effect, |f| per row that would add as much to travel or turn as a gain of the same
/// share of the prior would.
[[nodiscard]] double size_of_additions(Channel channel, const Shape& shape, int session,
                                       const ShapeContext& context);

}  // namespace trussmap::fitting
