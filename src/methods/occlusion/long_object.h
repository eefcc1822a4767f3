// SPDX-License-Identifier: Apache-2.0
// An object that reaches far into depth, such as the walls around the eye. As a whole it would cover nothing before the
// sweep has passed its far end, so it covers slab by slab:
//
//    eye  |  slab 0  |  slab 1  |  slab 2  |        a triangle belongs to the slab of its farthest vertex
//         \___________/\_________/\________/
//
// The object has ends at the border of two slabs, and cells along the border would stay open. So a slab covers together
// with the triangles of nearer slabs that share a vertex with it; its ends then lie within covered cells.
//
// A triangle that reaches through several slabs, such as half of a floor, covers in every third of these slabs, as far
// as the slab's far side, which cuts it like a far plane.
#pragma once

#include <optional>
#include <vector>

#include "occlusion/distance_ranges.h"
#include "occlusion/occluder.h"

namespace frontmost::occlusion_detail {

class LongObject {
 public:
  /// The object's triangles on the screen. Filled by put_on_screen() first.
  OccluderOnScreen on_screen;

  /// Ranges [first, last] in slabs of `length` ranges each.
  struct Slabs {
    int first, last, length;
    [[nodiscard]] int count() const { return (last - first) / length + 1; }
    [[nodiscard]] int of(int range) const { return (std::clamp(range, first, last) - first) / length; }
    /// The first range that lies wholly behind a slab.
    [[nodiscard]] int behind(int slab) const { return std::min(first + (slab + 1) * length, last + 1); }
  };

  /// Sorts the triangles into slabs.
  void sort_by_slab(const CellGrid& grid, const HidingObject& occluder, const DistanceRanges& range_of,
                    const Slabs& slabs);
  [[nodiscard]] bool has_triangles(int slab) const;
  /// The triangles that cover for a slab, within `rect`. Borrows from this object until the next call.
  [[nodiscard]] CoverPass choose(const CellGrid& grid, const HidingObject& occluder, int slab, const CellRect& rect);

 private:
  /// A triangle that covers in several slabs.
  struct Reaching {
    std::uint32_t triangle;
    int first_slab;
  };
  void find_far_sides(const CellGrid& grid, const DistanceRanges& range_of, const Slabs& slabs);
  void find_reaching(const CellGrid& grid, const HidingObject& occluder, const DistanceRanges& range_of,
                     const Slabs& slabs);
  void choose_cut(const HidingObject& occluder, int slab);
  void choose_around(const HidingObject& occluder, int slab, std::uint32_t triangle);
  [[nodiscard]] CellRect rect_of_chosen(const CellGrid& grid, const HidingObject& occluder, const CellRect& rect) const;

  std::vector<float> far_sides_;           ///< by slab; infinity for the last slab
  std::vector<std::uint16_t> slabs_;       ///< by triangle
  std::vector<std::uint32_t> by_slab_;     ///< triangles in the order of their slabs
  std::vector<std::uint32_t> slab_begin_;  ///< within by_slab_; one more than slabs
  std::vector<Reaching> reaching_;
  int first_reached_ = 0;  ///< the first slab in which a reaching triangle begins
  // State of the current slab.
  std::vector<std::uint32_t> whole_;
  std::vector<ClippedTriangle> cut_;
  std::vector<std::uint16_t> marks_;  ///< by triangle: 1 + the last slab that it was chosen for
  std::optional<ScreenTransform> screen_;
  ChosenTriangles chosen_;
};

}  // namespace frontmost::occlusion_detail
