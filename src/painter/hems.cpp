// SPDX-License-Identifier: Apache-2.0
// Polygons with their hems as one outline each.
#include "base/float_environment.h"
#include "painter/traps/make_traps.h"

namespace frontmost {
namespace {

using namespace painter_detail;

glm::dvec2 place_of(const PaintCorner& corner) { return glm::dvec2(corner.at); }

/// One outline after another.
class Joiner {
 public:
  explicit Joiner(PaintOrder& made) : made_(made) {}

  void begin(PrimitiveId id) { made_.polygons.push_back({id, 0, made_.corners.size()}); }
  void add(const PaintCorner& corner) {
    made_.corners.push_back(corner);
    ++made_.polygons.back().corner_count;
  }
  /// Around a corner two hems come from the same place: the corner is within them.
  void add_hem(const PaintCorner& from, std::span<const glm::dvec2> corners) {
    const std::size_t count = made_.polygons.back().corner_count;
    const bool goes_around = count > 1 && place_of(made_.corners.back()) == glm::dvec2(from.at) &&
                             place_of(made_.corners[made_.corners.size() - 2]) == corners[0];
    if (goes_around) {
      made_.corners.pop_back();
      --made_.polygons.back().corner_count;
    }
    for (const glm::dvec2& at : corners.subspan(goes_around)) add({glm::dvec3(at, from.at.z), true});
  }

 private:
  PaintOrder& made_;
};

}  // namespace

PaintOrder with_hems(const PaintOrder& order, double width, const std::function<bool(PrimitiveId)>& hides,
                     const Execution& execution) {
  if (!(width > 0 && width <= 100))
    throw Error(ErrorCode::bad_argument, "hems: must be more than 0, at most 100 pixels");
  const IeeeScope ieee;
  const HemList hems = side_hems(order, width, hides, execution);
  PaintOrder made;
  made.view = order.view;
  made.steps = order.steps;
  made.polygons.reserve(order.polygons.size());
  made.corners.reserve(order.corners.size() + hems.corners.size());
  Joiner joiner(made);
  for (std::size_t place = 0; place < order.polygons.size(); ++place) {
    const PaintPolygon& polygon = order.polygons[place];
    joiner.begin(polygon.id);
    std::span<const SideHem> left = hems.of(place);
    for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
      PaintCorner from = order.corners[polygon.first_corner + i];
      joiner.add(from);
      for (; !left.empty() && left[0].side == i; left = left.subspan(1)) {
        if (left[0].from != place_of(from)) joiner.add(from = {glm::dvec3(left[0].from, from.at.z), from.is_cut});
        joiner.add_hem(from, hems.corners_of(left[0]));
        const PaintCorner& end = order.corners[polygon.first_corner + (i + 1 == polygon.corner_count ? 0 : i + 1)];
        if (left[0].to != place_of(end)) joiner.add(from = {glm::dvec3(left[0].to, from.at.z), from.is_cut});
      }
    }
  }
  return made;
}

}  // namespace frontmost
