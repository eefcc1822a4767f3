// SPDX-License-Identifier: Apache-2.0
// Convex outlines on the screen, and what is left of them beside others.
#pragma once

#include <span>
#include <vector>

#include "frontmost/painter.h"

namespace frontmost::painter_detail {

/// A few convex outlines, counter-clockwise as they are seen; z is affine over the screen.
class Outlines {
 public:
  [[nodiscard]] std::size_t count() const { return ends_.size(); }
  [[nodiscard]] std::span<const PaintCorner> operator[](std::size_t i) const {
    const std::size_t begin = i == 0 ? 0 : ends_[i - 1];
    return {corners_.data() + begin, ends_[i] - begin};
  }
  void clear() {
    corners_.clear();
    ends_.clear();
  }
  void add(std::span<const PaintCorner> outline) {
    corners_.insert(corners_.end(), outline.begin(), outline.end());
    ends_.push_back(corners_.size());
  }
  /// Forgets all from the `count`-th on.
  void shrink(std::size_t count) {
    ends_.resize(count);
    corners_.resize(count == 0 ? 0 : ends_.back());
  }

 private:
  std::vector<PaintCorner> corners_;
  std::vector<std::size_t> ends_;
};

/// Takes outlines apart. Not for several threads at once.
class OutlineCutter {
 public:
  /// Pixels: what is thinner is not there.
  static constexpr double thin = 1.0 / 1024;

  void begin(std::span<const PaintCorner> outline);
  /// Leaves what is not within `cover`. \returns true when nothing is left.
  bool subtract(std::span<const PaintCorner> cover);
  /// Leaves what is within a box.
  void keep_within(const glm::dvec2& low, const glm::dvec2& high);

  [[nodiscard]] const Outlines& left() const { return left_; }
  /// Something was taken away.
  [[nodiscard]] bool is_changed() const { return is_changed_; }

 private:
  /// The line of a side; positive is outside.
  struct Line {
    glm::dvec2 from, along;
  };
  enum class Split : std::uint8_t { inside, outside, both };

  /// Sets inside_ and outside_ where they are both. `outline` may be inside_.
  Split split(const std::vector<PaintCorner>& outline, const Line& line);
  void subtract_from(std::span<const PaintCorner> outline, std::span<const PaintCorner> cover);

  Outlines left_, next_;
  std::vector<PaintCorner> rest_, inside_, outside_;
  std::vector<double> distances_;
  bool is_changed_ = false;
};

}  // namespace frontmost::painter_detail
