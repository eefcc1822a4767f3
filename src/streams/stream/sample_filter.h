// SPDX-License-Identifier: Apache-2.0
// Finds the triangles that may cover a sample of a view. In long streams most triangles lie between samples or outside
// of the picture. No surfaces have to be made from them.
//
//      .       .       .        samples
//         /\                    covers no sample: its box lies between two columns and two rows
//      .  --   .       .
//           ____
//      .   / .  \      .        may cover one: its box does
//
// Vertices are projected as in every method, but truncated instead of rounded to 1/256 pixel. The box around a triangle
// is therefore enlarged by one unit on each side. No triangle that a method would draw is lost. A few too many are
// kept, which costs time and changes no result.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "view/screen_transform.h"

namespace frontmost::streaming {

/// Pixels from (x0, y0) up to, but without, (x1, y1).
struct PixelBounds {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  [[nodiscard]] bool is_empty() const { return x0 >= x1 || y0 >= y1; }
  void include(const PixelBounds& other) {
    if (other.is_empty()) return;
    if (is_empty()) {
      *this = other;
      return;
    }
    x0 = std::min(x0, other.x0), y0 = std::min(y0, other.y0);
    x1 = std::max(x1, other.x1), y1 = std::max(y1, other.y1);
  }
};

class SampleFilter {
 public:
  explicit SampleFilter(const View& view) : transform_(view), width_(view.width), height_(view.height) {
    for (const glm::ivec2& offset : sample_offsets(view.samples)) offsets_.push_back(offset);
  }

  /// Marks every triangle that may cover a sample: all that do, and few others. \returns the pixels that marked
  /// triangles may cover.
  PixelBounds mark(const Mesh& mesh, std::vector<std::uint8_t>& marks) {
    corners_.resize(std::max(corners_.size(), mesh.positions.size()));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) corners_[i] = corner_of(mesh.positions[i]);
    PixelBounds pixels;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const glm::uvec3& corners = mesh.triangles[t];
      const Corner &a = corners_[corners.x], &b = corners_[corners.y], &c = corners_[corners.z];
      if ((a.beyond | b.beyond | c.beyond) != 0) {
        if ((a.beyond & b.beyond & c.beyond & ~std::uint32_t(unknown)) != 0) continue;
        marks[t] = 1;
        // Only clipping would tell where the triangle meets the screen.
        pixels = {0, 0, width_, height_};
        continue;
      }
      // One more unit on each side makes up for truncation.
      const Extent extent{std::min({a.x, b.x, c.x}) - 1, std::min({a.y, b.y, c.y}) - 1, std::max({a.x, b.x, c.x}) + 1,
                          std::max({a.y, b.y, c.y}) + 1};
      if (!may_hold_sample(extent)) continue;
      marks[t] = 1;
      pixels.include({std::max(extent.x0 >> 8, 0), std::max(extent.y0 >> 8, 0), std::min((extent.x1 >> 8) + 1, width_),
                      std::min((extent.y1 >> 8) + 1, height_)});
    }
    return pixels;
  }

 private:
  /// Planes that a vertex may be beyond. A triangle whose three vertices are beyond the same plane is not seen.
  enum Beyond : std::uint32_t { near = 1, far = 2, left = 4, right = 8, top = 16, bottom = 32, unknown = 64 };

  /// A vertex on the screen, in 1/256 pixel from the picture's top left corner, accurate to one unit; or the planes
  /// that it is beyond.
  struct Corner {
    std::int32_t x, y;
    std::uint32_t beyond;
  };
  /// A range of screen coordinates in 1/256 pixel, both ends inclusive.
  struct Extent {
    std::int32_t x0, y0, x1, y1;
  };
  static_assert(kSubPixels == 1 << 8);

  [[nodiscard]] Corner corner_of(const glm::vec3& position) const {
    const HomogeneousVertex v = transform(transform_, position);
    if (is_plain(transform_, v)) {
      const float inverse = transform_.orthographic ? 1.0f : 1.0f / v.d;
      // Truncating is faster than rounding, and less than one unit off.
      return {int(v.x * inverse) + transform_.centre_x, int(v.y * inverse) + transform_.centre_y, 0};
    }
    std::uint32_t beyond = unknown;
    if (v.d < transform_.near) beyond |= near;
    if (v.d > transform_.far) beyond |= far;
    const float reach = float(kGuardBand) * (transform_.orthographic ? 1.0f : v.d);
    // Sides are only determined in front of the eye; behind it they would be mirrored.
    if (v.d >= transform_.near && reach <= std::numeric_limits<float>::max()) {
      if (v.x < -reach) beyond |= left;
      if (v.x > reach) beyond |= right;
      if (v.y < -reach) beyond |= top;
      if (v.y > reach) beyond |= bottom;
    }
    return {0, 0, beyond};
  }

  [[nodiscard]] bool may_hold_sample(const Extent& e) const {
    // The first pixel whose sample is at or after `at`, and the last one whose sample is at or before it.
    const auto first_pixel = [](std::int32_t at, std::int32_t offset) { return (at - offset + kSubPixels - 1) >> 8; };
    const auto last_pixel = [](std::int32_t at, std::int32_t offset) { return (at - offset) >> 8; };
    for (const glm::ivec2& o : offsets_) {
      const std::int32_t x0 = std::max(first_pixel(e.x0, o.x), 0), x1 = std::min(last_pixel(e.x1, o.x), width_ - 1);
      const std::int32_t y0 = std::max(first_pixel(e.y0, o.y), 0), y1 = std::min(last_pixel(e.y1, o.y), height_ - 1);
      if (x0 <= x1 && y0 <= y1) return true;
    }
    return false;
  }

  ScreenTransform transform_;
  int width_, height_;
  std::vector<glm::ivec2> offsets_;  ///< sample positions within a pixel
  std::vector<Corner> corners_;      ///< vertices of the current mesh
};

}  // namespace frontmost::streaming
