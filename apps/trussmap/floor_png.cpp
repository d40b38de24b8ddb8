// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// By libpng's simplified interface.
#include "floor_maps.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <png.h>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

struct Colour {
  std::uint8_t red = 255;
  std::uint8_t green = 255;
  std::uint8_t blue = 255;
};

constexpr Colour kInk{60, 60, 60};
constexpr Colour kNeverThere{215, 215, 215};
constexpr int kLongSide = 640;  // pixels
constexpr int kMargin = 12;
constexpr int kScaleWidth = 18;
constexpr int kGlyph = 2;  // pixels of a glyph's dot

/// From blue through white to red, apart for colour-blind eyes; `strength` from 0 (white) to 1.
Colour shade_of(double value, double strength) {
  const double much = std::clamp(std::abs(value), 0.0, 1.0) * std::clamp(strength, 0.0, 1.0);
  const Colour end = value < 0.0 ? Colour{33, 102, 172} : Colour{178, 24, 43};
  const auto mixed = [much](std::uint8_t full) {
    return static_cast<std::uint8_t>(std::lround(255.0 + much * (full - 255.0)));
  };
  return {mixed(end.red), mixed(end.green), mixed(end.blue)};
}

/// What numbers are written with, 3 x 5 dots, a row in three bits from the top.
struct Glyph {
  char letter;
  std::array<std::uint8_t, 5> rows;
};
constexpr std::array<Glyph, 17> kGlyphs{{{'0', {7, 5, 5, 5, 7}},
                                         {'1', {2, 6, 2, 2, 7}},
                                         {'2', {7, 1, 7, 4, 7}},
                                         {'3', {7, 1, 3, 1, 7}},
                                         {'4', {5, 5, 7, 1, 1}},
                                         {'5', {7, 4, 7, 1, 7}},
                                         {'6', {7, 4, 7, 5, 7}},
                                         {'7', {7, 1, 2, 2, 2}},
                                         {'8', {7, 5, 7, 5, 7}},
                                         {'9', {7, 5, 7, 1, 7}},
                                         {'.', {0, 0, 0, 0, 2}},
                                         {'-', {0, 0, 7, 0, 0}},
                                         {'+', {0, 2, 7, 2, 0}},
                                         {'%', {5, 1, 2, 4, 5}},
                                         {'d', {1, 1, 7, 5, 7}},
                                         {'e', {0, 7, 7, 4, 7}},
                                         {'g', {7, 5, 7, 1, 6}}}};

class Canvas {
 public:
  Canvas(int width, int height)
      : width_(width),
        height_(height),
        bytes_(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 255) {}

  void fill(int left, int top, int width, int height, const Colour& colour) {
    for (int y = std::max(0, top); y < std::min(height_, top + height); ++y) {
      for (int x = std::max(0, left); x < std::min(width_, left + width); ++x) {
        const std::size_t at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                    static_cast<std::size_t>(x));
        bytes_[at] = colour.red;
        bytes_[at + 1] = colour.green;
        bytes_[at + 2] = colour.blue;
      }
    }
  }

  void write(int left, int top, std::string_view text) {
    for (const char letter : text) {
      const auto* const glyph = std::ranges::find(kGlyphs, letter, &Glyph::letter);
      for (int row = 0; glyph != kGlyphs.end() && row < 5; ++row) {
        for (int dot = 0; dot < 3; ++dot) {
          if ((glyph->rows[static_cast<std::size_t>(row)] >> (2 - dot) & 1) == 0) continue;
          fill(left + kGlyph * dot, top + kGlyph * row, kGlyph, kGlyph, kInk);
        }
      }
      left += 4 * kGlyph;
    }
  }

  [[nodiscard]] std::string as_png() const {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width_);
    image.height = static_cast<png_uint_32>(height_);
    image.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = 0;
    const auto failed = [&image] {
      const std::string why = image.message;
      png_image_free(&image);
      return SolveError("no picture of the floor map: " + why);
    };
    if (png_image_write_to_memory(&image, nullptr, &size, 0, bytes_.data(), 0, nullptr) == 0) {
      throw failed();
    }
    std::string file(size, '\0');
    if (png_image_write_to_memory(&image, file.data(), &size, 0, bytes_.data(), 0, nullptr) == 0) {
      throw failed();
    }
    file.resize(size);
    return file;
  }

 private:
  int width_;
  int height_;
  std::vector<std::uint8_t> bytes_;  ///< red, green, blue, row by row from the top
};

/// The scale to the right of the map: its ends and 0.
void draw_scale(Canvas& canvas, int left, int top, int height, double most, bool angle) {
  for (int y = 0; y < height; ++y) {
    const double value = 1.0 - 2.0 * y / std::max(1, height - 1);
    canvas.fill(left, top + y, kScaleWidth, 1, shade_of(value, 1.0));
  }
  const double shown = (angle ? 180.0 / std::numbers::pi : 100.0) * most;
  const char* unit = angle ? "deg" : "%";
  const int text = left + kScaleWidth + 6;
  canvas.write(text, top, fmt::format("+{:.2f}{}", shown, unit));
  canvas.write(text, top + height / 2 - 5, "0");
  canvas.write(text, top + height - 5 * kGlyph, fmt::format("-{:.2f}{}", shown, unit));
}

}  // namespace

bool draws_png() {
  return true;
}

std::string floor_png(const FieldOfPlaces& field) {
  constexpr int kNumbers = 100;  // pixels beside the scale
  const int side = std::max(2, kLongSide / std::max(field.columns, field.rows));
  const int width = side * field.columns;
  const int height = std::max(side * field.rows, 60);
  Canvas canvas(width + kScaleWidth + 3 * kMargin + kNumbers, height + 2 * kMargin);
  canvas.fill(kMargin, kMargin, width, height, kNeverThere);
  const double most = field.most();
  for (const FieldCell& one : field.cells_driven()) {
    if (!(most > 0.0)) continue;
    // What is known of the cell, against what the field varies by.
    const double known = 1.0 - 0.8 * std::min(1.0, std::pow(one.sd / field.size, 2));
    canvas.fill(kMargin + side * one.column, kMargin + height - side * (one.row + 1), side, side,
                shade_of(one.mean / most, known));
  }
  draw_scale(canvas, width + 2 * kMargin, kMargin, height, most, field.channel == Channel::compass);
  return canvas.as_png();
}

}  // namespace trussmap::app
