// SPDX-License-Identifier: Apache-2.0
// Every polygon loses what those after it cover, one after the other, the foremost first.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "base/float_environment.h"
#include "base/parallel.h"
#include "base/pool.h"
#include "painter/outlines.h"
#include "painter/piece_grid.h"
#include "painter/poll.h"

namespace frontmost {
namespace {

using namespace painter_detail;

constexpr std::size_t kPolygonsPerPart = 1024;
/// A polygon in more cells is asked cell by cell, and stays whole if it is seen at all.
constexpr int kFewCells = 4;
/// More pieces in a cell count as seen; more pieces of a polygon are not worth it.
constexpr std::size_t kMostPieces = 48, kMostPiecesKept = 6;

/// Perspective: depths are not affine over the screen, their reciprocals are.
double affine_of(const View& view, double depth) { return view.projection.orthographic ? depth : 1 / depth; }

class Scenery {
 public:
  Scenery(const PaintOrder& order, const std::function<bool(PrimitiveId)>& hides)
      : order_(order), corners_(order.corners), extents_(extents_of(order)), grid_(extents_) {
    for (PaintCorner& corner : corners_) corner.at.z = affine_of(order.view, corner.at.z);
    hides_.reserve(order.polygons.size());
    for (const PaintPolygon& polygon : order.polygons) hides_.push_back(!hides || hides(polygon.id));
  }

  [[nodiscard]] std::span<const PaintCorner> outline(std::size_t polygon) const {
    const PaintPolygon& p = order_.polygons[polygon];
    return {corners_.data() + p.first_corner, p.corner_count};
  }
  [[nodiscard]] const PieceGrid& grid() const { return grid_; }
  [[nodiscard]] const Extent& extent(std::size_t polygon) const { return extents_[polygon]; }
  [[nodiscard]] bool hides(std::size_t polygon) const { return hides_[polygon] != 0; }
  [[nodiscard]] glm::dvec2 size() const { return {order_.view.width, order_.view.height}; }

 private:
  static std::vector<Extent> extents_of(const PaintOrder& order) {
    std::vector<Extent> extents;
    extents.reserve(order.polygons.size());
    const glm::vec2 most(order.view.width, order.view.height);
    for (const PaintPolygon& polygon : order.polygons) {
      Extent extent{most, glm::vec2(0), 0, 0};
      for (std::size_t i = 0; i < polygon.corner_count; ++i) {
        const glm::vec2 at(order.corners[polygon.first_corner + i].at);
        extent.low = glm::min(extent.low, at);
        extent.high = glm::max(extent.high, at);
      }
      extent.low = glm::max(extent.low, glm::vec2(0));
      extent.high = glm::min(extent.high, most);
      extents.push_back(extent);
    }
    return extents;
  }

  const PaintOrder& order_;
  std::vector<PaintCorner> corners_;
  const std::vector<Extent> extents_;
  const PieceGrid grid_;
  std::vector<std::uint8_t> hides_;
};

/// One polygon after another. Not for several threads at once.
class Looker {
 public:
  Looker(const Scenery& scenery, const Execution& execution) : scenery_(scenery), poll_(execution) {}

  /// Whether those after a polygon hide an outline together.
  [[nodiscard]] bool is_hidden(std::size_t polygon, std::span<const PaintCorner> outline) {
    Extent box{glm::vec2(outline[0].at), glm::vec2(outline[0].at), 0, 0};
    for (const PaintCorner& corner : outline) {
      box.low = glm::min(box.low, glm::vec2(corner.at));
      box.high = glm::max(box.high, glm::vec2(corner.at));
    }
    const PieceGrid::Range cells = scenery_.grid().range(box);
    cutter_.begin(outline);
    for (int y = cells.first_y; y <= cells.last_y; ++y)
      for (int x = cells.first_x; x <= cells.last_x; ++x)
        if (take_covers_of_cell(polygon, scenery_.grid().number(x, y), box, false)) return true;
    return false;
  }

  /// Calls keep(outline) for every part of the polygon that is seen.
  template <class Keep>
  void look(std::size_t polygon, const Keep& keep) {
    const Extent& extent = scenery_.extent(polygon);
    if (!(extent.low.x < extent.high.x && extent.low.y < extent.high.y)) return;
    const PieceGrid::Range cells = scenery_.grid().range(extent);
    cutter_.begin(scenery_.outline(polygon));
    cutter_.keep_within(glm::dvec2(0), scenery_.size());
    if (cutter_.left().count() == 0) return;
    const bool is_small = (cells.last_x - cells.first_x + 1) * (cells.last_y - cells.first_y + 1) <= kFewCells;
    if (is_small ? !take_covers(polygon, cells) : is_seen_in_a_cell(polygon, cells)) {
      cutter_.begin(scenery_.outline(polygon));
      cutter_.keep_within(glm::dvec2(0), scenery_.size());
    }
    const Outlines& left = cutter_.left();
    for (std::size_t i = 0; i < left.count(); ++i) keep(left[i]);
  }

 private:
  /// \returns false where the polygon is to stay whole.
  bool take_covers(std::size_t polygon, const PieceGrid::Range& cells) {
    asked_.clear();
    for (int y = cells.first_y; y <= cells.last_y; ++y)
      for (int x = cells.first_x; x <= cells.last_x; ++x) {
        if (take_covers_of_cell(polygon, scenery_.grid().number(x, y), scenery_.extent(polygon), true)) return true;
        if (cutter_.left().count() > kMostPieces) return false;
      }
    return cutter_.left().count() <= kMostPiecesKept;
  }

  /// \returns true when nothing is left.
  bool take_covers_of_cell(std::size_t polygon, std::size_t cell, const Extent& own, bool remembers) {
    const std::span<const std::uint32_t> entries = scenery_.grid().cell(cell);
    for (std::size_t i = entries.size(); i-- > 0 && entries[i] > polygon;) {
      poll_.count();
      const std::uint32_t cover = entries[i];
      const Extent& e = scenery_.extent(cover);
      if (!scenery_.hides(cover) || e.low.x >= own.high.x || e.high.x <= own.low.x || e.low.y >= own.high.y ||
          e.high.y <= own.low.y)
        continue;
      if (remembers && std::find(asked_.begin(), asked_.end(), cover) != asked_.end()) continue;
      if (remembers) asked_.push_back(cover);
      if (cutter_.subtract(scenery_.outline(cover))) return true;
      if (cutter_.left().count() > kMostPieces) return false;
    }
    return false;
  }

  bool is_seen_in_a_cell(std::size_t polygon, const PieceGrid::Range& cells) {
    for (int y = cells.first_y; y <= cells.last_y; ++y)
      for (int x = cells.first_x; x <= cells.last_x; ++x) {
        const PieceGrid::Box box = scenery_.grid().box(x, y);
        cutter_.begin(scenery_.outline(polygon));
        cutter_.keep_within(glm::max(box.low, glm::dvec2(0)), glm::min(box.high, scenery_.size()));
        if (cutter_.left().count() == 0) continue;
        if (!take_covers_of_cell(polygon, scenery_.grid().number(x, y), scenery_.extent(polygon), false)) return true;
      }
    return false;
  }

  const Scenery& scenery_;
  Poll poll_;
  OutlineCutter cutter_;
  std::vector<std::uint32_t> asked_;
};

/// Parts in the order of their polygons.
struct Parts {
  std::vector<PaintPolygon> polygons;
  std::vector<PaintCorner> corners;
};

/// Makes an order of what look(looker, polygon, keep) keeps of every polygon.
template <class Look>
PaintOrder map_polygons(const PaintOrder& order, const Scenery& scenery, const Execution& execution, const Look& look) {
  const std::size_t count = order.polygons.size();
  std::vector<Parts> lists((count + kPolygonsPerPart - 1) / kPolygonsPerPart);
  Pool<Looker> lookers;
  std::atomic<std::size_t> done{0};
  parallel_for(execution, count, kPolygonsPerPart, [&](std::size_t begin, std::size_t end) {
    const auto looker = lookers.borrow([&] { return std::make_unique<Looker>(scenery, execution); });
    Parts& parts = lists[begin / kPolygonsPerPart];
    for (std::size_t i = begin; i < end; ++i)
      look(*looker, i, [&](std::span<const PaintCorner> outline) {
        parts.polygons.push_back({order.polygons[i].id, std::uint32_t(outline.size()), parts.corners.size()});
        for (const PaintCorner& corner : outline) {
          const double depth = affine_of(order.view, corner.at.z);  // its own inverse
          parts.corners.push_back({{corner.at.x, corner.at.y, depth}, corner.is_cut});
        }
      });
    report_progress(execution, "visible parts", double(done += end - begin) / double(count));
  });
  PaintOrder made;
  made.view = order.view;
  made.steps = order.steps;
  for (const Parts& parts : lists) {
    for (PaintPolygon polygon : parts.polygons) {
      polygon.first_corner += made.corners.size();
      made.polygons.push_back(polygon);
    }
    made.corners.insert(made.corners.end(), parts.corners.begin(), parts.corners.end());
  }
  return made;
}

/// Hems that are tried, the first that is hidden is taken: part of the width, and how far from the ends they have it,
/// in their width. Neighbours are narrow towards their corners, and may be narrow everywhere.
struct HemShape {
  double part, inset;
};
constexpr HemShape kHemShapes[] = {{1, 0.5}, {1, 2}, {0.25, 0.5}, {0.25, 2}, {0.0625, 1}};

/// What lies beside a side of an outline.
std::array<PaintCorner, 4> hem(const PaintCorner& from, const PaintCorner& to, double width, double inset) {
  const glm::dvec3 way = to.at - from.at;
  const double length = glm::length(glm::dvec2(way));
  inset = std::min(inset * width, 0.45 * length);
  const glm::dvec3 along = way / length, out(-along.y * width, along.x * width, 0);
  return {from, {from.at + along * inset + out, true}, {to.at - along * inset + out, true}, to};
}

}  // namespace

PaintOrder visible_parts(const PaintOrder& order, const std::function<bool(PrimitiveId)>& hides,
                         const Execution& execution) {
  const IeeeScope ieee;
  const Scenery scenery(order, hides);
  return map_polygons(order, scenery, execution,
                      [](Looker& looker, std::size_t polygon, const auto& keep) { looker.look(polygon, keep); });
}

PaintOrder with_hems(const PaintOrder& order, double width, const std::function<bool(PrimitiveId)>& hides,
                     const Execution& execution) {
  if (!(width > 0 && width <= 100))
    throw Error(ErrorCode::bad_argument, "hems: must be more than 0, at most 100 pixels");
  const IeeeScope ieee;
  const Scenery scenery(order, hides);
  return map_polygons(order, scenery, execution, [&](Looker& looker, std::size_t polygon, const auto& keep) {
    const std::span<const PaintCorner> outline = scenery.outline(polygon);
    std::vector<PaintCorner> hemmed;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const PaintCorner &from = outline[i], &to = outline[i + 1 == outline.size() ? 0 : i + 1];
      hemmed.push_back(from);
      if (!scenery.hides(polygon) || glm::length(glm::dvec2(to.at - from.at)) < OutlineCutter::thin) continue;
      for (const HemShape& shape : kHemShapes) {
        const std::array<PaintCorner, 4> beside = hem(from, to, width * shape.part, shape.inset);
        if (!looker.is_hidden(polygon, beside)) continue;
        hemmed.insert(hemmed.end(), {beside[1], beside[2]});
        break;
      }
    }
    keep(hemmed);
  });
}

}  // namespace frontmost
