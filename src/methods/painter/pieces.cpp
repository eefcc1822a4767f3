// SPDX-License-Identifier: Apache-2.0
// A corner in a cutting plane belongs to both halves. A side with one end in front of the plane and the other end
// behind it gets a new corner, which is the same to the bit in both halves. Its position is computed twice, by
// interpolation between the ends of the side and as the meeting point of three planes. The better position is kept,
// with its bound.
//
// A corner is also stored as the planes that meet there, which always come from triangles and from the eye, never from
// computed points. So an exact sign stays a polynomial of the ninth degree in the input, however often a piece was cut.
// The side of a corner is decided by its position if the bound allows it, and otherwise exactly by its planes.
#include "painter/pieces.h"

#include <algorithm>
#include <cmath>

namespace frontmost::painter_detail {
namespace {

/// Relative error of coordinates that is allowed for corners.
constexpr double kCornerError = 1e-11;

float rounded_down(double value) {
  const float nearest = float(value);
  return double(nearest) <= value ? nearest : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}
float rounded_up(double value) { return -rounded_down(-value); }

bool is_before(const glm::dvec3& a, const glm::dvec3& b) {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

}  // namespace

ExtentBuilder::ExtentBuilder(const Sight& sight)
    : sight_(sight),
      centre_(sight.to_screen({0, 0, 1})),
      unit_(glm::abs(glm::dvec2(sight.to_screen({1, 1, 1})) - centre_)) {}

void ExtentBuilder::include(const glm::dvec3& in_eye, double error) {
  // Rounding moves a point by some 1e-15 of its coordinates.
  error += 1e-12 * (std::abs(in_eye.x) + std::abs(in_eye.y) + std::abs(in_eye.z));
  nearest_ = std::min(nearest_, in_eye.z - error);
  farthest_ = std::max(farthest_, in_eye.z + error);
  const double w = sight_.is_parallel() ? 1 : in_eye.z;
  if (!sight_.is_parallel() && in_eye.z < 2 * error) {  // next to the eye's plane: it may be anywhere
    low_ = glm::dvec2(-std::numeric_limits<double>::infinity());
    high_ = -low_;
    return;
  }
  const glm::dvec2 at(sight_.to_screen(in_eye));
  const double lean = sight_.is_parallel() ? 0 : (std::abs(in_eye.x) + std::abs(in_eye.y)) / w;
  const glm::dvec2 slack = unit_ * (2 * error * (1 + lean) / w) + 1e-9 * (1.0 + glm::abs(at) + glm::abs(centre_));
  low_ = glm::min(low_, at - slack);
  high_ = glm::max(high_, at + slack);
}

PolygonExtent ExtentBuilder::extent() const {
  return {{rounded_down(low_.x), rounded_down(low_.y)},
          {rounded_up(high_.x), rounded_up(high_.y)},
          rounded_down(nearest_),
          rounded_up(farthest_)};
}

void Pieces::copy_corners(std::uint32_t piece, PaintCorner* corners) const {
  const auto place = [&](const glm::dvec3& at) {
    glm::dvec3 in_eye = sight_.in_eye(at);
    // Rounding of huge coordinates may move a corner to the eye, and so to infinity on the screen.
    in_eye.z = std::max(in_eye.z, sight_.near());
    return sight_.to_screen(in_eye);
  };
  if (is_whole(piece)) {
    for (const glm::vec3& corner : faces_[piece].corners) *corners++ = {place(glm::dvec3(corner)), false};
    return;
  }
  const PieceShape& own = shape(piece);
  for (std::size_t i = 0; i < own.corners.size(); ++i)
    *corners++ = {place(own.corners[i].at), own.sides[i] >= PieceShape::first_cut};
}

std::array<Plane, 3> Pieces::planes_of(const Face& face, const PieceCorner& corner) const {
  const auto of_side = [&](std::uint32_t side) {
    return side < PieceShape::first_cut ? edge_plane(face, side) : planes_[side - PieceShape::first_cut];
  };
  return {face.plane(), of_side(corner.sides[0]), of_side(corner.sides[1])};
}

int Pieces::side_of_corner(const Face& face, const PieceCorner& corner, const Plane& plane) const {
  if (corner.sides[0] == no_index) return plane.side(corner.at);
  const Bounded height = plane.height(corner.at, corner.error);
  if (height.value > height.error) return 1;
  if (height.value < -height.error) return -1;
  const std::array<Plane, 3> meeting = planes_of(face, corner);
  return plane.side_of_meeting({&meeting[0], &meeting[1], &meeting[2]});
}

Sides Pieces::sides(std::uint32_t piece, const Plane& plane) const {
  const Face& face = faces_[piece];
  Sides sides;
  const auto add = [&](int side) { side > 0 ? sides.front = true : side < 0 ? sides.back = true : false; };
  for (const glm::vec3& corner : face.corners) add(plane.side(glm::dvec3(corner)));
  if (!sides.both() || face.shape == no_index) return sides;
  sides = {};
  for (const PieceCorner& corner : shapes_[face.shape].corners) add(side_of_corner(face, corner, plane));
  return sides;
}

bool Pieces::keeps_off(std::uint32_t piece, const Plane& plane, int sign, bool& is_flat) const {
  const Face& face = faces_[piece];
  is_flat = true;
  bool keeps_off = true;
  for (const glm::vec3& corner : face.corners) {
    const int side = plane.side(glm::dvec3(corner));
    is_flat = is_flat && side == 0;
    if (side != sign) continue;
    keeps_off = false;
    break;
  }
  if (keeps_off || face.shape == no_index) return keeps_off;
  for (const PieceCorner& corner : shapes_[face.shape].corners)
    if (side_of_corner(face, corner, plane) == sign) return false;
  return true;
}

PieceShape Pieces::shape_of(std::uint32_t piece) const {
  const Face& face = faces_[piece];
  if (face.shape != no_index) return shapes_[face.shape];
  PieceShape whole;
  for (std::uint32_t k = 0; k < 3; ++k) {
    whole.corners.push_back({glm::dvec3(face.corners[k])});
    whole.sides.push_back(k);
  }
  return whole;
}

/// Returns the corner at which a plane cuts a side: interpolated between the ends of the side, or where the planes
/// meet, whichever is known better. Interpolation gets worse from cut to cut, and meeting points are bad if planes meet
/// at small angles. If both are bad, drawings would have corners pixels away, so the slow closest_meeting() is tried.
/// Interpolation begins at the end that comes first in space, so neighbours are cut at the same point to the bit.
PieceCorner Pieces::crossing(const Face& face, const PieceShape& shape, std::size_t side, std::uint32_t plane) const {
  const PieceCorner *from = &shape.corners[side], *to = &shape.corners[(side + 1) % shape.corners.size()];
  if (is_before(to->at, from->at)) std::swap(from, to);
  const Bounded a = planes_[plane].height(from->at, from->error), b = planes_[plane].height(to->at, to->error);
  const double span = std::abs(a.value) + std::abs(b.value), doubt = a.error + b.error;
  const double t = span > 0 ? std::abs(a.value) / span : 0.5;
  const glm::dvec3 way = to->at - from->at;
  PieceCorner corner{from->at + t * way, 0, {shape.sides[side], PieceShape::first_cut + plane}};
  const double length = std::abs(way.x) + std::abs(way.y) + std::abs(way.z);
  const double size = std::abs(corner.at.x) + std::abs(corner.at.y) + std::abs(corner.at.z);
  // The true corner is on the side, so it is never farther away than the side is long.
  corner.error = length * (span > 2 * doubt ? 2 * doubt / span : 1.0) + std::max(from->error, to->error) +
                 kRounding * (size + length);
  const std::array<Plane, 3> planes = planes_of(face, corner);
  const Approximate meeting = Plane::meeting({&planes[0], &planes[1], &planes[2]});
  const auto take_better = [&](const Approximate& found) {
    if (!(found.error < corner.error)) return;
    corner.at = found.at;
    corner.error = found.error;
  };
  take_better(meeting);
  const double allowed = kCornerError * (size + length);
  if (corner.error > allowed) take_better(Plane::closest_meeting({&planes[0], &planes[1], &planes[2]}, allowed));
  return corner;
}

Pieces::Halves Pieces::cut(std::uint32_t piece, std::uint32_t plane) {
  const PieceShape whole = shape_of(piece);
  const std::size_t count = whole.corners.size();
  const std::uint32_t cut = PieceShape::first_cut + plane;
  std::vector<int> at(count);
  for (std::size_t i = 0; i < count; ++i) at[i] = side_of_corner(faces_[piece], whole.corners[i], planes_[plane]);
  PieceShape front, back;
  const auto extend = [](PieceShape& half, const PieceCorner& corner, std::uint32_t side) {
    half.corners.push_back(corner);
    half.sides.push_back(side);
  };
  for (std::size_t i = 0; i < count; ++i) {
    const int next = at[(i + 1) % count];
    const std::uint32_t side = whole.sides[i];
    // A corner in the plane belongs to both halves; one of the halves continues along the cut.
    if (at[i] >= 0) extend(front, whole.corners[i], at[i] == 0 && next < 0 ? cut : side);
    if (at[i] <= 0) extend(back, whole.corners[i], at[i] == 0 && next > 0 ? cut : side);
    if (at[i] * next >= 0) continue;
    const PieceCorner corner = crossing(faces_[piece], whole, i, plane);
    extend(front, corner, next < 0 ? cut : side);
    extend(back, corner, next > 0 ? cut : side);
  }
  PolygonExtent& extent = extents_[piece];
  const PolygonExtent back_extent = extent_of(back, extent);
  extent = extent_of(front, extent);
  Face face = faces_[piece];
  const auto back_shape = std::uint32_t(shapes_.size());
  shapes_.push_back(std::move(back));
  if (face.shape == no_index) {
    faces_[piece].shape = back_shape + 1;
    shapes_.push_back(std::move(front));
  } else {
    shapes_[face.shape] = std::move(front);
  }
  face.shape = back_shape;
  add(back_extent, face);
  return {piece, size() - 1};
}

PolygonExtent Pieces::extent_of(const PieceShape& half, const PolygonExtent& whole) const {
  ExtentBuilder box(sight_);
  for (const PieceCorner& corner : half.corners) box.include(sight_.in_eye(corner.at), corner.error);
  const PolygonExtent own = box.extent();
  return {glm::max(own.low, whole.low), glm::min(own.high, whole.high), std::max(own.nearest, whole.nearest),
          std::min(own.farthest, whole.farthest)};
}

}  // namespace frontmost::painter_detail
