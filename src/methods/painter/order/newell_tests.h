// SPDX-License-Identifier: Apache-2.0
// Whether one piece may cover another: the tests of Newell, Newell and Sancha.
//
//    eye                  P covers Q at a point of the screen if both are there and P is nearer. P is
//     .                   then painted after Q. If neither covers the other, their order does not
//     . .   P ____        matter. If each covers the other somewhere, one of them must be cut.
//     .   .    Q ____
#pragma once

#include <optional>

#include "frontmost/painter.h"
#include "painter/pieces.h"

namespace frontmost::painter_detail {

/// One piece, prepared for tests against others.
class NewellTests {
 public:
  NewellTests(const Pieces& pieces, std::uint32_t piece);

  [[nodiscard]] const Plane& plane() const { return plane_; }
  /// Whether the piece covers a point of `other`, by all tests except those of the extents. Also true if one of the two
  /// was cut and no test decides: they may then have no order.
  [[nodiscard]] bool covers(std::uint32_t other, PaintSteps& steps);

 private:
  /// turns[k][i]: the side of edge k of one triangle on which vertex i of the other triangle lies.
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
  Turns other_turns_{}, turns_{};              ///< by this piece's edges, and by the other's edges
};

}  // namespace frontmost::painter_detail
