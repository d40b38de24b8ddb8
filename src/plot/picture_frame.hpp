// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where on a picture a place is drawn: metres to pixels, y upwards, as large as the width allows.
#pragma once

#include "trussmap/planar.hpp"

#include <algorithm>
#include <limits>

namespace trussmap::plot {

inline constexpr double kPictureWidth = 800.0;  // pixels
inline constexpr double kPictureMargin = 40.0;
inline constexpr double kPictureHeader = 76.0;  // title and legend

class PictureFrame {
 public:
  void include(const Vector2& point) {
    low_ = low_.cwiseMin(point);
    high_ = high_.cwiseMax(point);
  }

  /// When everything is included.
  void finish() {
    const Vector2 size = (high_ - low_).cwiseMax(1e-6);
    scale_ = std::min((kPictureWidth - 2.0 * kPictureMargin) / size.x(), kPictureWidth / size.y());
    height_ = kPictureHeader + 2.0 * kPictureMargin + scale_ * size.y();
  }

  [[nodiscard]] double x(const Vector2& point) const {
    return kPictureMargin + scale_ * (point.x() - low_.x());
  }
  [[nodiscard]] double y(const Vector2& point) const {
    return height_ - kPictureMargin - scale_ * (point.y() - low_.y());
  }
  [[nodiscard]] double height() const { return height_; }
  [[nodiscard]] double scale() const { return scale_; }

 private:
  Vector2 low_ = Vector2::Constant(std::numeric_limits<double>::infinity());
  Vector2 high_ = Vector2::Constant(-std::numeric_limits<double>::infinity());
  double scale_ = 1.0;
  double height_ = 0.0;
};

}  // namespace trussmap::plot
