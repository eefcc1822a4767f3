// SPDX-License-Identifier: Apache-2.0
#include "painter/emit.h"

#include <algorithm>

namespace frontmost::painter_detail {
namespace {

void emit_one(const Pieces& pieces, std::uint32_t piece, PaintOrder& order) {
  const Face& face = pieces.face(piece);
  const Sight& sight = pieces.sight();
  PaintPolygon polygon{face.id, 3, order.corners.size()};
  const auto add = [&](const glm::dvec3& at, bool is_cut) {
    glm::dvec3 in_eye = sight.in_eye(at);
    // Where rounding of huge coordinates takes a corner to the eye, it would be at infinity.
    in_eye.z = std::max(in_eye.z, sight.near());
    order.corners.push_back({sight.to_screen(in_eye), is_cut});
  };
  if (pieces.is_whole(piece)) {
    for (const glm::vec3& corner : face.corners) add(glm::dvec3(corner), false);
  } else {
    const Shape& shape = pieces.shape(piece);
    polygon.corner_count = std::uint32_t(shape.corners.size());
    for (std::size_t i = 0; i < shape.corners.size(); ++i) add(shape.corners[i].at, shape.sides[i] >= Shape::first_cut);
  }
  order.polygons.push_back(polygon);
}

}  // namespace

void emit(const Pieces& pieces, const std::vector<std::uint32_t>& members, PaintOrder& order, Poll& poll) {
  order.polygons.reserve(members.size());
  order.corners.reserve(3 * members.size());
  for (const std::uint32_t piece : members) {
    poll.count();
    emit_one(pieces, piece, order);
  }
}

}  // namespace frontmost::painter_detail
