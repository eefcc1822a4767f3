// SPDX-License-Identifier: Apache-2.0
// Triangles as a view sees them, and the convex pieces that they are cut into.
//
//        whole            cut by a plane          A piece is given by its triangle and, if it was cut, by the
//          /\                  /\                 sides of its outline. A side is an edge of the triangle
//         /  \                /  \.....           (0 to 2) or a stored cutting plane (first_cut + k). Two sides
//        /    \              / front              meet at a corner, whose place is rounded, with a bound; its
//       /______\            /__________           exact place is the meeting point of three planes.
//
// Pieces are numbered and never moved. When a piece is cut, the front half keeps the number, and the back half gets a
// new number at the end. So lists of numbers stay valid.
#pragma once

#include <deque>
#include <vector>

#include "frontmost/painter.h"
#include "painter/cutting/plane.h"
#include "view/sight.h"

namespace frontmost::painter_detail {

/// Boxes around a piece: on the screen in pixels, and in planar distances. Rounded outwards.
struct PolygonExtent {
  glm::vec2 low, high;
  float nearest, farthest;
};

/// The triangle that a piece belongs to, counter-clockwise to the eye.
struct Face {
  std::array<glm::vec3, 3> corners;
  PrimitiveId id;
  std::uint32_t shape = no_index;  ///< index of the piece's own outline in Pieces; no_index if the piece is all of the
                                   ///< triangle

  [[nodiscard]] glm::dvec3 corner(std::size_t k) const { return glm::dvec3(corners[k]); }
  [[nodiscard]] Plane plane() const { return Plane::through(corner(0), corner(1), corner(2)); }
};

/// A corner of a piece: a vertex of its triangle, or the point where two sides meet.
struct PieceCorner {
  glm::dvec3 at;
  double error = 0;                                        ///< greatest distance of the true corner from `at`
  std::array<std::uint32_t, 2> sides{no_index, no_index};  ///< numbered as in PieceShape; no_index: a vertex of the
                                                           ///< triangle
};

/// The outline of a piece that was cut, in the winding of its triangle.
struct PieceShape {
  /// Side i leads from corner i to the next: 0 to 2 is an edge of the triangle, first_cut + k is Pieces::planes_[k].
  static constexpr std::uint32_t first_cut = 3;
  std::vector<PieceCorner> corners;
  std::vector<std::uint32_t> sides;
};

/// The sides of a plane on which a piece has points.
struct Sides {
  bool front = false, back = false;
  [[nodiscard]] bool both() const { return front && back; }
  [[nodiscard]] bool none() const { return !front && !back; }
};

/// All pieces of a view, by number. A piece that is cut leaves its number to its front half.
class Pieces {
 public:
  explicit Pieces(const View& view) : sight_(view) {}

  [[nodiscard]] std::uint32_t size() const { return std::uint32_t(faces_.size()); }
  [[nodiscard]] const Sight& sight() const { return sight_; }
  [[nodiscard]] const PolygonExtent& extent(std::uint32_t piece) const { return extents_[piece]; }
  [[nodiscard]] const Face& face(std::uint32_t piece) const { return faces_[piece]; }
  [[nodiscard]] bool is_whole(std::uint32_t piece) const { return faces_[piece].shape == no_index; }
  [[nodiscard]] const PieceShape& shape(std::uint32_t piece) const { return shapes_[faces_[piece].shape]; }
  [[nodiscard]] std::uint32_t corner_count(std::uint32_t piece) const {
    return is_whole(piece) ? 3 : std::uint32_t(shape(piece).corners.size());
  }
  /// Sets corner_count() corners to those of the piece on the screen.
  void copy_corners(std::uint32_t piece, PaintCorner* corners) const;

  void add(const PolygonExtent& extent, const Face& face) {
    extents_.push_back(extent);
    faces_.push_back(face);
  }
  /// Makes room for whole triangles, which set() then fills, or removes the last ones.
  void resize(std::size_t count) {
    extents_.resize(count);
    faces_.resize(count);
  }
  void set(std::size_t piece, const PolygonExtent& extent, const Face& face) {
    extents_[piece] = extent;
    faces_[piece] = face;
  }

  /// Returns the sides of a plane on which the piece has points, exactly.
  [[nodiscard]] Sides sides(std::uint32_t piece, const Plane& plane) const;
  /// Returns whether no point of the piece is on the side `sign` of a plane. Quicker than sides(). Sets `is_flat` if
  /// the whole triangle is in the plane.
  [[nodiscard]] bool keeps_off(std::uint32_t piece, const Plane& plane, int sign, bool& is_flat) const;
  /// Returns the plane through the eye and an edge of the triangle, positive on the triangle's side.
  [[nodiscard]] Plane edge_plane(const Face& face, std::uint32_t edge) const {
    const glm::dvec3 p(face.corners[edge]), q(face.corners[edge == 2 ? 0 : edge + 1]);
    const Leg sight = sight_.is_parallel() ? Leg{sight_.forward()} : Leg{p, sight_.eye()};
    return {p, {q, p}, sight};
  }

  struct Halves {
    std::uint32_t front, back;
  };
  /// Stores a plane to cut by. \returns its number.
  std::uint32_t add_plane(const Plane& plane) {
    planes_.push_back(plane);
    return std::uint32_t(planes_.size() - 1);
  }
  /// Cuts a piece; the front half keeps the number. Precondition: sides() of that plane has both().
  Halves cut(std::uint32_t piece, std::uint32_t plane);

 private:
  [[nodiscard]] int side_of_corner(const Face& face, const PieceCorner& corner, const Plane& plane) const;
  [[nodiscard]] PieceShape shape_of(std::uint32_t piece) const;
  [[nodiscard]] std::array<Plane, 3> planes_of(const Face& face, const PieceCorner& corner) const;
  [[nodiscard]] PieceCorner crossing(const Face& face, const PieceShape& shape, std::size_t side,
                                     std::uint32_t plane) const;
  [[nodiscard]] PolygonExtent extent_of(const PieceShape& half, const PolygonExtent& whole) const;

  Sight sight_;
  std::vector<PolygonExtent> extents_;
  std::vector<Face> faces_;
  std::deque<PieceShape> shapes_;
  std::deque<Plane> planes_;
};

/// Finds the box around points of eye space, as far as they are in front of the eye. Each point is known to within an
/// error.
class ExtentBuilder {
 public:
  explicit ExtentBuilder(const Sight& sight);
  void include(const glm::dvec3& in_eye, double error = 0);
  [[nodiscard]] PolygonExtent extent() const;

 private:
  const Sight& sight_;
  const glm::dvec2 centre_, unit_;  ///< on the screen: centre of the view, and size of a unit at distance 1
  glm::dvec2 low_{std::numeric_limits<double>::infinity()}, high_{-std::numeric_limits<double>::infinity()};
  double nearest_ = std::numeric_limits<double>::infinity(), farthest_ = -std::numeric_limits<double>::infinity();
};

}  // namespace frontmost::painter_detail
