// SPDX-License-Identifier: Apache-2.0
// The lines and texts on a page, to find free places for more text.
//
//    +----+----+----+----+      Cells are about as large as a number. A box is free if it lies on the page and touches
//    |  __|____|___ |    |      neither a line of its cells nor a text. A leader may cross lines, each at a cost, but
//    | /  | 50 |   \|    |      no text.
//    +----+----+----+----+
#pragma once

#include <span>
#include <vector>

#include "sheets/dimensions/dimensions.h"

namespace frontmost::detail {

/// A straight line on the page.
struct PageSegment {
  glm::dvec2 from, to;
};

/// Lines and texts of a page, by the cells of a grid.
class Obstacles {
 public:
  explicit Obstacles(const PageBox& area);

  void add(const PageSegment& segment);
  /// Adds a text: no line may cross it, and no text may touch it.
  void add(const PageBox& text);
  /// Adds the strokes and centre lines of a view, arcs as chords.
  void add(const SheetView& view);

  /// Whether the box lies in the area and touches nothing.
  [[nodiscard]] bool is_free(const PageBox& box) const;
  /// The number of lines that the segment crosses; 1000 more if it leaves the area or touches a text.
  [[nodiscard]] int crossings(const PageSegment& segment) const;

 private:
  template <class Visit>
  void visit_cells(const PageBox& box, const Visit& visit) const;

  const PageBox area_;
  glm::ivec2 cells_;
  glm::dvec2 cell_size_;
  std::vector<PageSegment> segments_;
  std::vector<PageBox> texts_;
  std::vector<std::vector<std::uint32_t>> segments_in_;  ///< by cell
};

}  // namespace frontmost::detail
