// SPDX-License-Identifier: Apache-2.0
// What polygons reach under each other.
//
// Most sides are those of two polygons, and have one hem or none. One that is cut off where others end beside it lies
// beside several; there each part of it is looked at by itself, where the whole has none.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/float_environment.h"
#include "painter/hem_shape.h"
#include "painter/map_polygons.h"

namespace frontmost {
namespace {

using namespace painter_detail;

/// The first that is hidden is taken. Long sides have more of them: on short ones they look nearly the same.
constexpr std::array<HemShape, 7> kHemShapes{
    {{1, 0.5}, {1, 2}, {1, 6}, {0.25, 0.5}, {0.25, 2}, {0.25, 8}, {0.0625, 1}}};
constexpr std::array<HemShape, 13> kLongShapes{{{1, 0.5},
                                                {1, 2},
                                                {1, 6},
                                                {0.25, 0.5},
                                                {0.25, 2},
                                                {0.25, 8},
                                                {1, 0, 0.45, 0.45},
                                                {1, 0.5, 0, 0.85},
                                                {1, 0.5, 0.85},
                                                {0.25, 0, 0.45, 0.45},
                                                {0.25, 0.5, 0, 0.85},
                                                {0.25, 0.5, 0.85},
                                                {0.0625, 1}}};
/// In widths of the hem.
constexpr double kLong = 2;

/// What lies beside a side of an outline.
std::array<PaintCorner, 4> hem(const PaintCorner& from, const PaintCorner& to, double width, const HemShape& shape) {
  const glm::dvec3 way = to.at - from.at;
  const double length = glm::length(glm::dvec2(way)), reach = width * shape.part;
  const auto [from_inset, to_inset] = shape.insets(reach, length);
  const glm::dvec3 along = way / length, out(-along.y * reach, along.x * reach, 0);
  return {from, {from.at + along * from_inset + out, true}, {to.at - along * to_inset + out, true}, to};
}

/// Next to the middle of a side: within each of its hems. What lies at the rim of one hides nothing of it.
glm::dvec2 next_to(const PaintCorner& from, const PaintCorner& to, double distance) {
  const glm::dvec2 way(to.at - from.at), out(-way.y, way.x);
  return glm::dvec2(from.at) + 0.5 * way + out * (distance / glm::length(way));
}

/// A corner on a side.
PaintCorner corner_on(const PaintCorner& from, const PaintCorner& to, double along) {
  return {from.at + (to.at - from.at) * along, from.is_cut};
}

/// Polygons with their hems, one after the other. Not for several threads at once.
class Hemmer {
 public:
  Hemmer(const Scenery& scenery, Looker& looker, double width) : scenery_(scenery), looker_(looker), width_(width) {}

  [[nodiscard]] std::span<const PaintCorner> hemmed(std::size_t slot) {
    const Outline outline = scenery_.outline(slot);
    corners_.clear();
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const PaintCorner &from = outline[i], &to = outline[i + 1 == outline.size() ? 0 : i + 1];
      corners_.push_back(from);
      if (!scenery_.hides(slot) || add_hem(slot, i, from, to)) continue;
      looker_.ends_along(slot, i, ends_);
      if (!ends_.empty()) add_hems(slot, i, from, to);
    }
    return corners_;
  }

 private:
  /// \returns whether a part of a side has one.
  bool add_hem(std::size_t slot, std::size_t side, const PaintCorner& from, const PaintCorner& to) {
    const double length = glm::length(glm::dvec2(to.at - from.at));
    if (length < OutlineCutter::thin) return false;
    const bool is_long = length > kLong * width_;
    const std::span<const HemShape> shapes =
        is_long ? std::span<const HemShape>(kLongShapes) : std::span<const HemShape>(kHemShapes);
    const glm::dvec2 at = next_to(from, to, 0.5 * width_ * shapes.back().part);
    std::array<PaintCorner, 4> beside;
    const std::size_t found = looker_.first_hidden(slot, side, shapes.size(), at, [&](std::size_t k) {
      beside = hem(from, to, width_, shapes[k]);
      return Outline(beside);
    });
    if (found == shapes.size()) return false;
    corners_.insert(corners_.end(), {beside[1], beside[2]});
    return true;
  }

  /// From each of its parts' ends a hem reaches as far as it can.
  void add_hems(std::size_t slot, std::size_t side, const PaintCorner& from, const PaintCorner& to) {
    ends_.insert(ends_.begin(), 0);
    ends_.push_back(1);
    const auto corner = [&](std::size_t end) {
      return end == 0 ? from : end + 1 == ends_.size() ? to : corner_on(from, to, ends_[end]);
    };
    bool has_begin = true;
    for (std::size_t begin = 0, end; begin + 1 < ends_.size(); begin = end) {
      if (!has_begin) corners_.push_back(corner(begin));
      end = std::min(begin + kMostParts, ends_.size() - 1);
      while (end > begin && !add_hem(slot, side, corner(begin), corner(end))) --end;
      const bool has_hem = end > begin;
      if (has_hem && end + 1 < ends_.size()) corners_.push_back(corner(end));
      if (!has_hem && !has_begin) corners_.pop_back();
      if (!has_hem) end = begin + 1;
      has_begin = has_hem;
    }
  }

  static constexpr std::size_t kMostParts = 4;  ///< of a side that have one hem

  const Scenery& scenery_;
  Looker& looker_;
  const double width_;
  std::vector<PaintCorner> corners_;
  std::vector<double> ends_;
};

}  // namespace

PaintOrder with_hems(const PaintOrder& order, double width, const std::function<bool(PrimitiveId)>& hides,
                     const Execution& execution) {
  if (!(width > 0 && width <= 100))
    throw Error(ErrorCode::bad_argument, "hems: must be more than 0, at most 100 pixels");
  const IeeeScope ieee;
  const Scenery scenery(order, hides);
  const Mosaic mosaic(scenery);
  return map_polygons(order, scenery, mosaic, execution, [&](Looker& looker, std::size_t slot, const auto& keep) {
    keep(Hemmer(scenery, looker, width).hemmed(slot));
  });
}

}  // namespace frontmost
