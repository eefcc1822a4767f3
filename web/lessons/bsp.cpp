// SPDX-License-Identifier: Apache-2.0
// A lesson's tree of planes (BSP): each node is a triangle whose plane separates the others and cuts those that cross
// it. The library's own (PaintMethod::bsp) chooses other planes, and gives the same picture.
#include <frontmost/painter.h>
#include <frontmost/zbuffer.h>

#include <algorithm>

#include "web/lessons/lessons.h"

namespace frontmost::web {
namespace {

struct BspPlane {
  glm::dvec3 normal{0};
  double offset = 0;
  [[nodiscard]] double side(const glm::dvec3& point) const { return glm::dot(normal, point) - offset; }
};

/// A triangle, or a convex piece of one, in world space. An edge goes from its corner to the next.
struct BspPiece {
  struct Corner {
    glm::dvec3 at{0};
    bool is_cut = false;  ///< the edge comes from a cut
  };
  PrimitiveId id = no_primitive;
  BspPlane plane;  ///< the triangle's plane: corners of a piece may be collinear, or nearly so
  std::vector<Corner> corners;
};

struct BspNode {
  BspPlane plane;
  std::vector<BspPiece> pieces;  ///< pieces in the plane; the one with the lowest id is last
  int parent = -1, before = -1, behind = -1;
  int level = 0;
};

class BspTree {
 public:
  explicit BspTree(const Surfaces& surfaces) : least_(1e-7 * double(surfaces.bounds().diagonal())) {
    std::vector<BspPiece> pieces;
    for (PrimitiveId id = surfaces.primitive_count(); id-- > 0;) {
      const std::array<glm::vec3, 3> corners = surfaces.corners(id);
      BspPiece piece{id, {}, {}};
      for (const glm::vec3& corner : corners) piece.corners.push_back({glm::dvec3(corner), false});
      const glm::dvec3 a(corners[0]), b(corners[1]), c(corners[2]), normal = glm::cross(b - a, c - a);
      const double length = glm::length(normal);
      // Triangles without width are invisible and have no plane; all others would seem to lie in it.
      if (length <= least_ * std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)})) continue;
      piece.plane = {normal / length, glm::dot(normal, a) / length};
      pieces.push_back(std::move(piece));
    }
    build(std::move(pieces), -1, 0);
  }

  [[nodiscard]] const std::vector<BspNode>& nodes() const { return nodes_; }

  /// Appends the nodes from back to front.
  void walk(const glm::dvec3& eye, int number, std::vector<int>& order) const {
    if (number < 0) return;
    const BspNode& node = nodes_[std::size_t(number)];
    const bool is_before = node.plane.side(eye) >= 0;
    walk(eye, is_before ? node.behind : node.before, order);
    order.push_back(number);
    walk(eye, is_before ? node.before : node.behind, order);
  }

 private:
  /// Whether corners lie before a plane, and whether some lie behind it.
  [[nodiscard]] std::pair<bool, bool> sides_of(const BspPlane& plane, const BspPiece& piece) const {
    bool before = false, behind = false;
    for (const BspPiece::Corner& corner : piece.corners) {
      before = before || plane.side(corner.at) > least_;
      behind = behind || plane.side(corner.at) < -least_;
    }
    return {before, behind};
  }

  /// The part of a piece on the side where `sign` times the distance is positive.
  static BspPiece half_of(const BspPiece& piece, const BspPlane& plane, double sign) {
    BspPiece half{piece.id, piece.plane, {}};
    for (std::size_t i = 0; i < piece.corners.size(); ++i) {
      const BspPiece::Corner& from = piece.corners[i];
      const BspPiece::Corner& to = piece.corners[(i + 1) % piece.corners.size()];
      const double at_from = sign * plane.side(from.at), at_to = sign * plane.side(to.at);
      if (at_from >= 0) half.corners.push_back(from);
      if ((at_from >= 0) == (at_to >= 0)) continue;
      const glm::dvec3 border = from.at + (to.at - from.at) * (at_from / (at_from - at_to));
      half.corners.push_back({border, at_from >= 0 || from.is_cut});
    }
    return half;
  }

  /// The index of the piece whose plane cuts the fewest others.
  [[nodiscard]] std::size_t choose(const std::vector<BspPiece>& pieces) const {
    std::size_t best = 0, fewest = pieces.size();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const BspPlane& plane = pieces[i].plane;
      const auto cuts = std::size_t(std::count_if(pieces.begin(), pieces.end(), [&](const BspPiece& piece) {
        const auto [before, behind] = sides_of(plane, piece);
        return before && behind;
      }));
      if (cuts < fewest) fewest = cuts, best = i;
    }
    return best;
  }

  int build(std::vector<BspPiece> pieces, int parent, int level) {
    if (pieces.empty()) return -1;
    const int number = int(nodes_.size());
    nodes_.push_back({pieces[choose(pieces)].plane, {}, parent, -1, -1, level});
    const BspPlane plane = nodes_.back().plane;
    std::vector<BspPiece> before, behind;
    for (BspPiece& piece : pieces) {
      const auto [reaches_before, reaches_behind] = sides_of(plane, piece);
      if (reaches_before && reaches_behind) {
        before.push_back(half_of(piece, plane, 1));
        behind.push_back(half_of(piece, plane, -1));
      } else {
        (reaches_before   ? before
         : reaches_behind ? behind
                          : nodes_[std::size_t(number)].pieces)
            .push_back(std::move(piece));
      }
    }
    const int first = build(std::move(before), number, level + 1), second = build(std::move(behind), number, level + 1);
    nodes_[std::size_t(number)].before = first;
    nodes_[std::size_t(number)].behind = second;
    return number;
  }

  double least_;
  std::vector<BspNode> nodes_;
};

void add_polygon(PaintOrder& order, const BspPiece& piece) {
  std::vector<PaintCorner> corners;
  double twice = 0;
  for (const BspPiece::Corner& corner : piece.corners)
    corners.push_back(
        {glm::dvec3(pixel_of_point(order.view, corner.at), from_eye(order.view, corner.at).z), corner.is_cut});
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 &a = corners[i].at, &b = corners[(i + 1) % corners.size()].at;
    twice += a.x * b.y - a.y * b.x;
  }
  if (twice > 0) {  // clockwise, as y points down; reversed, edges start at their other corner
    std::reverse(corners.begin(), corners.end());
    const bool first = corners.front().is_cut;
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) corners[i].is_cut = corners[i + 1].is_cut;
    corners.back().is_cut = first;
  }
  order.polygons.push_back({piece.id, std::uint32_t(corners.size()), order.corners.size()});
  order.corners.insert(order.corners.end(), corners.begin(), corners.end());
}

}  // namespace

PlainJson bsp_lesson(const PlainJson& question) {
  static std::vector<std::uint8_t> colors;
  const LessonScene& stage = lesson_scene(question);
  const View view = lesson_view(stage, question);
  constexpr std::uint32_t most_triangles = 200;
  if (stage.surfaces.primitive_count() > most_triangles)
    throw Error(ErrorCode::bad_argument, "scene", "more than 200 triangles");
  const BspTree tree(stage.surfaces);
  std::vector<int> order;
  tree.walk(view.eye(), tree.nodes().empty() ? -1 : 0, order);
  const std::size_t step = std::min<std::size_t>(question.value("step", order.size()), order.size());
  PaintOrder whole, painted;
  whole.view = painted.view = view;
  for (std::size_t i = 0; i < order.size(); ++i)
    for (const BspPiece& piece : tree.nodes()[std::size_t(order[i])].pieces) {
      add_polygon(whole, piece);
      if (i < step) add_polygon(painted, piece);
    }
  colors = triangle_colors(paint(stage.surfaces, painted));
  const Visible all = paint(stage.surfaces, whole), right = zbuffer(stage.surfaces, view);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < right.primitives.size(); ++i) wrong += all.primitives[i] != right.primitives[i];
  PlainJson nodes = PlainJson::array();
  for (const BspNode& node : tree.nodes()) {
    PlainJson triangles = PlainJson::array();
    for (const BspPiece& piece : node.pieces) triangles.push_back(piece.id);
    nodes.push_back({{"parent", node.parent},
                     {"before", node.before},
                     {"behind", node.behind},
                     {"level", node.level},
                     {"eye_is_before", node.plane.side(view.eye()) >= 0},
                     {"triangles", std::move(triangles)}});
  }
  return {{"width", view.width},
          {"height", view.height},
          {"pixels", place_of(colors.data(), colors.size())},
          {"nodes", std::move(nodes)},
          {"order", order},
          {"polygons", whole.polygons.size()},
          {"triangles", stage.surfaces.primitive_count()},
          {"wrong_count", wrong}};
}

}  // namespace frontmost::web
