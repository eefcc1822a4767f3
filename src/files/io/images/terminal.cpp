// SPDX-License-Identifier: Apache-2.0
// Pictures for terminals. A character shows two pixels, one above the other, by the upper half block and its
// background.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/srgb.h"
#include "frontmost/files.h"
#include "image/srgb_pixels.h"

namespace frontmost {
namespace {

constexpr const char* upper_half = "\xE2\x96\x80";
constexpr const char* lower_half = "\xE2\x96\x84";

/// Source pixels that one target pixel covers along one axis; the first and the last are covered in part.
struct PixelSpan {
  int first = 0, end = 0;
  double first_weight = 1, last_weight = 1;  ///< weights of the end pixels; the pixels between have weight 1

  PixelSpan(int target, int target_size, int source_size) {
    const double from = double(target) * source_size / target_size;
    const double to = double(target + 1) * source_size / target_size;
    first = std::min(int(from), source_size - 1);
    end = std::clamp(int(std::ceil(to)), first + 1, source_size);
    first_weight = end == first + 1 ? to - from : first + 1 - from;
    last_weight = end == first + 1 ? to - from : to - (end - 1);
  }
  [[nodiscard]] double weight(int i) const { return i == first ? first_weight : i == end - 1 ? last_weight : 1.0; }
};

using TerminalColor = std::array<double, 4>;

/// Returns the mean colour of a box, in linear light and premultiplied, so that edges keep their brightness.
TerminalColor box_mean(const ColorPlanes& planes, const PixelSpan& columns, const PixelSpan& rows) {
  TerminalColor sum{};
  double weights = 0;
  for (int y = rows.first; y < rows.end; ++y)
    for (int x = columns.first; x < columns.end; ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(planes.width) + std::size_t(x);
      const double weight = columns.weight(x) * rows.weight(y);
      for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * double(planes.color[c][i]);
      sum[3] += weight * (planes.alpha ? double(planes.alpha[i]) : 1.0);
      weights += weight;
    }
  for (double& value : sum) value /= weights;
  return sum;
}

/// A target pixel: an sRGB colour, or nothing if the picture is more transparent than opaque.
struct Dot {
  bool visible = false;
  std::array<int, 3> srgb{};
};

Dot dot_of(const TerminalColor& mean) {
  Dot dot;
  dot.visible = mean[3] >= 0.5;  // false for NaN
  if (!dot.visible) return dot;
  for (std::size_t c = 0; c < 3; ++c) dot.srgb[c] = srgb8_of_linear(float(mean[c] / mean[3]));
  return dot;
}

int distance2(const std::array<int, 3>& a, const std::array<int, 3>& b) {
  int sum = 0;
  for (std::size_t c = 0; c < 3; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}

/// Returns the nearest of xterm's colours 16 to 255, which look alike in every terminal: a cube of 6 levels per
/// channel, and 24 greys.
int palette_index(const std::array<int, 3>& srgb) {
  constexpr int levels[] = {0, 95, 135, 175, 215, 255};
  std::array<int, 3> step{}, cube{};
  for (std::size_t c = 0; c < 3; ++c) {
    for (int i = 1; i < 6; ++i)
      if (std::abs(levels[i] - srgb[c]) < std::abs(levels[step[c]] - srgb[c])) step[c] = i;
    cube[c] = levels[step[c]];
  }
  const int grey = std::clamp(((srgb[0] + srgb[1] + srgb[2]) / 3 - 3) / 10, 0, 23);
  const int level = 8 + 10 * grey;
  if (distance2({level, level, level}, srgb) < distance2(cube, srgb)) return 232 + grey;
  return 16 + 36 * step[0] + 6 * step[1] + step[2];
}

/// Writes characters, and escape sequences only where a colour changes.
class Writer {
 public:
  explicit Writer(bool true_color) : true_color_(true_color) {}

  void put(const Dot& top, const Dot& bottom) {
    if (top.visible) set(foreground_, "38", top);
    if (!top.visible && bottom.visible) set(foreground_, "38", bottom);
    set(background_, "48", top.visible ? bottom : Dot{});
    text_ += top.visible ? upper_half : bottom.visible ? lower_half : " ";
  }
  void end_line() {
    text_ += "\x1b[0m\n";
    foreground_ = background_ = {};
  }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  void set(Dot& current, const char* plane, const Dot& wanted) {
    if (current.visible == wanted.visible && (!wanted.visible || current.srgb == wanted.srgb)) return;
    current = wanted;
    if (!wanted.visible) {
      text_ += "\x1b[49m";  // the terminal's own background
      return;
    }
    text_ += std::string("\x1b[") + plane;
    if (true_color_) {
      text_ += ";2";
      for (const int value : wanted.srgb) text_ += ';' + std::to_string(value);
    } else {
      text_ += ";5;" + std::to_string(palette_index(wanted.srgb));
    }
    text_ += 'm';
  }

  bool true_color_;
  Dot foreground_, background_;
  std::string text_;
};

}  // namespace

std::string terminal_picture(const Image& image, int columns, int rows, bool true_color) {
  if (columns < 1 || rows < 1 || columns > 10000 || rows > 10000)
    throw Error(ErrorCode::bad_argument, "terminal picture", "columns and rows must be 1 to 10000");
  validate(image);
  const std::optional<ColorPlanes> planes = color_planes(image);
  if (!planes) throw Error(ErrorCode::unsupported, "terminal picture", "the image has no colours R, G, B");
  // Half a character is about as wide as it is high.
  const double scale = std::min(double(columns) / image.width, 2.0 * rows / image.height);
  const int width = std::clamp(int(std::lround(image.width * scale)), 1, columns);
  const int height = std::clamp(int(std::lround(image.height * scale)), 1, 2 * rows);
  const auto dot = [&](int x, int y) {
    if (y >= height) return Dot{};
    return dot_of(box_mean(*planes, {x, width, image.width}, {y, height, image.height}));
  };
  Writer writer(true_color);
  for (int y = 0; y < height; y += 2) {
    for (int x = 0; x < width; ++x) writer.put(dot(x, y), dot(x, y + 1));
    writer.end_line();
  }
  return writer.take();
}

}  // namespace frontmost
