// SPDX-License-Identifier: Apache-2.0
#include "painter/emit.h"

#include <algorithm>

namespace frontmost::painter_detail {

std::uint32_t corner_count(const Pieces& pieces, std::uint32_t piece) {
  return pieces.is_whole(piece) ? 3 : std::uint32_t(pieces.shape(piece).corners.size());
}

void emit(const Pieces& pieces, std::uint32_t piece, PaintCorner* corners) {
  const Sight& sight = pieces.sight();
  const auto place = [&](const glm::dvec3& at) {
    glm::dvec3 in_eye = sight.in_eye(at);
    // Where rounding of huge coordinates takes a corner to the eye, it would be at infinity.
    in_eye.z = std::max(in_eye.z, sight.near());
    return sight.to_screen(in_eye);
  };
  if (pieces.is_whole(piece)) {
    for (const glm::vec3& corner : pieces.face(piece).corners) *corners++ = {place(glm::dvec3(corner)), false};
    return;
  }
  const PieceShape& shape = pieces.shape(piece);
  for (std::size_t i = 0; i < shape.corners.size(); ++i)
    *corners++ = {place(shape.corners[i].at), shape.sides[i] >= PieceShape::first_cut};
}

void emit(const Pieces& pieces, const std::vector<std::uint32_t>& members, PaintOrder& order, Poll& poll) {
  std::size_t corners = order.corners.size();
  order.polygons.reserve(order.polygons.size() + members.size());
  for (const std::uint32_t piece : members) {
    const std::uint32_t count = corner_count(pieces, piece);
    order.polygons.push_back({pieces.face(piece).id, count, corners});
    corners += count;
  }
  order.corners.resize(corners);
  for (std::size_t i = 0; i < members.size(); ++i) {
    poll.count();
    emit(pieces, members[i],
         order.corners.data() + order.polygons[order.polygons.size() - members.size() + i].first_corner);
  }
}

}  // namespace frontmost::painter_detail
