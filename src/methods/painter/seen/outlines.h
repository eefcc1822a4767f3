// SPDX-License-Identifier: Apache-2.0
// Convex outlines on the screen, and clipping of one by others.
//
// Positions are doubles in pixels. Depths are affine over the screen, so the depth of a corner that a cut makes is
// interpolated. Nothing here needs to be exact, because pieces were cut exactly before, and the result is only looked
// at in pixels. Every comparison has a slack of a thousandth of a pixel (OutlineClipper::thin), always to the side on
// which a polygon stays visible.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "frontmost/painter.h"

namespace frontmost::painter_detail {

using Outline = std::span<const PaintCorner>;

/// An outline and the box around it, in pixels.
struct Cover {
  Outline outline;
  glm::dvec2 low, high;
};

/// Returns whether two boxes do not overlap. They may touch.
template <class A, class B>
[[nodiscard]] bool is_apart(const A& a, const B& b) {
  return a.low.x >= b.high.x || b.low.x >= a.high.x || a.low.y >= b.high.y || b.low.y >= a.high.y;
}

/// In pixels. Shorter sides have no direction.
inline constexpr double shortest_side = 1e-9;

/// Returns twice the area of the triangle of `way` and `at`, positive if `at` lies to the left of `way` in a plane
/// whose y goes up.
[[nodiscard]] inline double turn(const glm::dvec2& way, const glm::dvec2& at) { return way.x * at.y - way.y * at.x; }

/// Returns whether an outline is nowhere wider than `width`, judged by its area and perimeter.
[[nodiscard]] bool is_narrow(Outline outline, double width);

/// Returns whether an outline is too narrow for its sides to bound it: the whole screen may be on their inner side.
/// Cuts leave such pieces, and models have triangles of that size. They hide nothing.
[[nodiscard]] inline bool is_flat(Outline outline) { return outline.empty() || is_narrow(outline, shortest_side); }

/// Returns whether a point is within an outline, or up to `beside` pixels beside it.
[[nodiscard]] inline bool is_within(Outline outline, const glm::dvec2& at, double beside) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 p(outline[i].at), way = glm::dvec2(outline[i + 1 == outline.size() ? 0 : i + 1].at) - p;
    const double turn = way.x * (at.y - p.y) - way.y * (at.x - p.x);
    if (turn > 0 && turn * turn > beside * beside * glm::dot(way, way)) return false;
  }
  return true;
}

/// Whether all corners are within a box, or on its border.
[[nodiscard]] inline bool is_in_box(Outline outline, const glm::dvec2& low, const glm::dvec2& high) {
  return std::all_of(outline.begin(), outline.end(), [&](const PaintCorner& corner) {
    return corner.at.x >= low.x && corner.at.y >= low.y && corner.at.x <= high.x && corner.at.y <= high.y;
  });
}

/// Clips convex outlines by other outlines. All are counter-clockwise to the eye, with z affine over the screen. Covers
/// must not be flat. Not for several threads at once.
class OutlineClipper {
 public:
  /// In pixels. Thinner parts are dropped.
  static constexpr double thin = 1.0 / 1024;

  void begin(Outline outline) {
    corners_.clear();
    parts_.clear();
    add(outline);
    is_changed_ = false;
  }
  /// Removes everything within `cover`. If there are more than 48 parts, they are not split further: only parts that
  /// lie wholly within `cover` are then removed. O(parts). \returns true if nothing is left.
  bool subtract(const Cover& cover);
  /// Removes everything outside a box.
  void keep_within(const glm::dvec2& low, const glm::dvec2& high);

  [[nodiscard]] std::size_t count() const { return parts_.size(); }
  [[nodiscard]] Outline operator[](std::size_t i) const { return {corners_.data() + parts_[i].first, parts_[i].count}; }
  void forget_changes() { is_changed_ = false; }
  /// Whether something was removed since begin() or forget_changes().
  [[nodiscard]] bool is_changed() const { return is_changed_; }

 private:
  struct Part {
    std::size_t first, count;
    glm::dvec2 low, high;
  };
  /// The line of a side, with a direction of unit length. Points outside have positive distances.
  struct Line {
    glm::dvec2 from, along;
  };
  enum class Place : std::uint8_t { inside, outside, both };
  /// Corners in memory that is kept from outline to outline.
  class CornerList {
   public:
    void begin(std::size_t most) {
      if (corners_.size() < most) corners_.resize(most);
      count_ = 0;
    }
    void add(const PaintCorner& corner) { corners_[count_++] = corner; }
    [[nodiscard]] Outline outline() const { return {corners_.data(), count_}; }

   private:
    std::vector<PaintCorner> corners_;
    std::size_t count_ = 0;
  };

  /// The place of `outline` relative to the line from p to q. Sets `line` if the result is `both`.
  static Place place(Outline outline, const glm::dvec2& p, const glm::dvec2& q, Line& line);
  /// Whether a side of `a` has all of `b` on its outer side.
  static bool parts(Outline a, Outline b);
  void add(Outline outline);
  bool subtract_from(std::size_t part, Outline cover, bool may_split);
  /// Splits an outline by a line. If the result is `both`, sets outside_, and inside_ if `keeps_inside` is true.
  /// \returns the place of the outline.
  Place split(Outline outline, const Line& line, bool keeps_inside);

  std::vector<PaintCorner> corners_;  ///< corners of all parts since begin(), including removed parts
  std::vector<Part> parts_;
  CornerList rest_, inside_, outside_;
  std::vector<double> distances_;
  std::vector<Line> lines_;
  bool is_changed_ = false;
};

}  // namespace frontmost::painter_detail
