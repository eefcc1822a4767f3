// SPDX-License-Identifier: Apache-2.0
// Whether one piece may cover another: the tests of Newell, Newell and Sancha.
//
//    eye                  P covers Q at a point of the screen where both are and P is nearer. It is
//     .                   then painted after Q. If neither covers the other, their order does not
//     . .   P ____        matter; if each covers the other somewhere, one of them has to be cut.
//     .   .    Q ____
#pragma once

#include <optional>

#include "frontmost/painter.h"
#include "painter/pieces.h"

namespace frontmost::painter_detail {

/// One piece, made ready to be held against others.
class NewellTests {
 public:
  NewellTests(const Pieces& pieces, std::uint32_t piece);

  [[nodiscard]] const Plane& plane() const { return plane_; }
  /// Whether the piece covers a point of `other`, by any of the tests but those of the extents. True also where one of
  /// the two was cut and no test tells: then they may have no order.
  [[nodiscard]] bool covers(std::uint32_t other, PaintSteps& steps);

 private:
  /// turns[k][i]: on which side of edge k of one triangle the other one's corner i is.
  using Turns = std::array<std::array<int, 3>, 3>;

  [[nodiscard]] bool is_apart(std::uint32_t other);
  [[nodiscard]] bool is_outside(const std::array<Plane, 3>& edges, std::uint32_t piece, Turns& turns) const;
  [[nodiscard]] bool is_over(const Face& other, const Plane& other_plane) const;
  [[nodiscard]] bool crosses_over(const Face& other) const;
  [[nodiscard]] std::array<Plane, 3> edges_of(const Face& face) const;

  const Pieces& pieces_;
  const std::uint32_t piece_;
  const Face& face_;
  const Plane plane_;
  std::optional<std::array<Plane, 3>> edges_;  ///< made when first needed
  Turns other_turns_{}, turns_{};              ///< by this piece's edges, by the other one's
};

}  // namespace frontmost::painter_detail
