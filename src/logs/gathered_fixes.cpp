// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/field_path.hpp"
#include "logs/gathering.hpp"
#include "logs/sensor_frames.hpp"

#include <cmath>

namespace trussmap::logs {
namespace {

/// NavSatFix: whether it has a fix, how good, and how certain.
bool status_of(FieldRef message, SeenFix& fix, GatheredLog& to) {
  const auto status = FieldPath("status.status", false).find(message);
  // Receivers without a fix say 0, 0, which is in the sea.
  if ((status && status->field().integer < 0) || (fix.x == 0.0 && fix.y == 0.0)) {
    ++to.lost_fixes;
    return false;
  }
  if (status && !std::isfinite(fix.quality)) fix.quality = status->number();
  const auto type = message.member("position_covariance_type");
  const auto xx = FieldPath("position_covariance[0]", false).find(message);
  const auto yy = FieldPath("position_covariance[4]", false).find(message);
  if (type && type->field().integer > 0 && xx && yy && !std::isfinite(fix.sd)) {
    const double variance = 0.5 * (xx->number() + yy->number());
    if (variance > 0.0 && std::isfinite(variance)) fix.sd = std::sqrt(variance);
  }
  return true;
}

}  // namespace

void feed_fixes(Gathering& g, const FixMap& fixes) {
  want_frames(g, "/tf");
  for (const std::string& base : base_frames(g.map)) g.to.frames.wants(base);
  g.feeds.add({fixes.topic, fixes.file, fixes.line}, [&g, &fixes](const FedMessage& fed) {
    const auto number = [&](const std::string& path) {
      return g.paths.number(path, fixes.line, fed.topic, fed.field);
    };
    SeenFix fix;
    fix.t = fed.t + nanoseconds(fixes.clock);
    fix.sd = fixes.sd_unit * number(fixes.sd);
    fix.quality = number(fixes.quality);
    if (!fixes.x.empty()) {
      fix.x = fixes.unit * number(fixes.x);
      fix.y = fixes.unit * number(fixes.y);
    } else if (!fixes.latitude.empty() || fed.field.member("latitude")) {
      const bool named = !fixes.latitude.empty();
      fix.geodetic = true;
      fix.y = number(named ? fixes.latitude : "latitude");
      fix.x = number(named ? fixes.longitude : "longitude");
      const auto height = fed.field.member("altitude");
      if (height && std::isfinite(height->number())) fix.height = height->number();
      if (!status_of(fed.field, fix, g.to)) return true;
    } else if (const auto pose = pose_of(fed.field)) {
      fix.x = pose->position.x();
      fix.y = pose->position.y();
    } else {
      return false;
    }
    if (!std::isfinite(fix.x) || !std::isfinite(fix.y)) return true;
    if (g.to.fixes.empty()) {
      g.to.fix_frame = frame_of(fed.message);
      g.to.frames.wants(g.to.fix_frame);
    }
    g.to.fixes.push_back(fix);
    return true;
  });
}

}  // namespace trussmap::logs
